#include <momenta/dae/solver/implicit_methods.h>
#include <momenta/dae/solver/integrators.h>

#include <stdexcept>

namespace momenta {
namespace {

using Takes = Integrator::Takes;
using Step = Integrator::Step;

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
      {"rk4", Takes::ode, Step::fixed, false, true, "classical Runge-Kutta, order 4", {}},
      {"dp5", Takes::ode, Step::adaptive, false, true, "Dormand-Prince 5(4)", {}},
      {"dop853", Takes::ode, Step::adaptive, false, true, "Dormand-Prince 8(5,3)", {}},
      {"vern9", Takes::ode, Step::adaptive, false, true, "Verner 9(8)", {}},
      {"adams",
       Takes::ode,
       Step::adaptive,
       true,
       false,
       "CVODE, Adams-Moulton of orders 1 to 12",
       {}},
      {"bdf", Takes::ode, Step::adaptive, true, true, "CVODE, BDF of orders 1 to 5", {}},
      {"gauss4", Takes::ode, Step::fixed, false, true, "Gauss collocation, 2 stages, order 4", {}},
      {"gauss6", Takes::ode, Step::fixed, false, true, "Gauss collocation, 3 stages, order 6", {}},
      {"rattle", Takes::ode, Step::fixed, false, false, "RATTLE, order 2", {"momentum"}},
      {"ida", Takes::dae, Step::adaptive, true, false, "IDA, BDF of orders 1 to 5", {}},
      {"bdf5",
       Takes::dae,
       Step::adaptive,
       true,
       false,
       "BDF of orders 1 to 5 on past values, whose gauge moves",
       {},
       true},
      {"radau5", Takes::dae, Step::adaptive, false, false, "Radau IIA, order 5", {}, true},
      {"generalised-alpha",
       Takes::dae,
       Step::fixed,
       false,
       false,
       "generalised-α, order 2",
       {"acceleration-index3"}},
      {"bayo-ledesma",
       Takes::dae,
       Step::fixed,
       false,
       false,
       "augmented Lagrangian of index 3, trapezoidal rule and mass-orthogonal projections, order 2",
       {"acceleration-index3"}},
      {"hem5",
       Takes::dae,
       Step::adaptive,
       false,
       false,
       "half-explicit Runge-Kutta, order 5",
       {"acceleration-index2", "momentum-index2"},
       true},
  };
  return all;
}

const Integrator& integrator(const std::string& name) {
  std::vector<std::string> names;
  for (const Integrator& i : integrators()) {
    if (i.name == name) return i;
    names.push_back(i.name);
  }
  throw std::invalid_argument("no integrator '" + name + "': expected " + listed(names));
}

std::string integrator_names(Takes takes) {
  std::vector<std::string> names;
  for (const Integrator& i : integrators())
    if (i.takes == takes) names.push_back(i.name);
  return listed(names);
}

namespace {

/// A system without unknowns: time passes, and there is nothing for a method to do. Everything may
/// be welded or driven.
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
  throw std::invalid_argument("no method \"" + name +
                              "\" for DAEs: " + integrator_names(Takes::dae) + " are known");
}

}  // namespace momenta
