#pragma once
// Stops at the limits of a joint: one-sided springs and dampers, whose force has a continuous
// derivative. With x the way of q beyond a limit and v = ẋ, the push back is
//
//   F(x, v) = k φ(x) + c ψ(x) v,  0 for x <= 0
//   φ = x²/2w,  ψ = s²(3 − 2s), s = x/w,   0 < x < w
//   φ = x − w/2,  ψ = 1,                   x >= w
//
// so a joint far beyond moves as one with the spring k, at rest half a width behind the limit, and
// the damper c. The spring stores k x³/6w, then k (x²/2 − w x/2 + w²/6). On the way back the damper
// may pull, unlike a contact.

#include <momenta/core/scalar/dual.h>
#include <momenta/core/scalar/pack.h>

namespace momenta {

struct JointStop {
  double least = 0, largest = 0;     ///< the limits
  double stiffness = 0;              ///< k
  double damping = 0, width = 0.01;  ///< c, w
  bool acts() const { return stiffness != 0 || damping != 0; }
};

/// F(x, v).
template <class S>
MOMENTA_INLINE S stop_push(const JointStop& stop, const S& x, const S& v) {
  if (!(value_of(x) > 0)) return S(0.0);
  if (!(value_of(x) < stop.width))
    return stop.stiffness * (x - 0.5 * stop.width) + stop.damping * v;
  const S s = (1.0 / stop.width) * x;
  return (0.5 * stop.stiffness * stop.width) * (s * s) +
         stop.damping * ((s * s) * (3.0 - 2.0 * s)) * v;
}

/// The generalised force of both stops.
template <class S>
__attribute__((noinline)) S stop_force(const JointStop& stop, const S& q, const S& u) {
  return stop_push(stop, S(stop.least - q), S(-u)) - stop_push(stop, S(q - stop.largest), u);
}
/// The same lane by lane, some lanes beyond a limit.
template <int W, int L>
__attribute__((noinline)) Pack<W, L> stop_force(const JointStop& stop, const Pack<W, L>& q,
                                                const Pack<W, L>& u) {
  using One = Pack<1, L>;
  Pack<W, L> force;
  for (int i = 0; i < W; ++i) {
    const One x(q.lane(i)), v(u.lane(i));
    force.set_lane(i, (stop_push(stop, One(stop.least - x), One(-v)) -
                       stop_push(stop, One(x - stop.largest), v))
                          .lane(0));
  }
  return force;
}

/// Energy of the spring of one side.
template <class S>
S stop_energy(const JointStop& stop, const S& x) {
  if (!(value_of(x) > 0)) return S(0.0);
  const double k = stop.stiffness, w = stop.width;
  if (value_of(x) < w) return (k / (6 * w)) * (x * x * x);
  return k * (0.5 * (x * x) - (0.5 * w) * x + S(w * w / 6));
}
/// Energy of both springs [J].
template <class S>
S stored_energy(const JointStop& stop, const S& q) {
  return stop_energy(stop, S(stop.least - q)) + stop_energy(stop, S(q - stop.largest));
}

/// Loss of the dampers of the stops [W].
template <class S>
S stop_loss(const JointStop& stop, const S& q, const S& u) {
  JointStop damper = stop;
  damper.stiffness = 0;
  return -stop_force(damper, q, u) * u;
}

}  // namespace momenta
