#include <momenta/dae/kinematics/platform_polynomials.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix4d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::Vector4d;
using Eigen::VectorXcd;
using Eigen::VectorXd;

/// v e as a matrix on e = (w, x, y, z).
Matrix4d from_left(const Vector3d& v) {
  Matrix4d m;
  m << 0, -v.x(), -v.y(), -v.z(),  //
      v.x(), 0, -v.z(), v.y(),     //
      v.y(), v.z(), 0, -v.x(),     //
      v.z(), -v.y(), v.x(), 0;
  return m;
}
/// e v
Matrix4d from_right(const Vector3d& v) {
  Matrix4d m;
  m << 0, -v.x(), -v.y(), -v.z(),  //
      v.x(), 0, v.z(), -v.y(),     //
      v.y(), -v.z(), 0, v.x(),     //
      v.z(), v.y(), -v.x(), 0;
  return m;
}

class Platform final : public LoopPolynomials {
 public:
  Platform(const Mechanism& mechanism, double t, const VectorXd& own)
      : mechanism_(mechanism),
        own_(own),
        poses_(poses_of_polynomials(mechanism, t, own)),
        length_(length_of(mechanism.scene())) {
    const Tree& tree = mechanism.tree();
    while (tree.bodies[body_].nv == 0) ++body_;
    std::vector<Polynomial> equations;
    Polynomial study;
    for (int i = 0; i < 4; ++i) study.push_back({1, {i, 4 + i}});
    equations.push_back(std::move(study));
    for (const LoopSpec& l : mechanism.scene().loops) {
      const Vector3d on_child = in_ground(tree.body(l.child), l.origin_child),
                     on_parent =
                         in_ground(tree.body(l.parent), origin_of_loop(mechanism.scene(), l, t));
      const bool is_child = tree.body(l.child) == static_cast<int>(body_);
      const Vector3d p = is_child ? on_child : on_parent, b = is_child ? on_parent : on_child;
      const double rest = p.squaredNorm() + b.squaredNorm() - (p - b).squaredNorm();
      const Matrix4d mixed = 4 * (from_right(p) - from_left(b)),
                     turned = -2 * from_left(b).transpose() * from_right(p) +
                              rest * Matrix4d::Identity();
      Polynomial rod;
      for (int i = 0; i < 4; ++i) {
        rod.push_back({4, {4 + i, 4 + i}});
        for (int j = 0; j < 4; ++j) {
          rod.push_back({mixed(i, j), {4 + i, j}});
          rod.push_back({turned(i, j), {i, j}});
        }
      }
      equations.push_back(std::move(rod));
    }
    system_.emplace(std::move(equations),
                    std::vector<VariableGroup>{{{0, 1, 2, 3, 4, 5, 6, 7}, {0, 1, 2, 3}}});
  }

  const PolynomialSystem& system() const override { return *system_; }

  std::optional<VectorXd> pose(const VectorXcd& x) const override {
    Eigen::Index largest;
    x.head<4>().cwiseAbs().maxCoeff(&largest);
    const VectorXcd turned = x / x[largest];
    if (turned.imag().norm() > real_enough * turned.norm()) return std::nullopt;
    const Vector4d e = turned.real().head<4>(), g = turned.real().tail<4>();
    const Quaterniond rotation(e[0], e[1], e[2], e[3]), dual(g[0], g[1], g[2], g[3]);
    Isometry3d displacement = Isometry3d::Identity();
    displacement.translate(2 * length_ / e.squaredNorm() * (dual * rotation.conjugate()).vec());
    displacement.rotate(rotation.normalized());
    const Tree::Body& b = mechanism_.tree().bodies[body_];
    const Isometry3d before =
        b.parent < 0 ? Isometry3d::Identity() : poses_[static_cast<std::size_t>(b.parent)];
    const Isometry3d in_joint = (before * b.placement).inverse() * displacement * poses_[body_];
    const Quaterniond now(in_joint.linear());
    VectorXd q = own_;
    q.segment<7>(b.q) << in_joint.translation(), now.w(), now.vec();
    return q;
  }

 private:
  Vector3d in_ground(int body, const Vector3d& scene_point) const {
    const Vector3d at = mechanism_.tree().point(body, scene_point);
    return (body < 0 ? at : Vector3d(poses_[static_cast<std::size_t>(body)] * at)) / length_;
  }

  const Mechanism& mechanism_;
  VectorXd own_;
  std::vector<Isometry3d> poses_;
  double length_;
  std::size_t body_ = 0;  ///< the one that moves
  std::optional<PolynomialSystem> system_;
};

}  // namespace

bool is_platform(const Mechanism& mechanism, const std::vector<bool>& held) {
  if (mechanism.scene().lagrangian) return false;
  const Tree& tree = mechanism.tree();
  int moving = -1;
  for (std::size_t k = 0; k < tree.bodies.size(); ++k) {
    const Tree::Body& b = tree.bodies[k];
    if (b.nv == 0) {
      if (b.parent >= 0 && b.parent == moving) return false;
      continue;
    }
    if (b.kind != JointKind::free || moving >= 0) return false;
    moving = static_cast<int>(k);
  }
  if (moving < 0 || std::any_of(held.begin(), held.end(), [](bool h) { return h; })) return false;
  const auto& loops = mechanism.scene().loops;
  return loops.size() == 6 && std::all_of(loops.begin(), loops.end(), [&](const LoopSpec& l) {
           return l.kind == LoopKind::distance &&
                  (tree.body(l.child) == moving) != (tree.body(l.parent) == moving);
         });
}

std::unique_ptr<LoopPolynomials> platform_polynomials(const Mechanism& mechanism, double t,
                                                      const VectorXd& own) {
  return std::make_unique<Platform>(mechanism, t, own);
}

}  // namespace momenta
