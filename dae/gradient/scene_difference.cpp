#include <momenta/core/format/toml/write_scene.h>
#include <momenta/dae/gradient/scene_difference.h>

#include <algorithm>
#include <utility>

namespace momenta {
namespace {

/// Whether a formula has the name as a word.
bool has_word(const std::string& formula, const std::string& name) {
  const auto of_word = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  for (std::size_t i = formula.find(name); i != std::string::npos; i = formula.find(name, i + 1))
    if ((i == 0 || !of_word(formula[i - 1])) &&
        (i + name.size() == formula.size() || !of_word(formula[i + name.size()])))
      return true;
  return false;
}

/// Formulas during a run: there a parameter is no number of the tables.
std::vector<std::string> formulas_of(const Scene& scene, bool with_drives) {
  std::vector<std::string> all;
  for (const ForceSpec& force : scene.forces) {
    all.push_back(force.law);
    all.insert(all.end(), force.force_law.begin(), force.force_law.end());
    all.insert(all.end(), force.torque_law.begin(), force.torque_law.end());
  }
  for (const LoopSpec& loop : scene.loops) all.push_back(loop.equation);
  if (with_drives)
    for (const DriveSpec& drive : scene.drives) all.push_back(drive.law);
  return all;
}

template <class Spec, class... Member>
void take(Spec& to, const Spec& from, Member Spec::*... members) {
  ((to.*members = from.*members), ...);
}

/// Whether a force acts along one length; linear in it, unless `known` is all.
bool is_spring(const ForceSpec& force, Forces known) {
  return (force.kind == "spring-damper" || force.kind == "coordinate-spring") &&
         force.law.empty() && (known == Forces::all || (force.dead_band == 0 && !has_stops(force)));
}
bool has_no_formulas(const ForceSpec& wrench) {
  const auto empty = [](const std::string& law) { return law.empty(); };
  return std::all_of(wrench.force_law.begin(), wrench.force_law.end(), empty) &&
         std::all_of(wrench.torque_law.begin(), wrench.torque_law.end(), empty);
}

/// Copies what slopes by numbers know without places of joints and loops.
void take_inertias_and_forces(Scene& other, const Scene& own, Forces known) {
  other.gravity = own.gravity;
  other.parameters = own.parameters;
  for (std::size_t i = 0; i < own.bodies.size(); ++i)
    take(other.bodies[i], own.bodies[i], &BodySpec::mass, &BodySpec::com, &BodySpec::inertia,
         &BodySpec::shape);
  for (std::size_t i = 0; i < own.joints.size(); ++i)
    take(other.joints[i], own.joints[i], &JointSpec::stiffness, &JointSpec::rest,
         &JointSpec::damping, &JointSpec::friction, &JointSpec::rotor_inertia);
  for (std::size_t i = 0; i < own.forces.size(); ++i) {
    const ForceSpec& force = own.forces[i];
    if (force.kind == "torque") other.forces[i].value = force.value;
    if (is_spring(force, known))
      take(other.forces[i], force, &ForceSpec::stiffness, &ForceSpec::damping, &ForceSpec::rest);
    if (known == Forces::plain || !force.law.empty()) continue;
    if (force.kind == "bushing")
      take(other.forces[i], force, &ForceSpec::stiffness, &ForceSpec::damping,
           &ForceSpec::rotational_stiffness, &ForceSpec::rotational_damping);
    if (force.kind == "wrench" && has_no_formulas(force))
      take(other.forces[i], force, &ForceSpec::point, &ForceSpec::force, &ForceSpec::torque);
  }
}

/// Copies places of joints, loops, springs and markers and guesses of the start; figures and
/// defaults of a run change no motion.
void take_places(Scene& other, const Scene& own, Forces known) {
  for (std::size_t i = 0; i < own.joints.size(); ++i)
    take(other.joints[i], own.joints[i], &JointSpec::origin_parent, &JointSpec::origin_child,
         &JointSpec::rotation, &JointSpec::axis, &JointSpec::axis2, &JointSpec::direction,
         &JointSpec::position, &JointSpec::velocity);
  for (std::size_t i = 0; i < own.loops.size(); ++i)
    take(other.loops[i], own.loops[i], &LoopSpec::origin_parent, &LoopSpec::origin_child,
         &LoopSpec::rotation, &LoopSpec::axis, &LoopSpec::axis2, &LoopSpec::direction,
         &LoopSpec::length, &LoopSpec::offset);
  for (std::size_t i = 0; i < own.forces.size(); ++i)
    if (is_spring(own.forces[i], known))
      take(other.forces[i], own.forces[i], &ForceSpec::origin_parent, &ForceSpec::origin_child);
  other.markers = own.markers;
  other.visuals = own.visuals;
  other.run = own.run;
}

/// Copies laws of drives, which read no parameter during a run, and the functions by points in
/// them.
void take_drives(Scene& other, const Scene& own) {
  for (std::size_t i = 0; i < own.drives.size(); ++i)
    take(other.drives[i], own.drives[i], &DriveSpec::kind, &DriveSpec::coefficients,
         &DriveSpec::offset, &DriveSpec::amplitude, &DriveSpec::frequency, &DriveSpec::phase,
         &DriveSpec::from, &DriveSpec::to, &DriveSpec::start, &DriveSpec::duration,
         &DriveSpec::times, &DriveSpec::values, &DriveSpec::law, &DriveSpec::functions);
  other.functions = own.functions;
}

}  // namespace

SceneDifference::SceneDifference(const Scene& scene, Change known, Forces forces)
    : scene_(scene),
      known_(known),
      forces_(forces),
      text_(scene_text(scene)),
      formulas_(formulas_of(scene, known < Change::drives)) {}

Change SceneDifference::of(Scene other) const {
  if (other.bodies.size() != scene_.bodies.size() || other.joints.size() != scene_.joints.size() ||
      other.loops.size() != scene_.loops.size() || other.forces.size() != scene_.forces.size() ||
      other.parameters.size() != scene_.parameters.size())
    return Change::more;
  for (std::size_t i = 0; i < scene_.parameters.size(); ++i)
    if (other.parameters[i].value != scene_.parameters[i].value &&
        std::any_of(formulas_.begin(), formulas_.end(), [&](const std::string& formula) {
          return has_word(formula, scene_.parameters[i].name);
        }))
      return Change::more;
  take_inertias_and_forces(other, scene_, forces_);
  if (scene_text(other) == text_) return Change::inertias_and_forces;
  if (known_ < Change::places) return Change::more;
  take_places(other, scene_, forces_);
  if (scene_text(other) == text_) return Change::places;
  if (known_ < Change::drives || other.drives.size() != scene_.drives.size()) return Change::more;
  take_drives(other, scene_);
  return scene_text(other) == text_ ? Change::drives : Change::more;
}

}  // namespace momenta
