#include <momenta/core/scene/kinds.h>
#include <momenta/core/scene/toml/write_scene.h>
#include <momenta/core/text/near_name.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace momenta {
namespace {

using Eigen::Vector3d;

/// TOML in the making: tables with keys that differ from their default.
class TomlText {
 public:
  std::string text;

  void open(const char* header) { text += std::string("\n") + header + "\n"; }
  void put(const char* key, const std::string& value) {
    text += std::string(key) + " = " + value + "\n";
  }
  void word(const char* key, const std::string& value) { put(key, quoted(value)); }
  void number(const char* key, double value, double otherwise = 0) {
    if (!same(value, otherwise)) put(key, digits(value));
  }
  void numbers(const char* key, const std::vector<double>& values) { put(key, list(values)); }
  void vector(const char* key, const Vector3d& v, const Vector3d& otherwise = Vector3d::Zero()) {
    if (!same(v, otherwise)) put(key, list({v[0], v[1], v[2]}));
  }

  void rotation(const Eigen::Quaterniond& r) {
    if (!same(r.w(), 1) || !same(r.vec(), Vector3d::Zero()))
      put("rotation", "{ quaternion = " + list({r.w(), r.x(), r.y(), r.z()}) + " }");
  }

  /// TOML's whole numbers have no minus zero and end at 2^63.
  static std::string digits(double value) {
    const bool large = std::abs(value) >= 1e15, minus_zero = value == 0 && std::signbit(value);
    std::string text = reading::digits(value);
    if ((large || minus_zero) && text.find_first_of(".e") == std::string::npos) text += ".0";
    return text;
  }
  static std::string list(const std::vector<double>& values) {
    std::string all;
    for (const double value : values) all += (all.empty() ? "" : ", ") + digits(value);
    return "[" + all + "]";
  }
  static std::string words(const std::vector<std::string>& values) {
    std::string all;
    for (const std::string& value : values) all += (all.empty() ? "" : ", ") + quoted(value);
    return "[" + all + "]";
  }
  static std::string quoted(const std::string& value) {
    static constexpr char hex[] = "0123456789abcdef";
    std::string all = "\"";
    for (const char c : value) {
      const auto byte = static_cast<unsigned char>(c);
      if (c == '"' || c == '\\') all += '\\';
      if (byte < 0x20 || byte == 0x7f) {
        all += "\\u00";
        all += hex[byte >> 4];
        all += hex[byte & 15];
      } else {
        all += c;
      }
    }
    return all + "\"";
  }
  static bool same(double a, double b) { return a == b && std::signbit(a) == std::signbit(b); }
  static bool same(const Vector3d& a, const Vector3d& b) {
    return same(a[0], b[0]) && same(a[1], b[1]) && same(a[2], b[2]);
  }
};

void write_body(const BodySpec& body, TomlText& t) {
  t.open("[[body]]");
  t.word("name", body.name);
  t.put("mass", TomlText::digits(body.mass));
  // what a shape would give is written out, so that nothing is computed once more
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

/// Two bodies and a point on each.
template <class Edge>
void write_ends(const Edge& e, TomlText& t) {
  if (e.parent != "ground") t.word("parent", e.parent);
  t.word("child", e.child);
  const bool one = !TomlText::same(e.origin_parent, Vector3d::Zero());
  const bool two = !TomlText::same(e.origin_child, Vector3d::Zero());
  const auto three = [](const Vector3d& v) { return TomlText::list({v[0], v[1], v[2]}); };
  if (one || two)
    t.put("origin", "{ " + (one ? "parent = " + three(e.origin_parent) : std::string()) +
                        (one && two ? ", " : "") +
                        (two ? "child = " + three(e.origin_child) : std::string()) + " }");
}

/// What joints and loops have alike. `has_axis`: of this kind.
template <class Edge>
void write_frames(const Edge& e, bool has_axis, TomlText& t) {
  write_ends(e, t);
  t.rotation(e.rotation);
  if (!has_axis) return;
  t.vector("axis", e.axis, Vector3d::UnitZ());
  t.vector("axis2", e.axis2);
  t.vector("direction", e.direction);
}

/// Limits and stops of a joint or of a force along a length.
template <class Spec>
void write_limits(const Spec& spec, TomlText& t) {
  if (spec.limits) t.numbers("limits", {(*spec.limits)[0], (*spec.limits)[1]});
  t.number("stop_stiffness", spec.stop_stiffness);
  t.number("stop_damping", spec.stop_damping);
  t.number("stop_width", spec.stop_width, Spec{}.stop_width);
}

void write_bearing(const BearingSpec& bearing, TomlText& t) {
  std::string text = "{ static = " + TomlText::digits(bearing.static_friction) +
                     ", dynamic = " + TomlText::digits(bearing.dynamic_friction) +
                     ", transition = " + TomlText::digits(bearing.transition_velocity);
  if (bearing.radius != 0) text += ", radius = " + TomlText::digits(bearing.radius);
  if (bearing.length != 0) text += ", length = " + TomlText::digits(bearing.length);
  t.put("bearing", text + " }");
}

void write_joint(const JointSpec& joint, TomlText& t) {
  t.open("[[joint]]");
  t.word("name", joint.name);
  t.word("kind", std::string(reading::name_of(joint.kind)));
  write_frames(joint, reading::has_axis(joint.kind), t);
  if (joint.kind == JointKind::helical) t.put("pitch", TomlText::digits(joint.pitch));
  if (!joint.position.empty()) t.numbers("position", joint.position);
  if (!joint.velocity.empty()) t.numbers("velocity", joint.velocity);
  t.number("stiffness", joint.stiffness);
  t.number("rest", joint.rest);
  t.number("damping", joint.damping);
  t.number("friction", joint.friction);
  t.number("friction_rate", joint.friction_rate, JointSpec{}.friction_rate);
  if (joint.bearing) write_bearing(*joint.bearing, t);
  if (!joint.rotor_inertia.empty()) t.numbers("rotor_inertia", joint.rotor_inertia);
  write_limits(joint, t);
  if (joint.restitution) t.put("restitution", TomlText::digits(*joint.restitution));
}

/// Σ ratios q of joints.
template <class Sum>
void write_sum(const Sum& sum, TomlText& t) {
  t.put("joints", TomlText::words(sum.joints));
  t.numbers("ratios", sum.ratios);
  if (!sum.coordinates.empty())
    t.numbers("coordinates", {sum.coordinates.begin(), sum.coordinates.end()});
}

std::string list_of(const std::vector<Vector3d>& points) {
  std::string all;
  for (const Vector3d& p : points)
    all += (all.empty() ? "" : ", ") + TomlText::list({p[0], p[1], p[2]});
  return "[" + all + "]";
}

/// The outline of one body of a cam.
std::string outline(const CurveSpec& curve) {
  const Vector3d& d = curve.direction;
  const auto along = [&](const char* key) {
    return std::string(", ") + key + " = " + TomlText::list({d[0], d[1], d[2]});
  };
  std::string text = "{ kind = " + TomlText::quoted(curve.kind);
  if (curve.kind == "circle") text += ", radius = " + TomlText::digits(curve.radius);
  if (curve.kind == "ellipse") {
    text += ", semi_axes = " + TomlText::list({curve.semi_axes[0], curve.semi_axes[1]});
    if (!d.isZero(0)) text += along("direction");
  }
  if (curve.kind == "flat") text += along("normal");
  if (curve.kind == "spline") text += ", points = " + list_of(curve.points);
  return text + " }";
}

/// What loops with curves have beside their frames.
void write_curves(const LoopSpec& loop, TomlText& t) {
  if (loop.kind == LoopKind::slot && !loop.curve.kind.empty()) {
    t.word("curve", loop.curve.kind);
    if (loop.curve.kind == "circle") t.put("radius", TomlText::digits(loop.curve.radius));
    if (loop.curve.kind == "spline") t.put("points", list_of(loop.curve.points));
    if (loop.curve.closed) t.put("closed", "true");
  }
  if (loop.kind == LoopKind::cam)
    t.put("profile",
          "{ parent = " + outline(loop.curve) + ", child = " + outline(loop.child_curve) + " }");
  if (loop.kind == LoopKind::rack) {
    t.put("radius", TomlText::digits(loop.radius));
    t.number("offset", loop.offset);
  }
  if (loop.kind == LoopKind::rolling) {
    t.vector("normal", loop.normal, Vector3d::UnitZ());
    t.put("radius", TomlText::digits(loop.radius));
    t.number("crown_radius", loop.crown_radius);
  }
}

void write_loop(const LoopSpec& loop, TomlText& t) {
  t.open("[[loop]]");
  t.word("name", loop.name);
  t.word("kind", std::string(reading::name_of(loop.kind)));
  if (loop.kind == LoopKind::coupler) {
    write_sum(loop, t);
    if (!loop.powers.empty()) t.numbers("powers", loop.powers);
    t.number("offset", loop.offset);
    return;
  }
  if (has_equation(loop)) return t.word("equation", loop.equation);
  write_frames(loop, reading::has_axis(loop.kind), t);
  if (loop.kind == LoopKind::distance) t.number("length", loop.length);
  write_curves(loop, t);
}

void write_drive(const DriveSpec& drive, TomlText& t) {
  t.open("[[drive]]");
  if (drive.joint.empty())
    t.word("loop", drive.loop);
  else
    t.word("joint", drive.joint);
  if (!drive.origin.empty())
    t.word("origin", drive.origin);
  else if (drive.coordinate != 0)
    t.put("coordinate", std::to_string(drive.coordinate));
  t.word("kind", drive.kind);
  if (drive.kind == "polynomial") t.numbers("coefficients", drive.coefficients);
  if (drive.kind == "harmonic") {
    t.put("amplitude", TomlText::digits(drive.amplitude));
    t.put("frequency", TomlText::digits(drive.frequency));
    t.number("offset", drive.offset);
    t.number("phase", drive.phase);
  }
  if (drive.kind == "step") {
    t.put("to", TomlText::digits(drive.to));
    t.put("duration", TomlText::digits(drive.duration));
    t.number("from", drive.from);
    t.number("start", drive.start);
  }
  if (drive.kind == "table") {
    t.numbers("times", drive.times);
    t.numbers("values", drive.values);
  }
  if (drive.kind == "formula") t.word("law", drive.law);
}

/// Three components, each a number or a formula.
void write_components(const char* key, const Vector3d& numbers,
                      const std::array<std::string, 3>& formulas, TomlText& t) {
  if (std::all_of(formulas.begin(), formulas.end(), [](const auto& f) { return f.empty(); }))
    return t.vector(key, numbers);
  std::string all;
  for (std::size_t i = 0; i < 3; ++i)
    all += (i > 0 ? ", " : "") + (formulas[i].empty()
                                      ? TomlText::digits(numbers[static_cast<Eigen::Index>(i)])
                                      : TomlText::quoted(formulas[i]));
  t.put(key, "[" + all + "]");
}

void write_force(const ForceSpec& force, TomlText& t) {
  t.open("[[force]]");
  if (!force.name.empty()) t.word("name", force.name);
  t.word("kind", force.kind);
  if (!force.law.empty()) t.word(force.kind == "potential" ? "V" : "law", force.law);
  if (force.kind == "spring-damper") {
    write_ends(force, t);
    t.number("stiffness", force.stiffness);
    t.number("damping", force.damping);
    t.number("rest", force.rest);
    t.number("dead_band", force.dead_band);
    write_limits(force, t);
  } else if (force.kind == "bushing") {
    write_ends(force, t);
    t.rotation(force.rotation);
    t.number("stiffness", force.stiffness);
    t.number("damping", force.damping);
    t.number("rotational_stiffness", force.rotational_stiffness);
    t.number("rotational_damping", force.rotational_damping);
  } else if (force.kind == "coordinate-spring") {
    write_sum(force, t);
    t.number("stiffness", force.stiffness);
    t.number("damping", force.damping);
    t.number("rest", force.rest);
    t.number("dead_band", force.dead_band);
    write_limits(force, t);
  } else if (force.kind == "torque") {
    t.word("joint", force.joint);
    if (force.law.empty()) t.put("value", TomlText::digits(force.value));
  } else if (force.kind == "wrench") {
    t.word("body", force.body);
    t.vector("point", force.point);
    write_components("force", force.force, force.force_law, t);
    write_components("torque", force.torque, force.torque_law, t);
    if (force.in_body_axes) t.word("axes", "body");
  }
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
