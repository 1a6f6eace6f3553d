#pragma once
// Rigid stops along a run (JointSpec::restitution): the run ends at an impact and begins anew
// behind it, with the rates of event/impact.h. Between impacts a stop is open, or it holds its
// coordinate: then the mechanism that runs is the one with the loop q_j = limit beside its own, in
// any form, and the loop's λ is the force of the stop.
//
//   open     ends where the gap ±(q_j − limit) passes zero from below
//   held     ends where ±λ passes zero from above: the stop would have to pull
//
// Behind an impact with the rate v off the stop and the acceleration a towards it, the next impact
// follows after 2v/a. Impacts of e < 1 come ever closer (Zeno), so that they must end somewhere:
// where 2v/a is shorter than 10⁻⁸ of the run, or v²/2a is below the rounding of q, the impact is
// taken with e = 0, and the stop holds. What is left out is a time of 2v/a e/(1 − e), and a way of
// v²/2a. Where a method does not resolve a flight, so that its own motion is beyond the stop at
// once, the stop holds too.

#include <momenta/dae/run/event/impact.h>
#include <momenta/dae/run/run_result.h>
#include <momenta/dae/topology/assembly/assembly.h>
#include <momenta/dae/topology/cut/integrated_scene.h>

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace momenta {

class RigidStops {
 public:
  /// `span`: length of the run [s]. The mechanism must outlive it. Driven joints meet no stop.
  RigidStops(const Mechanism& mechanism, double span);

  bool any() const { return !stops_.empty(); }
  /// Stops on both sides of each joint that has them.
  std::size_t size() const { return stops_.size(); }
  bool any_held() const { return !held_.empty(); }
  /// The mechanism of this phase.
  const Mechanism& acting() const { return *acting_; }
  /// Time after the last impact without a next one [s].
  double pause() const { return pause_; }
  /// Whether a stop was met at the last impact and is open.
  bool was_met(std::size_t i) const { return met_.contains(i) && !held_.contains(i); }

  /// Start of the run: stops met there are taken as impacts. @throws SceneError for a start beyond
  /// a stop, std::runtime_error as meet()
  Start begin(const Start& start, RunResult& told);
  /// Start behind an impact at some stops, or the release of some, at (t, q, u⁻). `taken`: energy
  /// that the stops took [J]. @throws std::runtime_error, one sentence
  Start meet(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u,
             const std::vector<std::size_t>& which, RunResult& told, double& taken);

  /// Value at a state whose root ends the phase of stop i.
  double value(std::size_t i, double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u);
  /// Whether the phase ends where value() passes upwards.
  bool ends_upwards(std::size_t i) const { return !held_.contains(i); }

 private:
  struct Stop {
    std::string joint;
    int q, u;
    double side, limit, restitution;
  };
  struct Acting {
    std::unique_ptr<Mechanism> mechanism;
    std::unique_ptr<Evaluation<double>> e;
    std::unique_ptr<LoopSolver> solver;
  };
  Start behind(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& before,
               const std::vector<std::size_t>& hit, RunResult& told, double& taken);
  /// Whether the rate `off` a stop, against the acceleration `pressed` > 0, leads off it for more
  /// than 10⁻⁸ of the run and beyond rounding.
  bool is_flight(std::size_t i, double off, double pressed) const;
  Acting& with(const std::set<std::size_t>& held);
  std::string loop_name(std::size_t i) const;
  /// ±λ of a held stop, of all multipliers of the acting mechanism.
  double push(const Mechanism& acting, std::size_t i, const Eigen::VectorXd& lambda) const;
  void tell(RunResult& told, double t, std::size_t i, const char* what, double before, double after,
            double impulse) const;

  const Mechanism& mechanism_;
  double span_;
  std::vector<Stop> stops_;
  Impact impact_;
  std::set<std::size_t> held_;
  std::map<std::set<std::size_t>, Acting> made_;  ///< by held stops
  const Mechanism* acting_;
  Acting* solving_ = nullptr;
  double pause_ = 0;
  std::set<std::size_t> met_;           ///< stops met at the last impact
  std::vector<double> slack_;           ///< way beyond each stop after closing drift [rad or m]
  std::map<std::size_t, double> last_;  ///< time when each was last met [s]
  Eigen::VectorXd udot_, lambda_;
};

}  // namespace momenta
