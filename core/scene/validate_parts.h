#pragma once
// Checks of validate() that look at the whole scene: names, tree, and ties of drives and couplers
// to joints and loops.

#include <momenta/core/scene/scene.h>

#include <cmath>
#include <map>
#include <string>
#include <string_view>

namespace momenta::reading {

/// What a check is about: its place in the scene, and the words that open its sentences.
struct Subject {
  const Scene& scene;
  Location at;
  std::string who;

  /// Throws SceneError "<place><who>: <sentence>" unless `condition` holds.
  void require(bool condition, std::string_view sentence) const {
    if (!condition) fail(std::string(sentence));
  }
  [[noreturn]] void fail(const std::string& sentence) const {
    throw SceneError(scene.where(at) + who + ": " + sentence);
  }
};

/// All names of a scene. Construction checks them: none empty, none twice among bodies, joints with
/// loops, markers, functions, named forces, named events; no control characters; no body "ground".
class Census {
 public:
  explicit Census(const Scene& scene);

  /// Requires a body, or "ground" where allowed; else SceneError "<place><who>: <key> is ...".
  void require_body(const std::string& name, bool or_ground, const Subject& who,
                    const std::string& key) const;

  /// Requires a joint of the tree.
  const JointSpec& require_joint(const std::string& name, const Subject& who) const;

  /// Requires a loop.
  const LoopSpec& require_loop(const std::string& name, const Subject& who) const;

  /// Requires a joint of one coordinate: revolute, prismatic or helical.
  void require_one_coordinate(const std::string& name, const Subject& who) const;

 private:
  const Scene& scene_;
  std::map<std::string, const BodySpec*, std::less<>> bodies_;
  std::map<std::string, const JointSpec*, std::less<>> joints_;
  std::map<std::string, const LoopSpec*, std::less<>> loops_;
};

/// The drive of a coordinate of a joint or loop, not of a loop's origin; or null. O(drives)
const DriveSpec* drive_of(const Scene& scene, std::string DriveSpec::*owner,
                          const std::string& name, int coordinate);

/// Checks joints known, as many coordinates and ratios, none a part of a quaternion, none twice.
/// Returns whether all are driven.
bool check_coordinates(const Scene& scene, const Census& census, const LoopSpec& coupler,
                       const Subject& who);
bool check_coordinates(const Scene& scene, const Census& census, const ForceSpec& spring,
                       const Subject& who);

/// check_coordinates(); numbers finite, not all driven.
void check_coupler(const Scene& scene, const Census& census, const LoopSpec& loop);

/// Checks joints, loops and coordinates known, none driven twice, laws without fault, spherical and
/// free joints and spherical loops driven as a whole, lengths positive at the start.
void check_drives(const Scene& scene, const Census& census);

/// Checks bodies and joints of forces known, numbers finite.
void check_forces(const Scene& scene, const Census& census);

/// Checks that functions have names usable in formulas, and points of a spline.
void check_functions(const Scene& scene);

/// Checks formulas of forces, equations and events, and the names in them. @pre the scene is valid
/// without them
void check_formulas(const Scene& scene);

/// Checks that every body is the child of exactly one joint and no joints form a cycle. @pre names
/// are known and unique
void check_tree(const Scene& scene);

/// Checks a scene with a Lagrangian: no bodies beside it, names usable in formulas, L or T, forces
/// on coordinates, constraints with names and equations.
void check_lagrangian(const Scene& scene);

/// Checks limits and stops of a joint or of a force along a length. @throws SceneError
template <class Spec>
void check_limits(const Spec& s, const Subject& who) {
  who.require(!s.limits || (std::isfinite((*s.limits)[0]) && std::isfinite((*s.limits)[1]) &&
                            (*s.limits)[0] < (*s.limits)[1]),
              "limits must be finite, the first below the second [rad or m]");
  who.require(std::isfinite(s.stop_stiffness) && std::isfinite(s.stop_damping) &&
                  std::isfinite(s.stop_width) && s.stop_stiffness >= 0 && s.stop_damping >= 0 &&
                  s.stop_width > 0,
              "stop_stiffness and stop_damping must be finite and >= 0, stop_width finite and > 0");
  who.require(s.limits || (s.stop_stiffness == 0 && s.stop_damping == 0),
              "stop_stiffness and stop_damping need limits");
}

}  // namespace momenta::reading
