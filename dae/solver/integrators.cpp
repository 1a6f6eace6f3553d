#include <momenta/core/text/near_name.h>
#include <momenta/dae/solver/implicit_methods.h>
#include <momenta/dae/solver/integrators.h>

#include <stdexcept>

namespace momenta {
namespace {

using Takes = Integrator::Takes;
using Step = Integrator::Step;
using Gauge = Integrator::Preferred;

}  // namespace

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " or " : ", ";
    text += names[i];
  }
  return text;
}

const std::vector<Integrator>& integrators() {
  static const std::vector<Integrator> all{
      {.name = "rk4",
       .takes = Takes::ode,
       .step = Step::fixed,
       .multistep = false,
       .projects = true,
       .method = "classical Runge-Kutta, order 4",
       .forms = {}},
      {.name = "dp5",
       .takes = Takes::ode,
       .step = Step::adaptive,
       .multistep = false,
       .projects = true,
       .method = "Dormand-Prince 5(4)",
       .forms = {}},
      {.name = "dop853",
       .takes = Takes::ode,
       .step = Step::adaptive,
       .multistep = false,
       .projects = true,
       .method = "Dormand-Prince 8(5,3)",
       .forms = {}},
      {.name = "vern9",
       .takes = Takes::ode,
       .step = Step::adaptive,
       .multistep = false,
       .projects = true,
       .method = "Verner 9(8)",
       .forms = {}},
      {.name = "adams",
       .takes = Takes::ode,
       .step = Step::adaptive,
       .multistep = true,
       .projects = false,
       .method = "CVODE, Adams-Moulton of orders 1 to 12",
       .forms = {}},
      {.name = "bdf",
       .takes = Takes::ode,
       .step = Step::adaptive,
       .multistep = true,
       .projects = true,
       .method = "CVODE, BDF of orders 1 to 5",
       .forms = {}},
      {.name = "gauss4",
       .takes = Takes::ode,
       .step = Step::fixed,
       .multistep = false,
       .projects = true,
       .method = "Gauss collocation, 2 stages, order 4",
       .forms = {}},
      {.name = "gauss6",
       .takes = Takes::ode,
       .step = Step::fixed,
       .multistep = false,
       .projects = true,
       .method = "Gauss collocation, 3 stages, order 6",
       .forms = {}},
      {.name = "rattle",
       .takes = Takes::ode,
       .step = Step::fixed,
       .multistep = false,
       .projects = false,
       .method = "RATTLE, order 2",
       .forms = {"momentum"},
       .closes = {"momentum"},
       .hamiltonian = true},
      {.name = "energy-momentum",
       .takes = Takes::ode,
       .step = Step::fixed,
       .multistep = false,
       .projects = false,
       .method = "energy-momentum scheme, order 2",
       .forms = {"momentum"},
       .closes = {"momentum"},
       .hamiltonian = true},
      {.name = "ida",
       .takes = Takes::dae,
       .step = Step::adaptive,
       .multistep = true,
       .projects = false,
       .method = "IDA, BDF of orders 1 to 5",
       .forms = {}},
      {.name = "bdf5",
       .takes = Takes::dae,
       .step = Step::adaptive,
       .multistep = true,
       .projects = false,
       .method = "BDF of orders 1 to 5 on past values, whose gauge moves",
       .forms = {},
       .resets = true,
       .gauge = Gauge::reset},
      {.name = "radau5",
       .takes = Takes::dae,
       .step = Step::adaptive,
       .multistep = false,
       .projects = false,
       .method = "Radau IIA, order 5",
       .forms = {},
       .resets = true},
      {.name = "generalised-alpha",
       .takes = Takes::dae,
       .step = Step::fixed,
       .multistep = false,
       .projects = false,
       .method = "generalised-α, order 2",
       .forms = {"acceleration-index3"},
       .closes = {"acceleration-index3"}},
      {.name = "bayo-ledesma",
       .takes = Takes::dae,
       .step = Step::fixed,
       .multistep = false,
       .projects = false,
       .method = "augmented Lagrangian of index 3, trapezoidal rule and mass-orthogonal "
                 "projections, order 2",
       .forms = {"acceleration-index3"},
       .closes = {"acceleration-index3"}},
      {.name = "hem5",
       .takes = Takes::dae,
       .step = Step::adaptive,
       .multistep = false,
       .projects = false,
       .method = "half-explicit Runge-Kutta, order 5",
       .forms = {"acceleration-index2", "momentum-index2"},
       .resets = true,
       .gauge = Gauge::reset_of_independent,
       .closes = {"momentum-index2"}},
      {.name = "hem8",
       .takes = Takes::dae,
       .step = Step::adaptive,
       .multistep = false,
       .projects = false,
       .method = "half-explicit Runge-Kutta on the hidden constraint, order 8",
       .forms = {"acceleration-index2", "momentum-index2"},
       .resets = true,
       .gauge = Gauge::reset},
  };
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

std::string integrator_names(Takes takes) {
  std::vector<std::string> names;
  for (const Integrator& i : integrators())
    if (i.takes == takes) names.push_back(i.name);
  return listed(names);
}

std::string resetting_names() {
  std::vector<std::string> names;
  for (const Integrator& i : integrators())
    if (i.takes == Takes::dae && i.resets) names.push_back(i.name);
  return listed(names);
}

namespace {

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
  if (name == "adams" || name == "bdf")
    return integrate_cvode(name, system, t0, y0, output_times, options, observer);
  if (name == "gauss4" || name == "gauss6")
    return integrate_gauss(name == "gauss4" ? 2 : 3, system, t0, y0, output_times, options,
                           observer);
  if (name == "rattle") return integrate_rattle(system, t0, y0, output_times, options, observer);
  if (name == "energy-momentum")
    return integrate_energy_momentum(system, t0, y0, output_times, options, observer);
  return integrate_explicit(name, system, t0, y0, output_times, options, observer);
}

IntegrationResult integrate(const std::string& name, DaeSystem& system, double t0,
                            const std::vector<double>& output_times,
                            const IntegrationOptions& options, const Observer& observer) {
  if (system.size() == 0) return pass_time(t0, output_times, observer);
  if (name == "ida") return integrate_ida(system, t0, output_times, options, observer);
  if (name == "bdf5") return integrate_bdf5(system, t0, output_times, options, observer);
  if (name == "radau5") return integrate_radau5(system, t0, output_times, options, observer);
  if (name == "generalised-alpha")
    return integrate_generalised_alpha(system, t0, output_times, options, observer);
  if (name == "bayo-ledesma")
    return integrate_bayo_ledesma(system, t0, output_times, options, observer);
  if (name == "hem5") return integrate_hem5(system, t0, output_times, options, observer);
  if (name == "hem8") return integrate_hem8(system, t0, output_times, options, observer);
  throw std::invalid_argument("no method \"" + name +
                              "\" for DAEs: " + integrator_names(Takes::dae) + " are known");
}

}  // namespace momenta
