#pragma once
// The space of poses in which assemblies are told apart: angles, which come back by full turns
// where the loops allow it, lengths, and quaternions up to their sign.

#include <momenta/dae/assembly/scaled_loops.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace momenta {

class PoseSpace {
 public:
  /// About a pose `own` (nq) that closes the loops at time t [s], which are evaluated here alone.
  PoseSpace(const Mechanism& mechanism, double t, const Eigen::VectorXd& own, ScaledLoops& loops);
  /// Number `i` of poses drawn at random: angles over a full turn, or two of those that a full turn
  /// does not bring back, lengths within 1.5 lengths of the scene about the own pose, quaternions
  /// evenly over all rotations; as in the own pose what is `held` (nq).
  Eigen::VectorXd start(std::uint64_t seed, std::size_t i, const std::vector<bool>& held) const;
  /// The same pose with angles within half a turn of the own ones, quaternions on their side.
  Eigen::VectorXd nearest(Eigen::VectorXd q) const;
  /// By the coordinate that differs most [rad or lengths of the scene].
  double apart(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const;

 private:
  enum class Place { angle, length, quaternion };

  Eigen::VectorXd own_;
  std::vector<Place> places_;  ///< of each coordinate
  std::vector<bool> turns_;    ///< whether a full turn brings it back
  Eigen::VectorXd lengths_;    ///< what it is counted in: 1 rad, or the scene's length [m]
  std::vector<int> quaternions_;
};

}  // namespace momenta
