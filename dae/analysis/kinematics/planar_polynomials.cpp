#include <momenta/core/scene/kinds.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/analysis/kinematics/isotropic.h>
#include <momenta/dae/analysis/kinematics/planar_polynomials.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace momenta {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Eigen::VectorXcd;
using Eigen::VectorXd;

bool is_written(LoopKind kind) {
  switch (kind) {
    case LoopKind::point:
    case LoopKind::revolute:
    case LoopKind::spherical:
    case LoopKind::weld:
    case LoopKind::prismatic:
    case LoopKind::slot:
    case LoopKind::distance:
      return true;
    default:
      return false;
  }
}

class PlanarLoops final : public LoopPolynomials {
 public:
  PlanarLoops(const Mechanism& mechanism, double t, const VectorXd& own,
              const std::vector<bool>& held)
      : mechanism_(mechanism),
        tree_(mechanism.tree()),
        t_(t),
        own_(own),
        poses_(poses_of_polynomials(mechanism, t, own)),
        length_(length_of(mechanism.scene())) {
    for (const Tree::Body& b : tree_.bodies)
      moves_.push_back(b.nv == 1 && !held[static_cast<std::size_t>(b.u)]);
    find_angles();
    find_slides();
    std::vector<Polynomial> equations = all_equations();
    if (equations.size() != groups_.size())
      refuse("has " + std::to_string(equations.size()) + " polynomials in " +
             std::to_string(groups_.size()) +
             " unknowns, since loop equations are redundant; "
             "expected as many");
    system_.emplace(std::move(equations), groups_);
  }

  const PolynomialSystem& system() const override { return *system_; }

  std::optional<VectorXd> pose(const VectorXcd& x) const override {
    const auto value = [&](int variable) {
      const int one = system_->groups()[of(groups_[of(variable)])].proper[0][0];
      return x[variable] / x[one];
    };
    const auto pair = [&](const std::pair<int, int>& of_both) -> std::optional<Complex> {
      const Complex z = value(of_both.first), w = value(of_both.second);
      if (std::abs(z - std::conj(w)) > real_enough * (1 + std::abs(z))) return std::nullopt;
      return z;
    };
    std::vector<Complex> turns(angles_.size(), 1);
    for (std::size_t a = 1; a < angles_.size(); ++a) {
      const auto z = pair(angles_[a]);
      if (!z) return std::nullopt;
      turns[a] = *z;
    }
    VectorXd q = own_;
    for (std::size_t k = 0; k < tree_.bodies.size(); ++k) {
      const Tree::Body& b = tree_.bodies[k];
      if (!moves_[k]) continue;
      if (b.kind == JointKind::revolute) {
        const Complex turned = turns[angle_of(static_cast<int>(k))] / turns[angle_of(b.parent)];
        q[b.q] += (along_normal(static_cast<int>(k)) ? 1 : -1) * std::arg(turned);
      } else if (slides_[k] >= 0) {
        const Complex s = value(slides_[k]);
        if (std::abs(s.imag()) > real_enough * (1 + std::abs(s))) return std::nullopt;
        q[b.q] += s.real() * length_;
      } else if (both_[k].first >= 0) {
        const auto way = pair(both_[k]);
        if (!way) return std::nullopt;
        // X = s₁ e₁ + s₂ e₂
        const Complex e1 = axis(b.parent), e2 = axis(static_cast<int>(k));
        const double across = std::imag(std::conj(e1) * e2);
        q[tree_.bodies[of(b.parent)].q] -= std::imag(std::conj(e2) * *way) / across * length_;
        q[b.q] += std::imag(std::conj(e1) * *way) / across * length_;
      }
    }
    return q;
  }

 private:
  static std::size_t of(int i) { return static_cast<std::size_t>(i); }

  [[noreturn]] void refuse(const std::string& what) const {
    throw SceneError(mechanism_.scene().where({}) + "the mechanism " + what);
  }

  Complex in_plane(const Vector3d& v) const {
    const Eigen::Matrix3d& basis = mechanism_.plan().basis;
    return {basis.col(0).dot(v), basis.col(1).dot(v)};
  }
  Complex origin(int body) const {
    return body < 0 ? Complex(0) : in_plane(poses_[of(body)].translation()) / length_;
  }
  /// Axis of a body's joint.
  Complex axis(int body) const { return in_plane(poses_[of(body)].linear().col(2)); }
  bool along_normal(int body) const {
    return mechanism_.plan().basis.col(2).dot(poses_[of(body)].linear().col(2)) > 0;
  }
  Complex point(int body, const Vector3d& scene_point) const {
    const Vector3d at = tree_.point(body, scene_point);
    return in_plane(body < 0 ? at : Vector3d(poses_[of(body)] * at)) / length_;
  }
  Complex direction(int body, const Vector3d& scene_direction) const {
    const Vector3d way = tree_.direction(body, scene_direction);
    return in_plane(body < 0 ? way : Vector3d(poses_[of(body)].linear() * way));
  }

  bool is_driven(const LoopSpec& l) const {
    return std::any_of(mechanism_.scene().drives.begin(), mechanism_.scene().drives.end(),
                       [&](const DriveSpec& d) { return d.loop == l.name && d.origin.empty(); });
  }

  /// Groups bodies that turn as one; the ground's angle is the first.
  void find_angles() {
    std::vector<int> same(tree_.bodies.size() + 1);  // ground first
    for (std::size_t i = 0; i < same.size(); ++i) same[i] = static_cast<int>(i);
    const auto root = [&](int i) {
      while (same[of(i)] != i) i = same[of(i)];
      return i;
    };
    const auto join = [&](int a, int b) {
      const int x = root(a + 1), y = root(b + 1);
      same[of(std::max(x, y))] = std::min(x, y);
    };
    for (std::size_t k = 0; k < tree_.bodies.size(); ++k) {
      const Tree::Body& b = tree_.bodies[k];
      const bool turns = b.kind == JointKind::revolute && moves_[k];
      if (b.nv > 0 && b.kind != JointKind::revolute && b.kind != JointKind::prismatic)
        refuse("has joint " + reading::in_quotes(b.joint) + " of kind " +
               std::string(reading::name_of(b.kind)) +
               ", which is no polynomial; expected joints that turn or slide");
      if (!turns) join(static_cast<int>(k), b.parent);
    }
    for (const LoopSpec& l : mechanism_.scene().loops)
      if (l.kind == LoopKind::weld || l.kind == LoopKind::prismatic ||
          (l.kind == LoopKind::revolute && is_driven(l)))
        join(tree_.body(l.parent), tree_.body(l.child));
    std::vector<int> number(same.size(), -1);
    angles_.assign(1, {-1, -1});
    number[0] = 0;
    for (std::size_t i = 0; i < same.size(); ++i) {
      const auto r = of(root(static_cast<int>(i)));
      if (number[r] < 0) {
        number[r] = static_cast<int>(angles_.size());
        angles_.emplace_back(variable(0), variable(1));
      }
      angle_.push_back(number[r]);
    }
  }
  std::size_t angle_of(int body) const { return of(angle_[of(body + 1)]); }

  int variable(int group) {
    groups_.push_back(group);
    return static_cast<int>(groups_.size()) - 1;
  }

  /// Whether the slide of body k alone moves on the slide of its parent.
  bool slides_on_a_slide(int k) const {
    const int parent = tree_.bodies[of(k)].parent;
    if (parent < 0 || tree_.bodies[of(parent)].kind != JointKind::prismatic || !moves_[of(parent)])
      return false;
    if (angle_of(parent) != 0) return false;
    if (std::abs(std::imag(std::conj(axis(parent)) * axis(k))) < 1e-3) return false;
    for (std::size_t i = 0; i < tree_.bodies.size(); ++i)
      if (tree_.bodies[i].parent == parent && static_cast<int>(i) != k) return false;
    for (const LoopSpec& l : mechanism_.scene().loops)
      if (tree_.body(l.parent) == parent || tree_.body(l.child) == parent) return false;
    return true;
  }

  void find_slides() {
    slides_.assign(tree_.bodies.size(), -1);
    both_.assign(tree_.bodies.size(), {-1, -1});
    int groups = 2;
    for (std::size_t k = 0; k < tree_.bodies.size(); ++k) {
      if (tree_.bodies[k].kind != JointKind::prismatic || !moves_[k]) continue;
      if (slides_on_a_slide(static_cast<int>(k)))
        both_[k] = {variable(0), variable(1)};
      else if (!carries_a_slide(static_cast<int>(k)))
        slides_[k] = variable(groups++);
    }
  }
  bool carries_a_slide(int k) const {
    for (std::size_t i = 0; i < tree_.bodies.size(); ++i)
      if (tree_.bodies[i].parent == k && tree_.bodies[i].kind == JointKind::prismatic &&
          moves_[i] && slides_on_a_slide(static_cast<int>(i)))
        return true;
    return false;
  }

  Isotropic turn(int body) const {
    const auto [z, w] = angles_[angle_of(body)];
    if (z < 0) return constant(1);
    return {{{1, {z}}}, {{1, {w}}}};
  }

  std::vector<Polynomial> all_equations() {
    std::vector<Isotropic> origins;
    const auto at = [&](int body) { return body < 0 ? constant(0) : origins[of(body)]; };
    for (std::size_t k = 0; k < tree_.bodies.size(); ++k) {
      const Tree::Body& b = tree_.bodies[k];
      const int body = static_cast<int>(k);
      Isotropic r = constant(origin(body) - origin(b.parent));
      if (slides_[k] >= 0)
        r = r + constant(axis(body)) * Isotropic{{{1, {slides_[k]}}}, {{1, {slides_[k]}}}};
      if (both_[k].first >= 0) r = r + Isotropic{{{1, {both_[k].first}}}, {{1, {both_[k].second}}}};
      origins.push_back(at(b.parent) + turn(b.parent) * r);
    }
    std::vector<Polynomial> equations;
    const auto add = [&](Polynomial p) {
      p = gathered(p);  // equations that hold at every pose vanish
      if (std::any_of(p.begin(), p.end(), [](const Monomial& m) { return !m.variables.empty(); }))
        equations.push_back(std::move(p));
    };
    for (std::size_t a = 1; a < angles_.size(); ++a)
      equations.push_back({{1, {angles_[a].first, angles_[a].second}}, {-1, {}}});
    for (const LoopSpec& l : mechanism_.scene().loops) {
      if (has_curves(l) || !is_written(l.kind))
        refuse("has loop " + reading::in_quotes(l.name) + " of kind " +
               std::string(reading::name_of(l.kind)) +
               ", which is not written as a polynomial; expected hinges, slides, welds and "
               "distances");
      const int a = tree_.body(l.child), b = tree_.body(l.parent);
      const Complex on_a = point(a, l.origin_child),
                    on_b = point(b, origin_of_loop(mechanism_.scene(), l, t_));
      const Isotropic gap = at(a) + turn(a) * constant(on_a - origin(a)) - at(b) -
                            turn(b) * constant(on_b - origin(b));
      if (l.kind == LoopKind::distance) {
        add(gap.z * gap.w + Polynomial{{-std::norm(on_a - on_b), {}}});
        continue;
      }
      const bool slides = l.kind == LoopKind::prismatic || l.kind == LoopKind::slot;
      if (slides && !is_driven(l)) {
        const Isotropic way = turn(b) * constant(direction(b, l.rotation * l.axis));
        add(gap.w * way.z + scaled(gap.z * way.w, -1));
        continue;
      }
      // A driven slide keeps its distance.
      const Isotropic apart = slides ? turn(b) * constant(on_a - on_b) : constant(0);
      add((gap - apart).z);
      add((gap - apart).w);
    }
    return equations;
  }

  const Mechanism& mechanism_;
  const Tree& tree_;
  double t_;
  VectorXd own_;
  std::vector<Isometry3d> poses_;
  double length_;
  std::vector<bool> moves_;                  ///< by body: its coordinate moves
  std::vector<int> groups_;                  ///< by variable
  std::vector<std::pair<int, int>> angles_;  ///< z and w by angle, without the ground's
  std::vector<int> angle_;                   ///< by body, the ground first
  std::vector<int> slides_;                  ///< s by body; −1: none
  std::vector<std::pair<int, int>> both_;    ///< X and X̄ by body; −1: none
  std::optional<PolynomialSystem> system_;
};

}  // namespace

std::unique_ptr<LoopPolynomials> planar_polynomials(const Mechanism& mechanism, double t,
                                                    const VectorXd& own,
                                                    const std::vector<bool>& held) {
  return std::make_unique<PlanarLoops>(mechanism, t, own, held);
}

}  // namespace momenta
