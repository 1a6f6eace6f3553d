// augmented-lagrangian
//
// Unknowns      q, u
// Equations     (M + Φ_qᵀ α Φ_q) u̇ₖ₊₁ = M u̇ₖ − Φ_qᵀ α (Φ̇_q u + Φ̇_t + 2ξω Φ̇ + ω² Φ), two iterations,
//               q̇ = u. With M u̇ₖ = Q + L_q − Ṁ u − Φ_qᵀλₖ this is equivalent to
//                 M u̇ₖ₊₁ + Φ_qᵀλₖ₊₁ = Q + L_q − Ṁ u,  λₖ₊₁ = λₖ + α (Φ̈ₖ₊₁ + 2ξω Φ̇ + ω² Φ),
//               which is (3) with −α⁻¹ (λₖ₊₁ − λₖ) in its second row. It is solved in this
//               form: no matrix has entries of 10⁷ beside entries of 1, and the sweeps solve it as
//               they solve (3). λ₀ is λ at the start of the step.
// Index         an ODE
// Hidden        Φ(q, t) = 0 and Φ_q u + Φ_t = 0
// Multipliers   λ, a force, the correction included
// Drifts        as `baumgarte`: Φ, Φ̇ bounded at a level set by ω and the step. An iteration
//               leaves the fraction 1/(1 + α W) of the error of λ, W = Φ_q M⁻¹Φ_qᵀ: 10⁻¹⁴ after
//               two. Where W loses rank, no row has to be chosen: in the lost directions λ keeps
//               its value.
// Settings      α = penalty / W with W at the start: `penalty` counts effective masses of the
//               loops, 10⁷ unless given. ξω = ω = 1/T, with T the time scale of the mechanism; the
//               literature takes ω = 10, ξ = 1 for motions of a second
// Index 3       with mass-orthogonal projections: integrator `bayo-ledesma`
// Source        Bayo, Avello, Nonlinear Dynamics 5 (1994); Bayo, García de Jalón, Serna, Comput.
//               Methods Appl. Mech. Eng. 71 (1988).

#include <momenta/dae/form/acceleration_form.h>
#include <momenta/dae/form/form_entry.h>
#include <momenta/dae/form/penalty.h>

namespace momenta {
namespace {

class AugmentedLagrangian final : public AccelerationForm {
 public:
  AugmentedLagrangian(const Mechanism& mechanism, const FormOptions& options, const Start& start)
      : AccelerationForm("augmented-lagrangian", mechanism, options, start,
                         feedback_of(mechanism, options, start), penalty_iterations),
        penalty_(soften(mechanism, *e_, solver_.get(), options, start)) {}

  double penalty() const override { return penalty_; }

 private:
  double penalty_;
};

}  // namespace

FormEntry augmented_lagrangian_entry() {
  return {.name = "augmented-lagrangian",
          .bearings = true,
          .colour = 7,
          .place = 7,
          .words = {.x = "u",
                    .solved = penalised_mass,
                    .penalised = true,
                    .constraints = {invariant(equation::rates), invariant(equation::positions)}},
          .make = made<AugmentedLagrangian>};
}

}  // namespace momenta
