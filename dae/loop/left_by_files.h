#pragma once

namespace momenta {

/// How far loops may be open, in lengths of the scene or radians, where redundant equations
/// contradict each other because a file has rounded numbers: six digits behind the point.
inline constexpr double left_by_files = 1e-6;

}  // namespace momenta
