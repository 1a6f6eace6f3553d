#pragma once
// A scene: the mechanism as its author wrote it, before any analysis. Plain data, SI units, angles
// in rad. Filled by readers (read_scene) or by hand.

#include <momenta/core/scene/body_spec.h>
#include <momenta/core/scene/drive_spec.h>
#include <momenta/core/scene/force_spec.h>
#include <momenta/core/scene/joint_spec.h>
#include <momenta/core/scene/lagrangian.h>
#include <momenta/core/scene/location.h>
#include <momenta/core/scene/loop_spec.h>
#include <momenta/core/scene/visual.h>

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace momenta {

/// Bad input. what() is one sentence: "file:line:column: what was found, what was expected".
class SceneError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A named point of a body, or of "ground", whose position and velocity are reported in ground
/// axes.
struct MarkerSpec {
  std::string name;                                 ///< heads its columns of trajectory.csv
  std::string body;                                 ///< or "ground"
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< in body axes [m]
  Location at;                                      ///< where the file has it
};

/// An event of a run: a formula passes zero.
struct EventSpec {
  std::string name;  ///< or empty: "event 1", by its place among the events
  /// A number of the mechanism (core/scene/formula.h) or of a Lagrangian; no comparison.
  FormulaSpec when;
  std::string direction = "both";  ///< up: from below zero to above it; down; both
  bool stop = false;               ///< the run ends there
  Location at;                     ///< where the file has it
};
/// The name of an event, or "event 1" by its place.
std::string name_of(const EventSpec& event, std::size_t place);

/// A named number from which the file computes others; here its value.
struct ParameterSpec {
  std::string name;   ///< name in formulas
  double value = 0;   ///< value, in the units of its use
  bool used = false;  ///< whether a formula of the scene takes it
};

/// Defaults of a run, for options not on the command line; also for `momenta drift`.
struct RunDefaults {
  double end_time = 10;        ///< [s]
  std::optional<double> step;  ///< fixed-step integrators [s]
  std::optional<double> leak;  ///< gauge leak κ [1/s]
  int samples = 1000;          ///< output intervals
  bool project = false;  ///< correct positions after each step: for scenes that pass singular poses
};

/// A mechanism as its author wrote it. read_scene() returns it; OpenChain and Mechanism take it.
struct Scene {
  std::string file;                   ///< for messages; empty when built by hand
  std::vector<std::string> included;  ///< files that this one includes, for messages
  std::string name;                   ///< for titles and tables
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< [m/s²]
  std::vector<BodySpec> bodies;                       ///< without the ground
  std::vector<JointSpec> joints;                      ///< one for each body
  std::optional<LagrangianSpec> lagrangian;           ///< instead of bodies, joints and loops
  std::vector<LoopSpec> loops;                        ///< empty: an open chain
  std::vector<DriveSpec> drives;                      ///< prescribed motion
  std::vector<ForceSpec> forces;          ///< forces besides gravity and those of joints
  std::vector<FunctionSpec> functions;    ///< functions in formulas
  std::vector<MarkerSpec> markers;        ///< points that are reported
  std::vector<EventSpec> events;          ///< moments of runs that are reported
  std::vector<VisualSpec> visuals;        ///< solids that are drawn; no effect on motion
  std::vector<std::string> held;          ///< [assembly] hold: joints whose q and u assembly keeps
  Location held_at;                       ///< place of that list in the file
  RunDefaults run;                        ///< [run] end, step, leak, samples
  std::vector<ParameterSpec> parameters;  ///< [parameters]; for reports: numbers here are values
  /// Things the reader of another format left out or changed: one sentence per kind.
  std::vector<std::string> remarks;

  /// Prefix of a message about a place in this scene: "file:line:column: ", without line and column
  /// for things not from a file, "scene: " for a scene not from a file.
  std::string where(Location at) const;
};

/// The length of the scene [m], the unit for gaps of loops. Each body and the ground have a box,
/// along their axes, around the centre of mass and points of joints, loops, springs, wrenches and
/// markers: the largest diagonal, or the largest `length` of a loop if that is more; 1 when all are
/// zero.
double length_of(const Scene& scene);

/// The largest diagonal of a body's box [m], without the ground: how far bodies swing. The length
/// of the scene where all are zero.
double length_of_bodies(const Scene& scene);

}  // namespace momenta
