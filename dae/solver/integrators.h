#pragma once
// The integrators by name: what each takes, how it steps, and the one place that calls it. Options,
// errors, studies and `momenta --help` ask here.

#include <momenta/dae/solver/integration.h>

#include <algorithm>
#include <string>
#include <vector>

namespace momenta {

/// One integrator, by name.
struct Integrator {
  /// Which systems it takes.
  enum class Takes {
    ode,  ///< y' = f(t, y)
    dae,  ///< F(t, y, y') = 0
  };
  /// Whether it chooses its steps.
  enum class Step {
    adaptive,  ///< by the local error
    fixed      ///< IntegrationOptions::step
  };

  std::string name;                ///< as options and tables have it
  Takes takes;                     ///< ODE or DAE
  Step step;                       ///< adaptive or fixed
  bool multistep;                  ///< carries a history: a gauge reset or flip would spoil it
  bool projects;                   ///< states may be corrected onto the constraints after each step
  std::string method;              ///< one line
  std::vector<std::string> forms;  ///< those it is for; empty: all of its kind

  /// Whether it is for the named form, a DAE or not.
  bool takes_form(const std::string& wanted, bool dae) const {
    return (takes == Takes::dae) == dae &&
           (forms.empty() || std::find(forms.begin(), forms.end(), wanted) != forms.end());
  }
};

/// All, in the order tables list them.
const std::vector<Integrator>& integrators();
/// @throws std::invalid_argument with all names for an unknown one.
const Integrator& integrator(const std::string& name);
/// "a, b or c".
std::string listed(const std::vector<std::string>& names);
/// The names of those that take such systems, listed.
std::string integrator_names(Integrator::Takes takes);

/// y' = f(t, y) from y0 by the named method. @throws std::invalid_argument for one that takes DAEs.
IntegrationResult integrate(const std::string& name, OdeSystem&, double t0,
                            const std::vector<double>& y0, const std::vector<double>& output_times,
                            const IntegrationOptions&, const Observer&);
/// F(t, y, y') = 0 from the system's own start. @throws std::invalid_argument for an ODE method.
IntegrationResult integrate(const std::string& name, DaeSystem&, double t0,
                            const std::vector<double>& output_times, const IntegrationOptions&,
                            const Observer&);

}  // namespace momenta
