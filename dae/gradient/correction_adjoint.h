#pragma once
// The transposed derivatives of the corrections that forms make after steps, with K of
// metric_system.h and D_(a,b) the derivative by (u, σ) along (a, b), of L* = T + σᵀΦ̇:
//
//   positions    q' = q + δ, K (δ, ν) = (0, −Φ);           K (a, b) = (λ_q, 0),
//                λ_q − D_(a,b) L*_q(q, δ, ν) − Φ_qᵀ b, drives left out
//   velocities   u' = v, K (v, ν) = (M u, −Φ_t) at q';     K (a, b) = (λ_u, 0),
//                λ_q + D_(a,0) L*_q(q', u, 0) − D_(a,b) L*_q(q', v, ν),   M a in the place of λ_u
//
// Numbers taken at once have the same with L*_θ and Φ_θ; other θ, −(a, b) times the derivatives of
// the rows.

#include <momenta/dae/gradient/metric_system.h>
#include <momenta/dae/gradient/momentum_rows.h>
#include <momenta/dae/gradient/number_slopes.h>
#include <momenta/dae/gradient/row_derivatives.h>
#include <momenta/dae/gradient/transposed_forces.h>

namespace momenta {

class CorrectionAdjoint {
 public:
  /// The mechanism has neither quaternions nor nonholonomic rows. All must outlive it.
  CorrectionAdjoint(const Mechanism& mechanism, const std::vector<OtherParameter>& others,
                    const TransposedForces& forces);

  /// Slopes by numbers are added here; null: none. `placed`: some θ changes places.
  struct Numbers {
    NumberSlopes* of = nullptr;
    bool placed = false;
  };
  /// λ (of q, then p or u) before the correction of q at t [s], from λ behind it; `repeated`: until
  /// consistent, as in the form `projected`. False where the matrix is singular. Each correction
  /// costs two solutions of K and one evaluation of rows in dual numbers.
  bool positions(double t, const Eigen::VectorXd& q, bool repeated, const Numbers& numbers,
                 Eigen::VectorXd& lambda, Eigen::VectorXd& by_parameters);
  /// The same for the correction of u, at the corrected q. Two solutions, two evaluations.
  bool velocities(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u,
                  const Numbers& numbers, Eigen::VectorXd& lambda, Eigen::VectorXd& by_parameters);

  MetricSystem& system() { return system_; }

 private:
  bool position(double t, const Eigen::VectorXd& q, const Numbers& numbers, Eigen::VectorXd& lambda,
                Eigen::VectorXd& by_parameters);
  const Eigen::VectorXd& along(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u,
                               const Eigen::VectorXd& sigma, const Eigen::VectorXd& a,
                               const Eigen::VectorXd& b);

  const std::vector<OtherParameter>& others_;
  MetricSystem system_;
  LagrangianSlopes rows_;
  bool driven_;
  std::unique_ptr<Evaluation<double>> e_;
  std::unique_ptr<Evaluation<Dual8>> dual_;
  std::vector<Dual8> x_, out_;
  std::vector<Eigen::VectorXd> passed_;  ///< q before each correction
  Eigen::VectorXd delta_, nu_, a_, b_, slope_, force_, none_, still_;
};

}  // namespace momenta
