#pragma once
// The implicit and half-explicit one-step methods of our own, each in its file; integrators.h calls
// them by name.

#include <momenta/dae/integrator/integration.h>

namespace momenta {

/// Radau IIA of order 5 with step control; started as IDA is, dense LU or KLU by the system's
/// pattern, with its exact Jacobian.
IntegrationResult integrate_radau5(DaeSystem&, double t0, const std::vector<double>& output_times,
                                   const IntegrationOptions&, const Observer&);

/// Backward differentiation formulas of orders 1 to 5 on past values, started as IDA is; takes
/// gauge reset.
IntegrationResult integrate_bdf5(DaeSystem&, double t0, const std::vector<double>& output_times,
                                 const IntegrationOptions&, const Observer&);

/// Gauss collocation with steps of options.step; `stages` 2 or 3 for orders 4 and 6.
IntegrationResult integrate_gauss(int stages, OdeSystem&, double t0, const std::vector<double>& y0,
                                  const std::vector<double>& output_times,
                                  const IntegrationOptions&, const Observer&);

/// RATTLE with steps of options.step, for systems that are ConstrainedHamiltonian; any σ of y0 is
/// taken out of its p.
IntegrationResult integrate_rattle(OdeSystem&, double t0, const std::vector<double>& y0,
                                   const std::vector<double>& output_times,
                                   const IntegrationOptions&, const Observer&);

/// The energy-momentum scheme with steps of options.step, for systems that are
/// ConstrainedHamiltonian; any σ of y0 is taken out of its p. @throws std::invalid_argument where
/// anything is prescribed, too.
IntegrationResult integrate_energy_momentum(OdeSystem&, double t0, const std::vector<double>& y0,
                                            const std::vector<double>& output_times,
                                            const IntegrationOptions&, const Observer&);

/// Generalised-α with steps of options.step and its spectral radius, for systems that are
/// SecondOrder.
IntegrationResult integrate_generalised_alpha(DaeSystem&, double t0,
                                              const std::vector<double>& output_times,
                                              const IntegrationOptions&, const Observer&);

/// The augmented Lagrangian of index 3 with mass-orthogonal projections, steps of options.step, for
/// systems that are SecondOrder.
IntegrationResult integrate_bayo_ledesma(DaeSystem&, double t0,
                                         const std::vector<double>& output_times,
                                         const IntegrationOptions&, const Observer&);

/// The half-explicit method of order 5, for systems that are HalfExplicit; step control, or steps
/// of options.step.
IntegrationResult integrate_hem5(DaeSystem&, double t0, const std::vector<double>& output_times,
                                 const IntegrationOptions&, const Observer&);

/// The half-explicit method of order 8, as integrate_hem5.
IntegrationResult integrate_hem8(DaeSystem&, double t0, const std::vector<double>& output_times,
                                 const IntegrationOptions&, const Observer&);

}  // namespace momenta
