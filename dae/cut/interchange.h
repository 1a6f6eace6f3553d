#pragma once
// Joints and loops in each other's place: which kind of loop a joint would be and the other way
// round, where its bodies stand then, and what of a scene is said of coordinates that would go.

#include <momenta/core/scene/turned_round.h>
#include <momenta/dae/cut/body_motions.h>

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace momenta {

/// The kind a loop would have as a joint and the other way round; nothing where there is none.
std::optional<JointKind> as_joint(LoopKind kind, bool planar);
/// A planar joint of a planar mechanism ties nothing: no loop.
std::optional<LoopKind> as_loop(JointKind kind, bool planar);
/// Equations of a loop of the kind a joint has.
int rows_of(JointKind kind, bool planar);

/// What the author says of coordinates of joints, by name, and of loops.
struct Sayings {
  std::set<std::string> of_coordinates;  ///< these joints stay joints
  std::set<std::string> driven_loops;
  std::set<std::string> kept;
  std::set<std::string> in_formulas;  ///< of_coordinates, those that formulas name

  /// @throws SceneError where `keep` names neither a joint nor a loop
  Sayings(const Scene& scene, const std::vector<std::string>& keep);
};

/// The joint that a loop would be; nothing where it is none or its bodies do not stand like that.
/// `length` [m]: of the scene, against which points lie apart.
std::optional<JointSpec> joint_of(const LoopSpec& loop, const Mechanism& mechanism,
                                  const BodyMotions& bodies, double length);
LoopSpec loop_of(const JointSpec& joint);

/// The joints of the scene with the q and u of the start.
std::vector<JointSpec> joints_at(const Mechanism& mechanism, const Start& start);

/// Turns a joint round, with what is said of its coordinates; false where that would mean others.
bool turn_round(JointSpec& joint, Scene& scene, const Sayings& said, const BodyMotions& bodies);

}  // namespace momenta
