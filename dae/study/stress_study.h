#pragma once
// The stress study: which form survives which scenes. A ladder is a series of ever harder scenes;
// each form with its integrator is run up each ladder until it fails, and the kind of failure is
// recorded.
//
// A run has survived when it reached its end within the time limit and
//
//   position drift   max |Φ| / length of the scene
//   energy    max |E(t) − E(0)| / max (T + |V − V(0)|)
//   error     max |q − q_ref| / (1 + |q_ref|), where there is a reference
//
// are all within one bound. Otherwise the verdict distinguishes two kinds of failure: a run that
// stopped or took too long reported it; a run with wrong results did not.

#include <momenta/dae/run/run_form.h>
#include <momenta/dae/study/extremes.h>
#include <momenta/dae/study/journal.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace momenta {

struct Rung {
  std::string label;
  Scene scene;
  MechanismOptions options = {};
};
struct Ladder {
  std::string name;
  std::vector<Rung> rungs;
  bool rising = true;  ///< ever harder: a contestant leaves at its first failure
};

/// A scene along one direction, a rung for each factor.
Ladder ladder_of(const Scene& scene, Extreme extreme, const std::vector<double>& factors);

struct Contestant {
  std::string form, integrator;  ///< no integrator: the form's default
};

enum class Verdict { survived, wrong, stopped, slow, untried };
const char* name_of(Verdict verdict);

struct StressRun {
  Contestant contestant;
  int rung = 0;
  Verdict verdict = Verdict::untried;
  std::string cause;         ///< one sentence unless survived
  double at = not_measured;  ///< time of the failure [s]
  double position_drift = not_measured, energy = not_measured, error = not_measured;
  double velocity_drift =
      not_measured;  ///< max |Φ̇| / √(2 T / m), largest kinetic energy T, whole mass m
  /// Drift of rows in rad beside rows in m [rad]; of their rates times length / √(2 T / m).
  double angle_drift = not_measured, angle_rate_drift = not_measured;
  RunResult run;  ///< without series
};

struct LadderResult {
  std::string name;
  bool rising = true;
  std::vector<std::string> rungs;            ///< labels
  std::vector<double> end_time;              ///< by rung [s]
  std::vector<std::string> refused;          ///< why a rung has no consistent start, or empty
  std::vector<double> reference;             ///< accuracy of each rung's reference; NaN without one
  std::vector<std::vector<StressRun>> runs;  ///< [contestant][rung tried]
};

struct StressResult {
  std::vector<Contestant> contestants;
  std::vector<LadderResult> ladders;
  double bound = 0, cpu_limit = 0, rtol = 0;
  bool complete = true;  ///< false: interrupted
  Environment environment;
  std::string command;
};

struct StressRequest {
  std::vector<Ladder> ladders;
  std::vector<Contestant> contestants;
  double rtol = 1e-8;  ///< = atol
  double bound = 1e-3;
  double cpu_limit = 10;            ///< per run [s]
  double reference_cpu_limit = 10;  ///< per reference in quadruple precision [s]; 0: none
  int threads = 1;
  Journal* journal = nullptr;  ///< journal of finished runs, or null
  /// Called before each run; false ends the study. Calls do not overlap.
  std::function<bool(int done, int total, const std::string& what)> progress;
};

/// Climbs all ladders. `threads` changes no result but what is too slow. @throws
/// std::invalid_argument for unknown names
StressResult run_stress_study(const StressRequest& request);

}  // namespace momenta
