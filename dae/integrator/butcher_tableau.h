#pragma once
// Coefficients of an explicit Runge-Kutta method as numbers, for sums over stages in another order
// than a step's: its adjoint. Steps have them as constants (explicit_step.h).

#include <string>
#include <vector>

namespace momenta {

/// c_i, a_ij (j < i) and b_j of k_i = f(t + c_i h, y + h Σ a_ij k_j), y + h Σ b_j k_j.
struct ButcherTableau {
  std::vector<double> c;               ///< by stage
  std::vector<std::vector<double>> a;  ///< stages × stages, zero from the diagonal on
  std::vector<double> b;               ///< by stage
  /// Whether k_1 is f at the end of the step before, also where y is corrected then.
  bool first_is_end = false;
};

/// Tableau of rk4, dp5, dop853, vern9. @throws std::invalid_argument for another name
ButcherTableau butcher_tableau(const std::string& method);

}  // namespace momenta
