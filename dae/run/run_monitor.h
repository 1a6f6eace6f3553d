#pragma once
// The run monitor: measures drift, energy, errors and faded rows along a run, at the output times
// (run_monitor.cpp) and between the steps (run_monitor_steps.cpp), and finds events: those of the
// scene as written, whatever joints the run cuts. Only run_form.cpp uses it.

#include <momenta/dae/run/departures.h>
#include <momenta/dae/run/event_watch.h>
#include <momenta/dae/run/integrated_work.h>
#include <momenta/dae/run/loop_closure_monitor.h>
#include <momenta/dae/run/measure/drive_power.h>
#include <momenta/dae/run/passed_limits.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/run/sample_errors.h>
#include <momenta/dae/run/singular_crossings.h>
#include <momenta/dae/topology/cut/integrated_scene.h>
#include <momenta/dae/topology/cut/original_scene_motion.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace momenta {

class RunMonitor {
 public:
  /// `stops`: null where there are none.
  RunMonitor(const Mechanism& mechanism, const IntegratedScene& scene, Form& form,
             const Start& start, const RunRequest& request, RunResult& result, RigidStops* stops);

  /// Begins the next phase of a run with rigid stops: `form` is of the acting mechanism, whose
  /// forces and power are measured. @pre there are stops
  void go_on(double t, Form& form);

  /// State where rigid stops are met or let go, and which.
  struct Hit {
    double t = 0;
    Eigen::VectorXd q, u;
    std::vector<std::size_t> stops;
  };
  const std::optional<Hit>& hit() const { return hit_; }
  /// Energy that stops took at an impact [J].
  void take_energy(double taken) { work_.add(-taken); }

  /// Takes another output of the last step, of full order.
  void take_exact(const Interpolant& exact) {
    exact_ = exact;
    if (events_) events_->has_exact();
  }

  /// Times of samples to come; they must outlive this.
  void expect_samples_at(const std::vector<double>& times) { output_times_ = &times; }

  /// Looks at a sample; `ydot` may be null. False: the run is to end.
  bool sample(double t, const double* y, const double* ydot);
  /// Looks at the step just taken, up to the event that ends the run.
  bool step(double t0, double t1, const Interpolant& between);
  /// Adds to the result what only the end of the run tells.
  void finish();

  /// The event that ended the run, in words; else empty.
  const std::string& ended_by() const { return ended_by_; }
  double ended_at() const { return ended_at_; }  ///< [s]
  const std::string& trouble() const { return trouble_; }
  /// One sentence if loops came apart; else empty.
  const std::string& came_apart() const { return came_apart_; }
  /// Last state with closed loops, if there are drives and loops.
  struct Closed {
    double t = 0;
    Eigen::VectorXd q;
  };
  const Closed& last_closed() const { return closed_; }

  /// Whether carry() has all: no stops, no solver that remembers.
  bool can_be_put_down() const {
    return !stops_ && (!solver_ || !solver_->remembers()) &&
           (!integrated_solver_ || !integrated_solver_->remembers());
  }
  /// Saves or restores, between steps, what is not in the result.
  void carry(Memory& memory);

 private:
  /// Reads the state into `now_`, with unit quaternions: interpolants leave them off by the
  /// tolerance.
  bool read(double t, const double* y, const double* ydot);
  /// Reads the coordinates of `state_` into `middle_`.
  bool read_coordinates(double t);
  /// Reads a state inside the last step for events; sets `u` only with `rates`.
  bool read_at(double t, bool exact, bool rates, const Eigen::VectorXd*& q,
               const Eigen::VectorXd*& u);
  /// Sets `state_` to the state at an event.
  void take_state_at(double t) { (exact_ ? exact_ : *between_)(t, state_.data()); }

  /// Drifts and energy of `now_`, where `e_` is then placed and moved.
  struct Measured {
    Drift position, velocity;
    double kinetic = 0, potential = 0, energy = 0;  ///< energy less the work done so far [J]
  };
  Drift position_drift(double t, const Eigen::VectorXd& q);
  Measured measure(double t, const Drift& position);
  void note(double t, const Measured& now);
  bool keep_row(double t, const Measured& now);
  std::vector<double> kept_row() const;
  /// Row of the trajectory at an event; empty: none kept, or not readable.
  std::vector<double> row_at(double t);
  /// @pre phi_ is Φ at (t, q)
  void keep_closed(double t, const Eigen::VectorXd& q);

  /// `inside`: the energy at times inside the step will be asked for.
  bool look_between(double t0, double t1, const Interpolant& between, bool inside);
  bool look_at_middle(double t, const Interpolant& between);
  /// Power of what has no potential: the sum, and that of absolute values.
  bool power(double t, const Interpolant& between, double& watts, double& flow);
  /// Adds the film's frames within the last step.
  void film_until(double t1, const Interpolant& between);
  /// Whether an output time up to t is left.
  bool sample_before(double t);
  /// Takes the samples up to t, inside the last step. False: the run is to end.
  bool sample_until(double t);
  /// Takes the samples up to stops that are met, and the state there. @return false
  bool meet(double t, const std::vector<EventWatch::Found>& found);
  /// Takes the samples up to the event that ends the run, and one there. @return false
  bool end_at(double t, const EventWatch::Found& event);

  const Mechanism& mechanism_;
  Form* form_;
  const RunRequest& request_;
  RunResult& result_;
  std::unique_ptr<Evaluation<double>> e_;
  std::unique_ptr<LoopSolver> solver_;
  std::optional<OriginalSceneMotion> written_;  ///< if the run integrates another scene
  std::unique_ptr<Evaluation<double>> integrated_e_;
  std::unique_ptr<LoopSolver> integrated_solver_;
  RigidStops* stops_;
  std::unique_ptr<Evaluation<double>> acting_e_;  ///< for runs with rigid stops
  std::unique_ptr<LoopSolver> acting_solver_;
  std::optional<DrivePower> drives_;
  std::unique_ptr<BearingFriction> friction_;  ///< null without bearings

  Snapshot now_, of_form_;  ///< state of the scene as written, of the integrated one
  std::vector<double> state_;
  Eigen::VectorXd residue_;  ///< Φ at the start where redundant equations leave it open, or empty
  Eigen::VectorXd phi_, drift_, middle_;
  SampleErrors errors_;
  TrajectoryRow row_;

  const std::vector<double>* output_times_ = nullptr;
  std::size_t next_ = 0;  ///< first output time left
  bool works_;            ///< forces beside drives have no potential
  IntegratedWork work_;
  PassedLimits limits_;
  std::optional<EventWatch> events_;
  std::optional<Hit> hit_;
  const Interpolant* between_ = nullptr;  ///< output of the last step while it is looked at
  Interpolant exact_;
  std::string ended_by_;
  double ended_at_ = 0;
  std::optional<SingularCrossings> singular_crossings_;
  std::optional<LoopClosureMonitor> apart_;
  Departures departures_;
  std::string came_apart_;
  Closed closed_;
  double energy_at_start_ = 0, potential_at_start_ = 0;
  Drift largest_between_;
  double fastest_ = 0;  ///< rate of a joint at the samples, in lengths of the scene [1/s]
  long rows_ = 0;       ///< rows of the trajectory
  std::string trouble_;
};

}  // namespace momenta
