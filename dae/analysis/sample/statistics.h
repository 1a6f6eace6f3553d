#pragma once
// Summary statistics of one quantity over a sample.

#include <array>
#include <cstddef>
#include <vector>

namespace momenta {

inline constexpr std::array<double, 5> told_quantiles{0.05, 0.25, 0.5, 0.75, 0.95};

struct Summary {
  std::size_t count = 0;   ///< finite values; if none, all below is NaN
  double mean, deviation;  ///< deviation: with n - 1, NaN for one value
  double least, greatest;
  std::array<double, told_quantiles.size()> quantiles;
};

/// Values that are not finite are left out. Cost: a sort.
Summary summary_of(std::vector<double> values);

/// x_(⌊h⌋) + (h - ⌊h⌋) (x_(⌊h⌋+1) - x_(⌊h⌋)), h = (n - 1) p, of sorted x_0 … x_(n-1): definition 7
/// of R. Hyndman, Y. Fan, Amer. Statist. 50 (1996), 361-365. @pre not empty, 0 <= p <= 1
double quantile_of(const std::vector<double>& sorted, double p);

}  // namespace momenta
