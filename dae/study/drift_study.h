#pragma once
// The drift study: one mechanism run in every form.

#include <momenta/dae/study/journal.h>
#include <momenta/dae/study/timing.h>

#include <functional>
#include <string>
#include <vector>

namespace momenta {

/// Request for a drift study, the same for all forms.
struct DriftRequest {
  std::vector<std::string> forms;  ///< empty: all
  std::string integrator;          ///< for ODE forms; empty: rk4 with a step, else dop853
  std::string gauge;     ///< for momentum forms; empty: leak, for `momentum` also reset and none
  double rtol = 1e-8;    ///< relative tolerance
  double atol = 1e-8;    ///< absolute tolerance, in scales of the unknowns
  double step = 0;       ///< [s]
  double end_time = 10;  ///< [s]
  int samples = 1000;    ///< output intervals
  double baumgarte_alpha = 0;  ///< α of Φ̈ + 2αΦ̇ + β²Φ = 0 [1/s]; 0: the form's own
  double baumgarte_beta = 0;   ///< β [1/s]; 0: the form's own
  double beta = 0;             ///< Φ̇ = −βΦ of momentum forms [1/s]
  double penalty = 0;          ///< for augmented Lagrangians; 0: their own
  bool project = false;  ///< correct positions in the ODE forms; false: one projected run of each
                         ///< kind is added
  const Reference* reference = nullptr;  ///< bound to trajectory_columns(mechanism), or null
  Timing timing = Timing::rounds;        ///< timing of finished runs
  double max_cpu_seconds = 0;            ///< per run; 0: none
  int film_intervals = 0;                ///< per run; 0: no films
  Journal* journal = nullptr;            ///< journal of finished runs, or null
  int threads = 1;                       ///< for watched runs; each is timed alone afterwards
  /// Called before and during each run, by one thread at a time (number, of how many, label,
  /// fraction done); false stops the study.
  std::function<bool(int, int, const std::string&, double)> progress;
};

/// Runs the study; results in the order of the tables, failed runs with their reason.
std::vector<RunResult> run_drift_study(const Mechanism& mechanism, const Start& start,
                                       const DriftRequest& request);

}  // namespace momenta
