#pragma once
// A Poincaré section: the states at which runs pass a surface g(t, q, u) = 0 in one direction,
// found as events are (event/crossings.h). Of one start, or of several of one energy: a start value
// x is varied, and one rate r is led so that
//
//   E(r) = T + V = E₀,   E(r) = a r² + b r + c
//
// with E₀ that of the scene's start: T is quadratic in the rates, and with loops the rates that are
// nearest to the guess are linear in it. a, b, c come from r = −1, 0, 1; of the two roots that one
// is taken that has the sign of the scene's own r. A value for which there is none is left out.

#include <momenta/dae/run/run_form.h>

#include <functional>
#include <string>
#include <vector>

namespace momenta {

/// Settings and start values of the runs.
struct SectionRequest {
  RunSettings settings;        ///< form, integrator, tolerances, end; samples are not looked at
  std::string varied;          ///< varied start value, "O.q" or "O.u"; empty: none
  std::vector<double> values;  ///< values of `varied` [its unit]
  std::string led;             ///< a rate, "A.u", that keeps the energy; empty: none
  double max_cpu_seconds = 0;  ///< per run; 0: none
  /// Called at samples with the number of the start; return false to stop. May be empty.
  std::function<bool(std::size_t start)> progress;
};

/// The points of one start.
struct SectionOrbit {
  double value = not_measured;   ///< value of `varied`
  double energy = not_measured;  ///< at the start [J]
  std::string left_out;          ///< one sentence if no start has the energy
  RunResult run;                 ///< its events are the points
};

/// Runs each start. The mechanism's scene has one event, whose crossings are the section. @throws
/// std::invalid_argument for a name that is none
std::vector<SectionOrbit> section(const Mechanism& mechanism, const SectionRequest& request);

}  // namespace momenta
