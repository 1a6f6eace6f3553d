// Tables of drives and forces.

#include <momenta/core/scene/toml/toml_text.h>

#include <algorithm>
#include <array>

namespace momenta {
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
