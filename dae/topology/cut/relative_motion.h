#pragma once
// Poses and velocities of the bodies of a mechanism, by their names, from its q and u.

#include <momenta/core/open_chain/poses.h>
#include <momenta/core/scene/reversed.h>
#include <momenta/core/scene/scene.h>
#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/mechanism/start.h>

#include <set>
#include <string>
#include <unordered_map>
#include <vector>

namespace momenta {

/// Owns its workspace; one object serves one thread. The mechanism need not outlive it.
class BodyMotions {
 public:
  explicit BodyMotions(const Mechanism& mechanism) : BodyMotions(mechanism, nullptr) {}
  /// Takes the state of `start`.
  BodyMotions(const Mechanism& mechanism, const Start& start) : BodyMotions(mechanism) {
    take(start.t, start.q, start.u);
  }
  /// Motions of the `wanted` bodies alone; "ground" may be among them.
  BodyMotions(const Mechanism& mechanism, const std::set<std::string>& wanted)
      : BodyMotions(mechanism, &wanted) {}

  /// Takes the state at time t [s]: q (nq), u (nv). O(bodies)
  void take(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u);
  /// @pre a state was taken, and the body is wanted
  const BodyMotion& of(const std::string& body) const { return motion_.at(body); }

 private:
  struct Wanted {
    BodyMotion* motion;
    int body;  ///< in the tree
  };
  BodyMotions(const Mechanism& mechanism, const std::set<std::string>* wanted);

  Poses poses_;
  std::unordered_map<std::string, BodyMotion> motion_;
  std::vector<Wanted> wanted_;
};

// Coordinates and rates of a joint from the motion of the two bodies it joins.

struct JointMotion {
  std::vector<double> q, u;    ///< as JointSpec has them
  double shift = 0, tilt = 0;  ///< part of the pose that q does not give: [m], sine of an angle
};

/// @pre Not a user joint; a helical one as a hinge alone.
JointMotion joint_motion(const JointSpec& joint, const BodyMotion& parent, const BodyMotion& child);

}  // namespace momenta
