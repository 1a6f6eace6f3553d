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

#include <momenta/dae/integrator/memory.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

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

// The first step of a method of order p, chosen from f and an estimate of its rate of change:
//
//   h_0 = 0.01 ‖y‖/‖f‖,  d_2 = ‖f(t + h_0, y + h_0 f) - f(t, y)‖/h_0,
//   h = min(100 h_0, T (0.01/max(T ‖f‖, T² d_2))^(1/p)),
//
// T the time scale of the system, 1 s in the source; norms RMS over the tolerances: the step
// changes y by about a hundredth of its size, and its local error is about a hundredth of the
// tolerance to the power of what p makes of it. Source: Hairer, Norsett, Wanner, Solving Ordinary
// Differential Equations I, II.4 (hinit).

/// RMS of x over the tolerances at y; size n.
inline double weighted_norm(const double* x, const double* y, const double* atol, double rtol,
                            std::size_t n) {
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double e = x[i] / (atol[i] + rtol * std::abs(y[i]));
    sum += e * e;
  }
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(n, 1)));
}

/// First step in (0, longest]. `f0` is f(t, y); `scale`: the system's time scale. `evaluate(t, y,
/// ydot)` may fail, the trial step is then shortened. `trial` and `rate` are workspace of size n.
template <class Evaluate>
double first_step(int order, double scale, double t, const double* y, const double* f0,
                  const double* atol, double rtol, std::size_t n, double longest, double* trial,
                  double* rate, Evaluate evaluate) {
  const double size = weighted_norm(y, y, atol, rtol, n);
  const double slope = weighted_norm(f0, y, atol, rtol, n);
  // At rest at the origin there is no scale in y and f: take a small part of the interval.
  double h = size > 1e-5 && scale * slope > 1e-5 ? 0.01 * size / slope : 1e-6 * longest;
  h = std::min(h, longest);

  double bend = NAN;
  for (int attempt = 0; attempt < 20 && !std::isfinite(bend); ++attempt, h *= 0.1) {
    for (std::size_t i = 0; i < n; ++i) trial[i] = y[i] + h * f0[i];
    if (!evaluate(t + h, trial, rate)) continue;
    for (std::size_t i = 0; i < n; ++i) rate[i] -= f0[i];
    bend = weighted_norm(rate, y, atol, rtol, n) / h;
    if (std::isfinite(bend)) break;
  }
  const double largest = std::max(scale * slope, scale * scale * bend);
  const double by_error = largest > 1e-15 ? scale * std::pow(0.01 / largest, 1.0 / order)
                                          : std::max(1e-6 * longest, h * 1e-3);
  const double first = std::min({100 * h, by_error, longest});
  // Tolerances so small that sizes over them overflow: control soon shortens any step.
  return first > 0 && std::isfinite(first) ? first : 1e-6 * longest;
}

}  // namespace momenta::explicit_rk
