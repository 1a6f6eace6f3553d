// Tables of a scene, in the order of its members.

#include <momenta/core/lagrangian/lagrangian_formulas.h>
#include <momenta/core/scene/file_text.h>
#include <momenta/core/scene/toml/parameters.h>
#include <momenta/core/scene/toml/parse_scene.h>
#include <momenta/core/scene/toml/read_tables.h>
#include <momenta/core/scene/toml/set_numbers.h>
#include <momenta/core/scene/validate.h>

#include <new>

namespace momenta {

Scene parse_scene(std::string_view text, const std::string& file) {
  return parse_scene(text, file, {});
}

Scene parse_scene(std::string_view text, const std::string& file,
                  const std::vector<Setting>& settings) try {
  reading::Value root = reading::parse_toml(text, file);
  reading::set_numbers(root, settings);
  const reading::Parameters parameters(root, file);
  const reading::Fields table(root, "", file, &parameters);
  table.allow({"name", "gravity", "parameters", "require", "body", "joint", "loop", "drive",
               "force", "function", "marker", "event", "visual", "assembly", "run", "lagrangian"});
  reading::check_requirements(root, parameters, file);

  Scene scene;
  scene.file = file;
  scene.name = table.text("name", "");
  scene.gravity = table.vector("gravity", {"m/s²"}, scene.gravity);
  for (const reading::Fields& t : table.tables("body", "body"))
    scene.bodies.push_back(reading::read_body(t));
  for (const reading::Fields& t : table.tables("joint", "joint"))
    scene.joints.push_back(reading::read_joint(t));
  for (const reading::Fields& t : table.tables("drive", "drive"))
    scene.drives.push_back(reading::read_drive(t));
  for (const reading::Fields& t : table.tables("loop", "loop"))
    scene.loops.push_back(reading::read_loop(t, scene.drives));
  for (const reading::Fields& t : table.tables("force", "force"))
    scene.forces.push_back(reading::read_force(t));
  for (const reading::Fields& t : table.tables("function", "function"))
    scene.functions.push_back(reading::read_function(t));
  for (const reading::Fields& t : table.tables("marker", "marker"))
    scene.markers.push_back(reading::read_marker(t));
  for (const reading::Fields& t : table.tables("event", "event"))
    scene.events.push_back(reading::read_event(t));
  for (const reading::Fields& t : table.tables("visual", "visual"))
    scene.visuals.push_back(reading::read_visual(t));
  if (const auto assembly = table.table("assembly")) {
    assembly->allow({"hold"});
    scene.held = assembly->texts("hold");
    if (const reading::Value* hold = assembly->find("hold")) scene.held_at = hold->at;
  }
  if (const auto lagrangian = table.table("lagrangian"))
    scene.lagrangian = reading::read_lagrangian(*lagrangian);
  if (const auto run = table.table("run")) scene.run = reading::read_run(*run);

  for (std::size_t i = 0; i < parameters.names().size(); ++i)
    scene.parameters.push_back({parameters.names()[i], parameters[i], parameters.used(i)});

  reading::read_formulas(table, scene);

  if (scene.bodies.empty() && !scene.lagrangian)
    reading::fail(file, {1, 1}, "no body, expected at least one [[body]]");
  validate(scene);
  if (scene.lagrangian) {
    const LagrangianFormulas formulas(scene);
    for (std::size_t i = 0; i < scene.parameters.size(); ++i)
      scene.parameters[i].used |= formulas.uses_parameter[i];
  }
  return scene;
} catch (const std::bad_alloc&) {
  reading::fail(file, {}, "the scene does not fit into memory, expected a smaller one");
}

}  // namespace momenta
