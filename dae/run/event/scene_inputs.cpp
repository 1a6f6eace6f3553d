#include <momenta/core/expression/input_times.h>
#include <momenta/core/scene/drive.h>
#include <momenta/core/scene/formula.h>
#include <momenta/core/scene/lagrangian/lagrangian_formulas.h>
#include <momenta/dae/run/event/scene_inputs.h>

namespace momenta {
namespace {

void add_formula(InputTimes& times, const FormulaReader& reader, const std::string& text,
                 const std::vector<OwnName>& own = {}) {
  const Formula formula = reader.read(text, own);
  for (std::size_t i = 0; i < formula.signals.size(); ++i)
    if (formula.signals[i].kind == Signal::Kind::time)
      times.add(formula.expression, static_cast<int>(i));
}

void add_lagrangian(InputTimes& times, const Scene& scene) {
  const LagrangianFormulas formulas(scene);
  const int t = 2 * static_cast<int>(scene.lagrangian->coordinates.size());
  const auto number = [&](int i) {
    return i > t ? std::optional(scene.parameters[static_cast<std::size_t>(i - t - 1)].value)
                 : std::nullopt;
  };
  const auto add = [&](const Expression& formula) { times.add(formula, t, number); };
  for (const auto* formula : {&formulas.lagrangian, &formulas.kinetic, &formulas.potential})
    if (*formula) add(**formula);
  for (const Expression& formula : formulas.forces) add(formula);
  for (const Expression& formula : formulas.constraints) add(formula);
}

}  // namespace

std::vector<double> input_times(const Scene& scene, double t0, double end) {
  InputTimes times(t0, end);
  if (scene.lagrangian) add_lagrangian(times, scene);
  const FormulaReader reader(scene);
  for (const ForceSpec& force : scene.forces)
    each_formula(force, [&](const std::string&, const std::string& law) {
      add_formula(times, reader, law, reader.own_names(force));
    });
  for (const LoopSpec& loop : scene.loops)
    if (!loop.equation.empty()) add_formula(times, reader, loop.equation);
  for (const DriveSpec& drive : scene.drives) {
    if (drive.kind == "step") {
      times.add_pulse(drive.start, drive.start + drive.duration);
    } else if (!drive.law.empty()) {
      const Formula law = reader.read_of_time(drive.law);
      if (!law.signals.empty()) times.add(law.expression, 0);
    }
  }
  return times.all();
}

}  // namespace momenta
