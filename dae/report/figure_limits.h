#pragma once
// Limits of joints as a figure shows them, and pages do (page/solids.js): of an angle a sector
// between its bounds, from the joint outwards towards the body's mass; of a displacement the way
// between them. Of a spherical joint, whose limit is a cone only for some axes, nothing.

#include <momenta/dae/study/picture.h>

#include <Eigen/Geometry>
#include <array>
#include <vector>

namespace momenta {

struct LimitMark {
  std::vector<Eigen::Vector3d> outline;  ///< ground axes; its first and last two points: the bounds
  std::array<Eigen::Vector3d, 2> now;    ///< where the joint stands
  bool passed = false;                   ///< beyond a bound
};

/// Of all joints with limits that are drawn. `at`: poses of the bodies; `width`: of bars [m].
/// O(bodies)
std::vector<LimitMark> limit_marks(const Picture& picture, const std::vector<Eigen::Isometry3d>& at,
                                   double width);

}  // namespace momenta
