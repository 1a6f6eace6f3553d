#pragma once
// Sweeps of all algorithms: poses, velocities and momenta. "Outward" visits parents first, "inward"
// children first; depth-first numbering makes both a plain loop.
//
//   Ω_K = 𝒯ⱽ Ω_L + E u + Ω_t                                (23)
//   P*_K = M_K Ω_K + w_K + Σ 𝒯ᶠ P*_child,  p_K = Eᵀ P*_K     (26), (34); + I_r u of a rotor
//   ṗ_K = Eᵀ (T*_K − Ω_K × P*_K) + Ėᵀ P*_K + Q_joint          (35)
//
// w: loop impulses on the body, if any. Ė = 0 for all joints but user joints.

#include <momenta/core/kernel/joint.h>
#include <momenta/core/kernel/prescribe.h>
#include <momenta/core/kernel/workspace.h>

namespace momenta {

/// The edge of body k at (q, t), its pose in ground axes too when asked; parents first.
template <class Space, class S>
void place_body(Workspace<Space, S>& w, std::size_t k, const S& t, const S* q, bool with_pose) {
  const auto& model = *w.model;
  const auto& b = model.bodies[k];
  auto& s = w.body[k];
  if (b.drive >= 0)
    prescribe(model.drives[static_cast<std::size_t>(b.drive)], t, s.drive, s.drive_rate,
              s.drive_acceleration);
  const auto* parent = b.parent < 0 ? nullptr : &w.body[static_cast<std::size_t>(b.parent)];
  if constexpr (Space::dimension == 6)
    if (b.law)
      Joint<Space>::place(b, t, q + b.q, w.users[static_cast<std::size_t>(b.user)], s.edge);
  const S value = b.drive >= 0 ? s.drive : (b.nq == 1 ? q[b.q] : S(0.0));
  if (b.sprung >= 0) w.sprung[static_cast<std::size_t>(b.sprung)].coordinate = value;
  if (!b.law)
    Joint<Space>::template place<S>(b, parent ? &parent->edge : nullptr, value, q + b.q, s.edge);
  if constexpr (Space::dimension == 3) s.inertia = Planar::turned(b.inertia, s.edge);
  if (with_pose) {
    typename Space::template Pose<S> ground;
    if constexpr (Space::dimension == 6) ground.axes = identity3<S>();
    const auto& from = parent ? parent->pose : ground;
    if constexpr (Space::dimension == 6) {
      const auto at = Space::pose_outward(b.edge, b.kind, s.edge,
                                          typename Space::template Pose<S>{from.axes, {}});
      s.step = at.origin;
      s.pose = {at.axes, from.origin + at.origin};
    } else {
      s.pose = Space::pose_outward(b.edge, b.kind, s.edge, from);
    }
  }
}

/// Edges at (q, t), with poses in ground axes when asked. O(bodies), one sine and cosine per
/// revolute joint.
template <class Space, class S>
void poses_outward(Workspace<Space, S>& w, const S& t, const S* q, bool with_poses) {
  w.time = t;
  for (std::size_t k = 0; k < w.body.size(); ++k) place_body(w, k, t, q, with_poses);
}

/// Adds Ω_t of (13) to V: prescribed joint motion, or motion of a user joint with t alone.
template <class Space, class S>
void add_drive(const typename Model<Space>::Body& b, const typename Workspace<Space, S>::Body& s,
               typename Space::template Motion<S>& v) {
  if (b.drive >= 0) Joint<Space>::add_motion(b, s.edge, &s.drive_rate, v);
  if constexpr (Space::dimension == 6)
    if (b.law) v += s.edge.own->drift;
}

/// Ω_K of body k from the joint rates, eq. (23); parents first.
template <class Space, class S>
void move_body(Workspace<Space, S>& w, std::size_t k, const S* u) {
  const auto& b = w.model->bodies[k];
  auto& s = w.body[k];
  s.V = b.parent < 0
            ? typename Space::template Motion<S>{}
            : Space::to_child(b.edge, b.kind, s.edge, w.body[static_cast<std::size_t>(b.parent)].V);
  if (b.drive >= 0)
    add_drive<Space, S>(b, s, s.V);
  else
    Joint<Space>::add_motion(b, s.edge, u + b.u, s.V);
  if (b.has_rotor())
    for (int i = 0; i < b.nv; ++i) s.rotor_rate[i] = u[b.u + i];
  if (b.sprung >= 0)
    w.sprung[static_cast<std::size_t>(b.sprung)].rate = b.drive >= 0 ? s.drive_rate : u[b.u];
  if (b.law) add_drive<Space, S>(b, s, s.V);
}

/// Ω_K of all bodies.
template <class Space, class S>
void velocities_outward(Workspace<Space, S>& w, const S* u) {
  for (std::size_t k = 0; k < w.body.size(); ++k) move_body(w, k, u);
}

/// Gravity in the axes of every body.
template <class Space, class S>
void gravity_outward(Workspace<Space, S>& w) {
  const auto& model = *w.model;
  typename Space::template Vector<S> ground;
  for (int i = 0; i < (Space::dimension == 3 ? 2 : 3); ++i) ground[i] = S(model.gravity[i]);
  for (std::size_t k = 0; k < w.body.size(); ++k) {
    const auto& b = model.bodies[k];
    w.body[k].g = Space::direction_to_child(
        b.edge, b.kind, w.body[k].edge,
        b.parent < 0 ? ground : w.body[static_cast<std::size_t>(b.parent)].g);
  }
}

/// body[k].P = M_K Ω_K: the start of (26), before loop impulses are added.
template <class Space, class S>
void body_momenta(Workspace<Space, S>& w) {
  for (std::size_t k = 0; k < w.body.size(); ++k)
    w.body[k].P = Space::momentum(w.inertia(k), w.body[k].V);
}

/// Sums the wrenches or momenta body[k].P over subtrees, eq. (26), and projects them: Eᵀ P*.
template <class Space, class S>
void project_inward(Workspace<Space, S>& w, S* along) {
  const auto& model = *w.model;
  for (std::size_t k = w.body.size(); k-- > 0;) {
    const auto& b = model.bodies[k];
    auto& s = w.body[k];
    if (b.drive < 0 && along) Joint<Space>::project(b, s.edge, s.P, along + b.u);
    if (b.parent >= 0)
      w.body[static_cast<std::size_t>(b.parent)].P += Space::to_parent(b.edge, b.kind, s.edge, s.P);
  }
}

/// P*_K, eq. (26), and p = Eᵀ P* + I_r u, eq. (34).
template <class Space, class S>
void momenta_inward(Workspace<Space, S>& w, S* p) {
  project_inward(w, p);
  if (!w.model->has_rotors || !p) return;
  for (std::size_t k = 0; k < w.body.size(); ++k)
    if (const auto& b = w.model->bodies[k]; b.has_rotor())
      for (int i = 0; i < b.nv; ++i) p[b.u + i] += b.rotor * w.body[k].rotor_rate[i];
}

/// Generalised force of a joint's own spring, damper, torque, friction −friction · u / √(u² +
/// friction_rate²) and stops (joint_stop.h).
template <class Body, class S>
S joint_force(const Body& b, const S& q, const S& u) {
  const S force = b.torque - b.stiffness * (q - b.rest) - b.damping * u;
  if (!b.is_curved) return force;
  using std::sqrt;
  const S size = sqrt(u * u + S(b.friction_rate * b.friction_rate));
  const S rubbed = force - b.friction * (u / size);
  if constexpr (requires { b.stop; })
    if (b.stop.acts()) return rubbed + stop_force(b.stop, q, u);
  return rubbed;
}

/// Accumulates T*_K, eq. (27), from body[k].T and writes ṗ, eq. (35), with body[k].P = P*_K and the
/// velocities current.
template <class Space, class S>
void momentum_rates_inward(Workspace<Space, S>& w, const S* q, const S* u, S* pdot) {
  const auto& model = *w.model;
  for (std::size_t k = w.body.size(); k-- > 0;) {
    const auto& b = model.bodies[k];
    auto& s = w.body[k];
    if (b.nv > 0) {
      auto net = s.T;
      net -= Space::cross_force(s.V, s.P);
      Joint<Space>::project(b, s.edge, net, pdot + b.u);
      if constexpr (Space::dimension == 6)
        if (b.law) {
          Joint<Space>::move(b, s.edge, u + b.u);
          Joint<Space>::add_axis_rate(b, s.edge, s.P, pdot + b.u);
        }
      if (b.nv == 1) pdot[b.u] += joint_force(b, q[b.q], u[b.u]);
    }
    if (b.parent >= 0)
      w.body[static_cast<std::size_t>(b.parent)].T += Space::to_parent(b.edge, b.kind, s.edge, s.T);
  }
}

/// q̇ of the whole tree from u.
template <class Space, class S>
void coordinate_rates(const Model<Space>& model, const S* q, const S* u, S* qdot) {
  for (const auto& b : model.bodies)
    if (b.law)
      for (int i = 0; i < b.nv; ++i) qdot[b.q + i] = u[b.u + i];
    else if (b.nv == 1)
      qdot[b.q] = u[b.u];
    else if (b.kind == JointKind::spherical)
      quaternion_rates(q + b.q, u + b.u, qdot + b.q);
    else if (b.nv > 0)
      coordinate_rates(b.kind, q + b.q, u + b.u, qdot + b.q);
}

/// The inverse: u of the whole tree from q̇.
template <class Space, class S>
void joint_rates(const Model<Space>& model, const S* q, const S* qdot, S* u) {
  for (const auto& b : model.bodies)
    if (b.law)
      for (int i = 0; i < b.nv; ++i) u[b.u + i] = qdot[b.q + i];
    else if (b.nv > 0)
      joint_rates(b.kind, q + b.q, qdot + b.q, u + b.u);
}

}  // namespace momenta
