#pragma once
// Distributions of one number, by their quantile functions: u in (0, 1) to the value x that is
// exceeded with probability 1 - u.
//
//     uniform       x = a + (b - a) u
//     log uniform   x = a (b / a)^u            evenly in the logarithm, a and b above zero
//     normal        x = a + b Φ⁻¹(u)           mean a, standard deviation b
//     choice        x = values[⌊n u⌋]          each of n values as likely as the others

#include <string>
#include <vector>

namespace momenta {

/// Φ⁻¹(u) of the standard normal distribution, to 4 units in the last place or 1e-16.
/// @pre 0 < u < 1
double normal_quantile(double u);

struct Distribution {
  enum class Kind { uniform, log_uniform, normal, choice };

  Kind kind = Kind::choice;
  double a = 0, b = 0;
  std::vector<double> values;  ///< choice only

  /// @pre 0 < u < 1
  double quantile(double u) const;
  /// "uniform", "log uniform", "normal", "choice"
  const char* name() const;
  /// "normal, mean 0.6, deviation 0.01", "uniform, 0.5 to 0.7", "choice of 4 values"
  std::string words() const;
};

}  // namespace momenta
