// The derivative of a run.

#include <momenta/dae/gradient/gradient.h>

#include "progress.h"
#include "run_arguments.h"

namespace momenta::python {
namespace {

using Names = std::vector<std::string>;

py::dict gradient(const Bench& b, const std::string& of, const Names& by, bool integral,
                  const std::string& form, const std::string& integrator, const std::string& gauge,
                  double rtol, const Given& atol, const Given& step, const Given& end,
                  const std::optional<int>& samples, const std::optional<bool>& project,
                  double baumgarte_alpha, double baumgarte_beta, double beta, double cpu_limit,
                  bool trajectory, const std::string& mode, const py::object& told) {
  RunArguments asked{form, integrator, gauge,           rtol,           atol, step, end, samples,
                     0.8,  project,    baumgarte_alpha, baumgarte_beta, beta, 0};
  SceneText scene;
  scene.text = b.source.empty() ? toml_of(b) : b.source;
  scene.fixed = b.set;
  scene.file = b.mechanism->scene().file;
  scene.options = b.mechanism->options();
  scene.options.cut = CutChoice::scene;
  GradientRequest request;
  request.of = of;
  request.by = by;
  request.integral = integral;
  request.settings = asked.settings(b.mechanism->scene().run);
  request.trajectory = trajectory;
  request.mode = gradient_mode(mode);
  request.max_cpu_seconds = cpu_time(cpu_limit);
  Progress progress(told);
  request.progress = [&](double t) { return progress(t / request.settings.end_time, form); };
  GradientResult r;
  progress.during([&] { r = momenta::gradient(scene, request); });
  py::dict all;
  all["value"] = r.value;
  all["gradient"] = r.gradient;
  all["by"] = by;
  all["without_effect"] = r.without_effect;
  all["remarks"] = r.remarks;
  all["mode"] = r.adjoint ? "adjoint" : "forward";
  all["steps"] = r.steps;
  if (!trajectory) return all;
  const auto rows = static_cast<py::ssize_t>(r.times.size()),
             columns = static_cast<py::ssize_t>(r.columns.size()),
             variables = static_cast<py::ssize_t>(by.size());
  py::array_t<double> t(rows), tangents({rows, columns, variables});
  auto to = tangents.mutable_unchecked<3>();
  for (py::ssize_t i = 0; i < rows; ++i) {
    t.mutable_at(i) = r.times[static_cast<std::size_t>(i)];
    for (py::ssize_t k = 0; k < columns; ++k)
      for (py::ssize_t j = 0; j < variables; ++j)
        to(i, k, j) = r.tangents[static_cast<std::size_t>(i)](k, j);
  }
  all["t"] = std::move(t);
  all["columns"] = r.columns;
  all["tangents"] = std::move(tangents);
  return all;
}

}  // namespace

void add_gradient(py::class_<Bench, BenchPtr>& mechanism) {
  using namespace py::literals;
  mechanism.def(
      "gradient", &gradient, "of"_a, "by"_a, py::kw_only(), "integral"_a = false,
      "form"_a = "momentum", "integrator"_a = "", "gauge"_a = "", "rtol"_a = 1e-8,
      "atol"_a = py::none(), "step"_a = py::none(), "end"_a = py::none(), "samples"_a = py::none(),
      "project"_a = py::none(), "baumgarte_alpha"_a = 0.0, "baumgarte_beta"_a = 0.0, "beta"_a = 0.0,
      "cpu_limit"_a = 0.0, "trajectory"_a = false, "mode"_a = "automatic",
      "progress"_a = py::none(),
      "The derivative of what a run ends with, as a dict: value; gradient (by) in the unit of the "
      "value over that of each number; without_effect (names) and remarks (sentences on what is "
      "not "
      "smooth); steps; with `trajectory` also t (rows), columns (coordinates, then rates) and "
      "tangents (rows, columns, by). `of`: a formula of t, parameters, energy and columns of a "
      "trajectory; `by`: parameters, places of numbers, start values such as 'O.q', 'O.u'; "
      "`integral`: of the formula over the run, in place of its value at the end. `mode`: "
      "'forward', "
      "'adjoint' (many numbers), or 'automatic'. Other arguments "
      "are those of run(); forms momentum, acceleration, projected and baumgarte by rk4, dp5, "
      "dop853 "
      "or vern9, of the mechanism as it is written. Raises SceneError where there is no "
      "derivative.");
}

}  // namespace momenta::python
