#include <momenta/core/format/toml/scene_keys.h>
#include <momenta/core/format/toml/write_scene.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/text/quoting.h>

namespace momenta {
namespace {

using reading::Keys;

/// A table with this header. `others`: what its declaration takes beside the spec.
template <class Spec, class... Others>
std::string table(const char* header, Spec spec, const Others&... others) {
  return std::string("\n") + header + "\n" +
         Keys::lines([&](Keys& keys) { reading::declare(keys, spec, others...); });
}

template <class Spec, class... Others>
std::string tables(const char* header, const std::vector<Spec>& specs, const Others&... others) {
  std::string all;
  for (const Spec& spec : specs) all += table(header, spec, others...);
  return all;
}

std::string lagrangian_text(const Scene& scene) {
  std::string text = scene.parameters.empty() ? "" : "\n[parameters]\n";
  for (const ParameterSpec& p : scene.parameters)
    text += p.name + " = " + toml_text::of(p.value) + "\n";
  return text + table("[lagrangian]", *scene.lagrangian) +
         tables("[[lagrangian.constraints]]", scene.lagrangian->constraints);
}

}  // namespace

std::string scene_text(const Scene& scene) {
  for (const JointSpec& joint : scene.joints)
    if (joint.kind == JointKind::user)
      throw SceneError(scene.where(joint.at) + "joint " + reading::in_quotes(joint.name) +
                       " is a user joint, whose formula no file can hold; expected another kind");
  std::string text;
  for (const std::string& remark : scene.remarks)
    text += "# " + reading::on_one_line(remark) + "\n";
  std::string name = scene.name;
  Eigen::Vector3d gravity = scene.gravity;
  text += Keys::lines([&](Keys& keys) {
    keys.value_or("name", name, "");
    keys.vector("gravity", gravity, {"m/s²"});
  });
  if (scene.lagrangian) text += lagrangian_text(scene);
  text += tables("[[body]]", scene.bodies) + tables("[[joint]]", scene.joints) +
          tables("[[loop]]", scene.loops, std::span<const DriveSpec>(scene.drives)) +
          tables("[[drive]]", scene.drives) + tables("[[force]]", scene.forces) +
          tables("[[function]]", scene.functions) + tables("[[marker]]", scene.markers) +
          tables("[[event]]", scene.events) + tables("[[visual]]", scene.visuals);
  if (!scene.held.empty()) text += "\n[assembly]\nhold = " + toml_text::of(scene.held) + "\n";
  return text + table("[run]", scene.run);
}

}  // namespace momenta
