#include <momenta/core/scene/near_name.h>
#include <momenta/core/scene/read_scene.h>
#include <momenta/core/scene/read_tables.h>
#include <momenta/core/scene/set_numbers.h>

#include <fstream>
#include <new>
#include <system_error>

namespace momenta {
namespace {

using reading::Fields;

/// The whole file. Its size is asked before a byte is read; what has no size (a pipe) is read up to
/// the limit.
std::string text_of(const std::filesystem::path& file, const std::string& name) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) reading::fail(name, {}, "no such file, expected a scene");
  if (std::filesystem::is_directory(status))
    reading::fail(name, {}, "a directory, expected a scene file");
  if (std::filesystem::is_regular_file(status)) {
    const auto size = std::filesystem::file_size(file, error);
    if (!error && size > reading::largest_text)
      reading::fail(name, {}, "the file is over 64 MiB, expected a scene of at most 64 MiB");
  }

  std::ifstream stream(file, std::ios::binary);
  if (!stream) reading::fail(name, {}, "the file cannot be opened for reading");
  std::string text;
  constexpr std::size_t chunk = std::size_t{1} << 16;
  while (stream && text.size() <= reading::largest_text) {
    const std::size_t size = text.size();
    text.resize(size + chunk);
    stream.read(text.data() + size, static_cast<std::streamsize>(chunk));
    text.resize(size + static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) reading::fail(name, {}, "the file cannot be read to its end");
  return text;
}

}  // namespace

Scene read_scene(const std::filesystem::path& file) {
  const std::string name = file.string();
  return parse_scene(text_of(file, name), name);
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
