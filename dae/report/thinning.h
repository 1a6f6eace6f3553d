#pragma once
// Fewer points for a curve on logarithmic axes, without losing what the eye looks for in it.

#include <cstddef>
#include <vector>

namespace momenta {

/// Indices (ascending, at most `limit` ≥ 8) of the points to draw of y over t on a logarithmic t
/// axis: only t > 0 and finite y; every point while they are few; else of each of equal stretches
/// of log t the first, the smallest and the largest |y|, and the very last point.
std::vector<std::size_t> thinned(const std::vector<double>& t, const std::vector<double>& y,
                                 std::size_t limit);

}  // namespace momenta
