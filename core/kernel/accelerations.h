#pragma once
// The acceleration route: Newton-Euler inward for joint forces and reactions, and the articulated
// recursion for u̇ (acceleration_sweeps.h, planar_acceleration_sweeps.h) with all forces of the
// scene.
//
//   A_K = 𝒯ⱽ A_L + E u̇ + c_K                                  derivative of (23)
//   F_K = M_K A_K + b_K − T_K + Σ 𝒯ᶠ F_child                  (17), (21)
//   τ_K = Eᵀ F_K + I_r u̇
//
// with c_K the velocity products and prescribed accelerations, and b_K = Ω_K × (M_K Ω_K). F_K is
// the whole wrench through joint K about O_K: the reaction T_r of (28) plus what acts along the
// joint.

#include <momenta/core/kernel/acceleration_sweeps.h>
#include <momenta/core/kernel/body_forces.h>
#include <momenta/core/kernel/planar_acceleration_sweeps.h>

namespace momenta {

/// c_K. Needs poses and velocities.
template <class Space, class S>
typename Space::template Motion<S> prescribed_acceleration(const Workspace<Space, S>& w,
                                                           std::size_t k, const S* u) {
  const auto& b = w.model->bodies[k];
  const auto& s = w.body[k];
  typename Space::template Motion<S> joint{};
  if (b.drive >= 0)
    Joint<Space>::add_motion(b, s.edge, &s.drive_rate, joint);
  else if (b.nv > 0)
    Joint<Space>::add_motion(b, s.edge, u + b.u, joint);
  if (b.law) add_drive<Space, S>(b, s, joint);
  auto c = Space::velocity_product(
      s.edge, b.parent < 0 ? nullptr : &w.body[static_cast<std::size_t>(b.parent)].V, s.V, joint);
  if (b.drive >= 0) Joint<Space>::add_motion(b, s.edge, &s.drive_acceleration, c);
  if constexpr (Space::dimension == 6)
    if (b.law) {
      Joint<Space>::move(b, s.edge, u + b.u);
      Joint<Space>::add_motion_rate(b, s.edge, u + b.u, c);
    }
  return c;
}

/// A_K of all bodies; udot null means zero.
template <class Space, class S>
void accelerations_outward(Workspace<Space, S>& w, const S* u, const S* udot) {
  for (std::size_t k = 0; k < w.body.size(); ++k) {
    const auto& b = w.model->bodies[k];
    auto& s = w.body[k];
    s.A = b.parent < 0 ? typename Space::template Motion<S>{}
                       : Space::to_child(b.edge, b.kind, s.edge,
                                         w.body[static_cast<std::size_t>(b.parent)].A);
    s.A += prescribed_acceleration(w, k, u);
    if (b.nv > 0 && udot) Joint<Space>::add_motion(b, s.edge, udot + b.u, s.A);
    if (b.has_rotor())
      for (int i = 0; i < b.nv; ++i) s.rotor_acceleration[i] = udot ? udot[b.u + i] : S(0.0);
  }
}

/// τ = M u̇ + bias − applied − joint forces (nv): the residual of (1a) without λ. On entry
/// body[k].T holds the applied wrenches (apply_forces) and the accelerations are current; on exit
/// body[k].P holds F_K.
template <class Space, class S>
void newton_euler_inward(Workspace<Space, S>& w, const S* q, const S* u, S* tau) {
  const auto& model = *w.model;
  for (std::size_t k = 0; k < w.body.size(); ++k) {
    auto& s = w.body[k];
    s.P = Space::momentum(w.inertia(k), s.A);
    s.P += Space::velocity_wrench(w.inertia(k), s.V);
    s.P -= s.T;
  }
  project_inward(w, tau);
  if (model.has_rotors)
    for (std::size_t k = 0; k < w.body.size(); ++k)
      if (const auto& b = model.bodies[k]; b.has_rotor())
        for (int i = 0; i < b.nv; ++i) tau[b.u + i] += b.rotor * w.body[k].rotor_acceleration[i];
  if (model.has_joint_forces)
    for (const auto& b : model.bodies)
      if (b.nv == 1) tau[b.u] -= joint_force(b, q[b.q], u[b.u]);
}

/// u̇ (nv) from (q, u, t) by the articulated recursion. False at a singular joint
/// (sweeps.singular_joint()). O(bodies).
template <class Space, class S>
bool acceleration_recursion(AccelerationSweeps<Space, S>& sweeps, Workspace<Space, S>& w,
                            const S& t, const S* q, const S* u, S* udot) {
  applied_forces(w, t, q, u);
  return sweeps(t, q, u, static_cast<const S*>(w.generalised.data()), udot);
}

}  // namespace momenta
