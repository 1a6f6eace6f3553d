#pragma once
// The numbers g of a scene's events (EventSpec::when) at states of its mechanism:
//
//   J.q, J.u      from q and u; of a driven coordinate its motion law and the rate of that
//   M.x … M.vz    from the poses and velocities of the open chain, which has the same q and u
//   S.length      |x_child − x_parent|;  S.rate  (x_child − x_parent)·(v_child − v_parent)/length
//   C.l, C.rate   Σ ratios q, Σ ratios u
//
// and of a Lagrangian its coordinates, their rates, t and the parameters.

#include <momenta/core/expression/expression.h>
#include <momenta/core/scene/drive.h>
#include <momenta/core/scene/formula.h>
#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

namespace momenta {

/// Owns its workspace; one object serves one thread. The mechanism must outlive it.
class EventValues {
 public:
  /// Takes events of the mechanism's scene, or of a like one. @throws SceneError for a formula that
  /// is none, one sentence
  EventValues(const Mechanism& mechanism, const std::vector<EventSpec>& events);

  std::size_t size() const { return events_.size(); }
  /// Whether any event depends on u.
  bool takes_rates() const { return takes_rates_; }
  /// g of each event at (t, q, u), NaN where a formula has no value. `u` may be anything where
  /// rates are not taken. O(lengths of the formulas); with markers or lengths of springs O(bodies)
  void at(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u, double* values);

 private:
  /// Source of a formula's variable.
  struct Input {
    enum class Of { number, time, q, u, law, law_rate, place, velocity, length, length_rate, sum };
    Of of = Of::number;
    int which = 0;      ///< index into q, u, laws_, points_; for lengths that of the child's point
    int component = 0;  ///< component of a point; for lengths the index of the parent's point
    double number = 0;  ///< a parameter
    std::vector<std::pair<double, Input>> terms{};  ///< terms of a sum, with their ratios
  };
  struct Event {
    Expression formula;
    std::vector<Input> inputs;
  };
  void take_lagrangian(const std::vector<EventSpec>& events);
  Input input_of(const Signal& signal);
  Input coordinate(const std::string& joint, int component, bool rate);
  int point(const std::string& body, const Eigen::Vector3d& at);
  double value(const Input& input, double t, const Eigen::VectorXd& q,
               const Eigen::VectorXd& u) const;

  const Mechanism& mechanism_;
  std::vector<Event> events_;
  bool takes_rates_ = false;
  std::vector<MotionLaw> laws_;
  std::vector<MarkerSpec> points_;
  std::unique_ptr<Mechanism> open_;  ///< the chain with these points alone; null: no points
  std::unique_ptr<Evaluation<double>> e_;
  std::vector<double> places_;  ///< position, velocity of each point
  std::vector<double> x_, line_;
};

}  // namespace momenta
