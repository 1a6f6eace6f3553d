#include <momenta/core/scene/toml/write_scene.h>
#include <momenta/dae/gradient/numbers_alone.h>

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

/// What of the scene is a formula while it runs: there a parameter is no number of the tables.
std::vector<std::string> formulas_of(const Scene& scene) {
  std::vector<std::string> all;
  for (const ForceSpec& force : scene.forces) {
    all.push_back(force.law);
    all.insert(all.end(), force.force_law.begin(), force.force_law.end());
    all.insert(all.end(), force.torque_law.begin(), force.torque_law.end());
  }
  for (const LoopSpec& loop : scene.loops) all.push_back(loop.equation);
  for (const DriveSpec& drive : scene.drives) all.push_back(drive.law);
  return all;
}

/// Gives `to` the members of `from`.
template <class Spec, class... Member>
void take(Spec& to, const Spec& from, Member Spec::*... members) {
  ((to.*members = from.*members), ...);
}

/// What `other` differs in that the slopes by numbers know without the places of joints and loops.
void take_inertias_and_forces(Scene& other, const Scene& own) {
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
    if (is_plain_spring(force))
      take(other.forces[i], force, &ForceSpec::stiffness, &ForceSpec::damping, &ForceSpec::rest);
  }
}

/// And with them: places of joints, loops, springs and markers, guesses of the start; figures and
/// defaults of a run change no motion.
void take_places(Scene& other, const Scene& own) {
  for (std::size_t i = 0; i < own.joints.size(); ++i)
    take(other.joints[i], own.joints[i], &JointSpec::origin_parent, &JointSpec::origin_child,
         &JointSpec::rotation, &JointSpec::axis, &JointSpec::axis2, &JointSpec::direction,
         &JointSpec::position, &JointSpec::velocity);
  for (std::size_t i = 0; i < own.loops.size(); ++i)
    take(other.loops[i], own.loops[i], &LoopSpec::origin_parent, &LoopSpec::origin_child,
         &LoopSpec::rotation, &LoopSpec::axis, &LoopSpec::axis2, &LoopSpec::direction,
         &LoopSpec::length, &LoopSpec::offset);
  for (std::size_t i = 0; i < own.forces.size(); ++i)
    if (is_plain_spring(own.forces[i]))
      take(other.forces[i], own.forces[i], &ForceSpec::origin_parent, &ForceSpec::origin_child);
  other.markers = own.markers;
  other.visuals = own.visuals;
  other.run = own.run;
}

}  // namespace

bool is_plain_spring(const ForceSpec& force) {
  return (force.kind == "spring-damper" || force.kind == "coordinate-spring") &&
         force.law.empty() && force.dead_band == 0 && !has_stops(force);
}

NumbersAlone::NumbersAlone(const Scene& scene, bool of_places)
    : scene_(scene),
      of_places_(of_places),
      text_(scene_text(scene)),
      formulas_(formulas_of(scene)) {}

Change NumbersAlone::of(Scene other) const {
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
  take_inertias_and_forces(other, scene_);
  if (scene_text(other) == text_) return Change::inertias_and_forces;
  if (!of_places_) return Change::more;
  take_places(other, scene_);
  return scene_text(other) == text_ ? Change::places : Change::more;
}

}  // namespace momenta
