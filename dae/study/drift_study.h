#pragma once
// The drift study: one mechanism run in every form.

#include <momenta/dae/study/journal.h>
#include <momenta/dae/study/timing.h>

#include <functional>
#include <string>
#include <vector>

namespace momenta {

/// The request for a drift study: the same for all forms.
struct DriftRequest {
  std::vector<std::string> forms;  ///< empty: all
  std::string integrator;  ///< of the ODE forms; empty: rk4 when there is a step, else dop853
  std::string gauge;     ///< of the momentum forms; empty: leak, for `momentum` also reset and none
  double rtol = 1e-8;    ///< relative tolerance
  double atol = 1e-8;    ///< absolute one, in scales of the unknowns
  double step = 0;       ///< [s]
  double end_time = 10;  ///< [s]
  int samples = 1000;    ///< output intervals
  double baumgarte_alpha = 0;  ///< α of Φ̈ + 2αΦ̇ + β²Φ = 0 [1/s]; 0: the form's own
  double baumgarte_beta = 0;   ///< β of it [1/s]; 0: the form's own
  double beta = 0;             ///< Φ̇ = −βΦ of momentum forms [1/s]
  double penalty = 0;          ///< of augmented Lagrangians; 0: their own
  bool project = false;  ///< correct positions in the ODE forms; false: one projected run of each
                         ///< kind is added
  const Reference* reference = nullptr;  ///< bound to trajectory_columns(mechanism), or null
  Timing timing = Timing::rounds;        ///< how finished runs are timed
  double max_cpu_seconds = 0;            ///< of each run; 0: none
  int film_intervals = 0;                ///< of each run; 0: no films
  Journal* journal = nullptr;            ///< finished runs are taken from it, and new ones recorded
  int threads = 1;                       ///< for the watched runs; each alone is timed after them
  /// Called before and during each run, by one thread at a time, with the number of the run, how
  /// many there are, a label and the fraction done; return false to stop the study.
  std::function<bool(int, int, const std::string&, double)> progress;
};

/// Runs the study. The runs are in the order of the tables; failed ones are among them, with their
/// reason.
std::vector<RunResult> run_drift_study(const Mechanism& mechanism, const Start& start,
                                       const DriftRequest& request);

}  // namespace momenta
