#pragma once
// Arguments of a run, with the names and defaults of `momenta run`, for one run and for the runs of
// a sweep.

#include <momenta/dae/run/run_form.h>

#include <optional>

#include "bindings.h"

namespace momenta::python {

using Given = std::optional<double>;

struct RunArguments {
  std::string form, integrator, gauge;
  double rtol = 1e-8;
  Given atol, step, end;
  std::optional<int> samples;
  double spectral_radius = 0.8;
  std::optional<bool> project;
  double baumgarte_alpha = 0, baumgarte_beta = 0, beta = 0, penalty = 0;

  /// The run of a scene with these defaults. @throws py::value_error by the argument's name
  RunSettings settings(const RunDefaults& defaults) const;
};

// `given`, or else `otherwise`. @throws py::value_error by its name
double positive(const char* name, const Given& given, double otherwise, const char* what);
double not_negative(const char* name, double x, const char* what);
double seconds(const char* name, const Given& given, double otherwise);
double tolerance(const char* name, double x);
double cpu_time(double x);
int sample_count(const std::optional<int>& given, int otherwise);

/// Calls define(arguments…) with the arguments above; pass them on to pybind11's def.
template <class Define>
void with_run_arguments(const Define& define) {
  using namespace py::literals;
  define("form"_a = "momentum", "integrator"_a = "", "gauge"_a = "", "rtol"_a = 1e-8,
         "atol"_a = py::none(), "step"_a = py::none(), "end"_a = py::none(),
         "samples"_a = py::none(), "spectral_radius"_a = 0.8, "project"_a = py::none(),
         "baumgarte_alpha"_a = 0.0, "baumgarte_beta"_a = 0.0, "beta"_a = 0.0, "penalty"_a = 0.0,
         "cpu_limit"_a = 0.0);
}

}  // namespace momenta::python
