#pragma once
// The settings and the result of one run of one form by one integrator: the rows of every table,
// CSV, JSON and page.

#include <momenta/dae/integrator/integration.h>
#include <momenta/dae/run/measure/growth.h>
#include <momenta/dae/run/picture.h>

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace momenta {

inline constexpr int most_samples = 10'000'000;  ///< limit of samples of a run

/// The settings of a run.
struct RunSettings {
  std::string form = "momentum";      ///< one of form_names()
  std::string integrator = "dop853";  ///< one of integrators()
  std::string when_stiff;             ///< integrator that takes over if stiff; empty: none
  std::string gauge = "none";         ///< none, leak:κ, reset, flip; empty for acceleration forms
  double rtol = 1e-8;                 ///< relative tolerance
  double atol = 1e-8;                 ///< absolute tolerance, in scales of the unknowns
  double step = 0;                    ///< [s], 0 for adaptive integrators
  double end_time = 10;               ///< [s]
  int samples = 1000;                 ///< output intervals
  bool project = false;          ///< one mass-metric position correction after each accepted step
  double baumgarte_alpha = 0;    ///< α of Φ̈ + 2αΦ̇ + β²Φ = 0 [1/s]
  double baumgarte_beta = 0;     ///< β [1/s]
  double beta = 0;               ///< [1/s]: Φ̇ = −βΦ of momentum forms
  double penalty = 0;            ///< for augmented Lagrangians, in effective masses of the loops
  double spectral_radius = 0.8;  ///< for generalised-alpha
  std::string kkt;               ///< solver of (7): dense, sparse; empty: no loops, or IDA's own
};

/// Time series at the output times, of equal length, for charts and trajectory.csv.
struct Series {
  std::vector<double> t;                 ///< [s]
  std::vector<double> position_drift;    ///< |Φ(q, t)|₂ of rows in `RunResult::drift_unit`
  std::vector<double> velocity_drift;    ///< |Φ̇(q, q̇, t)|₂ of the same rows
  std::vector<double> angle_drift;       ///< |Φ|₂ of rows in rad, where others are in m [rad]
  std::vector<double> angle_rate_drift;  ///< [rad/s]
  std::vector<double> energy;  ///< T + V less the work of dampers, of wrenches without potential
                               ///< and of drives [J]
  std::vector<double> energy_error;  ///< energy − energy(0) [J]
  std::vector<double> impulse;       ///< |σ|₂ of momentum forms, |λ|₂ of the others
  /// Position error against the reference, max |err|/(1+|ref|); empty without a reference.
  std::vector<double> position_error;
  std::vector<double> velocity_error;  ///< the same for rates
  /// Error of λ from (3) at (t, q, u), and of other forces, against a reference that has them;
  /// unique ones alone.
  std::vector<double> force_error;
  /// Error of λ as the form itself has it: in its state, or σ̇ + κσ; else empty.
  std::vector<double> multiplier_error;
  /// λ of the form itself against that of (3), max |difference|/(1+|λ|); else empty.
  std::vector<double> multiplier_difference;
  // Errors against a reference that has these columns (study/force_columns.h); else empty.
  std::vector<double> momentum_error;  ///< p without its gauge (study/reference_errors.h)
  std::vector<double> impulse_error;   ///< ∫λ dt
  std::vector<double> effort_error;    ///< efforts of drives, where unique
  std::vector<double> reaction_error;  ///< reactions of joints, where unique
  std::vector<double> work_error;      ///< work of drives and of what has no potential
};

/// trajectory.csv: one column per quantity, rows at the output times.
struct Trajectory {
  std::vector<std::string> columns;       ///< "t [s]", "O.q [rad]", …
  std::vector<std::vector<double>> rows;  ///< columns.size() numbers each
};

/// A joint or a length along a force beyond its limits, or a point beyond the ends of an open slot.
struct PassedLimit {
  std::string joint;       ///< name of the joint, force or slot
  double least = 0;        ///< lower limit [rad or m]
  double largest = 0;      ///< upper limit [rad or m]
  double since = 0;        ///< first time beyond [s]
  double farthest = 0;     ///< coordinate farthest beyond [rad or m]
  double farthest_at = 0;  ///< time of `farthest` [s]
  bool slides = false;     ///< in m, else rad
  bool stops = false;      ///< the limits push back
  bool of_slot = false;    ///< a slot; limits: 0 and its length along the chords
  bool of_force = false;   ///< the length along a force
};

/// An event of the scene that a run met.
struct FoundEvent {
  std::string name;  ///< as by name_of()
  double t = 0;      ///< [s]
  bool up = false;   ///< its number is positive afterwards
  /// Row of a kept trajectory there, by the columns of RunResult::trajectory.
  std::vector<double> row;
};

/// A contact at a rigid stop.
struct StopContact {
  std::string joint;   ///< name
  double limit = 0;    ///< the limit met [rad or m]
  double t = 0;        ///< [s]
  std::string what;    ///< impact; held: the stop begins to hold its coordinate; released
  double before = 0;   ///< rate before an impact [rad/s or m/s]
  double after = 0;    ///< rate after the impact
  double impulse = 0;  ///< impulse of the stop, at least 0 [N m s or N s]
};

/// The result of a run.
struct RunResult {
  std::string scene;     ///< name
  RunSettings settings;  ///< as given, with defaults filled in
  /// done; event: one of the scene's ended it; failed; time limit; came apart: loops opened too far
  /// (loop_closure_monitor.h), or the balance of energy or the rates of loops were lost
  /// (departures.h)
  std::string status = "done";
  std::string reason;  ///< one sentence when not done
  /// One sentence on how far the balance of energy or the rates of loops are off, if that makes a
  /// finished run unreliable (departures.h); else empty.
  std::string departure;
  double stopped_at = 0;  ///< [s]
  /// Time [s] since which stability limited the steps of an explicit method (solver/stiffness.h).
  double stiff_from = not_measured;
  /// Time [s] at which `settings.when_stiff` took over; else not_measured.
  double changed_at = not_measured;
  Counters counters;             ///< work of the run
  long partitions = 0;           ///< choices of coordinates by `partitioned`, with the start
  std::string jacobian;          ///< implicit methods: "dual numbers", "difference quotient"
  std::string linear_solver;     ///< implicit methods: "dense LU", "KLU"
  double cpu_s = not_measured;   ///< median of repeats, integration alone
  double wall_s = not_measured;  ///< the same, elapsed time
  int repeats = 0;               ///< count
  std::string untimed;           ///< why repeats gave no times; one clause, empty: they did
  /// Unit of the position drift: m, or rad where all rows of Φ are angles; empty without loops.
  std::string drift_unit;
  /// Position drifts below it are rounding, or left open by the start [drift_unit].
  double drift_rounding = rounding_level;
  double angle_rounding = rounding_level;  ///< likewise for angles [rad]
  /// Largest |Φ|₂ at the samples.
  double position_drift_max = not_measured;
  double velocity_drift_max = not_measured;  ///< largest |Φ̇|₂ there
  double between_steps_max = not_measured;   ///< largest |Φ|₂ between steps, before corrections
  Growth position_growth;                    ///< power law of the position drift
  Growth velocity_growth;                    ///< power law of the velocity drift
  /// Largest drift at the samples of the rows in rad, where other rows are in m [rad]; else not
  /// measured, as are the next four.
  double angle_drift_max = not_measured;
  double angle_rate_drift_max = not_measured;     ///< [rad/s]
  double angle_between_steps_max = not_measured;  ///< [rad]
  Growth angle_growth;                            ///< power law of the angles' drift
  Growth angle_rate_growth;                       ///< power law of its rate
  double energy_error_max = not_measured;    ///< largest |energy − energy(0)| at the samples [J]
  double kinetic_energy_max = not_measured;  ///< largest T at the samples [J], the scale of rates
  /// Largest T + |V − V(0)| at the samples [J]: energy errors compare to it.
  double energy_scale = not_measured;
  /// energy_scale, with V in the middle of steps too, and energy through dampers, friction,
  /// formulas, drives and impacts [J].
  double energy_turned_over = not_measured;
  /// Coordinates at the end, slides in lengths of the scene; empty unless singular crossings are
  /// looked for.
  std::vector<double> last_pose;
  double position_error_max = not_measured;         ///< largest of Series::position_error
  double velocity_error_max = not_measured;         ///< largest of Series::velocity_error
  double force_error_max = not_measured;            ///< largest of Series::force_error
  double multiplier_error_max = not_measured;       ///< largest of Series::multiplier_error
  double multiplier_difference_max = not_measured;  ///< largest of Series::multiplier_difference
  double momentum_error_max = not_measured;         ///< largest of Series::momentum_error
  double impulse_error_max = not_measured;          ///< largest of Series::impulse_error
  double effort_error_max = not_measured;           ///< largest of Series::effort_error
  double reaction_error_max = not_measured;         ///< largest of Series::reaction_error
  double work_error_max = not_measured;             ///< largest of Series::work_error
  /// A joint whose reaction is compared with a reference's, or is not unique.
  struct ReactionError {
    std::string joint;                ///< name
    double error_max = not_measured;  ///< largest |error|/(1+|ref|) of its columns; NaN: none
    long not_unique = 0;              ///< number of the reference's times
  };
  /// By joint_places(); empty without a reference of reactions.
  std::vector<ReactionError> reaction_errors;
  /// Scene integrated in place of the written one (cut/integrated_scene.h); empty: none.
  std::string integrated;
  int rank = 0;  ///< rank of Φ_q at the start (kkt/loop_rank.h)
  /// A row that follows from the others at the start.
  struct DependentRow {
    std::string loop;  ///< name of the loop
    std::string row;   ///< name of the equation
  };
  std::vector<DependentRow> dependent_rows;  ///< empty: the equations are independent there
  /// One sentence on the residue of the start; else empty.
  std::string residue;
  /// Number of right-hand sides with more faded rows than redundant ones at the start: in ODE
  /// forms, near singular poses or with nearly redundant equations.
  long weak_evaluations = 0;
  /// A row that faded during the run; ODE forms.
  struct Faded {
    std::string loop;      ///< name of the loop
    std::string row;       ///< name of the equation
    long evaluations = 0;  ///< number of right-hand sides
  };
  std::vector<Faded> faded_rows;  ///< empty: the equations were independent
  /// A singular crossing: the run came near a pose where the loop equations lose more rank than
  /// they lack everywhere. The pivot, relative to its value without other loops, is proportional to
  /// the square of the distance to that pose. Not measured where KLU solves (7).
  struct SingularCrossing {
    double t = 0;      ///< [s]
    double pivot = 0;  ///< least pivot; 0: faded
    /// The loops were open, in lengths of the scene, by as much as the pivot: chance decides which
    /// of the motions that meet at the pose the run follows.
    bool ambiguous = false;
  };
  std::vector<SingularCrossing> singular_crossings;  ///< by time
  double least_pivot = not_measured;                 ///< least pivot of the whole run
  /// Loop forces of a kept trajectory that are not unique (kkt/multipliers.h).
  struct Undetermined {
    std::string column;  ///< column of the trajectory
    long samples = 0;    ///< count
    double from = 0;     ///< time of the first [s]
    double to = 0;       ///< time of the last [s]
  };
  std::vector<Undetermined> undetermined;  ///< empty: all are unique
  std::vector<PassedLimit> passed_limits;  ///< joints beyond their limits, by time
  std::vector<FoundEvent> events;          ///< by time
  std::vector<std::string> event_remarks;  ///< one sentence for each event that had no value
  std::vector<StopContact> stops;          ///< contacts at rigid stops, by time
  Series series;                           ///< measures at the output times
  Trajectory trajectory;                   ///< empty unless asked for
  Film film;                               ///< empty unless asked for
};

/// Unit of the position drift of a run.
inline std::string drift_unit(const RunResult& run) {
  return run.drift_unit.empty() ? "m" : run.drift_unit;
}
/// Whether a run has drifts of angles besides those of lengths.
inline bool has_both_drifts(const RunResult& run) {
  return !run.series.angle_drift.empty() || !std::isnan(run.angle_drift_max);
}

/// Whether a run reached its end, or an event that ends it.
inline bool finished(const RunResult& run) {
  return run.status == "done" || run.status == "event";
}

/// Whether a finished run is reliable.
inline bool reliable(const RunResult& run) {
  return finished(run) && run.departure.empty();
}

/// Whether a run changed its integrator.
inline bool changed(const RunResult& run) {
  return !std::isnan(run.changed_at);
}

/// The machine and the build that made a result.
struct Environment {
  std::string cpu;         ///< name of the processor
  std::string compiler;    ///< name and version
  std::string flags;       ///< compiler flags, kernels excepted
  std::string build_type;  ///< "Release"
  int level = 1;           ///< x86-64 level of the kernels
  std::vector<std::pair<std::string, std::string>>
      versions;      ///< momenta, SUNDIALS, SuiteSparse, Eigen
  std::string date;  ///< ISO 8601
};

/// The result of `momenta run`, `momenta drift` and `momenta work`.
struct StudyResult {
  std::string scene;       ///< name
  std::string scene_file;  ///< file, or empty
  std::string scene_hash;  ///< hex digest of the scene text
  std::string command;     ///< as typed
  std::string reference;   ///< file name of the reference, or empty
  std::vector<std::pair<std::string, std::string>>
      plan;                     ///< lines of the plan, as `momenta check` prints them
  Picture picture;              ///< picture on the page
  std::vector<Motion> motions;  ///< one for each run with a film, or one of the start alone
  Environment environment;      ///< machine and build
  std::vector<RunResult> runs;  ///< the drift runs, one per form, then (work) further rungs
  bool drift_study = true;      ///< false: a ladder of tolerances
};

}  // namespace momenta
