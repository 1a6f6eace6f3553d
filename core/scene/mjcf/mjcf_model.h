#pragma once
// What is known of an MJCF while it is read: settings, defaults, where everything stands at qpos0,
// and the scene that grows.

#include <momenta/core/scene/mjcf/mjcf_defaults.h>
#include <momenta/core/scene/mjcf/mjcf_meshes.h>
#include <momenta/core/scene/mjcf/mjcf_settings.h>
#include <momenta/core/scene/xml/made_scene.h>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace momenta::reading {

/// The settings are those that hold where it is read.
struct MjcfModel : MjcfSettings {
  Scene scene;
  Remarks remarks;
  std::filesystem::path folder;         ///< of the model
  bool rubs = true, limits = true;      ///< flags frictionloss, limit
  bool ties = true;                     ///< flag equality
  bool springs = true, dampers = true;  ///< flags spring, damper
  bool clamps = true, actuates = true;  ///< flags clampctrl, actuation
  bool disabled_groups = false;         ///< actuatorgroupdisable names some
  FreeNames bodies, edges;
  MjcfDefaults defaults;
  MjcfMeshes meshes;
  std::map<std::string, MjcfSettings> attached;  ///< of attached models, by the `model` of <attach>

  /// Bodies by name with their frames at qpos0; "world" is the ground.
  std::map<std::string, MjcfFrame> frames{{"world", {}}};
  struct Site {
    std::string body;
    MjcfFrame frame;  ///< in the body
  };
  std::map<std::string, Site> sites;
  /// `ref` of hinges and slides [rad or m]: q of the file less that of the scene; none: 0.
  std::map<std::string, double> refs;
  /// Of joints that came with an attached model: the `model` of its <attach>.
  std::map<std::string, std::string> joint_of_attached;
  /// `springref` less `ref`: q of the scene where tendons have their resting lengths; none: 0.
  std::map<std::string, double> rests;
  /// Of `springdamper`: until all inertias are known.
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
  /// A fixed tendon: L of the scene is Σ ratio · q; a spatial one by two sites: their distance.
  struct Tendon {
    std::map<std::string, double> ratios;  ///< by joint, none zero; empty of a spatial one
    std::optional<std::pair<Site, Site>> ends;
    double ref = 0;  ///< L of the file less that of the scene
    Location at;
  };
  std::map<std::string, Tendon> tendons;
  std::set<std::string> held_tendons;  ///< those that an <equality> names

  /// Geoms that can be drawn, and whether MuJoCo draws them by default.
  std::vector<std::pair<VisualSpec, bool>> drawn;
  std::map<std::string, Eigen::Vector3d> materials;  ///< colours by name

  /// The name of a body in the scene.
  static std::string in_scene(const std::string& body) { return body == "world" ? "ground" : body; }
};

/// The bodies of a <worldbody>, with joints, springs, dampers and sites.
void read_worldbody(const Node& world, MjcfModel& model);

/// Axis, spring, damper, friction, armature and limits of a joint whose frames are known.
void read_mechanics(const Node& node, JointSpec& joint, MjcfModel& model);
/// Those of a ball or free joint, as a bushing.
void add_spring_and_damper(const JointSpec& joint, double stiffness, double damping,
                           MjcfModel& model);
/// Stiffness and damping of the joints with `springdamper`. After all bodies.
void settle_spring_dampers(MjcfModel& model);

/// `settotalmass`: masses and inertias times one factor (mjcf_masses.cpp). After all bodies.
void scale_to_total_mass(MjcfModel& model);

/// The armature of ball and free joints, as inertia of their bodies (mjcf_armature.cpp). After all
/// bodies. @throws SceneError where it is none
void settle_ball_armatures(MjcfModel& model);

/// The name of a hinge or slide that an attribute names. @throws SceneError
std::string coordinate_of(const Node& node, const char* key, const MjcfModel& model);

/// <tendon>: springs. After all bodies.
void read_tendons(const Node& tendons, MjcfModel& model);

/// How many there are in the <actuator> sections.
std::size_t count_actuators(const std::vector<Node>& sections);

/// <actuator> sections at the controls that are given, as text; none: left out, but what they act
/// on has to be in the model all the same. Actuators without one have that of the <key>, `of_key`
/// in the order of the file, one for each or empty, else 0. After the tendons.
void read_actuators(const std::vector<Node>& sections, const std::vector<std::string>& controls,
                    const std::vector<double>& of_key, MjcfModel& model);

/// <equality>: connect, weld, joint and tendon become loops. After the tendons.
void read_equality(const Node& equality, MjcfModel& model);

}  // namespace momenta::reading
