#pragma once
// Points of bodies in ground axes, and forces at such points as wrenches on bodies. Needs
// poses_outward(with_poses) and, for velocities, velocities_outward. Body −1 is the ground.

#include <momenta/core/kernel/workspace.h>

namespace momenta {

/// A vector of body k (its axes) in ground axes.
template <class Space, class S, class C>
auto to_ground(const Workspace<Space, S>& w, int k, const C& v) {
  typename Space::template Vector<S> r;
  if (k < 0) {
    for (int i = 0; i < static_cast<int>(std::size(v.x)); ++i) r[i] = S(v[i]);
    return r;
  }
  const auto& pose = w.body[static_cast<std::size_t>(k)].pose;
  if constexpr (Space::dimension == 3) {
    r[0] = pose.c * v[0] - pose.s * v[1];
    r[1] = pose.s * v[0] + pose.c * v[1];
  } else {
    for (int i = 0; i < 3; ++i)
      r[i] = pose.axes(i, 0) * v[0] + pose.axes(i, 1) * v[1] + pose.axes(i, 2) * v[2];
  }
  return r;
}

/// A vector in ground axes to the axes of the sweeps (body axes in space, ground axes in the
/// plane).
template <class Space, class S>
auto from_ground(const Workspace<Space, S>& w, int k, const typename Space::template Vector<S>& v) {
  if constexpr (Space::dimension == 3)
    return v;
  else
    return k < 0 ? v : transpose_times(w.body[static_cast<std::size_t>(k)].pose.axes, v);
}

template <class Space, class S>
auto origin(const Workspace<Space, S>& w, int k) {
  return k < 0 ? typename Space::template Vector<S>{}
               : w.body[static_cast<std::size_t>(k)].pose.origin;
}

template <class Space, class S, class C>
auto point_position(const Workspace<Space, S>& w, int k, const C& at) {
  return origin(w, k) + to_ground(w, k, at);
}

/// Angular velocity in ground axes: a vector in space, a number in the plane.
template <class Space, class S>
auto angular_velocity(const Workspace<Space, S>& w, int k) {
  if constexpr (Space::dimension == 3)
    return k < 0 ? S(0.0) : w.body[static_cast<std::size_t>(k)].V.w;
  else
    return k < 0 ? Vec3<S>{} : to_ground(w, k, w.body[static_cast<std::size_t>(k)].V.w);
}

/// Velocity in ground axes of the point of body k at the ground position x.
template <class Space, class S>
auto point_velocity(const Workspace<Space, S>& w, int k,
                    const typename Space::template Vector<S>& x) {
  using Vector = typename Space::template Vector<S>;
  if (k < 0) return Vector{};
  const auto& body = w.body[static_cast<std::size_t>(k)];
  const Vector arm = x - body.pose.origin;
  if constexpr (Space::dimension == 3)
    return body.V.v + cross(body.V.w, arm);
  else
    return to_ground(w, k, body.V.v) + cross(to_ground(w, k, body.V.w), arm);
}

/// Acceleration of that point in ground axes, from body[k].A. In space A is the derivative in body
/// axes, so O has d/dt v + ω × v; in the plane A.v is that already. Then α × r + ω × (ω × r).
template <class Space, class S>
auto point_acceleration(const Workspace<Space, S>& w, int k,
                        const typename Space::template Vector<S>& x) {
  using Vector = typename Space::template Vector<S>;
  if (k < 0) return Vector{};
  const auto& body = w.body[static_cast<std::size_t>(k)];
  const Vector arm = x - body.pose.origin;
  if constexpr (Space::dimension == 3) {
    return body.A.v + cross(body.A.w, arm) + cross(body.V.w, cross(body.V.w, arm));
  } else {
    const Vector omega = to_ground(w, k, body.V.w);
    return to_ground(w, k, body.A.v) + cross(omega, to_ground(w, k, body.V.v)) +
           cross(to_ground(w, k, body.A.w), arm) + cross(omega, cross(omega, arm));
  }
}

/// Angular acceleration in ground axes (dω/dt is the same in body and ground axes).
template <class Space, class S>
auto angular_acceleration(const Workspace<Space, S>& w, int k) {
  if constexpr (Space::dimension == 3)
    return k < 0 ? S(0.0) : w.body[static_cast<std::size_t>(k)].A.w;
  else
    return k < 0 ? Vec3<S>{} : to_ground(w, k, w.body[static_cast<std::size_t>(k)].A.w);
}

/// Adds the wrench of a ground-axes force f at ground position x to F, on body k about its origin.
template <class Space, class S>
void add_force(const Workspace<Space, S>& w, int k, const typename Space::template Vector<S>& x,
               const typename Space::template Vector<S>& f, typename Space::template Force<S>& F) {
  const auto arm = from_ground(w, k, x - origin(w, k));
  const auto force = from_ground(w, k, f);
  F.f += force;
  F.n += cross(arm, force);
}

/// Adds a ground-axes couple (a number in the plane).
template <class Space, class S, class Couple>
void add_couple(const Workspace<Space, S>& w, int k, const Couple& c,
                typename Space::template Force<S>& F) {
  if constexpr (Space::dimension == 3)
    F.n += c;
  else
    F.n += from_ground(w, k, c);
}

}  // namespace momenta
