#pragma once
// The implicit one-step methods of our own, each in its file; integrators.h calls them by name.

#include <momenta/dae/solver/integration.h>

namespace momenta {

/// Gauss collocation with steps of options.step; `stages` 2 or 3 for orders 4 and 6.
IntegrationResult integrate_gauss(int stages, OdeSystem&, double t0, const std::vector<double>& y0,
                                  const std::vector<double>& output_times,
                                  const IntegrationOptions&, const Observer&);

/// Generalised-α with steps of options.step and the spectral radius `rho` at infinite frequency,
/// for systems that are SecondOrder.
IntegrationResult integrate_generalised_alpha(DaeSystem&, double t0,
                                              const std::vector<double>& output_times,
                                              const IntegrationOptions&, const Observer&,
                                              double rho = 0.8);

}  // namespace momenta
