#pragma once
// The slow twin of dae/loop: Φ of a scene's loops from the positions of its bodies alone, and
// everything else by dual numbers, in long double.
//
//   Φ(t, q)    b_j · (x_A − x_B), a_i · b_j, (|x_A − x_B|² − l²) / (2 l) on frames(t, q)
//   Φ̇          derivative of Φ along q̇ = N(q) u, ṫ = 1
//   Φ_q        the same along N(q) e_j, ṫ = 0
//   Φ̈, Φ̇_q     derivative of those along the motion
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
    for (const LoopSpec& spec : scene.loops)
      loops_.push_back(plane ? planar(spec, *plane, at_zero) : spatial(spec));
  }

  template <class S>
  List<S> positions(const S& t, const List<S>& q) const {
    const auto frames = motion_.frames(t, q);
    List<S> phi;
    for (const Loop& l : loops_) {
      const auto [axes_a, origin_a] = frame(frames, l.spec->child);
      const auto [axes_b, origin_b] = frame(frames, l.spec->parent);
      const Triple<S> gap = (origin_a + axes_a * triple<S>(l.spec->origin_child)) -
                            (origin_b + axes_b * triple<S>(l.spec->origin_parent));
      if (l.spec->kind == LoopKind::distance) {
        const S length = lift<S>(l.spec->length);
        phi.push_back((inner(gap, gap) - length * length) / (lift<S>(2) * length));
        continue;
      }
      for (const std::size_t j : l.points) phi.push_back(inner(axes_b * raised<S>(l.b[j]), gap));
      for (const auto& [i, j] : l.axes)
        phi.push_back(inner(axes_a * raised<S>(l.a[i]), axes_b * raised<S>(l.b[j])) -
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
      n += l.spec->kind == LoopKind::distance
               ? 1
               : static_cast<Eigen::Index>(l.points.size() + l.axes.size());
    return n;
  }

 private:
  using D1 = Dual<Real, 1>;
  struct Loop {
    const LoopSpec* spec;
    std::array<Triple<Real>, 3> a, b;  ///< axes in the scene's axes of child and parent
    List<std::size_t> points;
    List<std::pair<std::size_t, std::size_t>> axes;
    Real cosine = 0;  ///< between the axes of a universal loop
  };

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
  static Loop spatial(const LoopSpec& spec) {
    Loop l{&spec, {}, {}, {0, 1, 2}, {}, 0};
    Rotation<Real> e = from_quaternion(Real(1), Triple<Real>{});
    if (spec.kind == LoopKind::revolute || spec.kind == LoopKind::prismatic ||
        spec.kind == LoopKind::universal || spec.kind == LoopKind::cylindrical ||
        spec.kind == LoopKind::planar) {
      const Triple<Real> axis = unit(spec.axis), z{0, 0, 1};
      e = from_quaternion(1 + inner(z, axis), outer(z, axis));
    }
    const Rotation<Real> child = transposed(e), parent = transposed(product(turn_of(spec), e));
    for (std::size_t i = 0; i < 3; ++i) {
      l.a[i] = child[i];
      l.b[i] = parent[i];
    }
    if (spec.kind == LoopKind::prismatic || spec.kind == LoopKind::cylindrical) l.points = {0, 1};
    if (spec.kind == LoopKind::planar) l.points = {2};
    if (spec.kind == LoopKind::revolute || spec.kind == LoopKind::cylindrical ||
        spec.kind == LoopKind::planar)
      l.axes = {{2, 0}, {2, 1}};
    if (spec.kind == LoopKind::universal) {
      l.a[0] = unit(spec.axis2);
      l.axes = {{0, 2}};
      l.cosine = inner(unit(spec.axis), unit(spec.axis2));
    }
    if (spec.kind == LoopKind::prismatic || spec.kind == LoopKind::weld)
      l.axes = {{0, 1}, {1, 2}, {2, 0}};
    return l;
  }

  /// First axis along e1, or along the slide, both bodies at joint position zero.
  static Loop planar(const LoopSpec& spec, const Eigen::Matrix3d& plane,
                     const std::map<std::string, Rotation<Real>>& at_zero) {
    Loop l{&spec, {}, {}, {0, 1}, {}, 0};
    const Rotation<Real> parent = at_zero.at(spec.parent);
    const Rotation<Real> joint = product(parent, turn_of(spec));
    const bool slides = spec.kind == LoopKind::prismatic;
    const Triple<Real> first =
        slides ? joint * unit(spec.axis) : triple<Real>(Eigen::Vector3d(plane.col(0)));
    const Triple<Real> second = outer(triple<Real>(Eigen::Vector3d(plane.col(2))), first);
    l.b = {transposed(parent) * first, transposed(parent) * second, {}};
    l.a = {transposed(joint) * first, transposed(joint) * second, {}};
    if (slides) l.points = {1};
    if (slides || spec.kind == LoopKind::weld) l.axes = {{0, 1}};
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
