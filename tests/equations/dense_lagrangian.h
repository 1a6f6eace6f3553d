#pragma once
// The slow twin of core/kernel: the dynamics of a scene from the positions of its bodies alone.
//
// frames() places every body of the scene at (t, q), straight from the words of core/scene/scene.h.
// Everything else is differentiation of it by dual numbers and sums over bodies, in long double:
//
//   velocities   v, ω of each body: derivative of its frame along q̇ = N(q) u, ṫ = 1
//   J            the same along N(q) e_j, ṫ = 0: v and ω are affine in u, so J_j = ∂(v, ω)/∂u_j
//   p            = ∂T/∂u = Σ J·h, with h = (m v_c, I ω)
//   d'Alembert   Σ J_j·(ḣ − applied) = joint force j  gives  M u̇ = Q − Σ J·ḣ(u̇ = 0), M = Σ J·(m,
//   I)·J ṗ            = d/dt of p(q(t), u(t), t) along that u̇
//
// Nothing here knows of recursions, transforms or quasi-velocity equations. In canonical trees
// lagrange_rates() gives ṗ once more as ∂L/∂q + Q.

#include <momenta/core/kernel/tree/tree.h>
#include <momenta/core/scalar/dual.h>
#include <momenta/core/scene/scene.h>

#include <Eigen/Dense>
#include <array>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

namespace momenta::equations {

using Real = long double;
using RealVector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using RealMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

/// A constant as a (nested) dual number, no digit lost.
template <class S>
S lift(Real x) {
  if constexpr (std::is_same_v<S, Real>)
    return x;
  else
    return S(lift<decltype(S{}.a)>(x));
}

template <class S>
using Triple = std::array<S, 3>;
template <class S>
Triple<S> operator+(const Triple<S>& a, const Triple<S>& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
template <class S>
Triple<S> operator-(const Triple<S>& a, const Triple<S>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class S>
Triple<S> operator*(const S& s, const Triple<S>& a) {
  return {s * a[0], s * a[1], s * a[2]};
}
template <class S>
S inner(const Triple<S>& a, const Triple<S>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class S>
Triple<S> outer(const Triple<S>& a, const Triple<S>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <class S>
Triple<S> triple(const Eigen::Vector3d& v) {
  return {lift<S>(v[0]), lift<S>(v[1]), lift<S>(v[2])};
}

/// Rows of a rotation: body components to ground components.
template <class S>
using Rotation = std::array<Triple<S>, 3>;
template <class S>
Triple<S> operator*(const Rotation<S>& r, const Triple<S>& v) {
  return {inner(r[0], v), inner(r[1], v), inner(r[2], v)};
}
template <class S>
Rotation<S> transposed(const Rotation<S>& r) {
  Rotation<S> t;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) t[i][j] = r[j][i];
  return t;
}
template <class S>
Rotation<S> product(const Rotation<S>& a, const Rotation<S>& b) {
  const Rotation<S> columns = transposed(b);
  Rotation<S> r;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) r[i][j] = inner(a[i], columns[j]);
  return r;
}

/// v + 2 (w e × v + e × (e × v)) of the unit vectors v, for the quaternion (w, e) made unit.
template <class S>
Rotation<S> from_quaternion(const S& w, const Triple<S>& e) {
  const S twice = lift<S>(2) / (w * w + inner(e, e));
  Rotation<S> columns;
  for (std::size_t j = 0; j < 3; ++j) {
    Triple<S> v{};
    v[j] = lift<S>(1);
    const Triple<S> across = outer(e, v);
    columns[j] = v + twice * (w * across + outer(e, across));
  }
  return transposed(columns);
}
/// v + sin θ a × v + (1 − cos θ) a × (a × v) of the unit vectors v: Rodrigues.
template <class S>
Rotation<S> about_axis(const Triple<S>& a, const S& angle) {
  using std::cos, std::sin;
  const S c = cos(angle), s = sin(angle);
  Rotation<S> columns;
  for (std::size_t j = 0; j < 3; ++j) {
    Triple<S> v{};
    v[j] = lift<S>(1);
    const Triple<S> across = outer(a, v);
    columns[j] = v + s * across + (lift<S>(1) - c) * outer(a, across);
  }
  return transposed(columns);
}

/// The cubic of the gap that t is in, from the second derivatives m at the points: in a gap of
/// width h, x = (t − t₀)/h,  f = (1 − x) y₀ + x y₁ + h²/6 ((1 − x)³ − (1 − x)) m₀ + h²/6 (x³ − x)
/// m₁, and equal slopes at the points make m.
template <class S>
S natural_spline(const DriveSpec& d, const S& t) {
  const auto n = static_cast<Eigen::Index>(d.times.size());
  const auto time = [&](Eigen::Index i) { return Real(d.times[static_cast<std::size_t>(i)]); };
  const auto at = [&](Eigen::Index i) { return Real(d.values[static_cast<std::size_t>(i)]); };
  RealMatrix slopes = RealMatrix::Identity(n, n);
  RealVector right = RealVector::Zero(n);
  for (Eigen::Index i = 1; i + 1 < n; ++i) {
    const Real before = time(i) - time(i - 1), after = time(i + 1) - time(i);
    slopes(i, i - 1) = before / 6;
    slopes(i, i) = (before + after) / 3;
    slopes(i, i + 1) = after / 6;
    right[i] = (at(i + 1) - at(i)) / after - (at(i) - at(i - 1)) / before;
  }
  const RealVector m = slopes.fullPivLu().solve(right);
  Eigen::Index gap = 0;
  while (gap + 2 < n && value_of(t) >= d.times[static_cast<std::size_t>(gap + 1)]) ++gap;
  const Real h = time(gap + 1) - time(gap);
  const S x = (t - lift<S>(time(gap))) / lift<S>(h), z = lift<S>(1) - x;
  return z * lift<S>(at(gap)) + x * lift<S>(at(gap + 1)) +
         lift<S>(h * h / 6 * m[gap]) * (z * z * z - z) +
         lift<S>(h * h / 6 * m[gap + 1]) * (x * x * x - x);
}

/// f(t) of a drive; its derivatives are left to dual numbers.
template <class S>
S drive_position(const DriveSpec& d, const S& t) {
  using std::sin;
  if (d.kind == "polynomial") {
    S f{}, power = lift<S>(1);
    for (const double c : d.coefficients) {
      f += lift<S>(c) * power;
      power = power * t;
    }
    return f;
  }
  if (d.kind == "harmonic")
    return lift<S>(d.offset) +
           lift<S>(d.amplitude) * sin(lift<S>(d.frequency) * t + lift<S>(d.phase));
  if (d.kind == "table") return natural_spline(d, t);
  const S x = (t - lift<S>(d.start)) / lift<S>(d.duration);  // step, between its ends
  return lift<S>(d.from) + (lift<S>(d.to) - lift<S>(d.from)) * x * x * x *
                               (lift<S>(10) - lift<S>(15) * x + lift<S>(6) * x * x);
}

class DenseLagrangian {
 public:
  template <class S>
  struct Frame {
    Rotation<S> axes;
    Triple<S> origin;
  };
  template <class S>
  struct Moving : Frame<S> {
    Triple<S> v, w;  ///< velocity of the origin, angular velocity; ground axes
  };
  /// Linear and angular momentum about the ground's origin, or force and moment about it.
  template <class S>
  struct Wrench {
    Triple<S> f{}, n{};
  };
  template <class S>
  using List = std::vector<S>;

  /// Only the layout of q and u is taken from the tree.
  DenseLagrangian(const Scene& scene, const Tree& tree);

  int nv() const { return nv_; }
  /// Place in q of a coordinate, or −1 and its drive.
  std::pair<int, const DriveSpec*> coordinate(const std::string& joint, int coordinate) const {
    for (const Place& p : places_) {
      if (p.joint->name != joint) continue;
      if (const auto drive = p.drives.find(coordinate); drive != p.drives.end())
        return {-1, drive->second};
      int at = p.q + coordinate;
      for (const auto& [driven, law] : p.drives) at -= driven < coordinate;
      return {at, nullptr};
    }
    return {-1, nullptr};
  }

  template <class S>
  List<Frame<S>> frames(const S& t, const List<S>& q) const;
  /// q̇ = N(q) u
  template <class S>
  List<S> coordinate_rates(const List<S>& q, const List<S>& u) const;
  /// Frames and their rates along (N u, ṫ = 1), or with the clock stopped.
  template <class S>
  List<Moving<S>> moving(const S& t, const List<S>& q, const List<S>& u, bool clock_runs) const;
  /// Body momenta about the ground's origin.
  template <class S>
  List<Wrench<S>> body_momenta(const List<Moving<S>>& bodies) const;
  /// Σ J_j · wrench
  template <class S>
  List<S> projected(const S& t, const List<S>& q, const List<Wrench<S>>& wrenches) const;
  template <class S>
  List<S> momenta(const S& t, const List<S>& q, const List<S>& u) const {
    List<S> p = projected(t, q, body_momenta(moving(t, q, u, true)));
    for (std::size_t i = 0; i < p.size(); ++i) p[i] += lift<S>(rotors_[i]) * u[i];
    return p;
  }
  template <class S>
  S kinetic_energy(const S& t, const List<S>& q, const List<S>& u) const;
  template <class S>
  S potential_energy(const S& t, const List<S>& q) const;

  // At one state, results as vectors.
  RealMatrix mass_matrix(Real t, const Eigen::VectorXd& q) const;
  RealVector momenta_at(Real t, const Eigen::VectorXd& q, const Eigen::VectorXd& u) const;
  RealVector generalised_forces(Real t, const Eigen::VectorXd& q, const Eigen::VectorXd& u) const;
  RealVector accelerations(Real t, const Eigen::VectorXd& q, const Eigen::VectorXd& u) const;
  /// d/dt p along the motion.
  RealVector momentum_rates(Real t, const Eigen::VectorXd& q, const Eigen::VectorXd& u) const;
  /// ∂L/∂q + Q (V only through Q); canonical trees: nq = nv.
  RealVector lagrange_rates(Real t, const Eigen::VectorXd& q, const Eigen::VectorXd& u) const;
  /// T + V, and its rate along the motion with these u̇.
  Real energy(Real t, const Eigen::VectorXd& q, const Eigen::VectorXd& u) const;
  Real energy_rate(Real t, const Eigen::VectorXd& q, const Eigen::VectorXd& u,
                   const RealVector& udot) const;
  RealVector coordinate_rates_at(const Eigen::VectorXd& q, const Eigen::VectorXd& u) const;
  /// Force, then moment about the child's joint origin, that each joint transmits to its child, in
  /// child axes: the balance of the subtree it carries. 6 numbers a joint, in the scene's order.
  List<Eigen::Matrix<double, 6, 1>> reactions(Real t, const Eigen::VectorXd& q,
                                              const Eigen::VectorXd& u) const;
  List<Eigen::Isometry3d> poses(Real t, const Eigen::VectorXd& q) const;

 private:
  using D1 = Dual<Real, 1>;
  struct Place {
    int parent = -1;  ///< body in the scene's order
    const JointSpec* joint = nullptr;
    std::map<int, const DriveSpec*> drives;  ///< by coordinate
    int q = 0, u = 0, nv = 0;
    bool quaternion = false;  ///< in q

    /// One number of q, and a spring, a damper or a torque may act along it.
    bool has_joint_forces() const { return nv == 1 && rates_of(joint->kind) == 1; }
  };
  static List<Real> real(const Eigen::VectorXd& x) { return {x.data(), x.data() + x.size()}; }
  /// q along q̇ = N(q) u, and u along u̇.
  std::pair<List<D1>, List<D1>> along(const Eigen::VectorXd& q, const Eigen::VectorXd& u,
                                      const RealVector& udot) const;
  int body(const std::string& name) const { return name == "ground" ? -1 : bodies_.at(name); }
  List<Wrench<Real>> applied(const List<Moving<Real>>& bodies) const;
  /// Rates of the body momenta when u̇ is as given.
  List<Wrench<Real>> momentum_changes(Real t, const List<Real>& q, const List<Real>& u,
                                      const List<Real>& udot) const;
  List<Real> free_accelerations(Real t, const List<Real>& q, const List<Real>& u) const;

  const Scene& scene_;
  std::map<std::string, int> bodies_;
  List<Place> places_;       ///< by body, in the scene's order
  List<std::size_t> order_;  ///< parents first
  List<double> rotors_;      ///< by rate
  int nq_ = 0, nv_ = 0;
};

}  // namespace momenta::equations
