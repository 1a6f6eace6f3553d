#pragma once
// State of reading an MJCF: settings, defaults, places at qpos0, and the growing scene.

#include <momenta/core/format/mjcf/mjcf_defaults.h>
#include <momenta/core/format/mjcf/mjcf_meshes.h>
#include <momenta/core/format/xml/made_scene.h>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace momenta::reading {

/// The settings are those that hold at the place being read.
struct MjcfModel : MjcfSettings {
  Scene scene;
  Remarks remarks;
  std::filesystem::path folder;         ///< folder of the model
  bool rubs = true, limits = true;      ///< flags frictionloss, limit
  bool ties = true;                     ///< flag equality
  bool springs = true, dampers = true;  ///< flags spring, damper
  bool clamps = true, actuates = true;  ///< flags clampctrl, actuation
  bool disabled_groups = false;         ///< actuatorgroupdisable names some
  FreeNames bodies, edges;
  MjcfDefaults defaults;
  MjcfMeshes meshes;
  std::map<std::string, MjcfSettings>
      attached;  ///< settings of attached models, by the `model` of <attach>

  /// Bodies by name with their frames at qpos0; "world" is the ground.
  std::map<std::string, MjcfFrame> frames{{"world", {}}};
  struct Site {
    std::string body;
    MjcfFrame frame;  ///< in the body
  };
  std::map<std::string, Site> sites;
  /// `ref` of hinges and slides [rad or m]: file's q less the scene's; none: 0.
  std::map<std::string, double> refs;
  /// Joints of attached models: the `model` of the <attach>.
  std::map<std::string, std::string> joint_of_attached;
  /// `springref` less `ref`: the scene's q at resting lengths of tendons; none: 0.
  std::map<std::string, double> rests;
  /// `springdamper` of a joint, kept until all inertias are known.
  struct SpringDamper {
    std::string joint;
    double time_constant, damping_ratio;  ///< [s], [1], > 0
  };
  std::vector<SpringDamper> spring_dampers;
  /// `armature` of ball and free joints.
  struct BallArmature {
    std::string joint;
    double inertia;  ///< a > 0 [kg m² and kg]
  };
  std::vector<BallArmature> ball_armatures;
  /// Tendon. Fixed: L of the scene is Σ ratio · q; spatial, by two sites: their distance.
  struct Tendon {
    std::map<std::string, double> ratios;  ///< by joint, none zero; empty: spatial
    std::optional<std::pair<Site, Site>> ends;
    double ref = 0;  ///< L of the file less the scene's
    Location at;
  };
  std::map<std::string, Tendon> tendons;
  std::set<std::string> held_tendons;  ///< tendons named by an <equality>

  /// Geoms that can be drawn, with whether MuJoCo draws them by default.
  std::vector<std::pair<VisualSpec, bool>> drawn;
  std::map<std::string, Eigen::Vector3d> materials;  ///< colours by name

  /// The name of a body in the scene.
  static std::string in_scene(const std::string& body) { return body == "world" ? "ground" : body; }
};

/// Reads the bodies of a <worldbody>, with joints, springs, dampers and sites.
void read_worldbody(const Node& world, MjcfModel& model);

/// Reads axis, spring, damper, friction, armature and limits of a joint with known frames.
void read_mechanics(const Node& node, JointSpec& joint, MjcfModel& model);
/// Adds spring and damper of a ball or free joint, as a bushing.
void add_spring_and_damper(const JointSpec& joint, double stiffness, double damping,
                           MjcfModel& model);
/// Computes stiffness and damping of joints with `springdamper`. After all bodies.
void settle_spring_dampers(MjcfModel& model);

/// `settotalmass`: scales masses and inertias (mjcf_inertia.cpp). After all bodies.
void scale_to_total_mass(MjcfModel& model);

/// Adds the armature of ball and free joints to their bodies (mjcf_joints.cpp). After all bodies.
/// @throws SceneError for one that is no inertia
void settle_ball_armatures(MjcfModel& model);

/// The name of a hinge or slide in an attribute. @throws SceneError
std::string coordinate_of(const Node& node, const char* key, const MjcfModel& model);

/// Reads springs of <tendon>. After all bodies.
void read_tendons(const Node& tendons, MjcfModel& model);

/// Number of actuators in the <actuator> sections.
std::size_t count_actuators(const std::vector<Node>& sections);

/// Reads <actuator> sections at the given controls, as text; none: left out, but their joints and
/// tendons must be in the model. Actuators without one have that of the <key>, `of_key` in the
/// order of the file, one for each or empty, else 0. After the tendons.
void read_actuators(const std::vector<Node>& sections, const std::vector<std::string>& controls,
                    const std::vector<double>& of_key, MjcfModel& model);

/// Makes loops of <equality>: connect, weld, joint and tendon. After the tendons.
void read_equality(const Node& equality, MjcfModel& model);

}  // namespace momenta::reading
