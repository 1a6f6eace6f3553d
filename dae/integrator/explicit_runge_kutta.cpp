// Explicit Runge-Kutta methods by name: their tableaux, and checks of options.

#include <momenta/dae/integrator/explicit_run.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/integrator/tableau_dop853.h>
#include <momenta/dae/integrator/tableau_dp5.h>
#include <momenta/dae/integrator/tableau_rk4.h>
#include <momenta/dae/integrator/tableau_vern9.h>

#include <stdexcept>

namespace momenta {
namespace {

void require(bool condition, const char* sentence) {
  if (!condition) throw std::invalid_argument(sentence);
}

void check(const OdeSystem& system, double t0, const std::vector<double>& y0,
           const IntegrationOptions& options, bool has_error_estimate) {
  require(std::isfinite(t0), "the start time must be finite");
  require(y0.size() == static_cast<std::size_t>(system.size()),
          "the start state must have the size of the system");
  require(std::isfinite(options.step) && options.step >= 0, "a fixed step must be positive");
  require(options.step > 0 || has_error_estimate,
          "rk4 has no error estimate and needs a fixed step > 0");
  require(options.step > 0 ||
              (options.rtol >= 0 && options.atol >= 0 && options.rtol + options.atol > 0),
          "rtol and atol must not be negative, nor both zero");
}

template <class Tableau>
IntegrationResult integrate(OdeSystem& system, double t0, const std::vector<double>& y0,
                            const std::vector<double>& output_times,
                            const IntegrationOptions& options, const Observer& observer) {
  check(system, t0, y0, options, Tableau::estimates > 0);
  return explicit_rk::ExplicitRun<Tableau>(system, t0, y0, output_times, options, observer).run();
}

template <class Tableau>
Integrator explicit_integrator(const char* method) {
  constexpr bool adaptive = Tableau::estimates > 0;
  return {.name = Tableau::name,
          .step = adaptive ? Integrator::Step::adaptive : Integrator::Step::fixed,
          .projects = true,
          .method = method,
          .ode_run = integrate<Tableau>};
}

}  // namespace

IntegrationResult integrate_explicit(const std::string& method, OdeSystem& system, double t0,
                                     const std::vector<double>& y0,
                                     const std::vector<double>& output_times,
                                     const IntegrationOptions& options, const Observer& observer) {
  using namespace explicit_rk;
  if (method == "rk4")
    return integrate<TableauRk4>(system, t0, y0, output_times, options, observer);
  if (method == "dp5")
    return integrate<TableauDp5>(system, t0, y0, output_times, options, observer);
  if (method == "dop853")
    return integrate<TableauDop853>(system, t0, y0, output_times, options, observer);
  if (method == "vern9")
    return integrate<TableauVern9>(system, t0, y0, output_times, options, observer);
  throw std::invalid_argument("no explicit method \"" + method +
                              "\": rk4, dp5, dop853, vern9 are known");
}

Integrator rk4_integrator() {
  return explicit_integrator<explicit_rk::TableauRk4>("classical Runge-Kutta, order 4");
}

Integrator dp5_integrator() {
  return explicit_integrator<explicit_rk::TableauDp5>("Dormand-Prince 5(4)");
}

Integrator dop853_integrator() {
  return explicit_integrator<explicit_rk::TableauDop853>("Dormand-Prince 8(5,3)");
}

Integrator vern9_integrator() {
  return explicit_integrator<explicit_rk::TableauVern9>("Verner 9(8)");
}

}  // namespace momenta
