#pragma once
// Whether numbers are finite.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace momenta {

/// Whether none of x (n) is infinite or NaN. O(n). The exponent of such a number is all ones: one
/// more carries into the sign bit. Integer sums have no latency to wait for, as floating-point ones
/// have, which for a mechanism of a few bodies would cost a tenth of its evaluation.
inline bool all_finite(const double* x, std::size_t n) {
  constexpr std::uint64_t exponent = 0x7ff0'0000'0000'0000, one = 0x0010'0000'0000'0000;
  std::uint64_t met = 0;
  for (std::size_t i = 0; i < n; ++i) met |= (std::bit_cast<std::uint64_t>(x[i]) & exponent) + one;
  return met >> 63 == 0;
}
/// Likewise.
inline bool all_finite(const std::vector<double>& x) {
  return all_finite(x.data(), x.size());
}

}  // namespace momenta
