#include <momenta/core/scene/file_text.h>
#include <momenta/core/scene/files/read_scene.h>
#include <momenta/core/scene/mjcf/mjcf.h>
#include <momenta/core/scene/near_name.h>
#include <momenta/core/scene/sdf/sdf.h>
#include <momenta/core/scene/urdf/urdf.h>

#include <algorithm>
#include <array>
#include <new>

namespace momenta {
namespace {

/// The endings of files that are XML.
constexpr std::array<std::string_view, 6> xml_endings{".urdf", ".xml",   ".mjcf",
                                                      ".sdf",  ".world", ".xacro"};

/// URDF, MJCF or SDF, by the root element.
Scene parse_robot(std::string_view text, const std::string& file, const ReadOptions& options) {
  const reading::Element root = reading::parse_xml(text, file);
  if (root.name == "robot") return reading::read_urdf(root, file, options);
  const std::string asked = !options.loops.empty() ? "a file of loops"
                            : options.free_root    ? "a free root"
                                                   : "";
  if (!asked.empty()) reading::fail(file, {}, "no URDF, expected one where " + asked + " is given");
  if (root.name == "mujoco") return reading::read_mjcf(root, file);
  if (root.name == "sdf") return reading::read_sdf(root, file);
  reading::fail(file, {root.line, 0},
                "the root element is <" + reading::on_one_line(root.name) +
                    ">, expected <robot> (URDF), <mujoco> (MJCF) or <sdf> (SDF)");
}

}  // namespace

bool is_toml(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  return std::find(xml_endings.begin(), xml_endings.end(), ending) == xml_endings.end();
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

}  // namespace momenta
