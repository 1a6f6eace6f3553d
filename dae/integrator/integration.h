#pragma once
// Options, counters, observers and results of integrators.

#include <momenta/dae/integrator/system.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace momenta {

/// Options of an integrator.
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
  long max_steps = 50'000'000;      ///< a run that needs more fails
  double max_cpu_seconds = 0;       ///< 0: none; a run beyond it stops with status "time limit"
  double spent_cpu_seconds = 0;     ///< spent before, where a run continues
  const Memory* carried = nullptr;  ///< what the run carried that continues; null: from the start
  bool until_stiff = false;         ///< dp5, dop853, vern9: stop as soon as `stiff_from` is known
  /// Ascending times [s] at which steps with error control end, where inputs change
  /// (core/expression/input_times.h).
  std::vector<double> stops{};

  /// The next stop farther behind t than `apart`, or the end.
  double stop_behind(double t, double end, double apart = 0) const {
    const auto next = std::upper_bound(stops.begin(), stops.end(), t + apart);
    return step > 0 || next == stops.end() ? end : std::min(*next, end);
  }
};

/// The work of an integration.
struct Counters {
  long steps = 0;              ///< accepted
  long rejected = 0;           ///< steps taken again
  long evaluations = 0;        ///< right-hand sides or residuals
  long jacobians = 0;          ///< Newton's matrices
  long factorizations = 0;     ///< (7), or Newton's matrix
  long newton_iterations = 0;  ///< implicit methods only
  /// Steps of DAE methods that were taken as an ODE near singular poses; they are among `steps`.
  long ode_restarts = 0;

  /// Adds the work of another integration.
  Counters& operator+=(const Counters& other) {
    steps += other.steps, rejected += other.rejected, evaluations += other.evaluations;
    jacobians += other.jacobians, factorizations += other.factorizations;
    newton_iterations += other.newton_iterations, ode_restarts += other.ode_restarts;
    return *this;
  }
};

/// Interpolates the last accepted step: writes y (size of the system) at any t in [t0, t1].
using Interpolant = std::function<void(double t, double* y)>;

/// Functions that an integrator calls during a run; `sample` and `step` return false to stop it.
/// Each may be empty.
struct Observer {
  /// Called at each output time, in order, with the state at the end of a step there, else from
  /// dense output. `ydot` is null for ODE systems.
  std::function<bool(double t, const double* y, const double* ydot)> sample;
  /// Called after each accepted step over [t0, t1]. The interpolant does not include changes made
  /// by after_step().
  std::function<bool(double t0, double t1, const Interpolant& between)> step;
  /// Called once, before the first step, by methods whose interpolant is less accurate than their
  /// steps' ends, with another of full order, whose every value costs a step.
  std::function<void(const Interpolant& exact)> exact;
  /// Called before steps of explicit Runge-Kutta methods, where can_be_put_down() holds. `carry`
  /// writes all that the run carries at t, for IntegrationOptions::carried.
  std::function<void(double t, const std::function<void(Memory&)>& carry)> before_step;
};

/// How an integration ended.
struct IntegrationResult {
  bool done = false;      ///< the end was reached
  std::string reason;     ///< one sentence when not done: what failed, at which time, why
  double end_time = 0;    ///< [s]
  std::vector<double> y;  ///< state there
  Counters counters;      ///< of the whole integration
  /// Time [s] since which stability, not the tolerance, limits the steps of an explicit method;
  /// NaN: it does not.
  double stiff_from = std::numeric_limits<double>::quiet_NaN();
  bool ended_stiff = false;   ///< stopped by `until_stiff` alone; y is the state to continue from
  std::string linear_solver;  ///< implicit methods: "dense LU", "KLU"; else empty
  std::string jacobian;  ///< implicit methods: "dual numbers", "difference quotient"; else empty
};

/// Integrates by an explicit Runge-Kutta method from y0 at t0 through output_times (ascending; the
/// last one is the end). Names: rk4 dp5 dop853 vern9. Steps do not allocate. @throws
/// std::invalid_argument for an unknown name.
IntegrationResult integrate_explicit(const std::string& method, OdeSystem&, double t0,
                                     const std::vector<double>& y0,
                                     const std::vector<double>& output_times,
                                     const IntegrationOptions&, const Observer&);

/// Integrates by CVODE; names: adams bdf. bdf uses Newton's method with a dense Jacobian by
/// difference quotients, adams fixed-point iteration.
IntegrationResult integrate_cvode(const std::string& method, OdeSystem&, double t0,
                                  const std::vector<double>& y0,
                                  const std::vector<double>& output_times,
                                  const IntegrationOptions&, const Observer&);

/// Integrates by IDA from system.start(t0), always with the exact Jacobian of the system; dense LU
/// or KLU, by the pattern of the system.
IntegrationResult integrate_ida(DaeSystem&, double t0, const std::vector<double>& output_times,
                                const IntegrationOptions&, const Observer&);

}  // namespace momenta
