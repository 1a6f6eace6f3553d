#pragma once
// How a drift grows: the exponent of its running maximum.

#include <momenta/dae/study/run_result.h>

#include <vector>

namespace momenta {

/// Fits running_max(t) ~ t^exponent over the last factor 20 in t, on logarithmically spaced times,
/// by least squares. The half-range is half the spread of the slopes of the two halves of that
/// range and of the whole. What has not risen above `rounding` has no law: the fit begins where the
/// maximum leaves it. All NaN when there are too few samples, or the maximum is above it for less
/// than the last factor 4. `t` ascending [s], `drift` ≥ 0, `rounding` of its unit > 0.
Growth fit_growth(const std::vector<double>& t, const std::vector<double>& drift, double rounding);

}  // namespace momenta
