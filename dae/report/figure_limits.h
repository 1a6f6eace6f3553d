#pragma once
// Limits of joints in figures, as on pages (page/solids.js): for an angle a sector between its
// bounds, from the joint towards the body's mass; for a displacement the way between them.
// Spherical joints have no mark: their limit is a cone only for some axes.

#include <momenta/dae/study/picture.h>

#include <Eigen/Geometry>
#include <array>
#include <vector>

namespace momenta {

struct LimitMark {
  std::vector<Eigen::Vector3d> outline;  ///< ground axes; its first and last two points: the bounds
  std::array<Eigen::Vector3d, 2> now;    ///< place of the joint
  bool passed = false;                   ///< beyond a bound
};

/// Limits that are drawn. `at`: poses of the bodies; `width`: of bars [m]. O(bodies)
std::vector<LimitMark> limit_marks(const Picture& picture, const std::vector<Eigen::Isometry3d>& at,
                                   double width);

}  // namespace momenta
