#pragma once
// Jumps of forces and drives by formulas along a run. A derivative of the pieces is that of the run
// as long as forces are continuous; where one jumps at a place of the motion, or at a time that θ
// moves, the moment of the jump moves with θ, and the tangents jump too, which no step here does.
// Of a drive the rate may not jump either, nor, on accelerations, the second one.
//
// Of a step the force is looked at in nine places, and where it changes most between two of them,
// these are halved, the half of more change each time: what is continuous changes less and less.

#include <momenta/core/scene/drive.h>
#include <momenta/dae/event/event_values.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace momenta {

class LawJumps {
 public:
  /// Of forces and drives by formulas with if(…), sign, floor, atan2 or a divisor of the motion, or
  /// of numbers that differ in one of the `others`, scenes of other θ. The mechanism must outlive
  /// it.
  LawJumps(const Mechanism& mechanism, const std::vector<Scene>& others, bool of_accelerations);
  bool any() const { return !laws_.empty(); }
  bool takes_rates() const { return values_ && values_->takes_rates(); }
  /// q and u at a time in a step; false: there is no value.
  using Motion = std::function<bool(double t, Eigen::VectorXd& q, Eigen::VectorXd& u)>;
  /// The first jump in the step, one sentence; empty: none.
  std::string in_step(double t0, double t1, const Motion& motion);

 private:
  std::vector<std::string> laws_;  ///< in words: those of forces, then of drives
  std::unique_ptr<EventValues> values_;
  std::vector<MotionLaw> drives_;
  bool of_accelerations_;
};

}  // namespace momenta
