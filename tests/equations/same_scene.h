#pragma once
// Two scenes alike, bit by bit but for places in files and remarks.

#include <momenta/core/scene/scene.h>

#include <bit>
#include <cstdint>
#include <string>

namespace momenta::equations {

/// What differs first, in words; empty: nothing.
inline std::string difference(const Scene& a, const Scene& b) {
  std::string found;
  const auto note = [&](bool same, const std::string& what) {
    if (!same && found.empty()) found = what;
  };
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  const auto number = [&](double x, double y, const std::string& what) {
    note(bits(x) == bits(y), what + ": " + std::to_string(x) + " and " + std::to_string(y));
  };
  const auto numbers = [&](const auto& x, const auto& y, const std::string& what) {
    note(x.size() == y.size(), what + ": sizes");
    if (x.size() == y.size())
      for (decltype(x.size()) i = 0; i < x.size(); ++i)
        number(x.data()[i], y.data()[i], what + "[" + std::to_string(i) + "]");
  };
  const auto ends = [&](const auto& x, const auto& y, const std::string& what) {
    note(x.name == y.name && x.kind == y.kind && x.parent == y.parent && x.child == y.child,
         what + ": name, kind or bodies");
    numbers(x.origin_parent, y.origin_parent, what + " origin_parent");
    numbers(x.origin_child, y.origin_child, what + " origin_child");
  };
  const auto frames = [&](const auto& x, const auto& y, const std::string& what) {
    ends(x, y, what);
    numbers(x.rotation.coeffs(), y.rotation.coeffs(), what + " rotation");
    numbers(x.axis, y.axis, what + " axis");
    numbers(x.axis2, y.axis2, what + " axis2");
    numbers(x.direction, y.direction, what + " direction");
  };
  const auto each = [&](const auto& x, const auto& y, const std::string& what, auto compare) {
    note(x.size() == y.size(), what + ": as many");
    if (x.size() == y.size())
      for (std::size_t i = 0; i < x.size(); ++i)
        compare(x[i], y[i], what + " " + std::to_string(i));
  };

  note(a.name == b.name && a.held == b.held, "name or held joints");
  numbers(a.gravity, b.gravity, "gravity");
  note(a.lagrangian.has_value() == b.lagrangian.has_value(), "lagrangian");
  if (a.lagrangian && b.lagrangian) {
    const LagrangianSpec &x = *a.lagrangian, &y = *b.lagrangian;
    each(x.coordinates, y.coordinates, "coordinate",
         [&](const auto& one, const auto& other, const auto& what) {
           note(one.name == other.name && one.unit == other.unit, what);
           number(one.position, other.position, what + " position");
           number(one.velocity, other.velocity, what + " velocity");
         });
    note(x.lagrangian.text == y.lagrangian.text && x.kinetic.text == y.kinetic.text &&
             x.potential.text == y.potential.text,
         "L, T or V");
    each(x.forces, y.forces, "Q", [&](const auto& one, const auto& other, const auto& what) {
      note(one.coordinate == other.coordinate && one.value.text == other.value.text, what);
    });
    each(x.constraints, y.constraints, "constraint",
         [&](const auto& one, const auto& other, const auto& what) {
           note(one.name == other.name && one.equation.text == other.equation.text &&
                    one.angle == other.angle,
                what);
         });
    each(a.parameters, b.parameters, "parameter",
         [&](const auto& one, const auto& other, const auto& what) {
           note(one.name == other.name, what);
           number(one.value, other.value, what);
         });
  }
  each(a.bodies, b.bodies, "body", [&](const BodySpec& x, const BodySpec& y, const auto& what) {
    note(x.name == y.name && x.any_inertia == y.any_inertia && x.shape.kind == y.shape.kind, what);
    number(x.mass, y.mass, what + " mass");
    numbers(x.com, y.com, what + " com");
    numbers(x.inertia, y.inertia, what + " inertia");
    numbers(x.shape.size, y.shape.size, what + " shape.size");
    numbers(x.shape.axis, y.shape.axis, what + " shape.axis");
  });
  each(a.joints, b.joints, "joint", [&](const JointSpec& x, const JointSpec& y, const auto& what) {
    frames(x, y, what);
    number(x.pitch, y.pitch, what + " pitch");
    numbers(x.position, y.position, what + " position");
    numbers(x.velocity, y.velocity, what + " velocity");
    number(x.stiffness, y.stiffness, what + " stiffness");
    number(x.rest, y.rest, what + " rest");
    number(x.damping, y.damping, what + " damping");
    number(x.friction, y.friction, what + " friction");
    number(x.friction_rate, y.friction_rate, what + " friction_rate");
    note(x.bearing.has_value() == y.bearing.has_value(), what + " bearing");
    if (x.bearing && y.bearing) {
      number(x.bearing->static_friction, y.bearing->static_friction, what + " bearing.static");
      number(x.bearing->dynamic_friction, y.bearing->dynamic_friction, what + " bearing.dynamic");
      number(x.bearing->transition_velocity, y.bearing->transition_velocity,
             what + " bearing.transition");
      number(x.bearing->radius, y.bearing->radius, what + " bearing.radius");
      number(x.bearing->length, y.bearing->length, what + " bearing.length");
    }
    note(x.limits == y.limits, what + " limits");
    number(x.stop_stiffness, y.stop_stiffness, what + " stop_stiffness");
    number(x.stop_damping, y.stop_damping, what + " stop_damping");
    number(x.stop_width, y.stop_width, what + " stop_width");
    number(x.restitution.value_or(-1), y.restitution.value_or(-1), what + " restitution");
    numbers(x.rotor_inertia, y.rotor_inertia, what + " rotor_inertia");
  });
  each(a.loops, b.loops, "loop", [&](const LoopSpec& x, const LoopSpec& y, const auto& what) {
    frames(x, y, what);
    number(x.length, y.length, what + " length");
    number(x.offset, y.offset, what + " offset");
    numbers(x.ratios, y.ratios, what + " ratios");
    numbers(x.powers, y.powers, what + " powers");
    number(x.radius, y.radius, what + " radius");
    note(x.equation == y.equation, what + " equation");
    const auto curve = [&](const CurveSpec& c, const CurveSpec& d, const std::string& of) {
      note(c.kind == d.kind && c.closed == d.closed, of + " kind");
      number(c.radius, d.radius, of + " radius");
      for (std::size_t i = 0; i < 2; ++i) number(c.semi_axes[i], d.semi_axes[i], of + " semi_axes");
      note(c.direction == d.direction && c.points == d.points, of + " points");
    };
    curve(x.curve, y.curve, what + " curve");
    curve(x.child_curve, y.child_curve, what + " child_curve");
    note(x.joints == y.joints && x.coordinates == y.coordinates, what + " joints");
  });
  each(a.drives, b.drives, "drive", [&](const DriveSpec& x, const DriveSpec& y, const auto& what) {
    note(x.joint == y.joint && x.loop == y.loop && x.coordinate == y.coordinate &&
             x.origin == y.origin && x.kind == y.kind,
         what);
    for (const auto member :
         {&DriveSpec::offset, &DriveSpec::amplitude, &DriveSpec::frequency, &DriveSpec::phase,
          &DriveSpec::from, &DriveSpec::to, &DriveSpec::start, &DriveSpec::duration})
      number(x.*member, y.*member, what);
    numbers(x.coefficients, y.coefficients, what + " coefficients");
    note(x.law == y.law, what + " law");
    numbers(x.times, y.times, what + " times");
    numbers(x.values, y.values, what + " values");
  });
  each(a.forces, b.forces, "force", [&](const ForceSpec& x, const ForceSpec& y, const auto& what) {
    ends(x, y, what);
    note(x.joint == y.joint && x.body == y.body && x.in_body_axes == y.in_body_axes, what);
    for (const auto member :
         {&ForceSpec::stiffness, &ForceSpec::damping, &ForceSpec::rest, &ForceSpec::value,
          &ForceSpec::rotational_stiffness, &ForceSpec::rotational_damping})
      number(x.*member, y.*member, what);
    note(x.joints == y.joints && x.coordinates == y.coordinates, what + " joints");
    note(x.law == y.law && x.force_law == y.force_law && x.torque_law == y.torque_law,
         what + " formulas");
    numbers(x.ratios, y.ratios, what + " ratios");
    numbers(x.rotation.coeffs(), y.rotation.coeffs(), what + " rotation");
    numbers(x.point, y.point, what + " point");
    numbers(x.force, y.force, what + " force");
    numbers(x.torque, y.torque, what + " torque");
  });
  each(a.functions, b.functions, "function",
       [&](const FunctionSpec& x, const FunctionSpec& y, const auto& what) {
         note(x.kind == y.kind, what + " kind");
         numbers(x.x, y.x, what + " x");
         numbers(x.y, y.y, what + " y");
       });
  each(a.markers, b.markers, "marker",
       [&](const MarkerSpec& x, const MarkerSpec& y, const auto& what) {
         note(x.name == y.name && x.body == y.body, what);
         numbers(x.point, y.point, what);
       });
  each(a.events, b.events, "event", [&](const EventSpec& x, const EventSpec& y, const auto& what) {
    note(x.name == y.name && x.when.text == y.when.text && x.direction == y.direction &&
             x.stop == y.stop,
         what);
  });
  each(a.visuals, b.visuals, "visual",
       [&](const VisualSpec& x, const VisualSpec& y, const auto& what) {
         note(x.body == y.body && x.kind == y.kind && x.file == y.file &&
                  x.colour.has_value() == y.colour.has_value(),
              what);
         numbers(x.size, y.size, what + " size");
         numbers(x.position, y.position, what + " position");
         numbers(x.rotation.coeffs(), y.rotation.coeffs(), what + " rotation");
         if (x.colour && y.colour) numbers(*x.colour, *y.colour, what + " colour");
       });
  number(a.run.end_time, b.run.end_time, "run end");
  number(a.run.step.value_or(-1), b.run.step.value_or(-1), "run step");
  number(a.run.leak.value_or(-1), b.run.leak.value_or(-1), "run leak");
  note(a.run.samples == b.run.samples && a.run.project == b.run.project, "run");
  return found;
}

}  // namespace momenta::equations
