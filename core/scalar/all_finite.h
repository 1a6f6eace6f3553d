#pragma once
// Whether numbers are finite. x · 0 is zero where x is finite and not a number where it is not, and
// a sum of zeros is zero:
//
//   Σ x_i · 0 = 0   if and only if all x_i are finite.
//
// So there is one comparison for any number of lists.

#include <cstddef>
#include <vector>

namespace momenta {

/// Σ x_i · 0 of the numbers taken so far. O(n), in four sums: a single one waits for itself at
/// every addition.
class FiniteSum {
 public:
  void take(double x) { sums_[3] += x * 0.0; }
  void take(const double* x, std::size_t n) {
    std::size_t i = 0;
    for (; i + 4 <= n; i += 4)
      for (std::size_t j = 0; j < 4; ++j) sums_[j] += x[i + j] * 0.0;
    if (n & 2) {
      sums_[0] += x[i] * 0.0;
      sums_[1] += x[i + 1] * 0.0;
      i += 2;
    }
    if (n & 1) sums_[2] += x[i] * 0.0;
  }
  /// Whether none of them is infinite or not a number.
  bool finite() const { return sums_[0] + sums_[1] + (sums_[2] + sums_[3]) == 0; }

 private:
  double sums_[4] = {};
};

/// Whether none of x (n) is infinite or not a number.
inline bool all_finite(const double* x, std::size_t n) {
  FiniteSum sum;
  sum.take(x, n);
  return sum.finite();
}
inline bool all_finite(const std::vector<double>& x) {
  return all_finite(x.data(), x.size());
}

}  // namespace momenta
