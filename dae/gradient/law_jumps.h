#pragma once
// Jumps of forces by formulas along a run. A derivative of the pieces is that of the run as long as
// forces are continuous; where one jumps at a place of the motion, the moment of the jump moves
// with θ, and the tangents jump too, which no step here does.
//
// Of a step the force is looked at in nine places, and where it changes most between two of them,
// these are halved, the half of more change each time: what is continuous changes less and less.

#include <momenta/dae/event/event_values.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace momenta {

class LawJumps {
 public:
  /// Of forces by formulas of the motion with if(…), sign or floor. The mechanism must outlive it.
  explicit LawJumps(const Mechanism& mechanism);
  bool any() const { return !laws_.empty(); }
  bool takes_rates() const { return any() && values_->takes_rates(); }
  /// q and u at a time in a step; false: there is no value.
  using Motion = std::function<bool(double t, Eigen::VectorXd& q, Eigen::VectorXd& u)>;
  /// The first jump in the step, one sentence; empty: none.
  std::string in_step(double t0, double t1, const Motion& motion);

 private:
  std::vector<std::string> laws_;
  std::unique_ptr<EventValues> values_;
};

}  // namespace momenta
