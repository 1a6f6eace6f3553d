#pragma once
// Joints and loops in each other's place: their kinds, where their bodies stand, and what a scene
// says of coordinates that would go.

#include <momenta/core/scene/reversed.h>
#include <momenta/dae/topology/cut/relative_motion.h>

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace momenta {

/// The joint of a loop's kind; nothing where there is none.
std::optional<JointKind> as_joint(LoopKind kind, bool planar);
/// The loop of a joint's kind; none for a planar joint of a planar mechanism, which ties nothing.
std::optional<LoopKind> as_loop(JointKind kind, bool planar);
/// Equations of a loop of the kind a joint has.
int rows_of(JointKind kind, bool planar);

/// Joints and loops, by name, of which the scene says something.
struct RecutRestrictions {
  std::set<std::string> of_coordinates;  ///< these joints stay joints
  std::set<std::string> driven_loops;
  std::set<std::string> kept;
  std::set<std::string> in_formulas;  ///< of_coordinates, those that formulas name

  /// @throws SceneError where `keep` names neither a joint nor a loop
  RecutRestrictions(const Scene& scene, const std::vector<std::string>& keep);
};

/// The joint that a loop would be; nothing where there is none or its bodies do not stand so.
/// `length` of the scene [m]: scale of distances between points.
std::optional<JointSpec> joint_of(const LoopSpec& loop, const Mechanism& mechanism,
                                  const BodyMotions& bodies, double length);
LoopSpec loop_of(const JointSpec& joint);

/// The joints of the scene with the q and u of the start.
std::vector<JointSpec> joints_at(const Mechanism& mechanism, const Start& start);

/// Turns a joint round, with all that names its coordinates; false where these would mean others.
bool turn_round(JointSpec& joint, Scene& scene, const RecutRestrictions& said,
                const BodyMotions& bodies);

}  // namespace momenta
