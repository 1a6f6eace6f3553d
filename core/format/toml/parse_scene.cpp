// Tables of a scene, in the order of its members, and [run].

#include <momenta/core/format/toml/parameters.h>
#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/core/format/toml/scene_keys.h>
#include <momenta/core/format/toml/set_numbers.h>
#include <momenta/core/scene/file_text.h>
#include <momenta/core/scene/lagrangian/lagrangian_formulas.h>
#include <momenta/core/scene/validate.h>

#include <new>

namespace momenta {

void reading::declare(Keys& t, RunDefaults& run) {
  const RunDefaults usual;
  t.number("end", run.end_time, {"s", Bound::positive}, usual.end_time);
  t.optional("step", run.step, {"s", Bound::positive});
  t.optional("leak", run.leak, {"1/s", Bound::positive});
  t.whole("samples", run.samples, 1, usual.samples);
  t.value_or("project", run.project, false);
}

namespace {

/// Reads the tables of [[key]]. `others`: what their declaration takes beside them.
template <class Spec, class... Others>
void read_all(const reading::Fields& scene, std::string_view key, std::vector<Spec>& specs,
              const Others&... others) {
  for (const reading::Fields& table : scene.tables(key, key)) {
    Spec& spec = specs.emplace_back();
    spec.at = table.at();
    if constexpr (requires { reading::read_kind_of(table, spec); })
      reading::read_kind_of(table, spec);
    reading::Keys::read(table,
                        [&](reading::Keys& keys) { reading::declare(keys, spec, others...); });
  }
}

}  // namespace

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
  read_all(table, "body", scene.bodies);
  read_all(table, "joint", scene.joints);
  read_all(table, "drive", scene.drives);
  read_all(table, "loop", scene.loops, std::span<const DriveSpec>(scene.drives));
  read_all(table, "force", scene.forces);
  read_all(table, "function", scene.functions);
  read_all(table, "marker", scene.markers);
  read_all(table, "event", scene.events);
  read_all(table, "visual", scene.visuals);
  if (const auto assembly = table.table("assembly")) {
    assembly->allow({"hold"});
    scene.held = assembly->texts("hold");
    if (const reading::Value* hold = assembly->find("hold")) scene.held_at = hold->at;
  }
  if (const auto lagrangian = table.table("lagrangian")) {
    LagrangianSpec& spec = scene.lagrangian.emplace();
    spec.at = lagrangian->at();
    reading::Keys::read(*lagrangian, [&](reading::Keys& keys) { declare(keys, spec); });
  }
  if (const auto run = table.table("run"))
    reading::Keys::read(*run, [&](reading::Keys& keys) { declare(keys, scene.run); });

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
