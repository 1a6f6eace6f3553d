#pragma once
// Whether numbers are numbers.

#include <cstddef>
#include <vector>

namespace momenta {

/// Whether none of x (n) is infinite or not a number. O(n), in four sums: a single one waits for
/// itself at every addition.
inline bool all_finite(const double* x, std::size_t n) {
  double sums[4] = {};
  std::size_t i = 0;
  for (; i + 4 <= n; i += 4)
    for (std::size_t j = 0; j < 4; ++j) sums[j] += x[i + j] * 0.0;
  for (; i < n; ++i) sums[0] += x[i] * 0.0;
  return sums[0] + sums[1] + sums[2] + sums[3] == 0;
}
inline bool all_finite(const std::vector<double>& x) {
  return all_finite(x.data(), x.size());
}

}  // namespace momenta
