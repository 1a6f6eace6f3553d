// Tables of joints and loops.

#include <momenta/core/scene/kinds.h>
#include <momenta/core/scene/toml/toml_text.h>

#include <algorithm>
#include <array>

namespace momenta {

namespace {

using Eigen::Vector3d;

/// Writes the parts common to joints and loops. `has_axis`: its kind has one.
template <class Edge>
void write_frames(const Edge& e, bool has_axis, TomlText& t) {
  write_ends(e, t);
  t.rotation(e.rotation);
  if (!has_axis) return;
  t.vector("axis", e.axis, Vector3d::UnitZ());
  t.vector("axis2", e.axis2);
  t.vector("direction", e.direction);
}

void write_bearing(const BearingSpec& bearing, TomlText& t) {
  std::string text = "{ static = " + TomlText::digits(bearing.static_friction) +
                     ", dynamic = " + TomlText::digits(bearing.dynamic_friction) +
                     ", transition = " + TomlText::digits(bearing.transition_velocity);
  if (bearing.radius != 0) text += ", radius = " + TomlText::digits(bearing.radius);
  if (bearing.length != 0) text += ", length = " + TomlText::digits(bearing.length);
  t.put("bearing", text + " }");
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

/// Writes the keys of loops with curves beside their frames.
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

}  // namespace

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

// Tables of drives and forces.

namespace {

/// Writes three components, each a number or a formula.
void write_components(const char* key, const Eigen::Vector3d& numbers,
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

}  // namespace

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

}  // namespace momenta
