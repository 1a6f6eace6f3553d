#include <momenta/core/scene/file_text.h>
#include <momenta/core/scene/files/read_scene.h>
#include <momenta/core/scene/mjcf/mjcf.h>
#include <momenta/core/scene/near_name.h>
#include <momenta/core/scene/urdf/urdf.h>

#include <new>

namespace momenta {
namespace {

/// URDF or MJCF, by the root element.
Scene parse_robot(std::string_view text, const std::string& file, const ReadOptions& options) {
  const reading::Element root = reading::parse_xml(text, file);
  if (root.name == "robot") {
    if (!options.key.empty()) reading::fail(file, {}, "no MJCF, expected one where a key is given");
    return reading::read_urdf(root, file, options);
  }
  const std::string asked = !options.loops.empty() ? "a file of loops"
                            : options.free_root    ? "a free root"
                                                   : "";
  if (!asked.empty()) reading::fail(file, {}, "no URDF, expected one where " + asked + " is given");
  if (root.name == "mujoco") return reading::read_mjcf(root, file, options.key);
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
  if (!options.key.empty()) reading::fail(name, {}, "no MJCF, expected one where a key is given");
  return parse_scene(text, name);
}

}  // namespace momenta
