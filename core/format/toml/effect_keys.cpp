// [[drive]], [[force]], [[function]] and [[event]].

#include <momenta/core/expression/spline.h>
#include <momenta/core/format/toml/scene_keys.h>
#include <momenta/core/scene/drive.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <array>
#include <initializer_list>

namespace momenta::reading {

void read_kind_of(const Fields& table, DriveSpec& drive) {
  drive.kind = drive_kinds.at(read_kind(table, drive_kinds));
}

namespace {

/// The keys of a drive's law. The unit of the driven number, rad or m, is not known here.
void declare_law(Keys& t, DriveSpec& drive) {
  constexpr Quantity coordinate{};
  constexpr int optional = 2, required = 1;  // places
  t.place(required);
  if (drive.kind == "polynomial") t.value("coefficients", drive.coefficients, coordinate);
  if (drive.kind == "harmonic") {
    t.place(optional);
    t.number("offset", drive.offset, coordinate);
    t.place(required);
    t.value("amplitude", drive.amplitude, coordinate);
    t.value("frequency", drive.frequency, {"rad/s"});
    t.place(optional);
    t.number("phase", drive.phase, {"rad"});
  }
  if (drive.kind == "step") {
    t.place(optional);
    t.number("from", drive.from, coordinate);
    t.place(required);
    t.value("to", drive.to, coordinate);
    t.place(optional);
    t.number("start", drive.start, {"s"});
    t.place(required);
    t.value("duration", drive.duration, {"s", Bound::positive});
  }
  if (drive.kind == "table") {
    t.value("times", drive.times, {"s"});
    t.value("values", drive.values, coordinate);
  }
  if (drive.kind == "formula") t.formula("law", drive.law);
  t.place(0);
}

/// What a drive moves: a coordinate of a joint or a loop, or a component of a loop's origin.
void declare_driven(Keys& t, DriveSpec& drive) {
  const bool of_loop = t.reads() ? t.in().has("loop") : drive.joint.empty();
  if (t.reads() && of_loop && t.in().has("joint"))
    t.in().fail_key("loop", "is given beside joint, expected one of them");
  if (t.reads() && !of_loop)
    t.in().refuse("origin", "belongs to the drive of a loop, expected none on that of a joint");
  if (!of_loop || t.names()) t.value("joint", drive.joint);
  if (of_loop || t.names()) t.value("loop", drive.loop);
  if (drive.origin.empty() || !t.writes()) t.whole("coordinate", drive.coordinate, 0, 0);
  t.value_or("origin", drive.origin, "");
  t.word("kind", drive.kind);
  if (!t.reads() || !t.in().has("origin")) return;
  if (drive.origin != "x" && drive.origin != "y" && drive.origin != "z")
    t.in().fail_key("origin", "is " + in_quotes(drive.origin) +
                                  ", expected \"x\", \"y\" or \"z\" of the loop's origin.parent");
  t.in().refuse("coordinate", "is given beside origin, expected one of them");
}

}  // namespace

void declare(Keys& t, DriveSpec& drive) {
  declare_law(t, drive);
  declare_driven(t, drive);
  if (!t.reads() || drive.kind == "formula") return;  // judged by read_formulas()
  if (const std::string fault = law_fault(drive); !fault.empty())
    t.in().fail_at(t.in().at(), fault);
}

void read_kind_of(const Fields& table, ForceSpec& force) {
  force.kind = force_kinds.at(read_kind(table, force_kinds));
}

namespace {

/// The formula in `law`, without the keys that it replaces.
void declare_law(Keys& t, ForceSpec& force, std::initializer_list<std::string_view> instead_of) {
  t.place(-1);
  if (t.names() || (t.writes() ? !force.law.empty() : t.in().has("law"))) {
    for (const std::string_view key : instead_of)
      if (t.reads()) t.in().refuse(key, "is given beside law, expected one of them");
    t.formula("law", force.law);
  }
  t.place(0);
}

/// A spring and a damper along a length in `unit`, with stops that push back by `push`, or a law.
void declare_spring(Keys& t, ForceSpec& force, const std::string& unit, const std::string& push,
                    const std::string& stiffness, const std::string& damping, Bound rest) {
  t.number("stiffness", force.stiffness, {stiffness});
  t.number("damping", force.damping, {damping});
  t.number("rest", force.rest, {unit, rest});
  t.number("dead_band", force.dead_band, {unit, Bound::not_negative});
  declare_limits(t, unit, push, force);
  declare_law(t, force, {"stiffness", "damping", "rest", "dead_band", "limits"});
}

/// Three components, each a number or a formula.
void declare_components(Keys& t, std::string_view key, Quantity quantity, Eigen::Vector3d& numbers,
                        std::array<std::string, 3>& formulas) {
  const auto written = [&]() -> std::string {
    if (std::all_of(formulas.begin(), formulas.end(), [](const auto& f) { return f.empty(); }))
      return toml_text::same(numbers, Eigen::Vector3d::Zero()) ? "" : toml_text::of(numbers);
    std::string all;
    for (std::size_t i = 0; i < 3; ++i)
      all += (i > 0 ? ", " : "") + (formulas[i].empty()
                                        ? toml_text::of(numbers[static_cast<Eigen::Index>(i)])
                                        : toml_text::of(formulas[i]));
    return "[" + all + "]";
  };
  t.key(
      key, [&](const Fields& in) { in.vector_or_formulas(key, quantity, numbers, formulas); },
      written);
}

void declare_wrench(Keys& t, ForceSpec& force) {
  t.value("body", force.body);
  t.vector("point", force.point, {"m"});
  declare_components(t, "force", {"N"}, force.force, force.force_law);
  declare_components(t, "torque", {"N m"}, force.torque, force.torque_law);
  std::string axes = force.in_body_axes ? "body" : "ground";
  t.value_or("axes", axes, "ground");
  if (axes != "ground" && axes != "body")
    t.in().fail_key("axes", "is " + in_quotes(axes) + ", expected \"ground\" or \"body\"");
  force.in_body_axes = axes == "body";
}

}  // namespace

void declare(Keys& t, ForceSpec& force) {
  t.place(-1);
  t.optional_name(force.name);
  t.word("kind", force.kind);
  t.place(0);
  if (force.kind == "spring-damper") {
    declare_ends(t, force);
    declare_spring(t, force, "m", "N", "N/m", "N s/m", Bound::not_negative);
  } else if (force.kind == "bushing") {
    declare_ends(t, force);
    t.rotation(force.rotation);
    t.number("stiffness", force.stiffness, {"N/m"});
    t.number("damping", force.damping, {"N s/m"});
    t.number("rotational_stiffness", force.rotational_stiffness, {"N m/rad"});
    t.number("rotational_damping", force.rotational_damping, {"N m s/rad"});
  } else if (force.kind == "coordinate-spring") {
    declare_sum(t, force.joints, force.coordinates, force.ratios);
    declare_spring(t, force, "rad or m", "N m or N", "N m/rad or N/m", "N m s/rad or N s/m",
                   Bound::none);
  } else if (force.kind == "torque") {
    t.value("joint", force.joint);
    if (t.names() || (t.writes() ? force.law.empty() : !t.in().has("law")))
      t.value("value", force.value, {"N m or N"});
    declare_law(t, force, {"value"});
  } else if (force.kind == "potential") {
    t.formula("V", force.law);
  } else if (force.kind == "wrench") {
    declare_wrench(t, force);
  }
}

void declare(Keys& t, FunctionSpec& function) {
  t.value("name", function.name);
  t.choice("kind", function.kind, function_kinds);
  const bool of_file = t.reads() && t.in().has("file");
  if (t.names()) t.word("file", "");
  if (of_file) read_columns(t.in(), function);
  if (of_file) return;
  t.value("x", function.x, {});
  t.value("y", function.y, {});
  if (!t.reads()) return;
  if (const std::string fault = spline_fault(function.x, function.y, "x", "y"); !fault.empty())
    t.in().fail_at(t.in().at(), fault);
}

void declare(Keys& t, EventSpec& event) {
  t.optional_name(event.name);
  t.value("when", event.when.text);
  if (t.reads()) event.when.at = t.in().find("when")->at;
  t.choice("direction", event.direction, event_directions);
  t.value_or("stop", event.stop, false);
}

}  // namespace momenta::reading
