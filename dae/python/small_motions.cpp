// Equilibria and modes.

#include <momenta/dae/linear/linearisation.h>
#include <momenta/dae/study/modes_study.h>

#include "bindings.h"

namespace momenta::python {

namespace {

Search search_named(const std::string& name) {
  if (name == "settle") return Search::settle;
  if (name == "nearest") return Search::nearest;
  if (name == "start") return Search::start;
  if (name == "steady") return Search::steady;
  throw py::value_error("equilibrium '" + name + "': expected settle, nearest, start or steady");
}

py::dict modes(const Bench& b, const std::string& equilibrium, const std::string& drives,
               int count) {
  if (count < 0)
    throw py::value_error("count is " + std::to_string(count) + ", expected 0 or more");
  if (drives != "held" && drives != "running")
    throw py::value_error("drives '" + drives + "': expected held or running");
  const ModesRequest request{search_named(equilibrium), count, Route::automatic};
  ModesResult result;
  {
    const py::gil_scoped_release others_go_on;
    if (drives == "running" || equilibrium == "steady" || b.mechanism->scene().drives.empty()) {
      result = find_modes(*b.mechanism, assemble(*b.mechanism).start, request);
    } else {
      const Mechanism held(held_at_start(b.mechanism->scene()));
      result = find_modes(held, assemble(held).start, request);
    }
  }
  const auto& found = result.spectrum.modes;
  const auto number = static_cast<Eigen::Index>(found.size());
  Eigen::VectorXcd s(number);
  Vector frequency(number), damping_ratio(number);
  Eigen::MatrixXcd shapes(b.mechanism->nv(), number);
  for (Eigen::Index i = 0; i < number; ++i) {
    const Mode& mode = found[static_cast<std::size_t>(i)];
    s[i] = mode.s;
    frequency[i] = mode.frequency();
    damping_ratio[i] = mode.damping_ratio();
    shapes.col(i) = mode.shape;
  }
  py::dict all;
  all["nature"] = result.nature();
  all["q"] = result.equilibrium.q;
  all["lambda_"] = result.equilibrium.lambda;
  all["potential"] = result.equilibrium.potential;
  all["moved"] = result.equilibrium.moved;
  all["degrees_of_freedom"] = result.spectrum.mobility;
  all["complete"] = result.spectrum.complete;
  all["singular"] = result.singular_here();
  all["s"] = std::move(s);
  all["frequency"] = std::move(frequency);
  all["damping_ratio"] = std::move(damping_ratio);
  all["shapes"] = std::move(shapes);
  std::vector<std::string> names;
  for (const Column& c : result.shapes) names.push_back(c.label());
  all["shape_names"] = names;
  return all;
}

}  // namespace

void add_modes(py::class_<Bench, BenchPtr>& mechanism) {
  using namespace py::literals;
  mechanism.def(
      "modes", &modes, "equilibrium"_a = "settle", "drives"_a = "held", "count"_a = 0,
      "An equilibrium and the modes of small motions about it, as a dict: nature, q (nq), "
      "lambda_ (m), potential [J], moved [rad or m], degrees_of_freedom, complete, "
      "singular; s [1/s], frequency [Hz] and damping_ratio, (modes) each; shapes (nv, "
      "modes) with modal mass 1 kg m^2, shape_names. `equilibrium`: settle, nearest, "
      "start, or steady for the motion at the start's rates, which must be constant; `drives`: "
      "held or running; `count`: how many modes, those nearest to s = 0 "
      "(0: all of up to 300, else 20). Raises SceneError where there is no equilibrium.");
}

}  // namespace momenta::python
