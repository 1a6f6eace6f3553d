#pragma once
// Motion of a user joint from its formula. From the pose (R, r)(t, q) of the child's joint frame in
// the parent's, all in child axes:
//
//   E_j = (Rᵀ ∂r/∂q_j, vee(Rᵀ ∂R/∂q_j)),   Ω_t = (Rᵀ ∂r/∂t, vee(Rᵀ ∂R/∂t))          (13)
//   Ė, dΩ_t/dt: the derivatives of these along (q̇, ṫ) = (u, 1)                       (35)
//
// The formula is evaluated for double, Dual<double, 1>, Dual8 and Jet, whose derivatives are exact,
// one direction at a time for other dual numbers, and lane by lane for packs: out of line, by code
// compiled once for any machine. Directions go through Dual8. LocalDual takes the derivatives by
// the twelve numbers q and u from Dual8, and the chain rule,
//
//   y = y(q, u),   dy = Σ_j ∂y/∂q_j dq_j + ∂y/∂u_j du_j,   t a constant.
//
// Other scalars go through double: long double has the digits of a double there, and Counted does
// not see the operations of the formula.

#include <momenta/core/kernel/spatial.h>
#include <momenta/core/scalar/dual.h>
#include <momenta/core/scalar/local_dual.h>
#include <momenta/core/scalar/pack.h>
#include <momenta/core/scalar/power_series.h>
#include <momenta/core/scene/joint_formula.h>

namespace momenta {

template <class S>
struct UserMotion {
  S t{};
  S q[6]{};                                  ///< the configuration, set before user_motion
  Mat3<S> rotation;                          ///< R
  Vec3<S> position;                          ///< r
  Spatial::Motion<S> E[6], drift;            ///< columns of E; Ω_t
  Spatial::Motion<S> E_rate[6], drift_rate;  ///< Ė, dΩ_t/dt
};

/// Calls f on every number computed by user_motion, in one order for all S.
template <class S, class F>
void each_number(UserMotion<S>& m, F&& f) {
  for (auto& x : m.rotation.x) f(x);
  for (auto& x : m.position.x) f(x);
  const auto motions = [&f](Spatial::Motion<S>& v) {
    for (int i = 0; i < 6; ++i) f(v[i]);
  };
  for (auto& column : m.E) motions(column);
  motions(m.drift);
  for (auto& column : m.E_rate) motions(column);
  motions(m.drift_rate);
}
constexpr int user_numbers_without_rates = 12 + 7 * 6;
constexpr int user_numbers = user_numbers_without_rates + 7 * 6;

/// Pose, E, Ω_t and their rates along u (null: no rates), in each scalar of the recursions.
class UserFormula : public JointFormula {
 public:
  /// Motion at m.t and m.q.
  virtual void move(const double* u, UserMotion<double>& m) const = 0;
  /// The same with one directional derivative.
  virtual void move(const Dual<double, 1>* u, UserMotion<Dual<double, 1>>& m) const = 0;
  /// The same with eight directional derivatives.
  virtual void move(const Dual8* u, UserMotion<Dual8>& m) const = 0;
  /// The same along a curve in t and q, with two directions.
  virtual void move(const Jet* u, UserMotion<Jet>& m) const = 0;
};

/// R, r, E and Ω_t at (m.t, m.q); with u not null their rates along (u, 1), else zeros there.
void user_motion(const UserFormula& joint, const double* u, UserMotion<double>& m);
void user_motion(const UserFormula& joint, const Dual<double, 1>* u,
                 UserMotion<Dual<double, 1>>& m);
void user_motion(const UserFormula& joint, const Dual8* u, UserMotion<Dual8>& m);
void user_motion(const UserFormula& joint, const Jet* u, UserMotion<Jet>& m);
void user_motion(const UserFormula& joint, const LocalDual* u, UserMotion<LocalDual>& m);
/// The same in plain arrays: six q and u; user_numbers results.
void user_motion(const UserFormula& joint, double t, const double* q, const double* u,
                 double* numbers);

/// The same on Dual8 in plain arrays: t, six q and u; user_numbers results; value and eight
/// derivatives of each.
void user_motion(const UserFormula& joint, const double* t, const double* q, const double* u,
                 double* numbers);

template <int W, int L>
void user_motion(const UserFormula& joint, const Directions<W, L>* u,
                 UserMotion<Directions<W, L>>& m) {
  double t[dual8_numbers]{}, q[6 * dual8_numbers]{}, rates[6 * dual8_numbers]{},
      numbers[user_numbers * dual8_numbers];
  spread(m.t, t);
  for (int i = 0; i < 6; ++i) spread(m.q[i], q + i * dual8_numbers);
  const int n = u ? joint.coordinates() : 0;
  for (int i = 0; i < 6 && i < n; ++i) spread(u[i], rates + i * dual8_numbers);
  user_motion(joint, static_cast<const double*>(t), static_cast<const double*>(q),
              static_cast<const double*>(u ? rates : nullptr), numbers);
  const double* from = numbers;
  each_number(m, [&from](Directions<W, L>& x) {
    gather(from, x);
    from += dual8_numbers;
  });
}

template <int W, int L>
void user_motion(const UserFormula& joint, const Pack<W, L>* u, UserMotion<Pack<W, L>>& m) {
  for (int lane = 0; lane < W; ++lane) {
    double q[6], rates[6], numbers[user_numbers];
    for (int i = 0; i < 6; ++i) {
      q[i] = m.q[i].lane(lane);
      rates[i] = u ? u[i].lane(lane) : 0.0;
    }
    user_motion(joint, m.t.lane(lane), q, static_cast<const double*>(u ? rates : nullptr), numbers);
    const double* from = numbers;
    each_number(m, [&](Pack<W, L>& x) { x.set_lane(lane, *from++); });
  }
}

template <class T>
constexpr bool is_series = false;
template <int K>
constexpr bool is_series<PowerSeries<K>> = true;
template <class T>
constexpr bool is_dual = false;
template <class T, int N>
constexpr bool is_dual<Dual<T, N>> = true;

template <class T, int N>
void user_motion(const UserFormula& joint, const Dual<T, N>* u, UserMotion<Dual<T, N>>& m) {
  static_assert(!is_dual<T> && !is_series<T>,
                "a user joint has no second derivatives beside those of Jet");
  using D = Dual<double, 1>;
  const int n = joint.coordinates();
  for (std::size_t direction = 0; direction < N; ++direction) {
    const auto along = [direction](const Dual<T, N>& x) {
      D y(value_of(x.a));
      y.b[0] = value_of(x.b[direction]);
      return y;
    };
    UserMotion<D> one;
    one.t = along(m.t);
    D rates[6];
    for (int i = 0; i < n; ++i) {
      one.q[i] = along(m.q[i]);
      if (u) rates[i] = along(u[i]);
    }
    user_motion(joint, static_cast<const D*>(u ? rates : nullptr), one);
    D numbers[user_numbers], *to = numbers;
    each_number(one, [&to](const D& x) { *to++ = x; });
    const D* from = numbers;
    each_number(m, [&from, direction](Dual<T, N>& x) {
      x.a = T(from->a);
      x.b[direction] = T((from++)->b[0]);
    });
  }
}

template <class S>
void user_motion(const UserFormula& joint, const S* u, UserMotion<S>& m) {
  static_assert(!is_series<S>, "a user joint has no series beside those of Jet");
  const int n = joint.coordinates();
  double q[6]{}, rates[6]{}, numbers[user_numbers];
  for (int i = 0; i < n; ++i) {
    q[i] = value_of(m.q[i]);
    if (u) rates[i] = value_of(u[i]);
  }
  user_motion(joint, value_of(m.t), q, static_cast<const double*>(u ? rates : nullptr), numbers);
  const double* from = numbers;
  each_number(m, [&](S& x) { x = S(*from++); });
}

}  // namespace momenta
