// The generalised-α method on equations of index 3, fixed steps, order 2: of Newmark's family
// (newmark.h) with
//
//   α_m = (2ρ − 1)/(ρ + 1), α_f = ρ/(ρ + 1), γ = ½ + α_f − α_m, β = (γ + ½)²/4,
//
// ρ in [0, 1) the spectral radius at infinite frequency. a is no acceleration of the solution at
// t_n but near t_n + (α_m − α_f) h; it starts as v̇(0), so that λ has an error of order 1 in its
// first steps, damped like ρ^n. Φ̇ holds to order 2.
// Source: Chung, Hulbert, J. Appl. Mech. 60 (1993) 371-375; Arnold, Brüls, Multibody System
// Dynamics 18 (2007) 185-202.

#include <momenta/dae/integrator/implicit_methods.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/integrator/newmark.h>

#include <stdexcept>

namespace momenta {

IntegrationResult integrate_generalised_alpha(DaeSystem& system, double t0,
                                              const std::vector<double>& output_times,
                                              const IntegrationOptions& options,
                                              const Observer& observer) {
  const double rho = options.spectral_radius;
  if (!(rho >= 0 && rho < 1))
    throw std::invalid_argument("the spectral radius of generalised-alpha must be in [0, 1)");
  NewmarkRule rule;
  rule.m = (2 * rho - 1) / (rho + 1);
  rule.f = rho / (rho + 1);
  rule.gamma = 0.5 + rule.f - rule.m;
  rule.beta = 0.25 * (rule.gamma + 0.5) * (rule.gamma + 0.5);
  return integrate_newmark("generalised-alpha", rule, system, t0, output_times, options, observer);
}

Integrator generalised_alpha_integrator() {
  return {.name = "generalised-alpha",
          .takes = Integrator::Takes::dae,
          .method = "generalised-α, order 2",
          .forms = {"acceleration-index3"},
          .closes = {"acceleration-index3"},
          .dae_run = integrate_generalised_alpha};
}

}  // namespace momenta
