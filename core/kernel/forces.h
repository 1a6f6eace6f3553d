#pragma once
// Applied wrenches T_K of (17): weights, spring-dampers, bushings, coordinate springs, constant
// wrenches, formulas; and their energies.

#include <momenta/core/kernel/bushing.h>
#include <momenta/core/kernel/formula_force.h>
#include <momenta/core/kernel/sweeps.h>

namespace momenta {

/// Adds springs, bushings, wrenches and formulas to body[k].T. Needs poses and velocities.
template <class Space, class S>
void add_body_forces(Workspace<Space, S>& w) {
  for (const auto& spring : w.model->springs) {
    const SpringLine<Space, S> line(w, spring);
    if (!line.has_direction()) continue;  // no direction at zero length
    const S inverse = S(1.0) / line.length;
    S tension = spring.stiffness * stretched(spring.band, S(line.length - spring.rest));
    if (spring.damping != 0)
      tension += spring.damping * inverse *
                 dot(line.D, point_velocity(w, spring.child, line.child) -
                                 point_velocity(w, spring.parent, line.parent));
    if (spring.stop.acts()) tension -= stop_force(spring.stop, line.length, line.rate(w, spring));
    line.pull(w, spring, S(tension * inverse));
  }
  add_bushings(w);
  add_coordinate_springs(w);
  add_formula_forces(w);
  for (const auto& wrench : w.model->wrenches) {
    const int k = wrench.body;
    auto& T = w.body[static_cast<std::size_t>(k)].T;
    const auto in_ground = [&](const auto& v) {
      return wrench.in_body_axes ? to_ground(w, k, v) : to_ground(w, -1, v);
    };
    add_force(w, k, point_position(w, k, wrench.at), in_ground(wrench.force), T);
    if constexpr (Space::dimension == 3)
      add_couple(w, k, S(wrench.normal_torque), T);
    else
      add_couple(w, k, in_ground(wrench.torque), T);
  }
}

/// body[k].T = weight, with `also_body_forces` plus springs and wrenches. Needs gravity_outward.
template <class Space, class S>
void apply_forces(Workspace<Space, S>& w, bool also_body_forces) {
  const auto& model = *w.model;
  for (std::size_t k = 0; k < w.body.size(); ++k) {
    auto& s = w.body[k];
    s.T = {};
    if (model.has_gravity) {
      const auto& inertia = w.inertia(k);
      typename Space::template Vector<S> mc;
      for (int i = 0; i < static_cast<int>(std::size(mc.x)); ++i) mc[i] = S(inertia.mc[i]);
      s.T = Space::weight(S(inertia.m), mc, s.g);
    }
  }
  if (also_body_forces) add_body_forces(w);
}

/// T = ½ Σ Ω·(M Ω) [J]. Needs velocities.
template <class Space, class S>
S kinetic_energy(const Workspace<Space, S>& w) {
  S twice{};
  for (std::size_t k = 0; k < w.body.size(); ++k) {
    twice += Space::power(Space::momentum(w.inertia(k), w.body[k].V), w.body[k].V);
    if (const auto& b = w.model->bodies[k]; b.has_rotor())
      twice += b.rotor * dot(w.body[k].rotor_rate, w.body[k].rotor_rate);
  }
  return 0.5 * twice;
}

/// V [J]: gravity, springs, joint springs and stops; constant joint torques and ground-axes forces
/// count as potentials −τ q and −F·x. Needs poses with ground positions.
template <class Space, class S>
S potential_energy(const Workspace<Space, S>& w, const S* q) {
  const auto& model = *w.model;
  S energy{};
  for (std::size_t k = 0; k < w.body.size(); ++k) {
    const auto& b = model.bodies[k];
    const int body = static_cast<int>(k);
    if (model.has_gravity) {
      const auto moment = S(b.inertia.m) * origin(w, body) + to_ground(w, body, b.inertia.mc);
      for (int i = 0; i < static_cast<int>(std::size(moment.x)); ++i)
        energy -= model.gravity[i] * moment[i];
    }
    if (b.nv == 1) {
      const S stretch = q[b.q] - b.rest;
      energy += 0.5 * b.stiffness * (stretch * stretch) - b.torque * q[b.q];
      if (b.stop.acts()) energy += stored_energy(b.stop, q[b.q]);
    }
  }
  for (const auto& spring : model.springs) {
    const S length = SpringLine<Space, S>(w, spring).length;
    energy += spring.stiffness * stretched_energy(spring.band, S(length - spring.rest));
    if (spring.stop.acts()) energy += stored_energy(spring.stop, length);
  }
  energy += bushing_energy(w) + coordinate_spring_energy(w);
  if (!model.formula_forces.empty()) energy += formula_energy(w);
  for (const auto& wrench : model.wrenches)
    if (!wrench.in_body_axes)
      energy -= dot(to_ground(w, -1, wrench.force), point_position(w, wrench.body, wrench.at));
  return energy;
}

}  // namespace momenta
