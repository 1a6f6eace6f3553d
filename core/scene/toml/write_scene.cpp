#include <momenta/core/scene/toml/toml_text.h>
#include <momenta/core/scene/toml/write_scene.h>

namespace momenta {
namespace {

using Eigen::Vector3d;

void write_body(const BodySpec& body, TomlText& t) {
  t.open("[[body]]");
  t.word("name", body.name);
  t.put("mass", TomlText::digits(body.mass));
  // com and inertia of a shape are written out: nothing is computed anew
  const bool shaped = !body.shape.kind.empty();
  if (shaped || !TomlText::same(body.com, Vector3d::Zero()))
    t.numbers("com", {body.com[0], body.com[1], body.com[2]});
  const Eigen::Matrix3d& m = body.inertia;
  if (shaped || body.mass > 0 || !m.isZero(0))
    t.numbers("inertia", {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)});
  if (body.any_inertia) t.put("any_inertia", "true");
  if (!shaped) return;
  std::string shape = "{ kind = " + TomlText::quoted(body.shape.kind);
  const auto size = [&](const char* key, int i) {
    shape += std::string(", ") + key + " = " + TomlText::digits(body.shape.size[i]);
  };
  const bool box = body.shape.kind == "box", point = body.shape.kind == "point";
  const Vector3d &s = body.shape.size, &a = body.shape.axis;
  if (box) shape += ", size = " + TomlText::list({s[0], s[1], s[2]});
  if (body.shape.kind == "sphere") size("radius", 0);
  if (body.shape.kind == "rod" || body.shape.kind == "cylinder") {
    size("length", 0);
    if (body.shape.kind == "cylinder") size("radius", 1);
  }
  if (!box && !point && body.shape.kind != "sphere" && !TomlText::same(a, Vector3d::UnitX()))
    shape += ", axis = " + TomlText::list({a[0], a[1], a[2]});
  t.put("shape", shape + " }");
}

void write_visual(const VisualSpec& visual, TomlText& t) {
  t.open("[[visual]]");
  t.word("body", visual.body);
  t.word("kind", visual.kind);
  const Vector3d& s = visual.size;
  if (visual.kind == "mesh") {
    t.word("file", visual.file);
    t.vector("scale", s, Vector3d::Ones());
  } else if (visual.kind == "box" || visual.kind == "ellipsoid") {
    t.numbers("size", {s[0], s[1], s[2]});
  } else {
    const bool round = visual.kind == "sphere";
    if (!round) t.put("length", TomlText::digits(s[0]));
    t.put("radius", TomlText::digits(s[round ? 0 : 1]));
  }
  t.vector("position", visual.position);
  t.rotation(visual.rotation);
  if (visual.colour) t.numbers("colour", {visual.colour->begin(), visual.colour->end()});
}

void write_lagrangian(const Scene& scene, TomlText& t) {
  const LagrangianSpec& spec = *scene.lagrangian;
  if (!scene.parameters.empty()) t.open("[parameters]");
  for (const ParameterSpec& p : scene.parameters) t.put(p.name.c_str(), TomlText::digits(p.value));
  t.open("[lagrangian]");
  std::vector<std::string> names, units;
  std::vector<double> position, velocity;
  for (const auto& c : spec.coordinates) {
    names.push_back(c.name), units.push_back(c.unit);
    position.push_back(c.position), velocity.push_back(c.velocity);
  }
  t.put("coordinates", TomlText::words(names));
  t.put("units", TomlText::words(units));
  t.numbers("position", position);
  t.numbers("velocity", velocity);
  const auto formula = [&](const char* key, const FormulaSpec& f) {
    if (!f.text.empty()) t.word(key, f.text);
  };
  formula("lagrangian", spec.lagrangian);
  formula("kinetic", spec.kinetic);
  formula("potential", spec.potential);
  std::string forces;
  for (const auto& f : spec.forces)
    forces += (forces.empty() ? "{ " : ", ") + TomlText::quoted(f.coordinate) + " = " +
              TomlText::quoted(f.value.text);
  if (!forces.empty()) t.put("force", forces + " }");
  for (const auto& c : spec.constraints) {
    t.open("[[lagrangian.constraints]]");
    t.word("name", c.name);
    t.word("equation", c.equation.text);
    if (c.angle) t.word("unit", "rad");
  }
}

void write_run(const RunDefaults& run, TomlText& t) {
  const RunDefaults usual;
  t.open("[run]");
  t.number("end", run.end_time, usual.end_time);
  if (run.step) t.put("step", TomlText::digits(*run.step));
  if (run.leak) t.put("leak", TomlText::digits(*run.leak));
  if (run.samples != usual.samples) t.put("samples", std::to_string(run.samples));
  if (run.project) t.put("project", "true");
}

}  // namespace

std::string scene_text(const Scene& scene) {
  TomlText t;
  for (const std::string& remark : scene.remarks)
    t.text += "# " + reading::on_one_line(remark) + "\n";
  if (!scene.name.empty()) t.word("name", scene.name);
  t.vector("gravity", scene.gravity);
  if (scene.lagrangian) write_lagrangian(scene, t);
  for (const BodySpec& body : scene.bodies) write_body(body, t);
  for (const JointSpec& joint : scene.joints) {
    if (joint.kind == JointKind::user)
      throw SceneError(scene.where(joint.at) + "joint " + reading::in_quotes(joint.name) +
                       " is a user joint, whose formula no file can hold; expected another kind");
    write_joint(joint, t);
  }
  for (const LoopSpec& loop : scene.loops) write_loop(loop, t);
  for (const DriveSpec& drive : scene.drives) write_drive(drive, t);
  for (const ForceSpec& force : scene.forces) write_force(force, t);
  for (const FunctionSpec& function : scene.functions) {
    t.open("[[function]]");
    t.word("name", function.name);
    if (function.kind != "cubic") t.word("kind", function.kind);
    t.numbers("x", function.x);
    t.numbers("y", function.y);
  }
  for (const MarkerSpec& marker : scene.markers) {
    t.open("[[marker]]");
    t.word("name", marker.name);
    t.word("body", marker.body);
    t.vector("point", marker.point);
  }
  for (const EventSpec& event : scene.events) {
    t.open("[[event]]");
    if (!event.name.empty()) t.word("name", event.name);
    t.word("when", event.when.text);
    if (event.direction != "both") t.word("direction", event.direction);
    if (event.stop) t.put("stop", "true");
  }
  for (const VisualSpec& visual : scene.visuals) write_visual(visual, t);
  if (!scene.held.empty()) {
    t.open("[assembly]");
    t.put("hold", TomlText::words(scene.held));
  }
  write_run(scene.run, t);
  return t.text;
}

}  // namespace momenta
