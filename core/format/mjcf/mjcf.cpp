// <mujoco>: settings, then defaults, bodies and constraints; the rest is counted.

#include <momenta/core/format/mjcf/mjcf.h>
#include <momenta/core/format/mjcf/mjcf_copies.h>
#include <momenta/core/format/mjcf/mjcf_keys.h>
#include <momenta/core/format/mjcf/mjcf_visuals.h>
#include <momenta/core/format/xml/known_elements.h>
#include <momenta/core/scene/validate.h>
#include <momenta/core/text/quoting.h>

#include <array>
#include <map>

namespace momenta::reading {
namespace {

void read_option(const Node& node, MjcfModel& model) {
  model.scene.gravity = node.vector("gravity", model.scene.gravity);
  for (const char* key : {"density", "viscosity"})
    if (node.number(key, 0) != 0) model.remarks.left_out("forces of a fluid");
  model.disabled_groups |= !node.text("actuatorgroupdisable", "").empty();
  for (const Node& flag : node.children("flag")) {
    constexpr std::array<std::string_view, 2> words{"enable", "disable"};
    const auto off = [&](const char* key) { return flag.word(key, words, 0) == 1; };
    const bool free = off("constraint"), passive = off("passive");
    if (off("gravity")) model.scene.gravity.setZero();
    model.rubs &= !free && !off("frictionloss");
    model.limits &= !free && !off("limit");
    model.ties &= !free && !off("equality");
    model.springs &= !passive && !off("spring");
    model.dampers &= !passive && !off("damper");
    model.clamps &= !off("clampctrl");
    model.actuates &= !off("actuation");
  }
}

void count_left_out(const Node& section, Remarks& remarks) {
  static const std::map<std::string, std::string> kinds{
      {"contact", "pairs for contact"},   {"sensor", "sensors"},
      {"visual", "settings of pictures"}, {"statistic", "settings of pictures"},
      {"size", "sizes of memory"},        {"custom", "custom entries"},
      {"extension", "plugins"},
  };
  const auto kind = kinds.find(section.name());
  if (kind == kinds.end()) return;
  if (section.children().empty() || kind->second.starts_with("settings"))
    return remarks.left_out(kind->second);
  for ([[maybe_unused]] const Node& part : section.children()) remarks.left_out(kind->second);
}

/// Reads the <mesh>es of an <asset>, in the folder of the model's settings.
void read_asset(const Node& asset, const MjcfFiles& files, MjcfModel& model) {
  const std::string* const attached = asset.element().find(of_model);
  std::filesystem::path folder = files.folder();
  if (attached != nullptr) folder = files.folder_of(asset);
  read_materials(asset, model);
  for (const Node& part : asset.children("mesh")) {
    const Element full = model.defaults.with_defaults(part, "mesh", MjcfDefaults::main_class);
    const Node mesh(full, "mesh " + in_quotes(part.text("name", "")), model.scene.file);
    const MjcfSettings& now = attached != nullptr ? model.attached.at(*attached) : model;
    model.meshes.take(mesh, folder, now);
  }
}

/// Reads <compiler> and <default> of an attached model.
void read_attached(const Node& node, MjcfModel& model) {
  MjcfSettings& settings = model.attached[*node.element().find("model")];
  settings.from_attached = *node.element().find("model");
  for (const Node& part : node.children("compiler")) {
    read_compiler(part, settings);
    if (settings.total_mass > 0)
      part.fail("settotalmass", "is of an attached model, expected it of the whole");
  }
  MjcfDefaults defaults;
  for (const Node& part : node.children("default")) defaults.take(part);
  model.defaults.take(defaults, *node.element().find("prefix"));
}

}  // namespace

Scene read_mjcf(const Element& element, const std::string& file, const std::string& key,
                const std::vector<std::string>& controls) {
  MjcfModel model;
  MjcfFiles files(file);
  const Element whole = assembled(element, file, files, model.remarks);
  const Node root(whole, "", file);
  refuse_misspelt(root, mjcf_elements());
  model.scene.file = file;
  model.folder = files.folder();
  model.scene.included = files.names();
  model.scene.name = root.text("model", "");
  model.scene.gravity = {0, 0, -9.81};
  for (const char* refused : {"deformable", "flex"})
    if (const auto found = root.children(refused); !found.empty())
      found.front().fail("is not read, expected rigid bodies");
  for (const Node& node : root.children("compiler")) read_compiler(node, model);
  for (const Node& node : root.children("option")) read_option(node, model);
  for (const Node& node : root.children("default")) model.defaults.take(node);
  for (const Node& node : root.children(attached_model)) read_attached(node, model);
  for (const Node& node : root.children("asset")) read_asset(node, files, model);
  for (const Node& node : root.children("worldbody")) read_worldbody(node, model);
  scale_to_total_mass(model);
  settle_ball_armatures(model);
  settle_spring_dampers(model);
  for (const Node& node : root.children("equality"))
    for (const Node& held : node.children("tendon"))
      for (const char* end : {"tendon1", "tendon2"}) model.held_tendons.insert(held.text(end, ""));
  for (const Node& node : root.children("tendon")) read_tendons(node, model);
  const std::vector<Node> keyframes = root.children("keyframe"),
                          actuators = root.children("actuator");
  expect_keys_fit(keyframes, count_actuators(actuators), model);
  read_actuators(actuators, controls, controls_of_key(keyframes, key, model), model);
  for (const Node& node : root.children("equality")) read_equality(node, model);
  read_keys(keyframes, key, !controls.empty(), model);
  for (const Node& node : root.children()) {
    count_left_out(node, model.remarks);
    if (node.name() == "actuator" && !controls.empty())
      tell_unread(node, mjcf_actuator_elements(), model.remarks);
  }
  tell_unread(root, mjcf_elements(), model.remarks);
  take_drawn(model);
  model.scene.remarks = model.remarks.sentences();
  if (model.scene.bodies.empty()) root.fail("has no <body>, expected at least one");
  validate(model.scene);
  return std::move(model.scene);
}

}  // namespace momenta::reading
