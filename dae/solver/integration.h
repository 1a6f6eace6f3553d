#pragma once
// What every integrator takes and gives, whatever its method.

#include <momenta/dae/solver/system.h>

#include <functional>
#include <string>
#include <vector>

namespace momenta {

/// How an integrator is to go.
struct IntegrationOptions {
  double rtol = 1e-8;  ///< relative tolerance of the local error
  double atol = 1e-8;  ///< times the system's scale(i)
  double step = 0;     ///< fixed step [s]; needed by rk4, gauss, generalised-alpha. dp5, dop853,
                       ///< vern9, radau5: > 0 means steps of this length without error control.
                       ///< Ignored by the multistep methods
  double initial_step = 0;          ///< 0: chosen by the method
  double max_step = 0;              ///< 0: none
  int max_order = 0;                ///< multistep; 0: the method's own limit
  double spectral_radius = 0.8;     ///< generalised-alpha: at infinite frequency, in [0, 1)
  long max_steps = 50'000'000;      ///< a run of more fails
  double max_cpu_seconds = 0;       ///< 0: none; a run beyond it stops with status "time limit"
  double spent_cpu_seconds = 0;     ///< of them, before a run that goes on
  const Memory* carried = nullptr;  ///< what a run carried that goes on; null: from the start
  bool until_stiff = false;         ///< dp5, dop853, vern9: end where `stiff_from` is known
};

/// What an integration took.
struct Counters {
  long steps = 0;              ///< accepted
  long rejected = 0;           ///< steps that were taken again
  long evaluations = 0;        ///< of right-hand sides or residuals
  long jacobians = 0;          ///< of Newton's matrices
  long factorizations = 0;     ///< of (7), or of Newton's matrix
  long newton_iterations = 0;  ///< of implicit methods
  /// Of the steps, those of DAE methods taken as an ODE near singular poses.
  long ode_restarts = 0;

  /// One integration after another.
  Counters& operator+=(const Counters& other) {
    steps += other.steps, rejected += other.rejected, evaluations += other.evaluations;
    jacobians += other.jacobians, factorizations += other.factorizations;
    newton_iterations += other.newton_iterations, ode_restarts += other.ode_restarts;
    return *this;
  }
};

/// Interpolates the last accepted step: y (size of the system) at any t in [t0, t1].
using Interpolant = std::function<void(double t, double* y)>;

/// Looks on while a run goes; return false to stop the run. Either may be empty.
struct Observer {
  /// At each requested output time, in order: the state there (step end where it coincides, else
  /// dense output). `ydot` is null for ODE systems.
  std::function<bool(double t, const double* y, const double* ydot)> sample;
  /// After each accepted step over [t0, t1] (before any after_step change is seen by the
  /// interpolant).
  std::function<bool(double t0, double t1, const Interpolant& between)> step;
  /// Before steps of explicit Runge-Kutta methods, where the system can be put down: `carry` writes
  /// down what there is at t, for IntegrationOptions::carried.
  std::function<void(double t, const std::function<void(Memory&)>& carry)> before_step;
};

/// How an integration ended.
struct IntegrationResult {
  bool done = false;      ///< the end was reached
  std::string reason;     ///< one sentence when not done: what failed, at which time, why
  double end_time = 0;    ///< where the run stopped [s]
  std::vector<double> y;  ///< the state there
  Counters counters;      ///< of the whole of it
  /// Since when an explicit method's steps were as long as its stability allows, not its tolerance
  /// [s]; NaN: they were not.
  double stiff_from = std::numeric_limits<double>::quiet_NaN();
  bool ended_stiff = false;   ///< not done for `until_stiff` alone; y is the state to go on from
  std::string linear_solver;  ///< implicit methods: "dense LU", "KLU"; else empty
  std::string jacobian;  ///< implicit methods: "dual numbers", "difference quotient"; else empty
};

/// Integrates from y0 at t0 through output_times (ascending, the last is the end). Names: rk4 dp5
/// dop853 vern9. Hot loop allocates nothing. @throws std::invalid_argument for a name it does not
/// know.
IntegrationResult integrate_explicit(const std::string& method, OdeSystem&, double t0,
                                     const std::vector<double>& y0,
                                     const std::vector<double>& output_times,
                                     const IntegrationOptions&, const Observer&);

/// CVODE; names: adams bdf. Newton with difference-quotient dense Jacobian for bdf, fixed-point for
/// adams.
IntegrationResult integrate_cvode(const std::string& method, OdeSystem&, double t0,
                                  const std::vector<double>& y0,
                                  const std::vector<double>& output_times,
                                  const IntegrationOptions&, const Observer&);

/// IDA, started by system.start(t0); dense LU or KLU by the system's pattern, always with the
/// system's exact Jacobian.
IntegrationResult integrate_ida(DaeSystem&, double t0, const std::vector<double>& output_times,
                                const IntegrationOptions&, const Observer&);

}  // namespace momenta
