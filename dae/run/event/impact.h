#pragma once
// The jump of momenta at rigid stops. A stop i bounds a coordinate q_j; n_i = ±e_j points beyond
// it, γ_i = n_iᵀu is the rate at which it is approached. At an impact the impulses Λ_i of the stops
// and σ' of the loops act, and no coordinate moves:
//
//   M u⁺ + Φ_qᵀσ' = M u⁻ − Σ n_i Λ_i,   Φ_q u⁺ = −Φ_t,    p⁺ = p⁻ − Σ n_i Λ_i
//   γ_i⁺ = −e_i γ_i⁻ or γ_i⁺ < that and Λ_i = 0,          Λ_i ≥ 0        (Newton's law)
//
// With w_i the rates that n_i as an impulse causes under the loops, M w_i + Φ_qᵀν = n_i, Φ_q w_i =
// 0,
//
//   u⁺ = u⁻ − Σ w_i Λ_i,   W Λ = (1 + e) γ⁻,   W_ik = n_iᵀ w_k,   ΔT = −½ Σ Λ_i (γ_i⁺ + γ_i⁻)
//
// where nothing is driven. Drives that move at an impact do work by it: then ΔT = −Σ Λ_i w_iᵀ p̄, p̄
// = M ½(u⁺ + u⁻) + prescribed part, which is the above less Σ Λ_i (ν_iᵀΦ_t + w_iᵀ p_t). Where
// several stops meet, those whose Λ would be negative are left out one by one, the most negative
// first, and stops that depend on each other share their impulse by least squares. Sources: F.
// Pfeiffer, C. Glocker, Multibody Dynamics with Unilateral Contacts, Wiley 1996, chapters 6 to 8;
// J. J. Moreau, Unilateral contact and dry friction in finite freedom dynamics, 1988.

#include <momenta/dae/kkt/loop_solver.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace momenta {

/// A stop that takes part in an impact.
struct StopAtImpact {
  int u = 0;               ///< place of its coordinate's rate
  double side = 1;         ///< 1: it bounds the coordinate from above; −1: from below
  double restitution = 0;  ///< e
  bool held = false;       ///< it stands at the stop: γ⁻ is zero but for rounding, e too
  bool stuck = false;      ///< γ⁺ = 0 whatever the sign of Λ: the end of bounces
  double impulse = 0;      ///< Λ, of the impact [N s or N m s]; found
};

/// Owns its workspace; one object serves one thread. The mechanism must outlive it.
class Impact {
 public:
  explicit Impact(const Mechanism& mechanism);

  /// Turns u⁻ into u⁺ at (t, q) and finds the stops' impulses. Returns the kinetic energy lost [J]:
  /// to the stops, not negative for e ≤ 1, and to drives by the impact's work on them. Cost: a
  /// solution of (7) for each stop. @throws std::runtime_error where a coordinate cannot move, one
  /// sentence
  double jump(double t, const Eigen::VectorXd& q, Eigen::VectorXd& u,
              std::vector<StopAtImpact>& stops);

 private:
  Eigen::VectorXd response(double t, const Eigen::VectorXd& q, int coordinate, double side);

  const Mechanism& mechanism_;
  std::unique_ptr<Evaluation<double>> e_;
  std::unique_ptr<LoopSolver> solver_;  ///< null without loops
};

}  // namespace momenta
