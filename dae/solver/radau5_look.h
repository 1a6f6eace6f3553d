#pragma once
// Samples of Radau IIA: steps to a time inside the last one, of full order and on all constraints.
// Matrices of their own, so that looking changes nothing.

#include <momenta/dae/solver/radau5_whole_stages.h>

#include <limits>
#include <memory>

namespace momenta::radau5 {

class Look {
 public:
  /// `whole`: steps by WholeStages.
  Look(DaeSystem& system, bool whole) : stages_(system), factors_(system.size(), system.pattern()) {
    if (whole) whole_ = std::make_unique<WholeStages>(system);
  }

  /// y and y' at t + h from (y0, y0') at t, with z a guess of the stages; `rate_scale` as in
  /// Stages::differentiate(). False where it does not converge.
  bool operator()(double t, double h, double rate_scale, const double* y0, const double* ydot0,
                  const WeightedNorm& norm, double fraction, StageValues& z, double* y,
                  double* ydot) {
    Outcome outcome = Outcome::diverged;
    if (whole_) {
      outcome = whole_->solve(t, h, rate_scale, y0, norm, fraction, z);
    } else {
      if (differentiated_ != t && !stages_.differentiate(t, y0, ydot0, rate_scale)) return false;
      differentiated_ = t;
      stages_.contraction = 1;
      if (stages_.factor(factors_, h))
        outcome = stages_.solve(factors_, t, h, y0, norm, fraction, patient_iterations, z);
    }
    for (std::size_t k = 0; k < z[2].size(); ++k) y[k] = y0[k] + z[2][k];
    stages_.rate(2, h, z, ydot);
    return outcome == Outcome::converged;
  }

 private:
  Stages stages_;
  Factors factors_;
  std::unique_ptr<WholeStages> whole_;  ///< null: simplified iterations
  double differentiated_ = std::numeric_limits<double>::quiet_NaN();  ///< at this t [s]
};

}  // namespace momenta::radau5
