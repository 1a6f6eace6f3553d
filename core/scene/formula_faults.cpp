// Why a formula is unfit for a force, an event or a loop.

#include <momenta/core/scene/formula.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>

namespace momenta {

using reading::in_quotes;

std::string formula_fault(const Scene& scene, const ForceSpec& force, const Formula& formula) {
  if (formula.expression.is_truth()) return "is a comparison, expected a formula of a number";
  if (force.kind != "potential") return "";
  bool exerts = false;
  for (const Signal& signal : formula.signals) {
    if (is_rate(signal.kind))
      return "takes the rate " + in_quotes(in_words(scene, signal)) +
             ", expected coordinates, positions of markers, lengths and t alone";
    exerts |= signal.kind != Signal::Kind::time;
  }
  return exerts ? ""
                : "takes no coordinate, position of a marker or length, so that it exerts no "
                  "force; expected one of them";
}

std::string event_fault(const Formula& formula) {
  if (formula.expression.is_truth())
    return "is a comparison, expected a number, which passes zero at the event";
  if (formula.signals.empty())
    return "takes nothing that changes, expected t, a coordinate, a marker or a length in it";
  return "";
}

std::string equation_fault(const Scene& scene, LoopKind kind, const Formula& formula) {
  if (formula.expression.is_truth())
    return "is a comparison, expected a formula that is to be zero";
  if (const std::string_view corner = formula.expression.corner(); !corner.empty())
    return "has " + in_quotes(corner) +
           ", where no second derivative may exist; expected a smooth formula";
  const bool of_rates = kind == LoopKind::velocity_equation;
  bool ties = false;
  std::vector<int> rates;
  for (std::size_t i = 0; i < formula.signals.size(); ++i) {
    const Signal& signal = formula.signals[i];
    const std::string name = in_quotes(in_words(scene, signal));
    const bool of_length =
        signal.kind == Signal::Kind::length || signal.kind == Signal::Kind::length_rate;
    if (is_rate(signal.kind) && !of_rates)
      return "takes the rate " + name +
             ", expected coordinates, positions of markers and t alone: an equation of positions; "
             "one that is linear in rates is a velocity-equation";
    if (of_length)
      return "takes " + name + ", expected coordinates, positions of markers " +
             (of_rates ? "and their rates: a length is that of two markers"
                       : "and t alone: a length is that of the positions of two markers");
    if (is_rate(signal.kind)) rates.push_back(static_cast<int>(i));
    ties |= of_rates ? is_rate(signal.kind) : signal.kind != Signal::Kind::time;
  }
  if (!ties)
    return of_rates ? "takes no rate of a coordinate and no velocity of a marker, so that it ties "
                      "no rates; expected one of them"
                    : "takes no coordinate and no position of a marker, so that it ties nothing; "
                      "expected one of them";
  if (!of_rates) return "";
  // Linear in rates: all second derivatives are the number zero.
  const Expression second = formula.expression.with_second_derivatives(rates);
  std::size_t at = 1 + rates.size();
  for (std::size_t v = 0; v < rates.size(); ++v)
    for (std::size_t w = 0; w <= v; ++w) {
      const auto& in = second.tape()[static_cast<std::size_t>(second.outputs()[at++])];
      if (in.operation == Expression::Operation::number && in.number == 0) continue;
      const auto signal = [&](std::size_t i) {
        return in_quotes(in_words(scene, formula.signals[static_cast<std::size_t>(rates[i])]));
      };
      return "is not linear in " + signal(w) + (v == w ? "" : " and " + signal(v)) +
             ", expected a sum of rates times functions of coordinates, positions and t";
    }
  return "";
}

// Things named in the formulas of a scene's forces, equations and events: they must keep their
// meaning where the scene is written in another way.

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
