// [[loop]], and sums of coordinates for couplers and coordinate springs. Curves of slots and cams:
// curve_keys.cpp.

#include <momenta/core/format/toml/curve_keys.h>
#include <momenta/core/format/toml/scene_keys.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <initializer_list>

namespace momenta::reading {

void declare_sum(Keys& t, std::vector<std::string>& joints, std::vector<int>& coordinates,
                 std::vector<double>& ratios) {
  t.value("joints", joints);
  if (t.reads() && joints.empty())
    t.in().fail_key("joints", "names no joint, expected at least one");
  t.place(1);
  std::vector<double> numbers(coordinates.begin(), coordinates.end());
  t.optional("coordinates", numbers);
  if (t.reads())
    for (const double x : numbers) {
      const int coordinate = x >= 0 && x < 10 ? static_cast<int>(x) : -1;
      if (coordinate != x)
        t.in().fail_key("coordinates",
                        "has " + digits(x) + ", expected whole numbers >= 0, one for each joint");
      coordinates.push_back(coordinate);
    }
  t.place(0);
  t.value("ratios", ratios, {});
  t.place(1);
}

namespace {

/// Keys of a coupler, which ties coordinates and no bodies.
void declare_coupler(Keys& t, LoopSpec& loop) {
  declare_sum(t, loop.joints, loop.coordinates, loop.ratios);
  t.optional("powers", loop.powers);
  if (t.reads() && loop.powers.size() > 3)
    t.in().fail_key("powers", "has " + std::to_string(loop.powers.size()) +
                                  " entries, expected at most 3: of the second to fourth power "
                                  "of the last joint's coordinate");
  t.number("offset", loop.offset, {"rad or m"});
}

/// "left = right" as left − right. Names in quotes may have any characters.
std::string as_difference(const Fields& table, const std::string& text) {
  std::size_t sign = std::string::npos;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\'') quoted = !quoted;
    if (quoted || text[i] != '=') continue;
    if (i > 0 && text[i - 1] == ':')
      table.fail_key("equation",
                     "has ':=' in it, which equations do not take, expected them whole");
    const bool compares =
        (i > 0 && std::string_view("=<>!").find(text[i - 1]) != std::string::npos) ||
        (i + 1 < text.size() && text[i + 1] == '=');
    if (compares) continue;
    if (sign != std::string::npos)
      table.fail_key("equation", "has two '=', expected one, or a formula that is to be zero");
    sign = i;
  }
  if (sign == std::string::npos) return text;
  const auto blank = [](std::string_view side) {
    return side.find_first_not_of(" \t\n") == std::string_view::npos;
  };
  if (blank(std::string_view(text).substr(0, sign)) ||
      blank(std::string_view(text).substr(sign + 1)))
    table.fail_key("equation", "has nothing on one side of '=', expected a formula on either");
  return "(" + text.substr(0, sign) + ") - (" + text.substr(sign + 1) + ")";
}

/// The key of an equation of positions or of velocities; its names are looked up once the whole
/// scene is known.
void declare_equation(Keys& t, LoopSpec& loop) {
  t.value("equation", loop.equation);
  if (!t.reads()) return;
  loop.equation = as_difference(t.in(), loop.equation);
  if (loop.equation.empty())
    t.in().fail_key("equation", "is empty, expected a formula that is to be zero");
}

/// Refuses the keys that a loop of this kind, the same as a joint's, cannot have.
void refuse_keys(Keys& t, LoopKind kind) {
  const auto only = [&](std::initializer_list<std::string_view> keys, bool has, const char* kinds) {
    for (const std::string_view key : keys)
      if (!has)
        t.refuse(key, "has no meaning for a " + std::string(name_of(kind)) + " loop, expected on " +
                          kinds + " only");
  };
  only({"joints", "coordinates", "ratios", "powers", "offset"}, false, "coupler");
  only({"axis"}, has_axis(kind), "revolute, prismatic, universal, cylindrical and planar");
  only({"axis2"}, kind == LoopKind::universal, "universal");
  only({"direction"}, kind == LoopKind::planar, "planar");
  only({"length"}, kind == LoopKind::distance, "distance");
}

/// Keys of a loop that is a joint or a distance, beside its bodies and points.
void declare_pair(Keys& t, LoopSpec& loop, std::span<const DriveSpec> drives) {
  if (t.names()) refuse_keys(t, loop.kind);
  if (has_axis(loop.kind) || !t.writes()) {
    t.direction("axis", loop.axis, Eigen::Vector3d::UnitZ());
    declare_second(t, "axis2", loop.axis2, loop);
    declare_second(t, "direction", loop.direction, loop);
  }
  const auto prescribes_length = [&](const DriveSpec& drive) {
    return drive.loop == loop.name && drive.origin.empty();
  };
  const bool distance = loop.kind == LoopKind::distance;
  if (t.has("length", distance && loop.length != 0) ||
      (distance && t.reads() && std::none_of(drives.begin(), drives.end(), prescribes_length)))
    t.value("length", loop.length, {"m", Bound::positive});
}

}  // namespace

void read_kind_of(const Fields& table, LoopSpec& loop) {
  loop.kind = static_cast<LoopKind>(read_kind(table, loop_kinds, "kind", joint_kinds, "[[joint]]"));
  if (loop.kind == LoopKind::coupler || has_equation(loop)) return;
  for (const std::string_view key : {"position", "velocity", "stiffness", "rest", "damping"})
    table.refuse(key,
                 "belongs to a [[joint]], expected none on a loop (a loop has no coordinates)");
  if (loop.kind == LoopKind::slot) read_kind_of_slot(table, loop);
}

void declare(Keys& t, LoopSpec& loop, std::span<const DriveSpec> drives) {
  t.value("name", loop.name);
  t.word("kind", name_of(loop.kind));
  if (loop.kind == LoopKind::coupler) return declare_coupler(t, loop);
  if (has_equation(loop)) return declare_equation(t, loop);
  declare_ends(t, loop);
  t.rotation(loop.rotation);
  switch (loop.kind) {
    case LoopKind::slot:
      return declare_slot(t, loop);
    case LoopKind::cam:
      return declare_cam(t, loop);
    case LoopKind::rack:
      return declare_rack(t, loop);
    case LoopKind::rolling:
      return declare_rolling(t, loop);
    default:
      return declare_pair(t, loop, drives);
  }
}

}  // namespace momenta::reading
