#pragma once
// The next step of Radau IIA by Gustafsson's prediction:
//
//   h_new = h min(s err^(−1/4), s h/h_old (err_old/err²)^(1/4)),   1/8 ≤ h_new/h ≤ 8,
//
// s = 0.9, less where Newton's method took many iterations; kept where it would grow by less than a
// fifth, with its factors. Source: Hairer, Wanner, Solving Ordinary Differential Equations II,
// IV.8.

#include <algorithm>
#include <cmath>

namespace momenta::radau5 {

class Prediction {
 public:
  static constexpr int most_iterations = 7;  ///< Newton iterations

  /// h over the next step, by this step's error alone.
  static double divisor(double error, int iterations) {
    const double caution =
        std::min(safety, safety * (1 + 2 * most_iterations) / (iterations + 2 * most_iterations));
    return std::clamp(std::pow(std::max(error, 1e-20), 0.25) / caution, 1 / grow, 1 / shrink);
  }
  /// The next step over h, after an accepted one; `first`: of the run, `rejected`: before.
  double factor(double h, double error, double divisor, bool first, bool rejected) {
    if (!first) {
      const double predicted = before_ / h * std::pow(error * error / error_before_, 0.25) / safety;
      divisor = std::max(divisor, std::clamp(predicted, 1 / grow, 1 / shrink));
    }
    before_ = h;
    error_before_ = std::max(1e-2, error);
    return rejected ? std::min(1 / divisor, 1.0) : 1 / divisor;
  }
  /// Whether the step is kept rather than changed by this factor.
  static bool keeps(double factor) { return factor >= 1 && factor <= 1.2; }

 private:
  static constexpr double safety = 0.9, shrink = 0.125, grow = 8;
  double before_ = 0, error_before_ = 1;
};

}  // namespace momenta::radau5
