// Equilibria, modes and linear models.

#include <momenta/dae/analysis/linear/linear_model.h>
#include <momenta/dae/analysis/linear/linearisation.h>
#include <momenta/dae/study/modes_study.h>
#include <momenta/dae/topology/assembly/drive_reach.h>

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
  all["shape_names"] = labels_of(result.shapes);
  return all;
}

py::dict linearise(const Bench& b, const std::string& kind, double t,
                   const std::optional<Vector>& q, const std::optional<Vector>& u,
                   const std::string& equilibrium, const std::vector<std::string>& inputs,
                   const std::vector<std::string>& outputs,
                   const std::vector<std::string>& independent) {
  if (kind != "minimal" && kind != "descriptor")
    throw py::value_error("kind '" + kind + "': expected minimal or descriptor");
  expect_time(t);
  if (q) expect_size(*q, b.mechanism->nq(), "q", "nq");
  if (u) expect_size(*u, b.mechanism->nv(), "u", "nv");
  if (!equilibrium.empty() && equilibrium != "settle" && equilibrium != "nearest")
    throw py::value_error("equilibrium '" + equilibrium + "': expected settle or nearest");
  if (!equilibrium.empty() && (q || u || t != 0))
    throw py::value_error("equilibrium and t, q or u are both given; expected one of them");
  LinearRequest request;
  request.kind = kind == "minimal" ? LinearRequest::Kind::minimal : LinearRequest::Kind::descriptor;
  request.inputs = inputs;
  request.outputs = outputs;
  request.independent = independent;
  LinearModel model;
  {
    const py::gil_scoped_release others_go_on;
    if (!equilibrium.empty()) {
      const Mechanism held(held_at_start(b.mechanism->scene()), b.mechanism->options());
      model = linear_model(
          held, find_equilibrium(held, assemble(held).start, search_named(equilibrium)), request);
    } else if (q || u) {
      const Tree& tree = b.mechanism->tree();
      model = linear_model(
          *b.mechanism,
          assemble(*b.mechanism, t, q.value_or(tree.q0), u.value_or(tree.u0), Assembled::rates)
              .start,
          request);
    } else {
      model =
          linear_model(*b.mechanism, assemble_at(*b.mechanism, t, Assembled::rates).start, request);
    }
  }
  py::dict all;
  all["kind"] = kind;
  all["t"] = model.t, all["q"] = model.q, all["u"] = model.u, all["udot"] = model.udot;
  all["E"] = model.E, all["A"] = model.A, all["B"] = model.B, all["C"] = model.C;
  all["D"] = model.D;
  all["states"] = labels_of(model.states);
  all["inputs"] = labels_of(model.inputs);
  all["outputs"] = labels_of(model.outputs);
  all["poles"] = model.poles;
  all["left_out"] = model.left_out;
  return all;
}

}  // namespace

void add_linearise(py::class_<Bench, BenchPtr>& mechanism) {
  using namespace py::literals;
  mechanism.def(
      "linearise", &linearise, "kind"_a = "minimal", "t"_a = 0.0, "q"_a = std::nullopt,
      "u"_a = std::nullopt, "equilibrium"_a = "", "inputs"_a = std::vector<std::string>{},
      "outputs"_a = std::vector<std::string>{}, "independent"_a = std::vector<std::string>{},
      "E x' = A x + B w, y = C x + D w about a state, as a dict: E, A, B, C, D; states, inputs and "
      "outputs (names with units); t, q, u, udot, the state; poles [1/s]; left_out (loop "
      "equations that follow from others). `kind`: minimal or descriptor. The state: t, with the "
      "loops closed from q and u (default: the scene's start, led to t), or `equilibrium`: settle "
      "or nearest, drives held. `inputs`, `outputs`: names, joints or groups; `independent`: "
      "coordinates that are states. Raises SceneError where the pose is singular.");
}

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
