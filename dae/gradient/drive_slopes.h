#pragma once
// Numbers of the drives of joints. A law is a function of time alone, so that of it stand f and ḟ
// in the equations, and
//
//   Σ_t ∂/∂f(t) ∂f(t)/∂θ + ∂/∂ḟ(t) ∂ḟ(t)/∂θ
//
// is taken at each time by itself, ∂f/∂θ and ∂ḟ/∂θ from the laws of neighbours (neighbours.h),
// which are linear in θ (linear_formulas.h).

#include <momenta/dae/gradient/number_slopes.h>
#include <momenta/dae/gradient/row_derivatives.h>

namespace momenta {

/// by_parameters (others) += what the derivatives by f and ḟ among `slopes` make at t [s] of θ that
/// change laws. Cost: six laws evaluated for each drive and such a θ
void add_drive_slopes(const NumberSlopes& numbers, const std::vector<OtherParameter>& others,
                      double t, const Eigen::VectorXd& slopes, Eigen::VectorXd& by_parameters);

/// Columns of `slopes` are numbers: their derivatives by θ at t through the laws of drives.
Eigen::VectorXd by_laws(const NumberSlopes& numbers, const OtherParameter& other, double t,
                        const Eigen::MatrixXd& slopes);

}  // namespace momenta
