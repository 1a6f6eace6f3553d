#pragma once
// The checks of validate() which look at the scene as a whole: its names, its tree, and what ties
// drives and couplers to joints and loops.

#include <momenta/core/scene/scene.h>

#include <cmath>
#include <map>
#include <string>
#include <string_view>

namespace momenta::reading {

/// `condition` or SceneError "<place><who>: <sentence>".
inline void require(bool condition, const Scene& scene, Location at, const std::string& who,
                    const char* sentence) {
  if (!condition) throw SceneError(scene.where(at) + who + ": " + sentence);
}

/// Who is called what. Construction checks the names themselves: none empty, none twice among
/// bodies, among joints and loops together, among markers, functions, named forces, named events;
/// none with control characters; no body called "ground".
class Census {
 public:
  explicit Census(const Scene& scene);

  /// `name` is a body, or "ground" where that is allowed; else SceneError "<place><who>: <key> is
  /// ...".
  void require_body(const std::string& name, bool or_ground, Location at, const std::string& who,
                    const std::string& key) const;

  /// `name` is a joint of the tree.
  const JointSpec& require_joint(const std::string& name, Location at,
                                 const std::string& who) const;

  /// `name` is a loop.
  const LoopSpec& require_loop(const std::string& name, Location at, const std::string& who) const;

  /// `name` is a joint of one coordinate: revolute, prismatic or helical.
  void require_one_coordinate(const std::string& name, Location at, const std::string& who) const;

 private:
  const Scene& scene_;
  std::map<std::string, const BodySpec*, std::less<>> bodies_;
  std::map<std::string, const JointSpec*, std::less<>> joints_;
  std::map<std::string, const LoopSpec*, std::less<>> loops_;
};

/// The drive of a coordinate of a joint or loop, which is none of a loop's origin; or null.
/// O(drives)
const DriveSpec* drive_of(const Scene& scene, std::string DriveSpec::*owner,
                          const std::string& name, int coordinate);

/// Joints known, as many coordinates and ratios, none a part of a quaternion, none twice. Returns
/// whether all are driven.
bool check_coordinates(const Scene& scene, const Census& census, const LoopSpec& coupler,
                       const std::string& who);
bool check_coordinates(const Scene& scene, const Census& census, const ForceSpec& spring,
                       const std::string& who);

/// check_coordinates(); finite numbers, not all driven.
void check_coupler(const Scene& scene, const Census& census, const LoopSpec& loop);

/// Joints, loops and coordinates known, none driven twice, laws without fault, spherical and free
/// joints and spherical loops driven as a whole, lengths positive at the start.
void check_drives(const Scene& scene, const Census& census);

/// Bodies and joints of forces known, numbers finite.
void check_forces(const Scene& scene, const Census& census);

/// Functions have names that formulas can take, and points of a spline.
void check_functions(const Scene& scene);

/// What formulas of forces stand in place of, and what they name. @pre the scene is valid without
/// them
void check_formulas(const Scene& scene);

/// Every body is the child of exactly one joint and no joints form a cycle. @pre the names are
/// known and unique
void check_tree(const Scene& scene);

/// Of a scene with a Lagrangian: no bodies beside it, names that formulas can take, L or T, forces
/// on coordinates, constraints with names and equations.
void check_lagrangian(const Scene& scene);

/// Limits and stops of a joint or of a force along a length. @throws SceneError
template <class Spec>
void check_limits(const Scene& scene, const Spec& s, const std::string& who) {
  require(!s.limits || (std::isfinite((*s.limits)[0]) && std::isfinite((*s.limits)[1]) &&
                        (*s.limits)[0] < (*s.limits)[1]),
          scene, s.at, who, "limits must be finite, the first below the second [rad or m]");
  require(std::isfinite(s.stop_stiffness) && std::isfinite(s.stop_damping) &&
              std::isfinite(s.stop_width) && s.stop_stiffness >= 0 && s.stop_damping >= 0 &&
              s.stop_width > 0,
          scene, s.at, who,
          "stop_stiffness and stop_damping must be finite and >= 0, stop_width finite and > 0");
  require(s.limits || (s.stop_stiffness == 0 && s.stop_damping == 0), scene, s.at, who,
          "stop_stiffness and stop_damping need limits");
}

}  // namespace momenta::reading
