#pragma once
// A user joint: a program gives the pose of the child's joint frame in the parent's as a formula of
// time and n = 1 … 6 coordinates, with q̇ = u. Dual numbers give the rest exactly
// (kernel/user_motion.h): E and Ω_t of (13), Ė and dΩ_t/dt.
//
//     struct Crank {  // a revolute joint at the end of an arm of 0.2 m
//       template <class S>
//       momenta::JointPose<S> operator()(const S& t, const S* q) const {
//         const auto R = momenta::turn_about<S>({0, 0, 1}, q[0]);
//         return {R, R * momenta::Vec3<S>{{S(0.2), S(0.0), S(0.0)}}};
//       }
//     };
//     joint.kind = momenta::JointKind::user;
//     joint.law = std::make_shared<momenta::UserJoint>(1, Crank{});
//
// S has the operators + − × ÷, the functions sin, cos and sqrt in its namespace, a constructor from
// double, and comparisons of values. The matrix must be a rotation for all t and q; validate()
// checks it at the start. All chains of the scene share the formula: it must not change.

#include <momenta/core/kernel/user_motion.h>

#include <cmath>
#include <initializer_list>
#include <memory>
#include <utility>

namespace momenta {

/// Pose of the child's joint frame in the parent's joint frame.
template <class S>
struct JointPose {
  Mat3<S> rotation;  ///< columns: the child's joint axes in the parent's joint frame
  Vec3<S> position;  ///< the child's joint point in the parent's joint frame [m]
};

/// The rotation by `angle` about a unit vector: cos + (1 − cos) a aᵀ + sin ã.
template <class S>
Mat3<S> turn_about(const Vec3<S>& a, const S& angle) {
  using std::cos, std::sin;
  const S c = cos(angle), s = sin(angle), rest = S(1.0) - c;
  Mat3<S> r;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    r(i, i) = c + rest * a[i] * a[i];
    r(j, i) = rest * a[i] * a[j] + s * a[k];
    r(k, i) = rest * a[i] * a[k] - s * a[j];
  }
  return r;
}

/// The formula of a user joint as the law of that joint; immutable, shared by chains and threads.
class UserJoint final : public UserFormula {
 public:
  /// `formula(t, q)` gives a `JointPose<S>` for any S; q has `coordinates` numbers. `lengths`:
  /// indices of the lengths [m]; the others are angles [rad]. Units of results and scales of
  /// solutions follow; other indices mean nothing.
  template <class Formula>
  UserJoint(int coordinates, Formula formula, std::initializer_list<int> lengths = {})
      : coordinates_(coordinates),
        law_(std::make_shared<LawOf<Formula>>(coordinates, std::move(formula))) {
    for (const int i : lengths) lengths_ |= i >= 0 && i < 6 ? 1u << i : 0u;
  }

  /// n, from 1 to 6.
  int coordinates() const override { return coordinates_; }
  /// Whether coordinate i is a length [m]; else an angle [rad].
  bool is_length(int i) const override { return (lengths_ >> i & 1u) != 0; }
  /// The pose at (t, q): the rotation, nine numbers by columns, and the position, three numbers.
  void pose(double t, const double* q, double* rotation, double* position) const override;

  /// Pose, E, Ω_t and the rates of E and Ω_t along u, at m.t and m.q.
  void move(const double* u, UserMotion<double>& m) const override;
  /// The same with one directional derivative.
  void move(const Dual<double, 1>* u, UserMotion<Dual<double, 1>>& m) const override;
  /// The same with eight directional derivatives.
  void move(const Dual8* u, UserMotion<Dual8>& m) const override;
  /// The same along a curve in t and q, with two directions from it.
  void move(const Jet* u, UserMotion<Jet>& m) const override;

 private:
  class Law {
   public:
    virtual ~Law();
    virtual void move(const double* u, UserMotion<double>& m) const = 0;
    virtual void move(const Dual<double, 1>* u, UserMotion<Dual<double, 1>>& m) const = 0;
    virtual void move(const Dual8* u, UserMotion<Dual8>& m) const = 0;
    virtual void move(const Jet* u, UserMotion<Jet>& m) const = 0;
  };
  template <class Formula>
  class LawOf final : public Law {
   public:
    LawOf(int n, Formula formula) : n_(n), formula_(std::move(formula)) {}
    void move(const double* u, UserMotion<double>& m) const override { along(u, m); }
    void move(const Dual<double, 1>* u, UserMotion<Dual<double, 1>>& m) const override {
      along(u, m);
    }
    void move(const Dual8* u, UserMotion<Dual8>& m) const override { along(u, m); }
    void move(const Jet* u, UserMotion<Jet>& m) const override { along(u, m); }

   private:
    /// E and Ω_t at (m.t, m.q); where u is not null also their rates along (q̇, ṫ) = (u, 1).
    template <class S>
    void along(const S* u, UserMotion<S>& m) const;
    template <class S>
    void columns(UserMotion<S>& m) const;

    int n_;
    Formula formula_;
  };

  int coordinates_;
  unsigned lengths_ = 0;  ///< bit i: coordinate i is a length
  std::shared_ptr<const Law> law_;
};

template <class Formula>
template <class S>
void UserJoint::LawOf<Formula>::columns(UserMotion<S>& m) const {
  using D = Dual<S, 7>;
  constexpr int time = 6;
  D q[6];
  for (int j = 0; j < n_; ++j) q[j] = D::variable(m.q[j], j);
  const JointPose<D> pose = formula_(D::variable(m.t, time), static_cast<const D*>(q));
  for (int i = 0; i < 9; ++i) m.rotation.x[i] = pose.rotation.x[i].a;
  for (int i = 0; i < 3; ++i) m.position.x[i] = pose.position.x[i].a;
  const auto column = [&](std::size_t direction) {
    Mat3<S> dR;
    Vec3<S> dr;
    for (int i = 0; i < 9; ++i) dR.x[i] = pose.rotation.x[i].b[direction];
    for (int i = 0; i < 3; ++i) dr.x[i] = pose.position.x[i].b[direction];
    const Mat3<S> w = transpose(m.rotation) * dR;
    return Spatial::Motion<S>{
        transpose_times(m.rotation, dr),
        {{0.5 * (w(2, 1) - w(1, 2)), 0.5 * (w(0, 2) - w(2, 0)), 0.5 * (w(1, 0) - w(0, 1))}}};
  };
  for (int j = 0; j < n_; ++j) m.E[j] = column(static_cast<std::size_t>(j));
  m.drift = column(time);
}

template <class Formula>
template <class S>
void UserJoint::LawOf<Formula>::along(const S* u, UserMotion<S>& m) const {
  if (!u) {
    for (auto& rate : m.E_rate) rate = {};
    m.drift_rate = {};
    return columns(m);
  }
  using D = Dual<S, 1>;
  UserMotion<D> moving;
  moving.t = D::variable(m.t, 0);
  for (int j = 0; j < n_; ++j) {
    moving.q[j].a = m.q[j];
    moving.q[j].b[0] = u[j];
  }
  columns(moving);
  for (int i = 0; i < 9; ++i) m.rotation.x[i] = moving.rotation.x[i].a;
  for (int i = 0; i < 3; ++i) m.position.x[i] = moving.position.x[i].a;
  const auto split = [](const Spatial::Motion<D>& from, Spatial::Motion<S>& value,
                        Spatial::Motion<S>& rate) {
    for (int i = 0; i < 6; ++i) {
      value[i] = from[i].a;
      rate[i] = from[i].b[0];
    }
  };
  for (int j = 0; j < n_; ++j) split(moving.E[j], m.E[j], m.E_rate[j]);
  split(moving.drift, m.drift, m.drift_rate);
}

}  // namespace momenta
