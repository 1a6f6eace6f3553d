// <mujoco>: settings, then defaults, bodies and constraints; what is left out is counted.

#include <momenta/core/scene/mjcf/mjcf.h>
#include <momenta/core/scene/mjcf/mjcf_model.h>
#include <momenta/core/scene/near_name.h>
#include <momenta/core/scene/validate.h>

#include <algorithm>
#include <array>
#include <map>

namespace momenta::reading {
namespace {

void read_compiler(const Node& node, MjcfModel& model) {
  constexpr std::array<std::string_view, 2> units{"degree", "radian"};
  if (node.has("angle"))
    model.angles.unit = node.word("angle", units, 0) == 1 ? 1 : std::numbers::pi / 180;
  if (node.has("eulerseq")) {
    const std::string order = node.text("eulerseq");
    if (order.size() != 3 || order.find_first_not_of("xyzXYZ") != std::string::npos)
      node.fail("eulerseq", "is " + in_quotes(order) + ", expected three of x y z X Y Z");
    model.angles.euler_order = order;
  }
  constexpr std::array<std::string_view, 3> sources{"auto", "false", "true"};
  if (node.has("inertiafromgeom")) {
    const std::size_t source = node.word("inertiafromgeom", sources, 0);
    model.geoms_weigh = source != 1;
    model.always_geoms = source == 2;
  }
  if (node.has("inertiagrouprange")) {
    const std::vector<double> range = node.numbers("inertiagrouprange", 2);
    model.least_group = range[0];
    model.largest_group = range[1];
  }
  for (const char* key : {"boundmass", "boundinertia"})
    if (node.number(key, 0) != 0) node.fail(key, "changes inertias, expected none");
  if (node.number("settotalmass", -1) > 0)
    node.fail("settotalmass", "changes masses, expected none");
  if (node.flag("balanceinertia", false)) node.fail("balanceinertia", "is true, expected false");
  if (node.text("coordinate", "local") != "local")
    node.fail("coordinate", "is not local, expected frames in their parents");
}

void read_option(const Node& node, MjcfModel& model) {
  model.scene.gravity = node.vector("gravity", model.scene.gravity);
  for (const char* key : {"density", "viscosity"})
    if (node.number(key, 0) != 0) model.remarks.left_out("forces of a fluid");
  for (const Node& flag : node.children("flag")) {
    if (flag.text("gravity", "enable") == "disable") model.scene.gravity.setZero();
    for (const char* key : {"equality", "passive", "spring", "damper"})
      if (flag.text(key, "enable") != "enable")
        flag.fail(key, "is not enable, expected what the model holds to act");
  }
}

void count_left_out(const Node& section, Remarks& remarks) {
  static const std::map<std::string, std::string> kinds{
      {"contact", "pairs for contact"},   {"sensor", "sensors"},
      {"keyframe", "keyframes"},          {"asset", "meshes, textures and materials"},
      {"visual", "settings of pictures"}, {"statistic", "settings of pictures"},
      {"size", "sizes of memory"},        {"custom", "custom entries"},
      {"extension", "plugins"},
  };
  const auto kind = kinds.find(section.name());
  if (kind == kinds.end()) return remarks.left_out("<" + section.name() + "> of the model");
  if (section.children().empty() || kind->second.starts_with("settings"))
    return remarks.left_out(kind->second);
  for ([[maybe_unused]] const Node& part : section.children()) remarks.left_out(kind->second);
}

}  // namespace

Scene read_mjcf(const Element& element, const std::string& file,
                const std::vector<std::string>& controls) {
  const Node root(element, "", file);
  MjcfModel model;
  model.scene.file = file;
  model.scene.name = root.text("model", "");
  model.scene.gravity = {0, 0, -9.81};
  for (const char* refused : {"include", "deformable", "flex"})
    if (const auto found = root.children(refused); !found.empty())
      found.front().fail("is not read, expected one file with everything in it");
  for (const Node& node : root.children("compiler")) read_compiler(node, model);
  for (const Node& node : root.children("option")) read_option(node, model);
  for (const Node& node : root.children("default")) model.defaults.take(node);
  for (const Node& node : root.children("worldbody")) read_worldbody(node, model);
  settle_spring_dampers(model);
  for (const Node& node : root.children("tendon")) read_tendons(node, model);
  read_actuators(root.children("actuator"), controls, model);
  for (const Node& node : root.children("equality")) read_equality(node, model);
  for (const Node& node : root.children()) {
    constexpr std::array<std::string_view, 7> read{"compiler", "option",   "default", "worldbody",
                                                   "tendon",   "actuator", "equality"};
    if (std::find(read.begin(), read.end(), node.name()) == read.end())
      count_left_out(node, model.remarks);
  }
  model.scene.remarks = model.remarks.sentences();
  if (model.scene.bodies.empty()) root.fail("has no <body>, expected at least one");
  validate(model.scene);
  return std::move(model.scene);
}

}  // namespace momenta::reading
