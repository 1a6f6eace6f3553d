// augmented-lagrangian-canonical
//
// Unknowns      q, p
// Equations     (M + Φ_qᵀ α Φ_q) uₖ₊₁ = p − Φ_qᵀσₖ − Φ_qᵀ α (Φ_t + 2ξω Φ),
//               σₖ₊₁ = σₖ + α (Φ̇ₖ₊₁ + 2ξω Φ), two iterations; q̇ = u,
//               ṗ = L_q + Q + Φ̇_qᵀσ − κ Φ_qᵀσ (8). The first two are (7) with −α⁻¹ in row 2,
//                 M uₖ₊₁ + Φ_qᵀσₖ₊₁ = p,  Φ_q uₖ₊₁ = −Φ_t − βΦ + α⁻¹ (σₖ₊₁ − σₖ),  β = 2ξω,
//               and are solved in this form; σ₀ is σ at the start of the step
// Index         an ODE on all of R²ⁿ: any p is consistent
// Hidden        Φ(q, t) = 0
// Multipliers   σ, an impulse; the constraint force is λ = σ̇ + κ σ
// Drifts        Φ bounded, at a level set by β and the step; Φ̇ = −βΦ. Without a gauge σ, the local
//               error and the loss of energy grow as in `momentum`: a penalty does not prevent it.
// Settings      penalty as in `augmented-lagrangian`; β = 2/T, T the time scale of the mechanism
// Left out      ω² ∫Φ dt beside 2ξω Φ: it would add m unknowns, and Φ decays without it
// Source        Bayo, Avello, Nonlinear Dynamics 5 (1994), the canonical equations; (6)-(8).

#include <momenta/dae/form/form_entry.h>
#include <momenta/dae/form/momentum_form.h>
#include <momenta/dae/form/penalty.h>

namespace momenta {
namespace {

class AugmentedLagrangianCanonical final : public MomentumForm {
 public:
  AugmentedLagrangianCanonical(const Mechanism& mechanism, const FormOptions& options,
                               const Start& start)
      : MomentumForm("augmented-lagrangian-canonical", mechanism, options, start,
                     options.beta > 0 ? options.beta : 2 * default_leak(mechanism, start),
                     penalty_iterations),
        penalty_(soften(mechanism, *e_, solver_.get(), options, start)) {}

  double penalty() const override { return penalty_; }

 private:
  double penalty_;
};

}  // namespace

FormEntry augmented_lagrangian_canonical_entry() {
  return {.name = "augmented-lagrangian-canonical",
          .impulses = true,
          .bearings = true,
          .colour = 0,
          .place = 14,
          .words = {.x = "p",
                    .solved = penalised_mass,
                    .penalised = true,
                    .constraints = {invariant(equation::positions)}},
          .make = made<AugmentedLagrangianCanonical>};
}

}  // namespace momenta
