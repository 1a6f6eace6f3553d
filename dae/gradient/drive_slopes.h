#pragma once
// Numbers of the drives of joints. A law is a function of time alone, so the equations have only
// its f and ḟ, and
//
//   Σ_t ∂/∂f(t) ∂f(t)/∂θ + ∂/∂ḟ(t) ∂ḟ(t)/∂θ
//
// is taken at each time, ∂f/∂θ and ∂ḟ/∂θ from neighbours' laws (neighbours.h), which are linear in
// θ (linear_formulas.h).

#include <momenta/dae/gradient/number_slopes.h>
#include <momenta/dae/gradient/row_derivatives.h>

namespace momenta {

/// by_parameters (others) += slopes at t [s] by θ that change laws, from those by f and ḟ among
/// `slopes`. Cost: six laws evaluated for each drive and such a θ
void add_drive_slopes(const NumberSlopes& numbers, const std::vector<OtherParameter>& others,
                      double t, const Eigen::VectorXd& slopes, Eigen::VectorXd& by_parameters);

/// Slopes by θ at t through laws of drives; columns of `slopes` are numbers.
Eigen::VectorXd by_laws(const NumberSlopes& numbers, const OtherParameter& other, double t,
                        const Eigen::MatrixXd& slopes);

}  // namespace momenta
