#pragma once
// A platform on six rods. Of the pieces of a mechanism (pieces.h) two stand out: the base, of which
// the ground is, and the platform, which most ties meet. Rods between them are
//
//   loops of kind distance
//   legs, pieces with two ties, one to either: both balls, or one a ball and one universal
//
// The centres of the ties of a leg keep their distance, and that is all that a leg asks of the
// platform over the complex numbers: a slide in it that is held or driven makes it longer or
// shorter, wherever its axis lies.
//
// The pose of a leg follows from that of the platform. Let v be the way from its universal centre
// to its ball in the own pose, v' the same in another pose seen from the piece that the universal
// joint stands on, a the universal's axis in that piece and b the one in the leg, both in the own
// pose. It is turned by Q = R(a, α) R(b, β) with Q v = v'. Let w = R(b, β) v = x a + y b + z a × b;
// turning about b keeps w·b = v·b, turning about a keeps w·a = v'·a:
//
//   c = a·b,   x = (v'·a − c v·b)/(1 − c²),   y = (v·b − c v'·a)/(1 − c²),
//   z² |a × b|² = v² − x² − y² − 2 c x y
//
// (R. M. Murray, Z. Li, S. S. Sastry, A Mathematical Introduction to Robotic Manipulation, 1994,
// subproblem 2). z and −z are two poses of the leg at one of the platform; where z² < 0 there is
// none. Of the two the one that is turned less from the own pose is taken: assemblies are counted
// by poses of the platform. A leg between two balls is turned by the shortest way, without spin.

#include <momenta/dae/kinematics/pieces.h>

#include <Eigen/Geometry>
#include <optional>
#include <vector>

namespace momenta {

struct PlatformRod {
  Eigen::Vector3d on_base, on_platform;  ///< its ends in the own pose, ground axes [m]
  int leg = -1;                          ///< the piece; −1: a loop
  struct Universal {
    bool on_platform;      ///< else on the base
    Eigen::Vector3d a, b;  ///< the axis that stands there and that of the leg, own pose
  };
  std::optional<Universal> universal;  ///< none between two balls

  /// The displacement of a leg from its own pose, where there is one, with the platform displaced
  /// so.
  std::optional<Eigen::Isometry3d> displaced(const Eigen::Isometry3d& platform) const;
};

struct PlatformLegs {
  Pieces pieces;
  int platform = -1;              ///< the piece
  std::vector<PlatformRod> rods;  ///< six
};

/// Of the mechanism at time t [s] with some coordinates held (by rate, nv), in the pose `poses` of
/// its bodies (poses_of_polynomials).
/// @throws SceneError naming the joint, loop or body that makes it another mechanism
PlatformLegs platform_legs(const Mechanism& mechanism, double t,
                           const std::vector<Eigen::Isometry3d>& poses,
                           const std::vector<bool>& held);

}  // namespace momenta
