// Checks of forces: what they act on, their numbers and formulas.

#include <momenta/core/expression/spline.h>
#include <momenta/core/scene/formula.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/scene/validate_parts.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace momenta::reading {
namespace {

bool not_empty(const std::string& text) {
  return !text.empty();
}

std::string owner_of(const ForceSpec& force) {
  return force.name.empty() ? "force of kind " + in_quotes(force.kind)
                            : "force " + in_quotes(force.name);
}

void check_ends(const Census& census, const ForceSpec& force, const Subject& who) {
  census.require_body(force.parent, true, who, "parent");
  census.require_body(force.child, false, who, "child");
  who.require(force.parent != force.child, "parent and child are one body, expected two");
  who.require(force.origin_parent.allFinite() && force.origin_child.allFinite(),
              "origin must be finite [m]");
}

/// Checks limits and dead band of springs along a length.
void check_length(const ForceSpec& force, const Subject& who) {
  check_limits(force, who);
  who.require(std::isfinite(force.dead_band) && force.dead_band >= 0,
              "dead_band must be finite and >= 0 [m or rad]");
}

}  // namespace

void check_forces(const Scene& scene, const Census& census) {
  for (const ForceSpec& force : scene.forces) {
    const Subject who{scene, force.at, owner_of(force)};
    who.require(!force.limits || (force.law.empty() && (force.kind == "spring-damper" ||
                                                        force.kind == "coordinate-spring")),
                "limits are for spring-dampers and coordinate springs without a law only");
    if (force.kind == "spring-damper") {
      check_ends(census, force, who);
      who.require(std::isfinite(force.stiffness) && std::isfinite(force.damping),
                  "stiffness [N/m] and damping [N s/m] must be finite");
      who.require(std::isfinite(force.rest) && force.rest >= 0, "rest must be finite and >= 0 [m]");
      check_length(force, who);
    } else if (force.kind == "bushing") {
      check_ends(census, force, who);
      who.require(std::abs(force.rotation.norm() - 1) <= norm_slack,
                  "rotation must be a unit quaternion within 1e-6");
      who.require(std::isfinite(force.stiffness) && std::isfinite(force.damping) &&
                      std::isfinite(force.rotational_stiffness) &&
                      std::isfinite(force.rotational_damping),
                  "stiffness [N/m], damping [N s/m], rotational_stiffness [N m/rad] and "
                  "rotational_damping [N m s/rad] must be finite");
    } else if (force.kind == "coordinate-spring") {
      check_coordinates(scene, census, force, who);
      who.require(std::isfinite(force.stiffness) && std::isfinite(force.damping) &&
                      std::isfinite(force.rest),
                  "stiffness, damping and rest must be finite");
      check_length(force, who);
    } else if (force.kind == "torque") {
      census.require_one_coordinate(force.joint, who);
      who.require(std::isfinite(force.value), "value must be finite [N m or N]");
    } else if (force.kind == "wrench") {
      census.require_body(force.body, false, who, "body");
      who.require(force.point.allFinite() && force.force.allFinite() && force.torque.allFinite(),
                  "point, force and torque must be finite");
    } else {
      who.require(
          force.kind == "potential",
          "kind must be spring-damper, bushing, coordinate-spring, torque, wrench or potential");
      who.require(!force.law.empty(), "law is empty, expected the formula of V");
    }
  }
}

void check_functions(const Scene& scene) {
  for (const FunctionSpec& f : scene.functions) {
    const Subject who{scene, f.at, "function " + in_quotes(f.name)};
    who.require(is_plain_name(f.name) && !is_reserved_name(f.name),
                "the name is none that formulas can call, expected letters, digits and _, a letter "
                "first, and no function of theirs");
    who.require(
        std::find(function_kinds.begin(), function_kinds.end(), f.kind) != function_kinds.end(),
        "kind must be cubic, monotone or linear");
    const std::string fault = spline_fault(f.x, f.y, "x", "y");
    who.require(fault.empty(), fault);
  }
}

void check_formulas(const Scene& scene) {
  if (std::none_of(scene.forces.begin(), scene.forces.end(), has_formula)) return;
  const FormulaReader reader(scene);
  for (const ForceSpec& force : scene.forces) {
    if (!has_formula(force)) continue;
    const Subject who{scene, force.at, owner_of(force)};
    const bool in_components =
        std::any_of(force.force_law.begin(), force.force_law.end(), not_empty) ||
        std::any_of(force.torque_law.begin(), force.torque_law.end(), not_empty);
    who.require(!in_components || force.kind == "wrench",
                "force_law and torque_law are for wrenches only");
    who.require(force.law.empty() || (force.kind != "wrench" && force.kind != "bushing"),
                "law is for torques, spring-dampers, coordinate springs and potentials only");
    who.require(force.law.empty() || (force.stiffness == 0 && force.damping == 0 &&
                                      force.rest == 0 && force.dead_band == 0 && force.value == 0),
                "law is given beside stiffness, damping, rest, dead_band or value, expected one of "
                "them");
    const std::vector<OwnName> own = reader.own_names(force);
    each_formula(force, [&](const std::string& key, const std::string& text) {
      std::string fault;
      try {
        fault = formula_fault(scene, force, reader.read(text, own));
        if (!fault.empty()) fault = ", " + fault;
      } catch (const ExpressionError& e) {
        fault = std::string(": ") + e.what();
      }
      who.require(fault.empty(), (key + ", " + in_quotes(text) + fault));
    });
  }
}

}  // namespace momenta::reading
