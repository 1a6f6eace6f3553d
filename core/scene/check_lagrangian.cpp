// validate() of a Lagrangian: no bodies beside it, names that formulas can take, each of one thing,
// and L or T.

#include <momenta/core/scene/validate_parts.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

namespace momenta::reading {
namespace {

/// Letters, digits and _, a letter first in each part; parts are joined by dots.
bool is_formula_name(std::string_view name) {
  const auto letter = [](char c) {
    return std::isalpha(static_cast<unsigned char>(c)) || c == '_';
  };
  bool first = true;
  for (const char c : name) {
    if (c == '.') {
      if (first) return false;
      first = true;
      continue;
    }
    if (!letter(c) && (first || !std::isdigit(static_cast<unsigned char>(c)))) return false;
    first = false;
  }
  return !first;
}

void check_coordinates(const Scene& scene) {
  const LagrangianSpec& spec = *scene.lagrangian;
  std::set<std::string> names;
  for (const ParameterSpec& p : scene.parameters) names.insert(p.name);
  const std::size_t parameters = names.size();
  Subject{scene, spec.at, "lagrangian"}.require(!spec.coordinates.empty(),
                                                "has no coordinates, expected at least one");
  for (const auto& c : spec.coordinates) {
    const Subject who{scene, spec.at, "coordinate " + in_quotes(c.name)};
    const bool reserved = c.name == "t" || c.name == "pi" || c.name == "and" || c.name == "or" ||
                          c.name == "not" || c.name == "if" || c.name == "dot" ||
                          c.name.ends_with(".dot");
    who.require(
        is_formula_name(c.name) && !reserved,
        "has a name that formulas cannot take, expected letters, digits and _, a letter first, "
        "and none of t, pi, and, or, not, if, dot");
    who.require(
        names.insert(c.name).second,
        names.size() > parameters && std::none_of(scene.parameters.begin(), scene.parameters.end(),
                                                  [&](const auto& p) { return p.name == c.name; })
            ? "the name is taken by another coordinate, expected each once"
            : "the name is taken by a parameter, expected another");
    who.require(
        !c.unit.empty() && std::none_of(c.unit.begin(), c.unit.end(),
                                        [](char x) {
                                          return static_cast<unsigned char>(x) < 0x20 ||
                                                 std::string_view(",\"[]\x7f").find(x) !=
                                                     std::string_view::npos;
                                        }),
        "has a unit that no column can have, expected one without commas, quotes, brackets and "
        "control characters");
    who.require(std::isfinite(c.position) && std::isfinite(c.velocity),
                "position and velocity must be finite");
  }
}

std::vector<std::string_view> names_of_coordinates(const Scene& scene) {
  std::vector<std::string_view> known;
  for (const auto& c : scene.lagrangian->coordinates) known.push_back(c.name);
  return known;
}

void check_held(const Scene& scene) {
  const std::vector<std::string_view> known = names_of_coordinates(scene);
  const Subject who{scene, scene.held_at, "[assembly] hold"};
  std::set<std::string> held;
  for (const std::string& name : scene.held) {
    if (std::find(known.begin(), known.end(), name) == known.end())
      who.fail(in_quotes(name) + " is no coordinate, expected one of: " + listed(known));
    who.require(held.insert(name).second,
                ("names coordinate " + in_quotes(name) + " twice, expected once"));
  }
}

void check_forces(const Scene& scene) {
  const LagrangianSpec& spec = *scene.lagrangian;
  const std::vector<std::string_view> known = names_of_coordinates(scene);
  std::set<std::string> pushed;
  for (const auto& f : spec.forces) {
    const Subject who{scene, f.at, "force on " + in_quotes(f.coordinate)};
    if (std::find(known.begin(), known.end(), f.coordinate) == known.end())
      who.fail("is no coordinate, expected one of: " + listed(known) +
               did_you_mean(f.coordinate, known));
    who.require(pushed.insert(f.coordinate).second,
                "is given twice, expected one formula for each coordinate");
  }
}

}  // namespace

void check_lagrangian(const Scene& scene) {
  const LagrangianSpec& spec = *scene.lagrangian;
  const Subject lagrangian{scene, spec.at, "lagrangian"};
  const bool alone = scene.bodies.empty() && scene.joints.empty() && scene.loops.empty() &&
                     scene.drives.empty() && scene.forces.empty() && scene.markers.empty() &&
                     scene.visuals.empty();
  lagrangian.require(alone,
                     "stands beside bodies, joints, loops, drives, forces, markers or visuals, "
                     "expected a system of its own");
  Subject{scene, spec.at, "gravity"}.require(
      scene.gravity.isZero(0), "has no bodies to act on, expected its potential in the Lagrangian");
  check_coordinates(scene);
  lagrangian.require(spec.lagrangian.text.empty() != spec.kinetic.text.empty(),
                     spec.kinetic.text.empty()
                         ? "has neither lagrangian nor kinetic, expected one of them"
                         : "has both lagrangian and kinetic, expected one of them");
  lagrangian.require(
      spec.lagrangian.text.empty() || spec.potential.text.empty(),
      "has potential beside lagrangian, which holds it already: expected potential with kinetic");
  check_forces(scene);
  check_held(scene);
  std::set<std::string> names;
  for (const auto& c : spec.constraints) {
    const Subject who{scene, c.at, "constraint " + in_quotes(c.name)};
    who.require(
        !c.name.empty() &&
            std::none_of(c.name.begin(), c.name.end(),
                         [](char x) { return static_cast<unsigned char>(x) < 0x20 || x == 0x7f; }),
        "must have a name without control characters");
    who.require(names.insert(c.name).second,
                "the name is taken, expected each once among constraints");
    who.require(!c.equation.text.empty(), "has no equation, expected a formula");
  }
}

}  // namespace momenta::reading
