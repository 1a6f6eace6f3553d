#pragma once
// Poses and velocities of the bodies of a mechanism, by their names, from its q and u.

#include <momenta/core/poses.h>
#include <momenta/dae/form/form.h>

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

}  // namespace momenta
