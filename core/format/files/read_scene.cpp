#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/format/mjcf/mjcf.h>
#include <momenta/core/format/sdf/sdf.h>
#include <momenta/core/format/urdf/urdf.h>
#include <momenta/core/scene/file_text.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <array>
#include <new>
#include <set>
#include <stdexcept>

namespace momenta {
namespace {

/// Endings of XML files.
constexpr std::array<std::string_view, 6> xml_endings{".urdf", ".xml",   ".mjcf",
                                                      ".sdf",  ".world", ".xacro"};

/// Refuses options of other formats.
void expect_own_options(const std::string& file, const ReadOptions& options, bool urdf, bool mjcf) {
  const auto expect = [&](const char* format, bool given, const char* what) {
    if (given)
      reading::fail(file, {},
                    std::string("no ") + format + ", expected one where " + what + " given");
  };
  if (!urdf) {
    expect("URDF", !options.loops.empty(), "a file of loops is");
    expect("URDF", options.free_root, "a free root is");
  }
  if (!mjcf) {
    expect("MJCF", !options.key.empty(), "a key is");
    expect("MJCF", !options.controls.empty(), "controls of actuators are");
  }
}

/// Parses URDF, MJCF or SDF, by the root element.
Scene parse_robot(std::string_view text, const std::string& file, const ReadOptions& options) {
  const reading::Element root = reading::parse_xml(text, file);
  const bool urdf = root.name == "robot", mjcf = root.name == "mujoco", sdf = root.name == "sdf";
  if (!urdf && !mjcf && !sdf)
    reading::fail(file, {root.line, 0},
                  "the root element is <" + reading::on_one_line(root.name) +
                      ">, expected <robot> (URDF), <mujoco> (MJCF) or <sdf> (SDF)");
  expect_own_options(file, options, urdf, mjcf);
  if (sdf) return reading::read_sdf(root, file);
  return urdf ? reading::read_urdf(root, file, options)
              : reading::read_mjcf(root, file, options.key, options.controls);
}

Scene read_any(const std::filesystem::path& file, const ReadOptions& options,
               const std::vector<Setting>& settings) {
  const std::string name = file.string(), text = reading::text_of(file);
  if (!is_toml(file)) {
    try {
      return parse_robot(text, name, options);
    } catch (const std::bad_alloc&) {
      reading::fail(name, {}, "the scene does not fit into memory, expected a smaller one");
    }
  }
  expect_own_options(name, options, false, false);
  return parse_scene(text, name, settings);
}

}  // namespace

void stop_at_limits(Scene& scene, const std::array<double, 2>& stops) {
  std::set<std::string> driven;
  for (const DriveSpec& drive : scene.drives) driven.insert(drive.joint);
  for (JointSpec& joint : scene.joints) {
    if (!joint.limits || has_stops(joint) || driven.contains(joint.name)) continue;
    joint.stop_stiffness = stops[0];
    joint.stop_damping = stops[1];
  }
  for (ForceSpec& force : scene.forces) {
    if (!force.limits || has_stops(force)) continue;
    force.stop_stiffness = stops[0];
    force.stop_damping = stops[1];
  }
  validate(scene);
}

bool is_toml(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  return std::find(xml_endings.begin(), xml_endings.end(), ending) == xml_endings.end();
}

Scene read_scene(const std::filesystem::path& file, const ReadOptions& options) {
  return read_scene(file, options, {});
}

Scene read_scene(const std::filesystem::path& file, const ReadOptions& options,
                 const std::vector<Setting>& settings) {
  if (!settings.empty() && !is_toml(file))
    throw std::invalid_argument(reading::in_quotes(settings.front().place) +
                                ": the scene is no TOML, expected one where numbers are set "
                                "(momenta convert)");
  Scene scene = read_any(file, options, settings);
  if (options.stops) stop_at_limits(scene, *options.stops);
  return scene;
}

}  // namespace momenta
