#pragma once
// The integrators by name: the systems each takes, its kind of steps, and its function, as its own
// file has them; integrators.cpp lists all. Options, messages, studies and `momenta --help` take
// them from here.

#include <momenta/dae/integrator/integration.h>

#include <algorithm>
#include <string>
#include <vector>

namespace momenta {

/// One integrator.
struct Integrator {
  /// Kinds of systems.
  enum class Takes {
    ode,  ///< y' = f(t, y)
    dae,  ///< F(t, y, y') = 0
  };
  /// Kinds of steps.
  enum class Step {
    adaptive,  ///< by the local error
    fixed      ///< IntegrationOptions::step
  };

  /// A function that integrates ODEs.
  using OdeRun = IntegrationResult (*)(OdeSystem&, double t0, const std::vector<double>& y0,
                                       const std::vector<double>& output_times,
                                       const IntegrationOptions&, const Observer&);
  /// A function that integrates DAEs.
  using DaeRun = IntegrationResult (*)(DaeSystem&, double t0,
                                       const std::vector<double>& output_times,
                                       const IntegrationOptions&, const Observer&);

  std::string name;          ///< as in options and tables
  Takes takes = Takes::ode;  ///< ODEs or DAEs
  Step step = Step::fixed;   ///< adaptive or fixed
  bool multistep = false;    ///< keeps a history, which a gauge reset or flip would invalidate
  bool projects = false;     ///< states may be corrected onto the constraints after each step
  std::string method = {};   ///< description, one line
  std::vector<std::string> forms = {};  ///< forms it takes; empty: all of its kind
  bool resets = false;                  ///< takes gauge reset (DAE methods)
  /// Gauges that DAE methods take by default.
  enum class Preferred {
    leak,
    reset,
    reset_of_independent  ///< reset, or leak where loops are redundant
  };
  Preferred gauge = Preferred::leak;  ///< default gauge of DAE methods in studies of cost
  /// Forms whose Φ = 0 it solves for positions alone, so that rows of rates have no place.
  std::vector<std::string> closes = {};
  /// Whether it steps on the parts of H(q, p): no σ is in its p, so that runs say gauge reset, and
  /// no accelerations are found, which friction by reaction takes.
  bool hamiltonian = false;
  OdeRun ode_run = nullptr;  ///< for ODEs; null where it takes DAEs
  DaeRun dae_run = nullptr;  ///< for DAEs; null where it takes ODEs

  /// `dae`: whether the form is a DAE.
  bool takes_form(const std::string& wanted, bool dae) const {
    return (takes == Takes::dae) == dae &&
           (forms.empty() || std::find(forms.begin(), forms.end(), wanted) != forms.end());
  }
  /// Whether it is one of `closes`.
  bool closes_form(const std::string& form) const {
    return std::find(closes.begin(), closes.end(), form) != closes.end();
  }
};

/// All integrators, in the order of the tables.
const std::vector<Integrator>& integrators();
/// @throws std::invalid_argument listing all names for an unknown one.
const Integrator& integrator(const std::string& name);
/// "a, b or c".
std::string listed(const std::vector<std::string>& names);
/// Names of the integrators that take such systems, listed.
std::string integrator_names(Integrator::Takes takes);
/// Names of the DAE integrators that take gauge reset, listed.
std::string resetting_names();

/// Integrates y' = f(t, y) from y0 by the named method. @throws std::invalid_argument for a method
/// that takes DAEs.
IntegrationResult integrate(const std::string& name, OdeSystem&, double t0,
                            const std::vector<double>& y0, const std::vector<double>& output_times,
                            const IntegrationOptions&, const Observer&);
/// Integrates F(t, y, y') = 0 from system.start(). @throws std::invalid_argument for an ODE method.
IntegrationResult integrate(const std::string& name, DaeSystem&, double t0,
                            const std::vector<double>& output_times, const IntegrationOptions&,
                            const Observer&);

}  // namespace momenta
