#pragma once
// Joint forces of wrenches between points of bodies: Q = Eᵀ T*, T* summed inward over subtrees,
// (27).

#include <momenta/core/kernel/forces.h>

namespace momenta {

/// Sets body k at rest in its own axes.
template <class Space, class S>
void stand_still(Workspace<Space, S>& w, std::size_t k) {
  auto& s = w.body[k];
  s.pose = {};
  if constexpr (Space::dimension == 6) s.pose.axes = identity3<S>();
  s.V = {};
  s.T = {};
}

/// Place in u of the spherical joint that a bushing only damps, between its two bodies; −1: none. n
/// = −c ω on the child and −n on the parent cancel in T* of the parent and inward of it, so Q = −c
/// u at this joint, u = ω in child axes, and 0 elsewhere: no body need be placed.
template <class Space>
int damped_ball(const Model<Space>& model, const typename Model<Space>::Bushing& b) {
  if (b.child < 0 || b.stiffness != 0 || b.damping != 0 || b.rotational_stiffness != 0 ||
      b.stop.acts())
    return -1;
  const auto& child = model.bodies[static_cast<std::size_t>(b.child)];
  const bool between = child.kind == JointKind::spherical && child.nv == 3;
  return between && child.parent == b.parent ? child.u : -1;
}

/// Q of bushings that merely damp balls, if there are no other forces between bodies; else false,
/// and nothing is done.
template <class Space, class S>
bool ball_damper_rates(Workspace<Space, S>& w, const S* u) {
  const auto& model = *w.model;
  if (!model.springs.empty() || !model.wrenches.empty() || model.has_forces_apart()) return false;
  for (const auto& b : model.bushings)
    if (damped_ball(model, b) < 0) return false;
  for (auto& value : w.generalised) value = S(0.0);
  for (const auto& b : model.bushings) {
    const int first = damped_ball(model, b);
    for (int i = first; i < first + 3; ++i)
      w.generalised[static_cast<std::size_t>(i)] -= b.rotational_damping * u[i];
  }
  return true;
}

/// w.generalised (nv) = Eᵀ T* of springs, dampers and wrenches at (q, u, t). One outward sweep for
/// poses and velocities, one inward, over forced_bodies.h; other bodies are stale. O(these bodies +
/// nv); where balls are damped alone, no body is placed.
template <class Space, class S>
void body_force_rates(Workspace<Space, S>& w, const S& t, const S* q, const S* u) {
  if (ball_damper_rates(w, u)) return;
  w.time = t;
  for (const auto& [at, from_rest] : w.forced) {
    const auto k = static_cast<std::size_t>(at);
    if (from_rest) stand_still(w, static_cast<std::size_t>(w.model->bodies[k].parent));
    place_body(w, k, t, q, true);
    move_body(w, k, u);
    w.body[k].T = {};
  }
  add_body_forces(w);
  for (auto& value : w.generalised) value = S(0.0);
  for (std::size_t i = w.forced.size(); i-- > 0;) {
    const auto k = static_cast<std::size_t>(w.forced[i].body);
    const auto& b = w.model->bodies[k];
    auto& s = w.body[k];
    if (b.nv > 0) Joint<Space>::project(b, s.edge, s.T, w.generalised.data() + b.u);
    if (b.parent >= 0 && !w.forced[i].from_rest)
      w.body[static_cast<std::size_t>(b.parent)].T += Space::to_parent(b.edge, b.kind, s.edge, s.T);
  }
}

/// w.generalised (nv) = all generalised forces but weights: those of joints and, unless a sweep
/// takes them as wrenches, at points of bodies.
template <class Space, class S>
void applied_forces(Workspace<Space, S>& w, const S& t, const S* q, const S* u,
                    bool at_points = true) {
  const auto& model = *w.model;
  if (at_points && model.has_body_forces())
    body_force_rates(w, t, q, u);
  else
    for (auto& value : w.generalised) value = S(0.0);
  if (model.has_joint_forces)
    for (const auto& b : model.bodies)
      if (b.nv == 1) w.generalised[static_cast<std::size_t>(b.u)] += joint_force(b, q[b.q], u[b.u]);
}

}  // namespace momenta
