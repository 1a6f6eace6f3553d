#include "run_arguments.h"

#include <momenta/dae/form/form.h>

#include <cmath>

namespace momenta::python {
namespace {

std::string written(double x) {
  return py::str(py::float_(x));
}

}  // namespace

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

RunSettings RunArguments::settings(const RunDefaults& defaults) const {
  RunSettings s = default_settings(defaults, form, integrator, tolerance("rtol", rtol));
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
  if (!(spectral_radius >= 0 && spectral_radius <= 1))
    throw py::value_error("spectral_radius is " + written(spectral_radius) +
                          ", expected a number from 0 to 1");
  s.spectral_radius = spectral_radius;
  s.project = project.value_or(s.project);
  constexpr const char* rate = "a rate in 1/s, not negative; 0: the form's own";
  s.baumgarte_alpha = not_negative("baumgarte_alpha", baumgarte_alpha, rate);
  s.baumgarte_beta = not_negative("baumgarte_beta", baumgarte_beta, rate);
  s.beta = not_negative("beta", beta, rate);
  s.penalty = not_negative("penalty", penalty, "a penalty, not negative; 0: the form's own");
  return s;
}

}  // namespace momenta::python
