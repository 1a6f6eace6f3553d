// Results of runs. Their arrays are views of a run's data that keep the run alive.

#include "run.h"

#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/output/table.h>
#include <momenta/dae/run/run_quantities.h>
#include <momenta/dae/study/drift_study.h>

#include <cstring>

namespace momenta::python {
namespace {

using Names = std::vector<std::string>;

/// A view of numbers that `owner` keeps alive.
py::array_t<double> view(const std::vector<double>& x, const py::object& owner) {
  return py::array_t<double>(static_cast<py::ssize_t>(x.size()), x.data(), owner);
}

RunPtr run_from(const py::tuple& kept) {
  RunResult result;
  const std::string record = kept.size() == 3 ? kept[0].cast<std::string>() : "";
  if (!read_record(nlohmann::json::from_cbor(record, true, false), result))
    throw py::value_error("this is no pickled Run of this version of momenta");
  result.trajectory.columns = kept[1].cast<Names>();
  auto run = std::make_shared<Run>(std::move(result));
  const auto rows = kept[2].cast<std::string>();
  run->rows.resize(rows.size() / sizeof(double));
  std::memcpy(run->rows.data(), rows.data(), run->rows.size() * sizeof(double));
  return run;
}

/// Events by the names of their columns, without units.
py::list events(const RunResult& r) {
  const Names& columns = r.trajectory.columns;
  py::list all;
  for (const FoundEvent& e : r.events) {
    py::dict one;
    one["name"] = e.name;
    one["t"] = e.t;
    one["direction"] = e.up ? "up" : "down";
    for (std::size_t i = 1; i < e.row.size(); ++i)
      one[py::str(columns[i].substr(0, columns[i].rfind(" [")))] = e.row[i];
    all.append(one);
  }
  return all;
}

/// Contacts at rigid stops.
py::list stops(const RunResult& r) {
  py::list all;
  for (const StopContact& s : r.stops) {
    py::dict one;
    one["joint"] = s.joint;
    one["limit"] = s.limit;
    one["t"] = s.t;
    one["what"] = s.what;
    one["before"] = s.before;
    one["after"] = s.after;
    one["impulse"] = s.impulse;
    all.append(one);
  }
  return all;
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
  using namespace py::literals;
  py::class_<Run, RunPtr> run(module, "Run",
                              "The result of one form by one integrator. run['B.x'] is a "
                              "column of its trajectory; arrays are views.");
  for (const RunQuantity& quantity : run_quantities())
    if (quantity.attribute)
      run.def_property_readonly(
          quantity.name, [value = quantity.value](const Run& r) { return value(r.result); },
          quantity.meaning);
  const auto property = [&](const char* name, auto get, const char* doc) {
    run.def_property_readonly(
        name, [get](const Run& r) { return get(r.result); }, doc);
  };
  property(
      "events", events,
      "events of the scene, in the order of time: dicts of name, t [s], direction (up or down) and "
      "the trajectory's columns there, by their names without units");
  property(
      "event_remarks", [](const RunResult& r) { return r.event_remarks; },
      "one sentence for each event whose formula had no value");
  property("stops", stops,
           "contacts at rigid stops, in the order of time: dicts of joint, limit, t [s], what "
           "(impact, held, released), the rates before and after an impact, and its impulse");
  property("counters", counters, "numbers of steps, evaluations, ... by name");
  property(
      "drift_unit", [](const RunResult& r) { return r.drift_unit; },
      "unit of the position drift: m, or rad where all loop equations are angles; empty without "
      "loops");
  run.def_property_readonly(
      "reaction_errors",
      [](const Run& r) {
        py::list all;
        for (const RunResult::ReactionError& joint : r.result.reaction_errors) {
          py::dict one;
          one["joint"] = joint.joint;
          one["error_max"] = joint.error_max;
          one["not_unique"] = joint.not_unique;
          all.append(one);
        }
        return all;
      },
      "by joint, against a reference with reactions: dicts with joint, error_max (nan: none) and "
      "at "
      "how many of its times the reaction is not unique");
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
  series("angle_drift", &Series::angle_drift,
         "|Phi| of equations in rad, where others are in m, at the output times [rad]");
  series("angle_rate_drift", &Series::angle_rate_drift, "|Phidot| of the same equations [rad/s]");
  series("velocity_drift", &Series::velocity_drift, "|Phidot| at the output times");
  series("energy", &Series::energy,
         "T + V less the work of drives and of forces without potential [J]");
  series("energy_error", &Series::energy_error, "energy - energy(0) [J]");
  series("impulse", &Series::impulse, "|sigma| of momentum forms, |lambda| of the others");
  series("position_error", &Series::position_error,
         "error against the reference, max |err| / (1 + |ref|); empty without a reference");
  series("force_error", &Series::force_error,
         "error of lambda solved from (3); empty without a reference that has it");
  series("multiplier_error", &Series::multiplier_error,
         "error of lambda as the form itself has it; empty without a reference that has it");
  series("multiplier_difference", &Series::multiplier_difference,
         "lambda of the form itself against lambda solved from (3)");
  series("momentum_error", &Series::momentum_error,
         "error of p without its gauge; empty without a reference that has M u");
  series("impulse_error", &Series::impulse_error,
         "error of the integral of lambda; empty without a reference that has it");
  series("effort_error", &Series::effort_error,
         "error of the efforts of drives; empty without a reference that has them");
  series("reaction_error", &Series::reaction_error,
         "error of the reactions of joints; empty without a reference that has them");
  series("work_error", &Series::work_error,
         "error of the work of drives and of forces without potential; empty without a reference "
         "that has it");
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
          "rows at the output times: (samples, columns)")
      .def(
          "__getitem__",
          [](const py::object& self, const std::string& name) {
            const Run& r = self.cast<const Run&>();
            const std::size_t n = r.columns(), at = r.column(name);
            return py::array_t<double>({r.rows.size() / n}, {n * sizeof(double)},
                                       r.rows.data() + at, self);
          },
          "name"_a, "A column of the trajectory, by its name with the unit or without.")
      .def(py::pickle(
          [](const Run& r) {
            const auto record = nlohmann::json::to_cbor(record_of(r.result));
            return py::make_tuple(
                py::bytes(reinterpret_cast<const char*>(record.data()), record.size()),
                r.result.trajectory.columns,
                py::bytes(reinterpret_cast<const char*>(r.rows.data()),
                          r.rows.size() * sizeof(double)));
          },
          &run_from))
      .def("__repr__", [](const Run& r) {
        return "<momenta.Run " + r.result.settings.form + ", " + r.result.settings.integrator +
               ": " + r.result.status + ">";
      });
  module.def(
      "table",
      [](const std::vector<RunPtr>& runs, bool ladder) {
        StudyResult study;
        study.drift_study = !ladder;
        for (const RunPtr& r : runs) study.runs.push_back(r->result);
        return drift_table(study);
      },
      "runs"_a, "ladder"_a);
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

}  // namespace momenta::python
