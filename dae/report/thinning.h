#pragma once
// Fewer points for a curve, with visible features kept.

#include <cstddef>
#include <vector>

namespace momenta {

/// Indices (ascending, at most `limit` ≥ 8) of the points to draw of y over t on a logarithmic t
/// axis: only t > 0 and finite y; all points if few; else of each of equal stretches of log t the
/// first, the smallest and the largest |y|, and the very last point. Not logarithmic: any t, equal
/// stretches of t, smallest and largest y.
std::vector<std::size_t> thinned(const std::vector<double>& t, const std::vector<double>& y,
                                 std::size_t limit, bool logarithmic = true);

}  // namespace momenta
