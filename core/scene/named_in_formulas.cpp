// Things named in the formulas of a scene's forces, equations and events: they must keep their
// meaning where the scene is written in another way.

#include <momenta/core/scene/formula.h>

#include <algorithm>

namespace momenta {

NamedInFormulas::NamedInFormulas(const Scene& scene) {
  if (std::none_of(scene.forces.begin(), scene.forces.end(), has_formula) &&
      std::none_of(scene.loops.begin(), scene.loops.end(), has_equation) && scene.events.empty())
    return;
  const FormulaReader reader(scene);
  // `own`: the force with this formula.
  const auto note = [&](const Formula& formula, const ForceSpec* own) {
    for (const Signal& s : formula.signals) {
      const auto which = static_cast<std::size_t>(s.which);
      if (s.kind == Signal::Kind::coordinate || s.kind == Signal::Kind::rate)
        joints.insert(scene.joints[which].name);
      if (s.kind == Signal::Kind::position || s.kind == Signal::Kind::velocity)
        bodies.insert(scene.markers[which].body);
      if (s.kind != Signal::Kind::length && s.kind != Signal::Kind::length_rate) continue;
      const ForceSpec& spring = scene.forces[which];
      if (&spring != own) springs.insert(spring.name);
      joints.insert(spring.joints.begin(), spring.joints.end());
    }
  };
  if (!scene.lagrangian)
    for (const EventSpec& event : scene.events) note(reader.read(event.when.text), nullptr);
  for (const LoopSpec& loop : scene.loops)
    if (has_equation(loop)) note(reader.read(loop.equation), nullptr);
  for (const ForceSpec& force : scene.forces) {
    if (!has_formula(force)) continue;
    const auto own = reader.own_names(force);
    if (!force.joint.empty()) joints.insert(force.joint);
    each_formula(force, [&](const std::string&, const std::string& text) {
      note(reader.read(text, own), &force);
    });
  }
}

}  // namespace momenta
