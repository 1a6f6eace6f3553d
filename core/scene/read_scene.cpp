#include <momenta/core/scene/file_text.h>
#include <momenta/core/scene/mjcf/mjcf.h>
#include <momenta/core/scene/near_name.h>
#include <momenta/core/scene/read_scene.h>
#include <momenta/core/scene/read_tables.h>
#include <momenta/core/scene/set_numbers.h>
#include <momenta/core/scene/urdf/urdf.h>

#include <new>

namespace momenta {
namespace {

using reading::Fields;

/// URDF or MJCF, by the root element.
Scene parse_robot(std::string_view text, const std::string& file, const ReadOptions& options) {
  const reading::Element root = reading::parse_xml(text, file);
  if (root.name == "robot") return reading::read_urdf(root, file, options);
  const std::string asked = !options.loops.empty() ? "a file of loops"
                            : options.free_root    ? "a free root"
                                                   : "";
  if (!asked.empty()) reading::fail(file, {}, "no URDF, expected one where " + asked + " is given");
  if (root.name == "mujoco") return reading::read_mjcf(root, file);
  reading::fail(file, {root.line, 0},
                "the root element is <" + reading::on_one_line(root.name) +
                    ">, expected <robot> (URDF) or <mujoco> (MJCF)");
}

}  // namespace

bool is_toml(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  return ending != ".urdf" && ending != ".xml" && ending != ".mjcf";
}

Scene read_scene(const std::filesystem::path& file, const ReadOptions& options) {
  const std::string name = file.string(), text = reading::text_of(file);
  if (!is_toml(file)) {
    try {
      return parse_robot(text, name, options);
    } catch (const std::bad_alloc&) {
      reading::fail(name, {}, "the scene does not fit into memory");
    }
  }
  if (!options.loops.empty() || options.free_root)
    reading::fail(name, {}, "no URDF, expected one where a file of loops or a free root is given");
  return parse_scene(text, name);
}

Scene parse_scene(std::string_view text, const std::string& file) {
  return parse_scene(text, file, {});
}

Scene parse_scene(std::string_view text, const std::string& file,
                  const std::vector<Setting>& settings) try {
  reading::Value root = reading::parse_toml(text, file);
  reading::set_numbers(root, settings);
  const Fields table(root, "", file);
  table.allow(
      {"name", "gravity", "body", "joint", "loop", "drive", "force", "marker", "assembly", "run"});

  Scene scene;
  scene.file = file;
  scene.name = table.text("name", "");
  scene.gravity = table.vector("gravity", {"m/s²"}, scene.gravity);
  for (const Fields& t : table.tables("body", "body"))
    scene.bodies.push_back(reading::read_body(t));
  for (const Fields& t : table.tables("joint", "joint"))
    scene.joints.push_back(reading::read_joint(t));
  for (const Fields& t : table.tables("drive", "drive"))
    scene.drives.push_back(reading::read_drive(t));
  for (const Fields& t : table.tables("loop", "loop"))
    scene.loops.push_back(reading::read_loop(t, scene.drives));
  for (const Fields& t : table.tables("force", "force"))
    scene.forces.push_back(reading::read_force(t));
  for (const Fields& t : table.tables("marker", "marker"))
    scene.markers.push_back(reading::read_marker(t));
  if (const auto assembly = table.table("assembly")) {
    assembly->allow({"hold"});
    scene.held = assembly->texts("hold");
    if (const reading::Value* hold = assembly->find("hold")) scene.held_at = hold->at;
  }
  if (const auto run = table.table("run")) scene.run = reading::read_run(*run);

  if (scene.bodies.empty()) reading::fail(file, {1, 1}, "no body, expected at least one [[body]]");
  validate(scene);
  return scene;
} catch (const std::bad_alloc&) {
  reading::fail(file, {}, "the scene does not fit into memory");
}

}  // namespace momenta
