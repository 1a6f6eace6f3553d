#pragma once
// Steps of Radau IIA from the last one's start to a time inside it: what a sample is, of full order
// and on all constraints. Matrices of their own, so that looking changes nothing.

#include <momenta/dae/solver/radau5_stages.h>

#include <limits>

namespace momenta::radau5 {

class Look {
 public:
  explicit Look(DaeSystem& system) : stages_(system), factors_(system.size(), system.pattern()) {}

  /// y and y' at t + h from (y0, y0') at t, with z a guess of the stages; `rate_scale` as in
  /// Stages::differentiate(). False where it does not converge.
  bool operator()(double t, double h, double rate_scale, const double* y0, const double* ydot0,
                  const WeightedNorm& norm, double fraction, StageValues& z, double* y,
                  double* ydot) {
    if (differentiated_ != t && !stages_.differentiate(t, y0, ydot0, rate_scale)) return false;
    differentiated_ = t;
    stages_.contraction = 1;
    const bool solved = stages_.factor(factors_, h) &&
                        stages_.solve(factors_, t, h, y0, norm, fraction, patient_iterations, z) ==
                            Outcome::converged;
    for (std::size_t k = 0; k < z[2].size(); ++k) y[k] = y0[k] + z[2][k];
    stages_.rate(2, h, z, ydot);
    return solved;
  }

 private:
  Stages stages_;
  Factors factors_;
  double differentiated_ = std::numeric_limits<double>::quiet_NaN();  ///< at this t [s]
};

}  // namespace momenta::radau5
