#pragma once
// A scene: the mechanism as its author wrote it, before any analysis. Plain data, SI units, angles
// in rad. Readers (read_scene) fill it from files; programs may fill it by hand.

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

/// A moment of a run to be told: where a formula passes zero.
struct EventSpec {
  std::string name;  ///< or empty: "event 1", by its place among the events
  /// A number of the mechanism (core/scene/formula.h), or of a Lagrangian's names; no comparison.
  FormulaSpec when;
  std::string direction = "both";  ///< up: from below zero to above it; down; both
  bool stop = false;               ///< the run ends there
  Location at;                     ///< where the file has it
};
/// Its name, or "event 1" by its place.
std::string name_of(const EventSpec& event, std::size_t place);

/// A number with a name, of which the file made others; here its value.
struct ParameterSpec {
  std::string name;   ///< as formulas have it
  double value = 0;   ///< in the units of what is made of it
  bool used = false;  ///< whether a formula of the scene takes it
};

/// The defaults of a run, for options that the command line does not give; also for `momenta
/// drift`.
struct RunDefaults {
  double end_time = 10;        ///< [s]
  std::optional<double> step;  ///< fixed-step integrators [s]
  std::optional<double> leak;  ///< gauge leak κ [1/s]
  int samples = 1000;          ///< output intervals
  bool project = false;  ///< correct positions after each step: scenes that pass singular poses
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
  std::vector<FunctionSpec> functions;    ///< what formulas may call
  std::vector<MarkerSpec> markers;        ///< points to be reported
  std::vector<EventSpec> events;          ///< moments of runs to be told
  std::vector<VisualSpec> visuals;        ///< solids to be drawn; no effect on motion
  std::vector<std::string> held;          ///< [assembly] hold: joints whose q and u assembly keeps
  Location held_at;                       ///< where the file has that list
  RunDefaults run;                        ///< [run] end, step, leak, samples
  std::vector<ParameterSpec> parameters;  ///< [parameters]; for reports: numbers here are values
  /// What the reader of another format left out or changed: one sentence per kind.
  std::vector<std::string> remarks;

  /// The prefix of a message about a place in this scene: "file:line:column: ", without line and
  /// column for a thing that did not come from a file, and "scene: " where the scene did not come
  /// from one.
  std::string where(Location at) const;
};

/// The length of the scene [m], the unit in which gaps of loops are judged. For each body and for
/// the ground take the box, along its axes, around its centre of mass and its points of joints,
/// loops, springs, wrenches and markers. The length is the largest diagonal of these boxes, or the
/// largest `length` of a loop if that is more; 1 when all of these are zero.
double length_of(const Scene& scene);

/// The largest diagonal of a body's box [m], the ground left out: how far what moves swings. The
/// length of the scene where all of these are zero.
double length_of_bodies(const Scene& scene);

}  // namespace momenta
