// What the formulas of a scene's forces, equations and events name: what may neither go nor change
// its meaning where the scene is written in another way.

#include <momenta/core/scene/formula.h>

#include <algorithm>

namespace momenta {

NamedInFormulas::NamedInFormulas(const Scene& scene) {
  if (std::none_of(scene.forces.begin(), scene.forces.end(), has_formula) &&
      std::none_of(scene.loops.begin(), scene.loops.end(), has_equation) && scene.events.empty())
    return;
  const FormulaReader reader(scene);
  for (const EventSpec& event : scene.events) {
    if (scene.lagrangian) break;
    for (const Signal& s : reader.read(event.when.text).signals) {
      const auto which = static_cast<std::size_t>(s.which);
      if (s.kind == Signal::Kind::coordinate || s.kind == Signal::Kind::rate)
        joints.insert(scene.joints[which].name);
      if (s.kind == Signal::Kind::position || s.kind == Signal::Kind::velocity)
        bodies.insert(scene.markers[which].body);
      if (s.kind != Signal::Kind::length && s.kind != Signal::Kind::length_rate) continue;
      springs.insert(scene.forces[which].name);
      joints.insert(scene.forces[which].joints.begin(), scene.forces[which].joints.end());
    }
  }
  for (const LoopSpec& loop : scene.loops) {
    if (!has_equation(loop)) continue;
    for (const Signal& s : reader.read(loop.equation).signals) {
      const auto which = static_cast<std::size_t>(s.which);
      if (s.kind == Signal::Kind::coordinate || s.kind == Signal::Kind::rate)
        joints.insert(scene.joints[which].name);
      if (s.kind == Signal::Kind::position || s.kind == Signal::Kind::velocity)
        bodies.insert(scene.markers[which].body);
    }
  }
  for (const ForceSpec& force : scene.forces) {
    if (!has_formula(force)) continue;
    const auto own = reader.own_names(force);
    if (!force.joint.empty()) joints.insert(force.joint);
    each_formula(force, [&](const std::string&, const std::string& text) {
      for (const Signal& s : reader.read(text, own).signals) {
        const auto which = static_cast<std::size_t>(s.which);
        if (s.kind == Signal::Kind::coordinate || s.kind == Signal::Kind::rate)
          joints.insert(scene.joints[which].name);
        if (s.kind == Signal::Kind::position || s.kind == Signal::Kind::velocity)
          bodies.insert(scene.markers[which].body);
        if (s.kind != Signal::Kind::length && s.kind != Signal::Kind::length_rate) continue;
        const ForceSpec& spring = scene.forces[which];
        if (&spring != &force) springs.insert(spring.name);
        joints.insert(spring.joints.begin(), spring.joints.end());
      }
    });
  }
}

}  // namespace momenta
