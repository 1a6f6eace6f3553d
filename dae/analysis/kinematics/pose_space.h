#pragma once
// The space of poses in which assemblies differ: angles, modulo full turns where the loops allow
// these, lengths, and quaternions up to their sign.

#include <momenta/dae/topology/assembly/scaled_loops.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace momenta {

class PoseSpace {
 public:
  /// Space about a pose `own` (nq) that closes the loops at time t [s]; `loops` serve it alone.
  PoseSpace(const Mechanism& mechanism, double t, const Eigen::VectorXd& own, ScaledLoops& loops);
  /// Random pose number `i`: angles over a full turn, or over two where a turn changes the pose,
  /// lengths within 1.5 lengths of the scene about the own pose, quaternions evenly over all
  /// rotations; `held` (nq) coordinates as in the own pose.
  Eigen::VectorXd start(std::uint64_t seed, std::size_t i, const std::vector<bool>& held) const;
  /// The same pose with angles within half a turn of the own pose, quaternions on its side.
  Eigen::VectorXd nearest(Eigen::VectorXd q) const;
  /// Largest difference of a coordinate [rad or lengths of the scene].
  double apart(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const;

 private:
  enum class Place { angle, length, quaternion };

  Eigen::VectorXd own_;
  std::vector<Place> places_;  ///< by coordinate
  std::vector<bool> turns_;    ///< by coordinate: a full turn keeps the pose
  Eigen::VectorXd lengths_;    ///< units of coordinates: 1 rad, or the scene's length [m]
  std::vector<int> quaternions_;
};

}  // namespace momenta
