#pragma once
// States and directions in lanes for the sweeps of bodies, in dual numbers of one direction a lane;
// the axes of bodies, and how they turn along the direction.

#include <momenta/core/kernel/sweeps.h>
#include <momenta/dae/gradient/levels/direction_slots.h>

#include <vector>

namespace momenta {

template <class Space, int Level, int Width>
struct PlacedAlong {
  using Lanes = Pack<Width, Level>;
  using S = Directions<Width, Level>;
  explicit PlacedAlong(const Model<Space>& model)
      : w(model), q(static_cast<std::size_t>(model.nv)), u(q.size()) {}
  /// x + dx ε
  static S along(const Lanes& x, const Lanes& dx) {
    S s;
    s.a = x;
    s.b[0] = dx;
    return s;
  }
  /// Poses and velocities at (t, q, u).
  void place(const Lanes& t, bool with_poses) {
    poses_outward(w, along(t, Lanes(0.0)), q.data(), with_poses);
    velocities_outward(w, u.data());
  }
  Workspace<Space, S> w;
  std::vector<S> q, u;
};

/// A vector in ground axes in those of body k.
template <class Space, class S>
auto in_body_axes(const Workspace<Space, S>& w, int k,
                  const typename Space::template Vector<S>& v) {
  if (k < 0) return v;
  if constexpr (Space::dimension == 3) {
    const auto& pose = w.body[static_cast<std::size_t>(k)].pose;
    return typename Space::template Vector<S>{
        {pose.c * v[0] + pose.s * v[1], pose.c * v[1] - pose.s * v[0]}};
  } else {
    return from_ground(w, k, v);
  }
}

/// Adds an impulse f at the point x of body k, whose velocity is u, to P, and the terms of ḟ and
/// the point's motion to T.
template <class Space, class S>
void hand_over(Workspace<Space, S>& w, int k, const typename Space::template Vector<S>& x,
               const typename Space::template Vector<S>& u,
               const typename Space::template Vector<S>& force,
               const typename Space::template Vector<S>& rate) {
  if (k < 0) return;
  auto& body = w.body[static_cast<std::size_t>(k)];
  add_force(w, k, x, force, body.P);
  add_force(w, k, x, rate, body.T);
  add_couple(w, k, cross(u, force), body.T);
}

/// Turn of body k along the direction, ground axes: a vector in space, a number in a plane.
template <class Space, class S>
auto turned_along(const Workspace<Space, S>& w, int k) {
  using Angular =
      decltype(cross(typename Space::template Vector<S>{}, typename Space::template Vector<S>{}));
  Angular turn{};
  if (k < 0) return turn;
  const auto& pose = w.body[static_cast<std::size_t>(k)].pose;
  if constexpr (Space::dimension == 3) {
    turn.a = pose.c.a * pose.s.b[0] - pose.s.a * pose.c.b[0];
  } else {
    // Σ e × δe = 2 θ of three axes that turn by θ.
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) {
        const auto &y = pose.axes((i + 1) % 3, j), &z = pose.axes((i + 2) % 3, j);
        turn[i].a += 0.5 * (y.a * z.b[0] - z.a * y.b[0]);
      }
  }
  return turn;
}

/// x without its direction; and its change along the direction, as a value.
template <class S>
S value_alone(const S& x) {
  S still(0.0);
  still.a = x.a;
  return still;
}
template <class S>
S change_alone(const S& x) {
  S change(0.0);
  change.a = x.b[0];
  return change;
}
/// A number of no value whose derivative is value_of(x).
template <class S>
S as_change(const S& x) {
  S change(0.0);
  change.b[0] = x.a;
  return change;
}

}  // namespace momenta
