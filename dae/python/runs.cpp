// Runs and studies. A run's arrays are views of it: they keep it alive and are never copied. Long
// calls release the interpreter, and Ctrl-C stops them at the next sample.

#include <momenta/dae/solver/integrators.h>
#include <momenta/dae/study/column_named.h>
#include <momenta/dae/study/drift_study.h>
#include <momenta/dae/study/own_reference.h>
#include <momenta/dae/study/work_study.h>

#include <cmath>
#include <optional>

#include "bindings.h"

namespace momenta::python {
namespace {

using Names = std::vector<std::string>;

/// A result, and its trajectory as one block of rows.
struct Run {
  RunResult result;
  std::vector<double> rows;

  explicit Run(RunResult made) : result(std::move(made)) {
    for (const auto& row : result.trajectory.rows) rows.insert(rows.end(), row.begin(), row.end());
    result.trajectory.rows.clear();
    result.trajectory.rows.shrink_to_fit();
  }
  std::size_t columns() const { return result.trajectory.columns.size(); }
  std::size_t column(const std::string& name) const {
    if (const auto at = column_named(result.trajectory.columns, name)) return *at;
    throw py::key_error("no column '" + name + "'; `columns` has all of them");
  }
};
using RunPtr = std::shared_ptr<Run>;

/// A view of numbers that `owner` keeps.
py::array_t<double> view(const std::vector<double>& x, const py::object& owner) {
  return py::array_t<double>(static_cast<py::ssize_t>(x.size()), x.data(), owner);
}

/// False once Ctrl-C was pressed; to be called without the interpreter's lock.
bool going_on() {
  const py::gil_scoped_acquire lock;
  return PyErr_CheckSignals() == 0;
}
/// What Ctrl-C left, raised.
void raise_pending() {
  if (PyErr_Occurred()) throw py::error_already_set();
}

std::vector<RunPtr> wrapped(std::vector<RunResult> runs) {
  std::vector<RunPtr> all;
  for (RunResult& run : runs) all.push_back(std::make_shared<Run>(std::move(run)));
  return all;
}

using Given = std::optional<double>;

std::string written(double x) {
  return py::str(py::float_(x));
}
/// What is given, or else `otherwise`. Raises ValueError unless it is positive and finite.
double positive(const char* name, const Given& given, double otherwise, const char* what) {
  if (!given) return otherwise;
  if (*given > 0 && std::isfinite(*given)) return *given;
  throw py::value_error(std::string(name) + " is " + written(*given) + ", expected " + what);
}
double not_negative(const char* name, double x, const char* what) {
  if (x >= 0 && std::isfinite(x)) return x;
  throw py::value_error(std::string(name) + " is " + written(x) + ", expected " + what);
}
double seconds(const char* name, const Given& given, double otherwise) {
  return positive(name, given, otherwise, "a positive number of seconds");
}
double tolerance(const char* name, double x) {
  return positive(name, x, x, "a positive tolerance");
}
double cpu_time(double x) {
  return not_negative("cpu_limit", x, "seconds, not negative; 0: none");
}
int sample_count(const std::optional<int>& given, int otherwise) {
  if (!given) return otherwise;
  if (*given > 0 && *given <= most_samples) return *given;
  throw py::value_error("samples is " + std::to_string(*given) + ", expected " +
                        (*given < 1 ? "at least 1" : "at most " + std::to_string(most_samples)));
}

std::unique_ptr<Reference> reference_of(const std::string& file, const Mechanism& mechanism) {
  if (file.empty()) return nullptr;
  auto reference = std::make_unique<Reference>(file);
  reference->bind(trajectory_columns(mechanism));
  return reference;
}

RunPtr run(const Bench& bench, const std::string& form, const std::string& integrator,
           const std::string& gauge, double rtol, const Given& atol, const Given& step,
           const Given& end, const std::optional<int>& samples, bool project,
           double baumgarte_alpha, double baumgarte_beta, double beta, double penalty,
           const std::string& reference, double cpu_limit) {
  const Mechanism& mechanism = *bench.mechanism;
  const auto given = reference_of(reference, mechanism);
  RunRequest request;
  RunSettings& s = request.settings;
  s = default_settings(mechanism.scene().run, form, integrator, tolerance("rtol", rtol));
  if (!gauge.empty()) {
    if (!takes_gauge(form))
      throw py::value_error("gauge '" + gauge + "': form '" + form +
                            "' has no impulses to gauge, expected none");
    s.gauge = gauge;
  }
  s.atol = positive("atol", atol, s.atol, "a positive tolerance");
  s.step = seconds("step", step, s.step);
  s.end_time = seconds("end", end, s.end_time);
  s.samples = sample_count(samples, s.samples);
  s.project = project;
  constexpr const char* rate = "a rate in 1/s, not negative; 0: the form's own";
  s.baumgarte_alpha = not_negative("baumgarte_alpha", baumgarte_alpha, rate);
  s.baumgarte_beta = not_negative("baumgarte_beta", baumgarte_beta, rate);
  s.beta = not_negative("beta", beta, rate);
  s.penalty = not_negative("penalty", penalty, "a penalty, not negative; 0: the form's own");
  request.reference = given.get();
  request.keep_trajectory = true;
  request.max_cpu_seconds = cpu_time(cpu_limit);
  request.progress = [](double) { return going_on(); };
  RunPtr made;
  {
    const py::gil_scoped_release unlocked;
    const Assembly a = assemble(mechanism);
    made = std::make_shared<Run>(run_form(mechanism, a.start, request));
  }
  raise_pending();
  return made;
}

std::vector<RunPtr> drift(const Bench& bench, const Names& forms, const std::string& integrator,
                          double rtol, const Given& step, const Given& end,
                          const std::optional<int>& samples, const std::string& reference,
                          double cpu_limit) {
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
  request.progress = [](int, int, const std::string&, double) { return going_on(); };
  std::vector<RunPtr> made;
  {
    const py::gil_scoped_release unlocked;
    made = wrapped(run_drift_study(mechanism, assemble(mechanism).start, request));
  }
  raise_pending();
  return made;
}

std::vector<RunPtr> work(const Bench& bench, const Names& forms, const Names& integrators,
                         const std::vector<double>& tolerances, const Given& end,
                         const std::string& reference, double cpu_limit) {
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
  request.progress = [](int, int, const std::string&, double) { return going_on(); };
  std::vector<RunPtr> made;
  {
    const py::gil_scoped_release unlocked;
    const Assembly a = assemble(mechanism);
    if (!given)
      given = std::make_unique<Reference>(
          own_reference(mechanism, a.start, request.end_time, rows, [](double) {
            return going_on();
          }).reference);
    request.reference = given.get();
    made = wrapped(run_work_study(mechanism, a.start, request));
  }
  raise_pending();
  return made;
}

py::dict counters(const RunResult& r) {
  py::dict all;
  all["steps"] = r.counters.steps;
  all["rejected"] = r.counters.rejected;
  all["evaluations"] = r.counters.evaluations;
  all["jacobians"] = r.counters.jacobians;
  all["factorizations"] = r.counters.factorizations;
  all["newton_iterations"] = r.counters.newton_iterations;
  all["ode_restarts"] = r.counters.ode_restarts;
  all["detours"] = r.counters.ode_restarts;  // deprecated
  return all;
}

}  // namespace

void bind_runs(py::module_& module) {
  py::class_<Run, RunPtr> run(module, "Run",
                              "One form by one integrator. run['B.x'] is a column of its "
                              "trajectory; arrays are views.");
  const auto text = [&](const char* name, auto get, const char* doc) {
    run.def_property_readonly(
        name, [get](const Run& r) { return get(r.result); }, doc);
  };
  text(
      "form", [](const RunResult& r) { return r.settings.form; }, "");
  text(
      "integrator", [](const RunResult& r) { return r.settings.integrator; }, "");
  text(
      "gauge", [](const RunResult& r) { return r.settings.gauge; }, "of momentum forms");
  text(
      "rtol", [](const RunResult& r) { return r.settings.rtol; }, "");
  text(
      "step", [](const RunResult& r) { return r.settings.step; }, "[s], 0: adaptive");
  text(
      "project", [](const RunResult& r) { return r.settings.project; }, "");
  text(
      "status", [](const RunResult& r) { return r.status; },
      "done, failed, time limit, came apart");
  text(
      "reason", [](const RunResult& r) { return r.reason; }, "one sentence when not done");
  text(
      "stopped_at", [](const RunResult& r) { return r.stopped_at; }, "[s]");
  text("counters", counters, "steps, evaluations, ... by name");
  text(
      "cpu_s", [](const RunResult& r) { return r.cpu_s; }, "processor time [s]");
  text(
      "position_drift_max", [](const RunResult& r) { return r.position_drift_max; }, "[m]");
  text(
      "velocity_drift_max", [](const RunResult& r) { return r.velocity_drift_max; }, "[m/s]");
  text(
      "energy_error_max", [](const RunResult& r) { return r.energy_error_max; }, "[J]");
  text(
      "position_error_max", [](const RunResult& r) { return r.position_error_max; },
      "against the reference, max |err| / (1 + |ref|); nan without one");
  const auto series = [&](const char* name, std::vector<double> Series::*member, const char* doc) {
    run.def_property_readonly(
        name,
        [member](const py::object& self) {
          return view(self.cast<const Run&>().result.series.*member, self);
        },
        doc);
  };
  series("t", &Series::t, "output times [s]");
  series("position_drift", &Series::position_drift, "|Phi(q, t)| at the output times");
  series("velocity_drift", &Series::velocity_drift, "|Phidot| at the output times");
  series("energy", &Series::energy, "T + V less what was dissipated [J]; nan with drives");
  series("energy_error", &Series::energy_error, "[J]");
  series("impulse", &Series::impulse, "|sigma| or |lambda|");
  series("position_error", &Series::position_error, "against the reference; empty without one");
  run.def_property_readonly(
         "columns", [](const Run& r) { return r.result.trajectory.columns; },
         "names of the trajectory's columns, with units")
      .def_property_readonly(
          "trajectory",
          [](const py::object& self) {
            const Run& r = self.cast<const Run&>();
            const std::size_t n = r.columns();
            return py::array_t<double>({n == 0 ? 0 : r.rows.size() / n, n}, r.rows.data(), self);
          },
          "(samples, columns)")
      .def(
          "__getitem__",
          [](const py::object& self, const std::string& name) {
            const Run& r = self.cast<const Run&>();
            const std::size_t n = r.columns(), at = r.column(name);
            return py::array_t<double>({r.rows.size() / n}, {n * sizeof(double)},
                                       r.rows.data() + at, self);
          },
          "A column of the trajectory, by its name with the unit or without.")
      .def("__repr__", [](const Run& r) {
        return "<momenta.Run " + r.result.settings.form + ", " + r.result.settings.integrator +
               ": " + r.result.status + ">";
      });
  module.def("forms", &form_names, "Names of all forms.");
  module.def(
      "integrators",
      [] {
        Names names;
        for (const Integrator& i : integrators()) names.push_back(i.name);
        return names;
      },
      "Names of all integrators.");
}

void add_runs(py::class_<Bench, BenchPtr>& mechanism) {
  using namespace py::literals;
  mechanism
      .def(
          "run", &run, py::kw_only(), "form"_a = "momentum", "integrator"_a = "", "gauge"_a = "",
          "rtol"_a = 1e-8, "atol"_a = py::none(), "step"_a = py::none(), "end"_a = py::none(),
          "samples"_a = py::none(), "project"_a = false, "baumgarte_alpha"_a = 0.0,
          "baumgarte_beta"_a = 0.0, "beta"_a = 0.0, "penalty"_a = 0.0, "reference"_a = "",
          "cpu_limit"_a = 0.0,
          "One form from the assembled start: a Run, failed ones too, with all samples up to "
          "there. What is None, zero or empty is the scene's, the form's or the program's default.")
      .def("drift", &drift, py::kw_only(), "forms"_a = Names{}, "integrator"_a = "",
           "rtol"_a = 1e-8, "step"_a = py::none(), "end"_a = py::none(), "samples"_a = py::none(),
           "reference"_a = "", "cpu_limit"_a = 60.0, "Every form side by side: a list of Run.")
      .def("work", &work, py::kw_only(), "forms"_a = Names{}, "integrators"_a = Names{},
           "tolerances"_a = std::vector<double>{1e-4, 1e-6, 1e-8, 1e-10}, "end"_a = py::none(),
           "reference"_a = "", "cpu_limit"_a = 10.0,
           "Error against run time over a ladder of tolerances, judged by a reference file or, "
           "without one, by a solution in quadruple precision made here: a list of Run.");
}

}  // namespace momenta::python
