#pragma once
// The norm of BDF's error estimates e on equations of index 2. With z of index 2 found through
// x' = f(x) + B z, 0 = g(x), each change of step or order changes the error of z, and e has h B Δz
// in it, which no x has: x is on g = 0. It is of order h whatever the order of the formula, so that
// neither steps nor orders would grow. What an implicit Euler step would leave of e is without it,
//
//   J(c)⁻¹ c ∂F/∂y' e,      J(c) = ∂F/∂y + c ∂F/∂y',
//
// and is what is tested, of a variable of weight power k h^k times. It has nothing of an x that
// g(x, t) = 0 prescribes, however fast: of such the estimate itself is tested, which z has no part
// in, and of others a small part of it (DaeSystem::unfiltered_part), in which changes of z are
// lost. Source: Brenan, Campbell, Petzold, Numerical Solution of Initial-Value Problems in
// Differential-Algebraic Equations, ch. 5.

#include <momenta/dae/integrator/newton_matrix.h>

#include <memory>
#include <vector>

namespace momenta {

class FilteredError {
 public:
  explicit FilteredError(DaeSystem& system);

  /// Takes J and ∂F/∂y' at (t, y, y'). False: they have no value, or J is singular.
  bool at(double t, const double* y, const double* ydot, double c);
  /// Root mean square, over all variables, of weighted errors of the tested ones, filtered after
  /// at(); `h`: of the step.
  double norm(const double* e, const double* weights, double h);

 private:
  DaeSystem& system_;
  std::size_t n_;
  std::unique_ptr<NewtonMatrix<double>> matrix_;
  std::vector<double> by_y_, by_rate_, filtered_;
  double c_ = 0;
};

}  // namespace momenta
