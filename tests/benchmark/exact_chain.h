#pragma once
// A chain's motion in quad precision, for the doubles its model holds. It rests on p = Σ Eᵀ M Ω and
// on the Newton-Euler recursion alone: what the fused recursions give is used to solve, and then
// corrected by the residual until it is exact, so that constants they keep rounded (squares of
// cosines, leaves) do not enter. No forces but weights.

#include <momenta/core/expression/functions_quad.h>
#include <momenta/core/kernel/accelerations.h>
#include <momenta/core/kernel/momentum_recursion.h>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace momenta {

using Quads = std::vector<Quad>;

inline Quads quads(const std::vector<double>& x) {
  return Quads(x.begin(), x.end());
}
/// max |x|; NaN where one is among them.
template <class S>
S largest(const std::vector<S>& x) {
  using std::abs;
  S most{};
  for (const S& value : x) {
    const S size = abs(value);
    if (size <= most) continue;
    if (!(size > most)) return size;
    most = size;
  }
  return most;
}

class ExactChain {
 public:
  /// @pre the model stays where it is.
  explicit ExactChain(const Model<Spatial>& model)
      : size_(static_cast<std::size_t>(model.nv)),
        links_(build_links(model)),
        sweeps_(links_),
        w_(model) {}

  /// Takes the configuration of all that follows.
  void place(const Quads& q) {
    q_ = q;
    poses_outward(w_, Quad(), q_.data(), false);
    Quads p(size_), u(size_), pdot(size_);
    if (!sweeps_(Quad(), q_.data(), p.data(), u.data(), pdot.data()))
      throw std::runtime_error("a joint has no inertia");
  }

  /// p = M u
  Quads momenta(const Quads& u) {
    Quads p(size_);
    gather_momenta(u);
    momenta_inward(w_, p.data());
    return p;
  }
  /// u with M u = p.
  Quads velocities(const Quads& p) {
    return solve([&](const Quads& u) {
      Quads left = momenta(u);
      for (std::size_t i = 0; i < size_; ++i) left[i] -= p[i];
      return left;
    });
  }
  /// ṗ, eq. (35).
  Quads momentum_rates(const Quads& u) {
    Quads pdot(size_);
    gather_momenta(u);
    momenta_inward(w_, static_cast<Quad*>(nullptr));
    weigh();
    momentum_rates_inward(w_, q_.data(), u.data(), pdot.data());
    return pdot;
  }
  /// u̇ for which no joint needs a force.
  Quads accelerations(const Quads& u) {
    return solve([&](const Quads& udot) {
      Quads tau(size_);
      velocities_outward(w_, u.data());
      weigh();
      accelerations_outward(w_, u.data(), udot.data());
      newton_euler_inward(w_, q_.data(), u.data(), tau.data());
      return tau;
    });
  }
  Quad kinetic(const Quads& u) {
    velocities_outward(w_, u.data());
    return kinetic_energy(w_);
  }

 private:
  void gather_momenta(const Quads& u) {
    velocities_outward(w_, u.data());
    body_momenta(w_);
  }
  void weigh() {
    gravity_outward(w_);
    apply_forces(w_, false);
  }

  /// x with M x + rest = 0 by residual(x) = M x + rest.
  template <class Residual>
  Quads solve(Residual&& residual) {
    Quads x(size_), step(size_);
    for (int round = 0; round < 20; ++round) {
      const Quads left = residual(x);
      sweeps_.inverse_mass_times(left.data(), step.data());
      for (std::size_t i = 0; i < size_; ++i) x[i] -= step[i];
      if (largest(step) <= 1e-19 * largest(x)) return x;
    }
    throw std::runtime_error("no reference: M is singular even to quad precision");
  }

  std::size_t size_;
  LinkTree links_;
  MomentumSweeps<Spatial, Quad> sweeps_;
  Workspace<Spatial, Quad> w_;
  Quads q_;
};

}  // namespace momenta
