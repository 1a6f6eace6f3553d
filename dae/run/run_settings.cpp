#include <momenta/dae/form/form.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/run/run_settings.h>

#include <cmath>
#include <stdexcept>

namespace momenta {

std::string default_integrator(const std::string& form, double rtol) {
  if (is_dae_form(form)) return "ida";
  // A tolerance typed as 1e-4 or 1e-9 may come by way of a logarithm.
  return rtol > 0.99e-4 ? "dp5" : rtol < 1.01e-9 ? "vern9" : "dop853";
}

RunSettings default_settings(const RunDefaults& scene, const std::string& form,
                             const std::string& method, double rtol) {
  RunSettings s;
  s.form = form;
  s.integrator = method.empty() ? default_integrator(form, rtol) : method;
  s.gauge = scene.leak ? Gauge{Gauge::Kind::leak, *scene.leak}.text() : "leak";
  s.rtol = s.atol = rtol;
  if (method.empty()) s.when_stiff = "bdf";
  s.step = scene.step.value_or(0);
  s.end_time = scene.end_time;
  s.samples = scene.samples;
  s.project = scene.project && integrator(s.integrator).projects;
  return s;
}

void expect(bool holds, const char* name, double found, const char* expected) {
  if (!holds)
    throw std::invalid_argument(std::string(name) + " is " + in_words(found) + ", expected " +
                                expected);
}
void expect_numbers(const RunSettings& s) {
  const auto positive = [](double x) { return x > 0 && std::isfinite(x); };
  const auto not_negative = [](double x) { return x >= 0 && std::isfinite(x); };
  expect(positive(s.end_time), "the end time", s.end_time, "a positive number of seconds");
  expect(s.samples >= 1 && s.samples <= most_samples, "the number of samples", s.samples,
         "1 to 10000000");
  expect(s.rtol >= 0 && s.rtol < 1, "rtol", s.rtol, "a tolerance, 0 or more, below 1");
  expect(not_negative(s.atol), "atol", s.atol, "a tolerance, not negative");
  expect(not_negative(s.step), "the step", s.step, "a positive number of seconds, or 0: none");
  expect(!(s.step > 0) || s.end_time / s.step < 1e12, "the step", s.step,
         "one of which fewer than 1e12 make the run");
  const struct {
    const char* name;
    double x;
  } gains[] = {{"baumgarte_alpha", s.baumgarte_alpha},
               {"baumgarte_beta", s.baumgarte_beta},
               {"beta", s.beta},
               {"penalty", s.penalty}};
  for (const auto& [name, x] : gains)
    expect(not_negative(x), name, x, "a number, not negative; 0: the form's own");
  expect(s.spectral_radius >= 0 && s.spectral_radius < 1, "the spectral radius", s.spectral_radius,
         "0 or more, below 1");
}

}  // namespace momenta
