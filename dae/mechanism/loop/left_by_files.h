#pragma once

namespace momenta {

/// Gap of loops, in lengths of the scene or radians, where redundant equations contradict each
/// other by a file's rounding: six digits behind the point.
inline constexpr double left_by_files = 1e-6;

}  // namespace momenta
