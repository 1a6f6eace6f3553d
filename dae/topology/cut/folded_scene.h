#pragma once
// A scene with fewer bodies that moves alike: bodies without coordinates of their own are part of
// others (fold_welds.h), rotors are numbers on joints (fold_rotors.h). What was folded has its
// motion from what is left, so that all that is said of it can still be reported.

#include <momenta/core/scene/scene.h>

#include <string>
#include <vector>

namespace momenta {

/// A body that another one carries rigidly.
struct CarriedBody {
  std::string body;        ///< the carried one
  std::string carrier;     ///< a body of the folded scene, "ground", or a rotor of `following`
  Eigen::Isometry3d pose;  ///< the body's frame in the carrier's
};

/// A revolute joint whose angle follows from a coordinate of another: q = ratio q' + offset.
struct FollowingJoint {
  std::string joint;    ///< name
  std::string body;     ///< the rotor it carried
  std::string leader;   ///< a joint of the folded scene
  int coordinate = 0;   ///< coordinate of the leader
  double ratio = 0;     ///< [1, or rad/m]
  double offset = 0;    ///< [rad]
  double inertia = 0;   ///< the body's part of the leader's rotor_inertia [kg m² or kg]
  bool slides = false;  ///< the leader's coordinate is a displacement
};

/// A scene without the bodies and joints that cost an integration for nothing.
struct FoldedScene {
  Scene scene;                            ///< without them
  std::vector<CarriedBody> carried;       ///< in the order of the given scene
  std::vector<FollowingJoint> following;  ///< likewise
  /// Whether anything was folded.
  bool folds() const { return !carried.empty() || !following.empty(); }
};

/// "welded into 'B': 'C', 'D'; rotor 'R' taken as 0.02 kg m² at joint 'O'"; empty: nothing folded.
std::string in_words(const FoldedScene& folded);

}  // namespace momenta
