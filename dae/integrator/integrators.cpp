#include <momenta/core/text/quoting.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/integrator/stopping.h>

#include <cmath>
#include <stdexcept>

// clang-format off
/// In the order of the tables.
#define MOMENTA_INTEGRATORS(integrator) \
  integrator(rk4)                       \
  integrator(dp5)                       \
  integrator(dop853)                    \
  integrator(vern9)                     \
  integrator(adams)                     \
  integrator(bdf)                       \
  integrator(gauss4)                    \
  integrator(gauss6)                    \
  integrator(rattle)                    \
  integrator(energy_momentum)           \
  integrator(ida)                       \
  integrator(bdf5)                      \
  integrator(radau5)                    \
  integrator(generalised_alpha)         \
  integrator(bayo_ledesma)              \
  integrator(hem5)                      \
  integrator(hem8)
// clang-format on

namespace momenta {

#define MOMENTA_DECLARED(integrator) Integrator integrator##_integrator();
MOMENTA_INTEGRATORS(MOMENTA_DECLARED)

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " or " : ", ";
    text += names[i];
  }
  return text;
}

void expect_tolerances(const IntegrationOptions& options, const std::string& method) {
  if (!(options.rtol > 0) || !(options.atol > 0))
    throw std::invalid_argument("rtol and atol of " + method + " must be positive");
}

void expect_fixed_step(const IntegrationOptions& options, const std::string& method) {
  if (!(options.step > 0) || !std::isfinite(options.step))
    throw std::invalid_argument(method + " has fixed steps and needs a step > 0");
}

const std::vector<Integrator>& integrators() {
#define MOMENTA_LISTED(integrator) integrator##_integrator(),
  static const std::vector<Integrator> all{MOMENTA_INTEGRATORS(MOMENTA_LISTED)};
  return all;
}

const Integrator& integrator(const std::string& name) {
  std::vector<std::string> names;
  for (const Integrator& i : integrators()) {
    if (i.name == name) return i;
    names.push_back(i.name);
  }
  const std::vector<std::string_view> known(names.begin(), names.end());
  throw std::invalid_argument("integrator " + reading::in_quotes(name) +
                              " is not known; expected " + listed(names) +
                              reading::did_you_mean(name, known));
}

std::string integrator_names(Integrator::Takes takes) {
  std::vector<std::string> names;
  for (const Integrator& i : integrators())
    if (i.takes == takes) names.push_back(i.name);
  return listed(names);
}

std::string resetting_names() {
  std::vector<std::string> names;
  for (const Integrator& i : integrators())
    if (i.takes == Integrator::Takes::dae && i.resets) names.push_back(i.name);
  return listed(names);
}

namespace {

/// Null for an unknown name.
const Integrator* find(const std::string& name) {
  for (const Integrator& i : integrators())
    if (i.name == name) return &i;
  return nullptr;
}

/// Passes time for a system without unknowns: everything may be welded or driven.
IntegrationResult pass_time(double t0, const std::vector<double>& output_times,
                            const Observer& observer) {
  IntegrationResult result;
  result.end_time = t0;
  const double nothing = 0;
  const Interpolant between = [](double, double*) {};
  for (const double t : output_times) {
    if (observer.step && t > result.end_time && !observer.step(result.end_time, t, between)) {
      result.reason = "the observer ended the run";
      return result;
    }
    result.end_time = t;
    if (observer.sample && !observer.sample(t, &nothing, &nothing)) {
      result.reason = "stopped at t = " + std::to_string(t) + " s";
      return result;
    }
  }
  result.done = true;
  return result;
}

}  // namespace

IntegrationResult integrate(const std::string& name, OdeSystem& system, double t0,
                            const std::vector<double>& y0, const std::vector<double>& output_times,
                            const IntegrationOptions& options, const Observer& observer) {
  if (system.size() == 0) return pass_time(t0, output_times, observer);
  const Integrator* method = find(name);
  if (method && method->ode_run)
    return method->ode_run(system, t0, y0, output_times, options, observer);
  return integrate_explicit(name, system, t0, y0, output_times, options, observer);
}

IntegrationResult integrate(const std::string& name, DaeSystem& system, double t0,
                            const std::vector<double>& output_times,
                            const IntegrationOptions& options, const Observer& observer) {
  if (system.size() == 0) return pass_time(t0, output_times, observer);
  const Integrator* method = find(name);
  if (method && method->dae_run)
    return method->dae_run(system, t0, output_times, options, observer);
  throw std::invalid_argument("no method \"" + name + "\" for DAEs: " +
                              integrator_names(Integrator::Takes::dae) + " are known");
}

}  // namespace momenta
