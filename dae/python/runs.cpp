// Runs and studies. Long calls release the interpreter's lock, and Ctrl-C stops them at the next
// sample.

#include <momenta/dae/run/force_columns.h>
#include <momenta/dae/study/drift_study.h>
#include <momenta/dae/study/own_reference.h>
#include <momenta/dae/study/work_study.h>

#include "progress.h"
#include "run.h"
#include "run_arguments.h"

namespace momenta::python {
namespace {

using Names = std::vector<std::string>;

std::unique_ptr<Reference> reference_of(const std::string& file, const Mechanism& mechanism) {
  if (file.empty()) return nullptr;
  auto reference = std::make_unique<Reference>(file);
  reference->bind(measured_columns(mechanism));
  return reference;
}

RunPtr run(const Bench& bench, const std::string& form, const std::string& integrator,
           const std::string& gauge, double rtol, const Given& atol, const Given& step,
           const Given& end, const std::optional<int>& samples, double spectral_radius,
           const std::optional<bool>& project, double baumgarte_alpha, double baumgarte_beta,
           double beta, double penalty, double cpu_limit, const std::string& reference,
           bool reactions, const py::object& told) {
  const Mechanism& mechanism = *bench.mechanism;
  const RunArguments asked{
      form,    integrator,      gauge,          rtol, atol,   step, end, samples, spectral_radius,
      project, baumgarte_alpha, baumgarte_beta, beta, penalty};
  const auto given = reference_of(reference, mechanism);
  RunRequest request;
  request.settings = asked.settings(mechanism.scene().run);
  request.reference = given.get();
  request.keep_trajectory = request.multipliers = true;
  request.reactions = reactions;
  request.events = true;
  request.max_cpu_seconds = cpu_time(cpu_limit);
  Progress progress(told);
  request.progress = [&](double t) { return progress(t / request.settings.end_time, form); };
  RunPtr made;
  progress.during([&] {
    made = std::make_shared<Run>(run_form(mechanism, assemble(mechanism).start, request));
  });
  return made;
}

/// The runs of a study as a Study of the package.
py::object study_of(std::vector<RunResult> runs, bool ladder) {
  py::list all;
  for (RunResult& run : runs) all.append(std::make_shared<Run>(std::move(run)));
  return py::module_::import("momenta").attr("Study")(all, ladder);
}

py::object drift(const Bench& bench, const Names& forms, const std::string& integrator, double rtol,
                 const Given& step, const Given& end, const std::optional<int>& samples,
                 const std::string& reference, double cpu_limit, const py::object& told) {
  const Mechanism& mechanism = *bench.mechanism;
  const RunDefaults& defaults = mechanism.scene().run;
  const auto given = reference_of(reference, mechanism);
  DriftRequest request;
  request.forms = forms;
  request.integrator = integrator;
  request.rtol = request.atol = tolerance("rtol", rtol);
  request.step = seconds("step", step, defaults.step.value_or(0));
  request.end_time = seconds("end", end, defaults.end_time);
  request.samples = sample_count(samples, defaults.samples);
  request.reference = given.get();
  request.max_cpu_seconds = cpu_time(cpu_limit);
  Progress progress(told);
  request.progress = [&](int number, int total, const std::string& label, double part) {
    return progress.of_study(number, total, label, part);
  };
  std::vector<RunResult> made;
  progress.during([&] { made = run_drift_study(mechanism, assemble(mechanism).start, request); });
  return study_of(std::move(made), false);
}

py::object work(const Bench& bench, const Names& forms, const Names& integrators,
                const std::vector<double>& tolerances, const Given& end,
                const std::string& reference, double cpu_limit, const py::object& told) {
  constexpr int rows = 100;
  const Mechanism& mechanism = *bench.mechanism;
  auto given = reference_of(reference, mechanism);
  WorkRequest request;
  request.forms = forms;
  request.integrators = integrators;
  request.tolerances = tolerances;
  for (const double x : tolerances) tolerance("a tolerance", x);
  if (tolerances.empty()) throw py::value_error("tolerances is empty, expected at least one");
  request.end_time = seconds("end", end, mechanism.scene().run.end_time);
  request.samples = rows;
  request.max_cpu_seconds = cpu_time(cpu_limit);
  Progress progress(told);
  request.progress = [&](int number, int total, const std::string& label, double part) {
    return progress.of_study(number, total, label, part);
  };
  std::vector<RunResult> made;
  progress.during([&] {
    const Assembly a = assemble(mechanism);
    if (!given)
      given = std::make_unique<Reference>(
          own_reference(mechanism, a.start, request.end_time, rows, [&](double) {
            return progress(0, "reference");
          }).reference);
    request.reference = given.get();
    made = run_work_study(mechanism, a.start, request);
  });
  return study_of(std::move(made), true);
}

}  // namespace

void add_runs(py::class_<Bench, BenchPtr>& mechanism) {
  using namespace py::literals;
  with_run_arguments([&](const auto&... arguments) {
    mechanism.def(
        "run", &run, py::kw_only(), arguments..., "reference"_a = "", "reactions"_a = false,
        "progress"_a = py::none(),
        "Runs one form from the assembled start. Returns a Run; a failed one has all samples up to "
        "the failure. Arguments that are None, zero or empty take the default of the scene, the "
        "form or the program. `reactions`: with those of joints as columns. `progress`: True for a "
        "line on standard error, or a function of "
        "(fraction, text).");
  });
  mechanism
      .def("drift", &drift, py::kw_only(), "forms"_a = Names{}, "integrator"_a = "",
           "rtol"_a = 1e-8, "step"_a = py::none(), "end"_a = py::none(), "samples"_a = py::none(),
           "reference"_a = "", "cpu_limit"_a = 60.0, "progress"_a = py::none(),
           "Runs every form. Returns a Study, a list of Run.")
      .def(
          "work", &work, py::kw_only(), "forms"_a = Names{}, "integrators"_a = Names{},
          "tolerances"_a = std::vector<double>{1e-4, 1e-6, 1e-8, 1e-10}, "end"_a = py::none(),
          "reference"_a = "", "cpu_limit"_a = 10.0, "progress"_a = py::none(),
          "Error against run time over a ladder of tolerances. Errors are against a reference file "
          "or, without one, against a solution in quadruple precision that this call computes. "
          "Returns a Study.");
}

}  // namespace momenta::python
