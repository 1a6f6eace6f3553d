#pragma once
// A rotation as turns about given lines through one point, all of length one.
//
// Two turns that take v to v', R(a, α) R(b, β) v = v' (R. M. Murray, Z. Li, S. S. Sastry, A
// Mathematical Introduction to Robotic Manipulation, 1994, subproblem 2). Let w = R(b, β) v = x a +
// y b + z a × b; turning about b keeps w·b = v·b, turning about a keeps w·a = v'·a:
//
//   c = a·b,   x = (v'·a − c v·b)/(1 − c²),   y = (v·b − c v'·a)/(1 − c²),
//   z² |a × b|² = v² − x² − y² − 2 c x y
//
// z and −z are two solutions; z² < 0 has none. Three turns R(a, α) R(b, β) R(c, γ) = Q are two that
// take c to Q c, and the rest about c. Of the two solutions the one with smaller angles, Σ |α|, is
// taken.

#include <Eigen/Geometry>
#include <optional>
#include <vector>

namespace momenta {

/// The turns about two lines, in order; none without a solution.
/// @pre |v| = |v'|, a and b not parallel
std::optional<std::vector<Eigen::Quaterniond>> turns_that_take(const Eigen::Vector3d& a,
                                                               const Eigen::Vector3d& b,
                                                               const Eigen::Vector3d& v,
                                                               const Eigen::Vector3d& to);

/// The turns about three lines. @pre neither a and b nor b and c parallel
std::optional<std::vector<Eigen::Quaterniond>> turns_that_make(const Eigen::Vector3d& a,
                                                               const Eigen::Vector3d& b,
                                                               const Eigen::Vector3d& c,
                                                               const Eigen::Quaterniond& q);

/// Displacement of a turn about a centre.
inline Eigen::Isometry3d turned_about(const Eigen::Vector3d& centre,
                                      const Eigen::Quaterniond& turn) {
  Eigen::Isometry3d d = Eigen::Isometry3d::Identity();
  d.translate(centre);
  d.rotate(turn);
  d.translate(-centre);
  return d;
}

}  // namespace momenta
