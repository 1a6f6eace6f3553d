#pragma once
// The power of prescribed motion: drives of joints, drives of loops, constraints that depend on
// time. With f_d(t) the motion of the driven coordinates, τ_d the efforts of their drives and Φ =
// Φ(q, f(t), t),
//
//   d/dt (T + V) = Q·u + Σ τ_d ḟ_d + λᵀ ∂Φ/∂t          τ_d = τ⁰_d + (∂Φ/∂f_d)ᵀ λ
//                = Q·u + Σ F⁰_K·Ω_t,K + λᵀ Φ_t          where Φ̇ = Φ_q u + Φ_t = 0
//
// F⁰_K is the wrench of joint K without loop forces, Ω_t,K its prescribed motion (13), and Φ_t is Φ̇
// at u = 0, with the drives of joints in it: no derivative of Φ by a driven coordinate is needed.
// Work of the loops where Φ̇ is not zero is not included, and shows as energy error.
//
// u̇ and λ are those of (3) at (t, q, u), whatever the form.

#include <momenta/dae/kkt/bearing_friction.h>
#include <momenta/dae/run/measure/reactions.h>

#include <memory>
#include <vector>

namespace momenta {

class DrivePower {
 public:
  /// `e` and, with loops, `solver` (else null) serve as workspaces.
  DrivePower(const Mechanism& mechanism, Evaluation<double>& e, LoopSolver* solver);

  /// Whether prescribed motion can do work.
  bool any() const { return any_; }
  /// The power at (t, q, u) [W]; NaN where (3) has no solution. Changes the pose of `e`. Cost: a
  /// solution of (3), and O(bodies + loops). No allocation.
  double at(double t, const double* q, const double* u);

 private:
  const Mechanism& mechanism_;
  Evaluation<double>& e_;
  LoopSolver* solver_;
  std::unique_ptr<BearingFriction> friction_;
  bool any_;
  std::unique_ptr<WrenchSweep> sweep_;  ///< null: a Lagrangian
  std::vector<double> udot_, lambda_, none_, moving_;
};

}  // namespace momenta
