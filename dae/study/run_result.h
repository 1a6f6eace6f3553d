#pragma once
// One run of one form by one integrator: what was asked, what came out. The rows of every table,
// CSV, JSON and page.

#include <momenta/dae/solver/integration.h>
#include <momenta/dae/study/picture.h>

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace momenta {

inline constexpr double not_measured =
    std::numeric_limits<double>::quiet_NaN();  ///< JSON null, empty CSV cell

/// Drift below this is the rounding of Φ, or of Φ̇, itself: no growth law is read from it [m, m/s].
inline constexpr double rounding_level = 1e-13;

inline constexpr int most_samples = 10'000'000;  ///< of a run

struct RunSettings {
  std::string form = "momentum";
  std::string integrator = "dop853";
  std::string when_stiff;  ///< goes on from where the problem turns out stiff; empty: `integrator`
  std::string gauge = "none";  ///< none, leak:κ, reset, flip; empty for acceleration forms
  double rtol = 1e-8, atol = 1e-8;
  double step = 0;       ///< [s], 0 for adaptive integrators
  double end_time = 10;  ///< [s]
  int samples = 1000;    ///< output intervals
  bool project = false;  ///< one mass-metric position correction after each accepted step
  double baumgarte_alpha = 0, baumgarte_beta = 0;  ///< [1/s]: Φ̈ + 2αΦ̇ + β²Φ = 0
  double beta = 0;                                 ///< [1/s]: Φ̇ = −βΦ of momentum forms
  double penalty = 0;            ///< of augmented Lagrangians, in effective masses of the loops
  double spectral_radius = 0.8;  ///< of generalised-alpha
  std::string kkt;  ///< how (7) is solved: dense, sparse, or empty (no loops, or solved inside
                    ///< IDA's Newton matrix)
};

/// A fitted power law running_max(t) ~ t^exponent (measure/growth.h).
struct Growth {
  double exponent = not_measured;
  double half_range = not_measured;  ///< half the spread of the slopes of sub-ranges
  double from = 0, to = 0;           ///< fitted range of t [s]
};

/// Time series at the output times, all of one length; what the charts draw and trajectory.csv
/// holds.
struct Series {
  std::vector<double> t;               ///< [s]
  std::vector<double> position_drift;  ///< |Φ(q, t)|₂
  std::vector<double> velocity_drift;  ///< |Φ̇(q, q̇, t)|₂
  std::vector<double> energy;  ///< T + V less the work of dampers and of wrenches without potential
                               ///< [J]; NaN with drives
  std::vector<double> energy_error;  ///< energy − energy(0) [J]
  std::vector<double> impulse;       ///< |σ|₂ of momentum forms, |λ|₂ of the others
  std::vector<double>
      position_error;  ///< against the reference, max |err|/(1+|ref|); empty without one
  std::vector<double> velocity_error;
};

/// trajectory.csv: one column per quantity, rows at the output times.
struct Trajectory {
  std::vector<std::string> columns;       ///< "t [s]", "O.q [rad]", …
  std::vector<std::vector<double>> rows;  ///< each of columns.size()
};

struct RunResult {
  std::string scene;
  RunSettings settings;
  /// done, failed, time limit; came apart: the loops opened by more than a form may leave (apart.h)
  std::string status = "done";
  std::string reason;     ///< one sentence when not done
  double stopped_at = 0;  ///< [s]
  /// Since when the steps of an explicit method were held by stability (solver/stiffness.h) [s].
  double stiff_from = not_measured;
  /// Since when `settings.when_stiff` went on [s]; not_measured: it was not called.
  double changed_at = not_measured;
  Counters counters;
  long partitions = 0;  ///< how often `partitioned` chose its coordinates, the start included
  std::string jacobian, linear_solver;
  double cpu_s = not_measured, wall_s = not_measured;  ///< median of repeats, integration alone
  int repeats = 0;
  double position_drift_max = not_measured, velocity_drift_max = not_measured,
         between_steps_max = not_measured;
  Growth position_growth, velocity_growth;
  double energy_error_max = not_measured;
  /// Largest T, and largest T + |V − V(0)|, at the samples [J]: what rates and energy errors
  /// compare with.
  double kinetic_energy_max = not_measured, energy_scale = not_measured;
  double position_error_max = not_measured, velocity_error_max = not_measured;
  /// Loop equations that were redundant or nearly so, in how many right-hand sides of the run; ODE
  /// forms.
  struct Faded {
    std::string loop, row;
    long evaluations = 0;
  };
  std::vector<Faded> faded_rows;
  /// Where loop equations came near to losing rank, beyond what is redundant everywhere: the least
  /// pivot on the way, relative to what it would be without other loops; it goes with the square of
  /// the distance to the singular pose. Not where (7) is solved by KLU.
  struct SingularCrossing {
    double t = 0;      ///< [s]
    double pivot = 0;  ///< least, 0: faded
    /// The loops were open, in lengths of the scene, by as much as the pivot: motions that meet at
    /// the pose are no longer told apart, and which one went on is chance.
    bool ambiguous = false;
  };
  std::vector<SingularCrossing> singular_crossings;
  double least_pivot = not_measured;  ///< of the whole run
  /// Loop forces of the trajectory that are not unique (measure/multipliers.h), where one is kept.
  struct Undetermined {
    std::string column;
    long samples = 0;         ///< how many
    double from = 0, to = 0;  ///< the first and the last of them [s]
  };
  std::vector<Undetermined> undetermined;
  Series series;
  Trajectory trajectory;
  Film film;  ///< empty where none was asked for
};

/// Whether a run changed its integrator on the way.
inline bool changed(const RunResult& run) {
  return !std::isnan(run.changed_at);
}

struct Environment {
  std::string cpu, compiler, flags, build_type;
  int level = 1;  ///< x86-64 level of the kernels
  std::vector<std::pair<std::string, std::string>>
      versions;      ///< momenta, SUNDIALS, SuiteSparse, Eigen
  std::string date;  ///< ISO 8601
};

/// What `momenta run`, `momenta drift` and `momenta work` produce.
struct StudyResult {
  std::string scene;  ///< its name
  std::string scene_file;
  std::string scene_hash;  ///< hex digest of the scene text
  std::string command;     ///< as typed
  std::string reference;   ///< file name of the reference, or empty
  std::vector<std::pair<std::string, std::string>>
      plan;  ///< lines of the plan, as `momenta check` prints them
  Picture picture;
  std::vector<Motion> motions;  ///< of each run with a film, or one of the start alone
  Environment environment;
  std::vector<RunResult> runs;  ///< the drift runs, one per form, then (work) further rungs
  bool drift_study = true;      ///< false: a ladder of tolerances
};

}  // namespace momenta
