#pragma once
// The next step from the local error, PI control:
//
//   h_new = h · safety · err_n^-α · err_{n-1}^β,   shrink ≤ h_new / h ≤ grow,
//
// with err the local error over its tolerance and α = 1/k - (a fraction of β), k the order of the
// error's leading term. The integral part alone (β = 0) oscillates when stability bounds the step.
// After a rejection the step does not grow at once. One log and one exp a step.
//
// Source: Gustafsson, ACM TOMS 17 (1991) 533-554; Hairer, Wanner, Solving Ordinary Differential
// Equations II, IV.2; the bounds and the treatment of rejections: I, II.4.

#include <momenta/dae/solver/memory.h>

#include <algorithm>
#include <cmath>

namespace momenta::explicit_rk {

template <class Tableau>
class StepControl {
 public:
  /// Factor for the step after an accepted one with this squared error.
  double accepted(double error_squared) {
    // No error counts as 1e-60: the bound `grow` holds anyway.
    const double log_error = 0.5 * std::log(std::max(error_squared, 1e-60));
    double factor =
        Tableau::safety * std::exp(Tableau::beta * log_old_error_ - Tableau::exponent * log_error);
    factor = std::clamp(factor, Tableau::shrink, Tableau::grow);
    if (rejected_) factor = std::min(factor, 1.0);
    rejected_ = false;
    // Not below 1e-4: one lucky step must not make the next one timid.
    if constexpr (Tableau::beta != 0) log_old_error_ = std::max(log_error, log_smallest_error);
    return factor;
  }

  /// Factor for a repeated step that missed its tolerance.
  double rejected(double error_squared) {
    rejected_ = true;
    const double log_error = 0.5 * std::log(error_squared);
    return std::max(Tableau::shrink, Tableau::safety * std::exp(-Tableau::exponent * log_error));
  }

  /// Factor for a repeated step in which a stage failed: its error says nothing.
  double failed() {
    rejected_ = true;
    return 0.25;
  }

  void carry(Memory& memory) { memory(log_old_error_), memory(rejected_); }

 private:
  static constexpr double log_smallest_error = -9.210340371976182;  ///< ln 1e-4
  double log_old_error_ = log_smallest_error;
  bool rejected_ = false;
};

}  // namespace momenta::explicit_rk
