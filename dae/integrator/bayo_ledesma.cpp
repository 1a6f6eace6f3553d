// The augmented Lagrangian of index 3 with mass-orthogonal projections, fixed steps, order 2: the
// trapezoidal rule in positions (newmark.h with β = ¼, γ = ½, a = v̇), equilibrium at t_{n+1}
//
//   M v̇ + Φ_qᵀ(λ* + αΦ) = Q,   λ* ← λ* + αΦ,
//
// iterated by Newton's method until λ* no longer changes and Φ = 0; then
//
//   (P + (h²/4) Φ_qᵀαΦ_q) v = P v* − (h²/4) Φ_qᵀα Φ_t,            P = M + (h/2) ∂F/∂v + (h²/4)
//   ∂F/∂q (P + (h²/4) Φ_qᵀαΦ_q) v̇ = P v̇* − (h²/4) Φ_qᵀα (Φ̇_q v + Φ̇_t)
//
// v*, v̇* those of the rule: v - v* and v̇ - v̇* are orthogonal in P to what the loops allow. They are
// the start of the next step. The bare rule on index 3 is weakly unstable, v̇ and λ alternate with
// growing size; projections end that.
// α of a row is `penalty` effective masses of its loop, 10⁷, over h²/4. All is solved with λ as an
// unknown and −1/α in its block: no matrix holds 10⁷ and 1 side by side, and redundant rows need
// no choice. Φ, Φ̇, Φ̈ hold after each step, Φ to 10⁻³ of the tolerance, the others at rounding.
// Source: Bayo, Ledesma, Nonlinear Dynamics 9 (1996) 113-130; Cuadrado, Cardenal, Morer, Bayo,
// Multibody System Dynamics 4 (2000) 55-73.

#include <momenta/dae/integrator/implicit_methods.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/integrator/newmark.h>

namespace momenta {

IntegrationResult integrate_bayo_ledesma(DaeSystem& system, double t0,
                                         const std::vector<double>& output_times,
                                         const IntegrationOptions& options,
                                         const Observer& observer) {
  NewmarkRule rule;
  rule.augmented = true;
  return integrate_newmark("bayo-ledesma", rule, system, t0, output_times, options, observer);
}

Integrator bayo_ledesma_integrator() {
  return {.name = "bayo-ledesma",
          .takes = Integrator::Takes::dae,
          .method =
              "augmented Lagrangian of index 3, trapezoidal rule and mass-orthogonal "
              "projections, order 2",
          .forms = {"acceleration-index3"},
          .closes = {"acceleration-index3"},
          .dae_run = integrate_bayo_ledesma};
}

}  // namespace momenta
