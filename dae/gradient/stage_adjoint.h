#pragma once
// The transposed derivative of the momentum form's right-hand side and of what it does after steps:
// one product wᵀ f_y, and wᵀ f_θ of all θ, in the place of a tangent for each θ. The form is
// canonical: with the augmented Lagrangian L* = T − V + σᵀ(Φ_q u + Φ_t),
//
//   H(q, p) = stat over (u, σ) of  pᵀu − L*(q, u, σ),     f = J ∇H,   J = ( 0 1; −1 0 ),
//
// and the Hessian of H is symmetric, so
//
//   f_yᵀ w = (J H_yy)ᵀ w = H_yy Jᵀ w = Jᵀ f_y (Jᵀ w),         f_θᵀ w = D_z H_θ = −D_z L*_θ      (4)
//
// with z = Jᵀ w: one derivative of f along one direction, and nothing is run backwards in it. Of
// w = (a, b): z = (−b, a), and with (δu, δσ) of (2) and δr of L*_q along (−b, δu, δσ),
//
//   f_yᵀ w = (−δr, δu),        f_θᵀ w = bᵀ r3_θ − δuᵀ r1_θ − δσᵀ r2_θ                           (5)
//
// with the rows of momentum_rows.h at constant q, u, σ. What has no potential is added:
//   forces Q(q, u, t): a + Q_uᵀ b in the place of a, and Q_qᵀ b  (transposed_forces.h)
//   leak and β: with k = κ + β, −k Φ_q b in the second row of (2), −k Φ_qᵀ δσ in the result, and
//     L*_q less κ Φ_qᵀσ. The derivative of Φ_qᵀσ by q is symmetric as well.
//
// After a step, for λ of the state behind it, c = 1 of a reset, 2 of a flip, p' = p − c Φ_qᵀσ:
//   K μ = (0, Φ_q λ_p),  λ_p − c μ_u,  λ_q − c D_λp(Φ_qᵀσ) + c (D_μ L*_q + β Φ_qᵀ μ_σ)
// and of a correction q' = q + δ, K (δ, ν) = (0, −Φ):
//   K μ = (λ_q, 0),  λ_q − D_μ L*_q(q, δ, ν) − Φ_qᵀ μ_σ, of L* without V and drives
// Here D_μ is the derivative by (u, σ) along μ, and K the matrix of (2).
//
// Derivation: docs/theory/gradients.md, section 7. Compare Maciąg, Malczyk, Frączek, Int. J. Numer.
// Methods Eng. 121 (2020), who integrate the adjoint system of (7), (8), and Multibody Syst. Dyn.
// 56 (2022), who transpose a discrete scheme.

#include <momenta/dae/form/ode_form.h>
#include <momenta/dae/gradient/momentum_rows.h>
#include <momenta/dae/gradient/row_derivatives.h>
#include <momenta/dae/gradient/stage_matrix.h>
#include <momenta/dae/gradient/transposed_forces.h>

namespace momenta {

/// A state at which f is differentiated: its time [s], q (nq), and u (nv), σ (m) of (7) there.
struct AdjointState {
  double t = 0;
  Eigen::VectorXd q, u, sigma;
};

class StageAdjoint {
 public:
  /// @pre the form is `momentum`, the mechanism has neither quaternions nor nonholonomic rows. All
  /// must outlive it.
  StageAdjoint(const Mechanism& mechanism, const OdeForm& form,
               const std::vector<OtherParameter>& others);

  /// f_yᵀ w (nq + nv) of w; by_parameters (others) += f_θᵀ w. False where the matrix is singular.
  /// Cost: two evaluations of rows in dual numbers, one factorisation, six plain evaluations of
  /// rows for each parameter.
  bool rates(const AdjointState& at, const Eigen::VectorXd& w, Eigen::VectorXd& product,
             Eigen::VectorXd& by_parameters);

  /// λ behind a reset or flip to λ before it, at the state where (7) was solved for it.
  bool gauge(const AdjointState& at, Eigen::VectorXd& lambda, Eigen::VectorXd& by_parameters);
  /// λ behind a correction of q to λ before it; q (nq) before it.
  bool correction(double t, const Eigen::VectorXd& q, Eigen::VectorXd& lambda,
                  Eigen::VectorXd& by_parameters);

 private:
  template <class Rows>
  Eigen::VectorXd along(const Rows& rows, const Eigen::VectorXd& x, const Eigen::VectorXd& dx,
                        Eigen::Index size);
  template <class Rows>
  void add_by_parameters(const Rows& rows, const Eigen::VectorXd& x, const Eigen::VectorXd& weights,
                         Eigen::VectorXd& sum);
  bool factor(double t, const Eigen::VectorXd& q);
  Eigen::VectorXd loop_rates(const Eigen::VectorXd& u);

  const Mechanism& mechanism_;
  const std::vector<OtherParameter>& others_;
  std::unique_ptr<Evaluation<double>> e_;
  std::unique_ptr<Evaluation<Dual8>> dual_;
  StageMatrix matrix_;
  TransposedForces forces_;
  Gauge gauge_;
  MomentumAndRateRows rows_;
  Eigen::Index nv_, m_;
  bool driven_;
  std::vector<Dual8> x_, out_;
  Eigen::VectorXd plain_;
};

}  // namespace momenta
