#pragma once
// The transposed derivative of the right-hand side of the forms on accelerations, and of their
// corrections after steps: one product wᵀ f_y and wᵀ f_θ of all θ. Of y = (q, u), with
//
//   r1 = M u̇ + b − Q + Φ_qᵀλ = 0,      r2 = Φ̈ + 2αΦ̇ + β²Φ = 0                              (3)
//
// solved for (u̇, λ), w = (w_q, w_u) and the symmetric matrix K of (3), K (ν, μ) = (w_u, 0):
//
//   wᵀ dẏ = w_qᵀ du − νᵀ dr1 − μᵀ dr2,      f_yᵀ w = (−S_q, w_q − S_u),      f_θᵀ w = −S_θ
//
// at constant u̇, λ, ν, μ, with the number S = νᵀr1 + μᵀr2. The rows are Lagrange's: with
// L* = T − V + σᵀΦ̇ and D_c along the curve (q + u s, u + u̇ s, λ s, t + s) of (q, u, σ, t) from
// σ = 0,
//
//   S = D_c D_(0,ν,μ) L* − D_(ν,0,0) L* − νᵀQ + 2α μᵀΦ̇ + β² μᵀΦ
//
// so that S_q, S_u, S_θ are second derivatives of P = L*_u, R = L*_q, L*_θ (mixed_rates.h), one
// derivative more than on momenta, where u and σ are stationary (stage_adjoint.h). Forces without
// potential stand apart: Q_qᵀν, Q_uᵀν (transposed_forces.h). K is solved as (7) is, with p = w_u:
// O(bodies).
//
// All numbers of bodies, joints, loops and springs go at once (number_slopes.h): L*_θ is of degree
// two in (u, σ), so
//
//   D_c D_(0,ν,μ) L*_θ = ( D_c L*_θ(q, u + sν, sμ) − D_c L*_θ(q, u − sν, −sμ) ) / 2s
//
// where nothing is prescribed; else, and for other θ, the rows of mechanisms with neighbouring θ
// give S_θ. Corrections after steps: correction_adjoint.h.
//
// Derivation: docs/theory/gradients.md, section 8. Compare Haug, Ehle, Int. J. Numer. Methods Eng.
// 18 (1982), and Bestle, Eberhard, Mech. Struct. Mach. 20 (1992), who integrate adjoint systems of
// (3); here the steps of the run are transposed.

#include <momenta/dae/form/ode_form.h>
#include <momenta/dae/gradient/correction_adjoint.h>
#include <momenta/dae/gradient/form_adjoint.h>
#include <momenta/dae/gradient/mixed_rates.h>

namespace momenta {

class AccelerationAdjoint final : public FormAdjoint {
 public:
  /// @pre the form is `acceleration`, `baumgarte` or `projected`; the mechanism has neither
  /// quaternions nor nonholonomic rows. All must outlive it.
  AccelerationAdjoint(const Mechanism& mechanism, const OdeForm& form,
                      const std::vector<OtherParameter>& others);

  /// Cost: one solution of (7); three evaluations of rows in dual numbers, or one in series if
  /// driven; three sweeps for all numbers of tables; six plain evaluations of rows for each other
  /// θ.
  bool rates(const AdjointState& at, const Eigen::VectorXd& w, Eigen::VectorXd& product,
             Eigen::VectorXd& by_parameters) override;
  bool gauge(const AdjointState& at, Eigen::VectorXd& lambda,
             Eigen::VectorXd& by_parameters) override;
  bool correction(double t, const Eigen::VectorXd& q, Eigen::VectorXd& lambda,
                  Eigen::VectorXd& by_parameters) override;
  void finish(Eigen::VectorXd& by_parameters) override;

  Eigen::Index at_once() const override;
  bool needs_solutions() const override { return true; }
  bool needs_rates() const override { return false; }
  bool solved(const AdjointState&) const override { return true; }
  void by_rows() override { corrections_.system().by_matrix(); }

 private:
  void add_numbers(const AdjointState& at);
  CorrectionAdjoint::Numbers numbers() { return {numbers_.get(), placed_}; }

  const Mechanism& mechanism_;
  const std::vector<OtherParameter>& others_;
  Eigen::Index nv_, m_;
  double alpha_, beta_;
  bool projects_, repeats_;
  TransposedForces forces_;
  MixedRates mixed_;
  CorrectionAdjoint corrections_;
  std::unique_ptr<NumberSlopes> numbers_;        ///< null: no θ goes by numbers
  std::unique_ptr<NumberSlopes> mixed_numbers_;  ///< slopes of D_c D_(0,ν,μ) L*_θ
  bool placed_ = false;                          ///< some θ changes places
  bool any_rows_ = false;                        ///< rows of other mechanisms give some θ
  Eigen::VectorXd nu_, mu_, by_q_, by_u_, shifted_, sigma_, x_, weights_;
};

}  // namespace momenta
