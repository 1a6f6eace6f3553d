#pragma once
// Whether numbers are finite. x · 0 is zero where x is finite and not a number where it is not, and
// a sum of zeros is zero:
//
//   Σ x_i · 0 = 0   if and only if all x_i are finite.
//
// So one comparison serves any number of lists.

#include <cstddef>
#include <vector>

namespace momenta {

/// Σ x_i · 0 of the numbers taken so far. O(n); each list in four sums, since additions to a single
/// one wait for each other.
class FiniteSum {
 public:
  void take(double x) { sum_ += x * 0.0; }
  [[gnu::always_inline]] void take(const double* x, std::size_t n) {
    double a = 0, b = 0, c = 0, d = 0;
    for (const double* const last = x + n / 4 * 4; x != last; x += 4) {
      a += x[0] * 0.0, b += x[1] * 0.0;
      c += x[2] * 0.0, d += x[3] * 0.0;
    }
    if (n & 2) a += x[0] * 0.0, b += x[1] * 0.0, x += 2;
    if (n & 1) c += x[0] * 0.0;
    sum_ += (a + b) + (c + d);
  }
  /// Whether all of them are finite.
  bool finite() const { return sum_ == 0; }

 private:
  double sum_ = 0;
};

/// Whether all of x (n) are finite.
inline bool all_finite(const double* x, std::size_t n) {
  FiniteSum sum;
  sum.take(x, n);
  return sum.finite();
}
inline bool all_finite(const std::vector<double>& x) {
  return all_finite(x.data(), x.size());
}

}  // namespace momenta
