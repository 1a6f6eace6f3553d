#pragma once
// Inverse dynamics with loops: the efforts τ of actuated rates that give a mechanism its motion,
// beside the forces of the scene,
//
//   B τ = r + Φ_qᵀλ,     r = M u̇ + bias − Q,     B: columns of the identity, at actuated rates
//
// With N of loop_islands.h, in units of the scene, λ is gone, island by island:
//
//   G τ' = b,     G = Nᵀ B,  b = Nᵀ C r,  τ' = C τ                                           (a)
//
// one equation for each freedom and one unknown for each actuator. τ is unique where G has full
// column rank. Else actuators work against each other, and the solution of least Σ wᵢ τᵢ² is taken;
// wᵢ = Cᵢ² unless given: 1 for torques, L² for forces, L the length of the scene, so that units do
// not matter. Where (a) has no solution, the actuators cannot hold the motion: b − G τ' moves the
// mechanism, at rates N (b − G τ').
//
//   Jᵀλ' = B τ' − C r                                                                        (b)
//
// Power: τ·u; the sum over actuators is the same for all solutions. Joints without loops: τ = r.
// Source of (a): Y. Nakamura, M. Ghodoussi, IEEE Trans. Robotics and Automation 5 (1989) 294-302.

#include <momenta/dae/analysis/effort/loop_islands.h>

#include <string>
#include <vector>

namespace momenta {

class Actuation {
 public:
  /// `actuated`: places in u; `weights` by actuator [of N m or N, squared], 0: default. The
  /// mechanism must outlive it.
  Actuation(const Mechanism& mechanism, std::vector<int> actuated, std::vector<double> weights);

  /// Residual of (a) at a state.
  struct Unheld {
    double missing = 0;   ///< largest |b − G τ'| of an island, relative to its forces
    double force = 0;     ///< largest entry of it, in units of the scene [N m]
    Eigen::VectorXd way;  ///< N (b − G τ'), nv, in units; empty: all is held
  };
  /// The efforts (one for each actuator) [N m or N] at (t, q, u, u̇); `islands` was factored at q
  /// with all rows of Φ.
  /// Cost: O(bodies), and with loops a dense decomposition of G of each island.
  Unheld efforts(ScaledLoops& loops, const LoopIslands& islands, double t, const Eigen::VectorXd& q,
                 const Eigen::VectorXd& u, const Eigen::VectorXd& udot, Eigen::VectorXd& tau);
  /// λ (m) of independent rows, by (b). After efforts().
  Eigen::VectorXd multipliers(const ScaledLoops& loops, const LoopIslands& islands,
                              const Eigen::VectorXd& tau) const;

  /// Actuators beyond the motions they act on, at the last efforts().
  int redundant() const { return redundant_; }
  /// Motions without an actuator, at the last efforts().
  int unactuated() const { return unactuated_; }

 private:
  const Mechanism& mechanism_;
  std::vector<int> actuated_;
  Eigen::VectorXd weights_;                  ///< weights of τ', all known
  std::vector<std::vector<int>> of_island_;  ///< places of actuators, by island
  std::vector<std::vector<int>> place_;      ///< places of their rates in it
  Eigen::VectorXd r_, still_, moving_, none_;
  int redundant_ = 0, unactuated_ = 0;
};

}  // namespace momenta
