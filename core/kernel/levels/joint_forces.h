#pragma once
// Forces of joints for acceleration sweeps, of a pack of states.

#include <momenta/core/kernel/levels/strided.h>
#include <momenta/core/kernel/sweeps.h>

namespace momenta {

/// τ and the forces of the joints' springs, dampers and torques; `tau`: coordinates `stride` apart,
/// null: none. `room` holds nv packs. Not inlined: g++ 12 warns of stores that are not made.
template <class S, class Model>
[[gnu::noinline]] StridedIn<S> joint_forces(const Model& model, const double* tau,
                                            std::ptrdiff_t stride, const StridedIn<S>& q,
                                            const StridedIn<S>& u, double* room) {
  constexpr std::ptrdiff_t width = sizeof(S) / sizeof(double);
  if (!model.has_joint_forces) {
    if (tau) return {tau, stride};
    S(0.0).store(room);
    return {room, 0};  // one zero for all coordinates
  }
  for (const auto& b : model.bodies)
    for (int i = b.u; i < b.u + b.nv; ++i) {
      S force(0.0);
      if (tau) force = S::load(tau + i * stride);
      if (b.nv == 1) force += joint_force(b, q[b.q], u[b.u]);
      force.store(room + i * width);
    }
  return {room, width};
}

}  // namespace momenta
