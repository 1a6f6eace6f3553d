#pragma once
// Steps of Radau IIA from the last one's start to a time inside it: what a sample is, of full order
// and on all constraints. Matrices of their own, so that looking changes nothing.

#include <momenta/dae/solver/radau5_whole_stages.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

namespace momenta::radau5 {

/// Powers of the step by which errors of variables are worse than those of index 1. Multipliers
/// that no norm sees have one more than what it sees.
inline std::vector<int> powers_of(const DaeSystem& system) {
  std::vector<int> power;
  for (int k = 0; k < system.size(); ++k) power.push_back(system.weight(k).power);
  const int most = power.empty() ? 0 : std::max(0, *std::max_element(power.begin(), power.end()));
  for (int& p : power)
    if (p < 0) p = most + 1;
  return power;
}

/// Whether a step to this part of the last one is worse than the cubic, which is of the order that
/// variables of higher index have anyway: what the start misses of constraints is divided by the
/// step's length. Of index 2 that is what Newton's method leaves, of index 3 the error of
/// velocities.
inline bool cubic_is_better(int power, double part) {
  constexpr double enlarges_newton = 1e-2, enlarges_error = 0.5;
  return power > 0 && part < (power == 1 ? enlarges_newton : enlarges_error);
}

class Look {
 public:
  explicit Look(DaeSystem& system)
      : system_(system), stages_(system), factors_(system.size(), system.pattern()) {}

  /// y and y' at t + h from (y0, y0') at t, with z a guess of the stages; `rate_scale` as in
  /// Stages::differentiate(); `whole`: by WholeStages where the simplified iteration does not
  /// converge. False where none does.
  bool operator()(double t, double h, double rate_scale, const double* y0, const double* ydot0,
                  const WeightedNorm& norm, double fraction, bool whole, StageValues& z, double* y,
                  double* ydot) {
    if (differentiated_ != t && !stages_.differentiate(t, y0, ydot0, rate_scale)) return false;
    differentiated_ = t;
    stages_.contraction = 1;
    if (whole) guess_ = z;
    bool solved = stages_.factor(factors_, h) &&
                  stages_.solve(factors_, t, h, y0, norm, fraction, patient_iterations, z) ==
                      Outcome::converged;
    if (!solved && whole) {
      if (!whole_) whole_ = std::make_unique<WholeStages>(system_);
      z = guess_;
      solved = whole_->solve(t, h, rate_scale, y0, norm, fraction, z) == Outcome::converged;
    }
    for (std::size_t k = 0; k < z[2].size(); ++k) y[k] = y0[k] + z[2][k];
    stages_.rate(2, h, z, ydot);
    return solved;
  }

 private:
  DaeSystem& system_;
  Stages stages_;
  Factors factors_;
  std::unique_ptr<WholeStages> whole_;  ///< null until asked for
  StageValues guess_;
  double differentiated_ = std::numeric_limits<double>::quiet_NaN();  ///< at this t [s]
};

}  // namespace momenta::radau5
