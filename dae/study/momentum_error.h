#pragma once
// The error of p without its gauge. p of (7) holds Φ_qᵀσ, which moves nothing and which a gauge
// chooses; so what is compared is what of a difference e_p of momenta moves at the pose q,
//
//   M v + Φ_qᵀν = e_p,   Φ_q v = 0            error = M v = e_p − Φ_qᵀν.
//
// Any Φ_qᵀc in p or in its reference goes into ν. With p = M u + Φ_qᵀσ, e_p = M u − p_ref will do
// in every form, those on accelerations too.

#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/measure/growth.h>

#include <cmath>
#include <vector>

namespace momenta {

class MomentumError {
 public:
  /// `e` and, where there are loops, `solver` (else null) are used as workspaces.
  MomentumError(const Mechanism& mechanism, Evaluation<double>& e, LoopSolver* solver)
      : e_(e),
        solver_(solver),
        error_(static_cast<std::size_t>(mechanism.nv())),
        moved_(error_.size()),
        prescribed_(error_.size()) {}

  /// max |M v| / (1 + |reference|) at (t, q, u), `reference` (nv) up to Φ_qᵀc; NaN where (7) has no
  /// solution, 0 without coordinates. Cost: a solution of (7). No allocation.
  double at(double t, const double* q, const double* u, const double* reference) {
    e_.place(t, q);
    e_.move(u);
    e_.momenta(nullptr, error_.data());
    for (std::size_t i = 0; i < error_.size(); ++i) error_[i] -= reference[i];
    if (solver_) {
      if (!solver_->free_velocity(t, q, error_.data(), moved_.data())) return not_measured;
      e_.place(t, q);
      e_.move(nullptr);
      e_.momenta(nullptr, prescribed_.data());
      e_.move(moved_.data());
      e_.momenta(nullptr, error_.data());
      for (std::size_t i = 0; i < error_.size(); ++i) error_[i] -= prescribed_[i];
    }
    double largest = 0;
    for (std::size_t i = 0; i < error_.size(); ++i) {
      const double error = std::abs(error_[i]) / (1 + std::abs(reference[i]));
      if (!(error <= largest)) largest = error;
    }
    return largest;
  }

 private:
  Evaluation<double>& e_;
  LoopSolver* solver_;
  std::vector<double> error_, moved_, prescribed_;
};

}  // namespace momenta
