#pragma once
// The slow twin of dae/mechanism/loop: Φ of a scene's loops from the positions of its bodies alone,
// and everything else by dual numbers, in long double.
//
//   Φ(t, q)    b_j · (x_A − x_B), a_i · b_j, (|x_A − x_B|² − l²) / (2 l) on frames(t, q)
//   Φ̇          derivative of Φ along q̇ = N(q) u, ṫ = 1
//   Φ_q        the same along N(q) e_j, ṫ = 0
//   Φ̈, Φ̇_q     derivative of those along the motion
//
// Drives are functions of t here: origins and lengths as they say; a driven displacement shifts the
// parent's point; of a driven angle the rotation is written out, as the scene format defines it,
// and undone on the child's axes (or, outer angle of a universal loop alone, done to the parent's).
//
// With a basis of the plane given (columns e1, e2, normal) the rows are those of a planar scene.

#include "equations/dense_lagrangian.h"

#include <optional>

namespace momenta::equations {

class DenseLoops {
 public:
  template <class S>
  using List = std::vector<S>;

  DenseLoops(const Scene& scene, const DenseLagrangian& motion,
             const std::optional<Eigen::Matrix3d>& plane = {})
      : motion_(motion) {
    std::map<std::string, Rotation<Real>> at_zero;  // body axes with all joints at zero
    at_zero["ground"] = from_quaternion(Real(1), Triple<Real>{});
    for (std::size_t k = 0; k < scene.bodies.size(); ++k)
      index_[scene.bodies[k].name] = static_cast<int>(k);
    while (at_zero.size() <= scene.bodies.size())
      for (const JointSpec& j : scene.joints)
        if (at_zero.contains(j.parent)) at_zero[j.child] = product(at_zero[j.parent], turn_of(j));
    for (const LoopSpec& spec : scene.loops) {
      std::array<const DriveSpec*, 3> driven{}, origin{};
      for (const DriveSpec& d : scene.drives)
        if (d.loop == spec.name) {
          if (d.origin.empty())
            driven[static_cast<std::size_t>(d.coordinate)] = &d;
          else
            origin[static_cast<std::size_t>(d.origin[0] - 'x')] = &d;
        }
      if (spec.kind == LoopKind::distance || spec.kind == LoopKind::coupler)
        loops_.push_back({&spec, {}, {}, {}, {}, 0, {}, {}, {}, {}, {}});
      else
        loops_.push_back(plane ? planar(spec, driven, *plane, at_zero) : spatial(spec, driven));
      loops_.back().driven = driven;
      loops_.back().origin = origin;
      const auto given = [](const DriveSpec* d) { return d != nullptr; };
      if (plane && !std::any_of(driven.begin(), driven.end(), given) &&
          !std::any_of(origin.begin(), origin.end(), given) && only_points(spec.kind) &&
          apart(scene, spec.child, spec.parent))
        loops_.back().tied_along = plane;
    }
  }

  template <class S>
  List<S> positions(const S& t, const List<S>& q) const {
    const auto frames = motion_.frames(t, q);
    List<S> phi;
    for (const Loop& l : loops_) {
      if (l.spec->kind == LoopKind::coupler) {
        phi.push_back(coupling(l, t, q));
        continue;
      }
      const auto [axes_a, origin_a] = frame(frames, l.spec->child);
      const auto [axes_b, origin_b] = frame(frames, l.spec->parent);
      Triple<S> at_b = triple<S>(l.spec->origin_parent);
      for (std::size_t i = 0; i < 3; ++i)
        if (l.origin[i]) at_b[i] = drive_position(*l.origin[i], t);
      for (const auto& [axis, drive] : l.slides)
        at_b = at_b + drive_position(*drive, t) * raised<S>(axis);
      const Triple<S> gap =
          (origin_a + axes_a * triple<S>(l.spec->origin_child)) - (origin_b + axes_b * at_b);
      if (l.spec->kind == LoopKind::distance) {
        S length = lift<S>(l.spec->length), scale = length;
        if (l.driven[0]) {
          length = drive_position(*l.driven[0], t);
          scale = lift<S>(drive_position(*l.driven[0], Real(0)));
        }
        phi.push_back((inner(gap, gap) - length * length) / (lift<S>(2) * scale));
        continue;
      }
      const auto turn = [&](const List<Angle>& angles) {
        auto r = from_quaternion(lift<S>(1), Triple<S>{});
        for (const Angle& a : angles)
          r = product(r,
                      about_axis(raised<S>(a.axis), lift<S>(a.sign) * drive_position(*a.drive, t)));
        return r;
      };
      const Rotation<S> turned_a = product(axes_a, turn(l.turns_a)),
                        turned_b = product(axes_b, turn(l.turns_b));
      for (const std::size_t j : l.points)
        phi.push_back(l.tied_along
                          ? inner(triple<S>(l.tied_along->col(static_cast<Eigen::Index>(j))), gap)
                          : inner(turned_b * raised<S>(l.b[j]), gap));
      for (const auto& [i, j] : l.axes)
        phi.push_back(inner(turned_a * raised<S>(l.a[i]), turned_b * raised<S>(l.b[j])) -
                      lift<S>(l.cosine));
    }
    return phi;
  }

  /// Derivative of Φ along (N u, ṫ = 1), or with the clock stopped.
  template <class S>
  List<S> velocities(const S& t, const List<S>& q, const List<S>& u, bool clock_runs) const {
    using D = Dual<S, 1>;
    const List<S> qdot = motion_.coordinate_rates(q, u);
    List<D> along(q.size());
    for (std::size_t i = 0; i < q.size(); ++i) along[i] = moving(q[i], qdot[i]);
    const auto phi = positions(moving(t, lift<S>(clock_runs ? 1 : 0)), along);
    List<S> rate;
    for (const D& x : phi) rate.push_back(x.b[0]);
    return rate;
  }

  // At one state, results as vectors.
  RealVector positions_at(Real t, const Eigen::VectorXd& q) const {
    return vector(positions(t, real(q)));
  }
  RealVector velocities_at(Real t, const Eigen::VectorXd& q, const Eigen::VectorXd& u) const {
    return vector(velocities(t, real(q), real(u), true));
  }
  /// Φ̈ for these u̇.
  RealVector accelerations_at(Real t, const Eigen::VectorXd& q, const Eigen::VectorXd& u,
                              const Eigen::VectorXd& udot) const {
    List<D1> rates(static_cast<std::size_t>(u.size()));
    for (std::size_t i = 0; i < rates.size(); ++i)
      rates[i] =
          moving(Real(u[static_cast<Eigen::Index>(i)]), Real(udot[static_cast<Eigen::Index>(i)]));
    return derivative(velocities(moving(t, Real(1)), along_motion(q, u), rates, true));
  }
  /// Φ_q and d/dt Φ_q along the motion.
  std::pair<RealMatrix, RealMatrix> jacobian_at(Real t, const Eigen::VectorXd& q,
                                                const Eigen::VectorXd& u) const {
    RealMatrix j(rows(), u.size()), rate(rows(), u.size());
    for (Eigen::Index i = 0; i < u.size(); ++i) {
      List<D1> unit(static_cast<std::size_t>(u.size()), D1(Real(0)));
      unit[static_cast<std::size_t>(i)] = D1(Real(1));
      const auto column = velocities(moving(t, Real(1)), along_motion(q, u), unit, false);
      rate.col(i) = derivative(column);
      for (std::size_t row = 0; row < column.size(); ++row)
        j(static_cast<Eigen::Index>(row), i) = column[row].a;
    }
    return {j, rate};
  }
  /// ∂(Φ̇ᵀσ)/∂q: what σ adds to ∂L/∂q in ∂L*/∂q. Canonical trees: nq = nv.
  RealVector impulse_gradient(Real t, const Eigen::VectorXd& q, const Eigen::VectorXd& u,
                              const Eigen::VectorXd& sigma) const {
    RealVector gradient(q.size());
    List<D1> rates;
    for (const double x : u) rates.emplace_back(Real(x));
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      List<D1> at;
      for (Eigen::Index k = 0; k < q.size(); ++k)
        at.push_back(moving(Real(q[k]), Real(k == i ? 1 : 0)));
      gradient[i] = derivative(velocities(D1(t), at, rates, true)).dot(sigma.cast<Real>());
    }
    return gradient;
  }
  Eigen::Index rows() const {
    Eigen::Index n = 0;
    for (const Loop& l : loops_)
      n += l.spec->kind == LoopKind::distance || l.spec->kind == LoopKind::coupler
               ? 1
               : static_cast<Eigen::Index>(l.points.size() + l.axes.size());
    return n;
  }

 private:
  using D1 = Dual<Real, 1>;
  struct Angle {
    Triple<Real> axis;  ///< in the body's axes
    Real sign;
    const DriveSpec* drive;
  };
  using Drives = std::array<const DriveSpec*, 3>;
  struct Loop {
    const LoopSpec* spec;
    std::array<Triple<Real>, 3> a, b;  ///< axes in the scene's axes of child and parent
    List<std::size_t> points;
    List<std::pair<std::size_t, std::size_t>> axes;
    Real cosine = 0;  ///< between the axes of a universal loop
    List<std::pair<Triple<Real>, const DriveSpec*>> slides;  ///< axes of the parent
    List<Angle> turns_a, turns_b;
    Drives driven{}, origin{};
    std::optional<Eigen::Matrix3d> tied_along{};  ///< of a tie in a plane: axes of the ground
  };

  static bool only_points(LoopKind kind) {
    return kind == LoopKind::point || kind == LoopKind::spherical || kind == LoopKind::revolute;
  }
  /// Whether no body carries both.
  static bool apart(const Scene& scene, const std::string& a, const std::string& b) {
    const auto carriers = [&](std::string name) {
      std::vector<std::string> all;
      while (name != "ground") {
        all.push_back(name);
        for (const JointSpec& j : scene.joints)
          if (j.child == all.back()) name = j.parent;
      }
      return all;
    };
    for (const std::string& x : carriers(a))
      for (const std::string& y : carriers(b))
        if (x == y) return false;
    return true;
  }

  template <class S>
  S coupling(const Loop& l, const S& t, const List<S>& q) const {
    S sum = l.driven[0] ? lift<S>(-1) * drive_position(*l.driven[0], t) : lift<S>(-l.spec->offset);
    for (std::size_t i = 0; i < l.spec->joints.size(); ++i) {
      const int coordinate = l.spec->coordinates.empty() ? 0 : l.spec->coordinates[i];
      const auto [at, drive] = motion_.coordinate(l.spec->joints[i], coordinate);
      sum += lift<S>(l.spec->ratios[i]) *
             (drive ? drive_position(*drive, t) : q[static_cast<std::size_t>(at)]);
    }
    return sum;
  }

  template <class Spec>
  static Rotation<Real> turn_of(const Spec& s) {
    return from_quaternion(Real(s.rotation.w()), triple<Real>(s.rotation.vec()));
  }
  template <class S>
  static Triple<S> raised(const Triple<Real>& v) {
    return {lift<S>(v[0]), lift<S>(v[1]), lift<S>(v[2])};
  }
  template <class S>
  static Dual<S, 1> moving(const S& value, const S& rate) {
    Dual<S, 1> x;
    x.a = value;
    x.b[0] = rate;
    return x;
  }
  static Triple<Real> unit(const Eigen::Vector3d& v) {
    const Triple<Real> along = triple<Real>(v);
    return (1 / std::sqrt(inner(along, along))) * along;
  }

  /// Third axis along the joint's, by the shortest turn from z; the child's axes as at zero.
  static Loop spatial(const LoopSpec& spec, const Drives& driven) {
    Loop l{&spec, {}, {}, {}, {}, 0, {}, {}, {}, {}, {}};
    const LoopKind kind = spec.kind;
    const Triple<Real> z{0, 0, 1};
    Triple<Real> third = z;
    if (kind == LoopKind::revolute || kind == LoopKind::prismatic || kind == LoopKind::universal ||
        kind == LoopKind::cylindrical || kind == LoopKind::planar || kind == LoopKind::slot)
      third = unit(spec.axis);
    const Triple<Real> hinge = third;
    Triple<Real> second{};
    if (kind == LoopKind::universal)
      second =
          unit(spec.axis2.isZero() ? perpendicular_to(spec.axis) : Eigen::Vector3d(spec.axis2));
    const bool outer_alone = kind == LoopKind::universal && driven[0] && !driven[1];
    if (outer_alone) third = second;
    Rotation<Real> e = from_quaternion(1 + inner(z, third), outer(z, third));
    if (kind == LoopKind::planar && (driven[0] || driven[1] || driven[2])) {
      Triple<Real> first = triple<Real>(spec.direction.isZero() ? perpendicular_to(spec.axis)
                                                                : Eigen::Vector3d(spec.direction));
      first = first - inner(first, third) * third;
      first = (1 / std::sqrt(inner(first, first))) * first;
      e = transposed(Rotation<Real>{first, outer(third, first), third});
    }
    const Rotation<Real> child = transposed(e), parent = transposed(product(turn_of(spec), e));
    for (std::size_t i = 0; i < 3; ++i) {
      l.a[i] = child[i];
      l.b[i] = parent[i];
    }
    const auto slide = [&](std::size_t coordinate, std::size_t axis) {
      if (!driven[coordinate]) return;
      l.points.push_back(axis);
      l.slides.emplace_back(parent[axis], driven[coordinate]);
    };
    // C of the coordinates, inner angles first taken off.
    const auto undo = [&](const Triple<Real>& axis, const DriveSpec* drive) {
      if (drive) l.turns_a.push_back({axis, -1, drive});
    };
    switch (kind) {
      case LoopKind::prismatic:
      case LoopKind::cylindrical:
      case LoopKind::slot:
        l.points = {0, 1};
        slide(0, 2);
        break;
      case LoopKind::planar:
        l.points = {2};
        slide(0, 0);
        slide(1, 1);
        break;
      default:
        l.points = {0, 1, 2};
    }
    if (kind == LoopKind::prismatic || kind == LoopKind::weld ||
        (kind == LoopKind::spherical && driven[0]))
      l.axes = {{0, 1}, {1, 2}, {2, 0}};
    if (kind == LoopKind::spherical)
      for (std::size_t i = 0; i < 3; ++i) undo(identity()[i], driven[i]);
    const DriveSpec* angle = nullptr;  // about the third axis
    if (kind == LoopKind::revolute) angle = driven[0];
    if (kind == LoopKind::cylindrical) angle = driven[1];
    if (kind == LoopKind::planar) angle = driven[2];
    if (kind == LoopKind::universal) {
      undo(second, driven[1]);
      if (driven[1]) angle = driven[0];
      if (outer_alone) l.turns_b.push_back({turn_of(spec) * hinge, 1, driven[0]});
      if (!driven[0] && !driven[1]) {
        l.a[0] = second;
        l.axes = {{0, 2}};
        l.cosine = inner(hinge, second);
      }
    }
    if (l.axes.empty() && kind != LoopKind::point && kind != LoopKind::spherical &&
        kind != LoopKind::slot)
      l.axes = {{2, 0}, {2, 1}};
    if (angle) {
      l.axes.emplace_back(0, 1);
      undo(third, angle);
    }
    return l;
  }
  static Rotation<Real> identity() { return from_quaternion(Real(1), Triple<Real>{}); }

  /// First axis along e1, or along the slide, both bodies at joint position zero.
  static Loop planar(const LoopSpec& spec, const Drives& driven, const Eigen::Matrix3d& plane,
                     const std::map<std::string, Rotation<Real>>& at_zero) {
    Loop l{&spec, {}, {}, {0, 1}, {}, 0, {}, {}, {}, {}, {}};
    const Rotation<Real> parent = at_zero.at(spec.parent);
    const Rotation<Real> joint = product(parent, turn_of(spec));
    const bool slot = spec.kind == LoopKind::slot,
               slides = slot || spec.kind == LoopKind::prismatic;
    const Triple<Real> first =
        slides ? joint * unit(spec.axis) : triple<Real>(Eigen::Vector3d(plane.col(0)));
    const Triple<Real> second = outer(triple<Real>(Eigen::Vector3d(plane.col(2))), first);
    l.b = {transposed(parent) * first, transposed(parent) * second, {}};
    l.a = {transposed(joint) * first, transposed(joint) * second, {}};
    if (slides) l.points = {1};
    if (slides && driven[0]) {
      l.points.push_back(0);
      l.slides.emplace_back(l.b[0], driven[0]);
    }
    if ((slides && !slot) || spec.kind == LoopKind::weld) l.axes = {{0, 1}};
    if (spec.kind == LoopKind::revolute && driven[0]) {
      l.axes = {{0, 1}};
      l.turns_a.push_back({unit(spec.axis), -1, driven[0]});
    }
    return l;
  }

  template <class Frames>
  auto frame(const Frames& frames, const std::string& body) const {
    using S = std::remove_cvref_t<decltype(frames[0].origin[0])>;
    if (body == "ground") return std::pair{from_quaternion(lift<S>(1), Triple<S>{}), Triple<S>{}};
    const auto& f = frames[static_cast<std::size_t>(index_.at(body))];
    return std::pair{f.axes, f.origin};
  }

  static List<Real> real(const Eigen::VectorXd& x) { return {x.data(), x.data() + x.size()}; }
  static RealVector vector(const List<Real>& x) {
    return Eigen::Map<const RealVector>(x.data(), static_cast<Eigen::Index>(x.size()));
  }
  static RealVector derivative(const List<D1>& x) {
    RealVector v(static_cast<Eigen::Index>(x.size()));
    for (std::size_t i = 0; i < x.size(); ++i) v[static_cast<Eigen::Index>(i)] = x[i].b[0];
    return v;
  }
  List<D1> along_motion(const Eigen::VectorXd& q, const Eigen::VectorXd& u) const {
    const List<Real> at = real(q), qdot = motion_.coordinate_rates(at, real(u));
    List<D1> along;
    for (std::size_t i = 0; i < at.size(); ++i) along.push_back(moving(at[i], qdot[i]));
    return along;
  }

  const DenseLagrangian& motion_;
  std::map<std::string, int> index_;
  List<Loop> loops_;
};

}  // namespace momenta::equations
