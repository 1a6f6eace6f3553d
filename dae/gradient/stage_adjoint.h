#pragma once
// The transposed derivative of the momentum form's right-hand side and of its changes after steps:
// one product wᵀ f_y, and wᵀ f_θ of all θ, in place of a tangent for each θ. The form is canonical:
// with the augmented Lagrangian L* = T − V + σᵀ(Φ_q u + Φ_t),
//
//   H(q, p) = stat over (u, σ) of  pᵀu − L*(q, u, σ),     f = J ∇H,   J = ( 0 1; −1 0 ),
//
// and the Hessian of H is symmetric, so
//
//   f_yᵀ w = (J H_yy)ᵀ w = H_yy Jᵀ w = Jᵀ f_y (Jᵀ w),         f_θᵀ w = D_z H_θ = −D_z L*_θ      (4)
//
// with z = Jᵀ w: one derivative of f along one direction, and nothing is run backwards in it. For w
// = (a, b): z = (−b, a), and with (δu, δσ) of (2) and δr of L*_q along (−b, δu, δσ),
//
//   f_yᵀ w = (−δr, δu),        f_θᵀ w = bᵀ r3_θ − δuᵀ r1_θ − δσᵀ r2_θ                           (5)
//
// with the rows of momentum_rows.h at constant q, u, σ. What has no potential is added:
//   forces Q(q, u, t): a + Q_uᵀ b in the place of a, and Q_qᵀ b  (transposed_forces.h; along lines
//     of their own line_losses.h)
//   leak and β: with k = κ + β, −k Φ_q b in the second row of (2), −k Φ_qᵀ δσ in the result, and
//     L*_q less κ Φ_qᵀσ. The derivative of Φ_qᵀσ by q is symmetric as well.
//
// After a step, for λ of the state behind it, c = 1 for a reset, 2 for a flip, p' = p − c Φ_qᵀσ:
//   K μ = (0, Φ_q λ_p),  λ_p − c μ_u,  λ_q − c D_λp(Φ_qᵀσ) + c (D_μ L*_q + β Φ_qᵀ μ_σ)
// or, since p' = c M u − (c − 1) p and u = ∂H/∂p, with δu, δr of f along (0, M λ_p),
//   c δu − (c − 1) λ_p,  λ_q − c δr + c D_λp T_q  at σ = 0,
// and of corrections correction_adjoint.h. D_μ is the derivative by (u, σ) along μ, K the matrix of
// (2).
//
// δu, δσ, δr come from the sweeps in dual numbers where they carry the mechanism (swept_tangent.h),
// without leak and β, else from the rows and K. For θ that change numbers of tables alone, f_θᵀ w
// is a sum of slopes by all numbers at once (number_slopes.h): of L* with z, of βΦ with −δσ, behind
// a gauge c (D_μ L*_θ + β (μ_σᵀΦ)_θ − D_λp (σᵀΦ̇)_θ); other θ take the rows of mechanisms with
// neighbouring θ.
//
// Derivation: docs/theory/gradients.md, section 7. Compare Maciąg, Malczyk, Frączek, Int. J. Numer.
// Methods Eng. 121 (2020), who integrate the adjoint system of (7), (8), and Multibody Syst. Dyn.
// 56 (2022), who transpose a discrete scheme.

#include <momenta/dae/form/ode_form.h>
#include <momenta/dae/gradient/correction_adjoint.h>
#include <momenta/dae/gradient/form_adjoint.h>
#include <momenta/dae/gradient/line_losses.h>
#include <momenta/dae/gradient/mixed_rates.h>
#include <momenta/dae/gradient/momentum_rows.h>
#include <momenta/dae/gradient/number_slopes.h>
#include <momenta/dae/gradient/row_derivatives.h>
#include <momenta/dae/gradient/stage_matrix.h>
#include <momenta/dae/gradient/swept_tangent.h>
#include <momenta/dae/gradient/transposed_forces.h>

namespace momenta {

class StageAdjoint final : public FormAdjoint {
 public:
  /// @pre the form is `momentum`, the mechanism has neither quaternions nor nonholonomic rows. All
  /// must outlive it.
  StageAdjoint(const Mechanism& mechanism, const OdeForm& form,
               const std::vector<OtherParameter>& others);

  /// f_yᵀ w (nq + nv) of w; by_parameters (others) += f_θᵀ w, for those taken at once in finish().
  /// False where the matrix is singular. Cost: one evaluation of the sweeps in dual numbers, or two
  /// of rows and one factorisation; one sweep outward and inward for all numbers of tables; six
  /// plain evaluations of rows for each other θ.
  bool rates(const AdjointState& at, const Eigen::VectorXd& w, Eigen::VectorXd& product,
             Eigen::VectorXd& by_parameters) override;

  /// λ before a reset or flip, from λ behind it, at the state of its (7). With known u the sweeps
  /// need not find it.
  bool gauge(const AdjointState& at, Eigen::VectorXd& lambda,
             Eigen::VectorXd& by_parameters) override;
  bool correction(double t, const Eigen::VectorXd& q, Eigen::VectorXd& lambda,
                  Eigen::VectorXd& by_parameters) override;
  void finish(Eigen::VectorXd& by_parameters) override;

  Eigen::Index at_once() const override;
  bool needs_solutions() const override { return !swept_ || any_rows_; }
  bool needs_rates() const override { return losses_ ? losses_->at_state() : forces_.any(); }
  bool solved(const AdjointState& at) const override {
    return at.u.size() == nv_ && at.sigma.size() == m_;
  }
  bool swept() const { return swept_ != nullptr; }
  const double* found_rates() const override { return swept_ ? swept_->u.data() : nullptr; }
  /// Rows and K alone from now on: slower, but the only way where rows of Φ are redundant and fade
  /// in the sweeps.
  void by_rows() override {
    swept_.reset();
    corrections_.system().by_matrix();
  }

 private:
  bool sweep(const AdjointState& at, const Eigen::VectorXd& w, Eigen::VectorXd& product,
             Eigen::VectorXd& by_parameters);
  bool sweep_gauge(const AdjointState& at, double c, Eigen::VectorXd& lambda,
                   Eigen::VectorXd& by_parameters);
  template <class Rows>
  Eigen::VectorXd along(const Rows& rows, const Eigen::VectorXd& x, const Eigen::VectorXd& dx,
                        Eigen::Index size);
  /// sum_j += weights · ∂(r1, r2, r3)/∂θ_j, or of r1, r2 and Φ_qᵀσ.
  void add_by_rows(const AdjointState& at, const Eigen::VectorXd& weights, bool of_gauge,
                   Eigen::VectorXd& sum);
  template <class Rows>
  void add_by_parameters(const Rows& rows, const Eigen::VectorXd& x, const Eigen::VectorXd& weights,
                         Eigen::VectorXd& sum);
  void add_gauge(double c, const NumberSweep::Motion& along_mu, const double* of_p,
                 Eigen::VectorXd& by_parameters);
  void take_drives(double t, Eigen::VectorXd& by_parameters);
  bool factor(double t, const Eigen::VectorXd& q);
  Eigen::VectorXd loop_rates(const Eigen::VectorXd& u);

  const Mechanism& mechanism_;
  const std::vector<OtherParameter>& others_;
  std::unique_ptr<Evaluation<double>> e_;
  std::unique_ptr<Evaluation<Dual8>> dual_;
  StageMatrix matrix_;
  TransposedForces forces_;
  CorrectionAdjoint corrections_;
  std::unique_ptr<LineLosses> losses_;     ///< null: forces_ has all
  std::unique_ptr<SweptTangent> swept_;    ///< null: by rows
  std::unique_ptr<NumberSlopes> numbers_;  ///< null: no θ goes by numbers
  std::unique_ptr<KineticRates> kinetic_;  ///< where there are sweeps
  Eigen::VectorXd slopes_;                 ///< so far
  bool placed_ = false;                    ///< some θ changes places
  bool moves_drives_ = false;              ///< some θ changes laws of drives
  Gauge gauge_;
  MomentumAndRateRows rows_;
  Eigen::Index nv_, m_;
  bool driven_;
  bool any_rows_ = false;  ///< rows of other mechanisms give some θ
  std::vector<Dual8> x_, out_;
  Eigen::VectorXd by_q_, by_u_, along_q_, along_p_, still_, rates_, u_;
};

}  // namespace momenta
