// [[loop]], and sums of coordinates for couplers and coordinate springs.

#include <momenta/core/scene/kinds.h>
#include <momenta/core/scene/shapes.h>
#include <momenta/core/scene/toml/read_tables.h>
#include <momenta/core/text/near_name.h>

#include <algorithm>
#include <cmath>

namespace momenta::reading {

void read_sum(const Fields& table, std::vector<std::string>& joints, std::vector<int>& coordinates,
              std::vector<double>& ratios) {
  joints = table.texts("joints");
  if (joints.empty()) table.fail_key("joints", "names no joint, expected at least one");
  ratios = table.numbers("ratios", {});
  if (table.has("coordinates"))
    for (const double x : table.numbers("coordinates", {})) {
      const int coordinate = x >= 0 && x < 10 ? static_cast<int>(x) : -1;
      if (coordinate != x)
        table.fail_key("coordinates",
                       "has " + digits(x) + ", expected whole numbers >= 0, one for each joint");
      coordinates.push_back(coordinate);
    }
}

namespace {

/// Keys of a coupler, which ties coordinates and no bodies.
void read_coupler(const Fields& table, LoopSpec& loop) {
  table.allow({"name", "kind", "joints", "coordinates", "ratios", "powers", "offset"});
  loop.name = table.text("name");
  read_sum(table, loop.joints, loop.coordinates, loop.ratios);
  if (table.has("powers")) {
    loop.powers = table.numbers("powers", {});
    if (loop.powers.size() > 3)
      table.fail_key("powers", "has " + std::to_string(loop.powers.size()) +
                                   " entries, expected at most 3: of the second to fourth power "
                                   "of the last joint's coordinate");
  }
  loop.offset = table.number("offset", {"rad or m"}, 0);
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

/// Keys of an equation of positions or of velocities; its names are looked up once the whole scene
/// is known.
void read_equation(const Fields& table, LoopSpec& loop) {
  table.allow({"name", "kind", "equation"});
  loop.name = table.text("name");
  loop.equation = as_difference(table, table.text("equation"));
  if (loop.equation.empty())
    table.fail_key("equation", "is empty, expected a formula that is to be zero");
}

}  // namespace

LoopSpec read_loop(const Fields& table, std::span<const DriveSpec> drives) {
  LoopSpec loop;
  loop.at = table.at();
  loop.kind = static_cast<LoopKind>(read_kind(table, loop_kinds, "kind", joint_kinds, "[[joint]]"));
  const std::string kind(name_of(loop.kind));
  if (loop.kind == LoopKind::coupler) {
    read_coupler(table, loop);
    return loop;
  }
  if (has_equation(loop)) {
    read_equation(table, loop);
    return loop;
  }
  for (const std::string_view key : {"position", "velocity", "stiffness", "rest", "damping"})
    table.refuse(key,
                 "belongs to a [[joint]], expected none on a loop (a loop has no coordinates)");
  if (loop.kind == LoopKind::slot || loop.kind == LoopKind::cam || loop.kind == LoopKind::rack) {
    (loop.kind == LoopKind::slot  ? read_slot
     : loop.kind == LoopKind::cam ? read_cam
                                  : read_rack)(table, loop);
    return loop;
  }
  if (loop.kind == LoopKind::rolling) {
    read_rolling(table, loop);
    return loop;
  }
  for (const std::string_view key : {"joints", "coordinates", "ratios", "powers", "offset"})
    table.refuse(key, "has no meaning for a " + kind + " loop, expected on coupler only");
  if (!has_axis(loop.kind))
    table.refuse("axis", "has no meaning for a " + kind +
                             " loop, expected on revolute, prismatic, "
                             "universal, cylindrical and planar only");
  if (loop.kind != LoopKind::universal)
    table.refuse("axis2", "has no meaning for a " + kind + " loop, expected on universal only");
  if (loop.kind != LoopKind::planar)
    table.refuse("direction", "has no meaning for a " + kind + " loop, expected on planar only");
  if (loop.kind != LoopKind::distance)
    table.refuse("length", "has no meaning for a " + kind + " loop, expected on distance only");
  table.allow({"name", "kind", "parent", "child", "origin", "rotation", "axis", "axis2",
               "direction", "length"});

  loop.name = table.text("name");
  read_ends(table, loop);
  read_axes(table, loop);
  const auto prescribes_length = [&](const DriveSpec& drive) {
    return drive.loop == loop.name && drive.origin.empty();
  };
  if (loop.kind == LoopKind::distance &&
      (table.has("length") || std::none_of(drives.begin(), drives.end(), prescribes_length)))
    loop.length = table.number("length", {"m", Bound::positive});
  return loop;
}

}  // namespace momenta::reading
