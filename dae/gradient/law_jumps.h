#pragma once
// Jumps of forces and of drives by formulas along a run. The derivative of the pieces is that of
// the run while forces are continuous; where one jumps at a place of the motion, or at a time that
// θ moves, the moment moves with θ, and the tangents jump too, which no step here does. The rate of
// a drive may not jump either, nor, on accelerations, its second derivative.
//
// A formula is evaluated at nine times in a step. The part with the largest change is halved, then
// the half that changes more: a continuous force changes less and less. Where forces have formulas,
// which may be too steep for the steps, energies turn by a corner, bushings by half a turn, or
// springs by length zero, all forces are evaluated together, at the ends of steps: those that
// change more than in the step before are halved. Steps shorten at a jump, and what is continuous
// shrinks with them.

#include <momenta/core/scene/drive.h>
#include <momenta/dae/run/event/event_values.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace momenta {

class LawJumps {
 public:
  /// Takes forces and drives by formulas with if(…), sign, floor, atan2 or a divisor of the motion,
  /// or of numbers that differ in `others`, scenes of other θ; `inputs`: times at which forces may
  /// jump [s]. The mechanism must outlive it.
  LawJumps(const Mechanism& mechanism, const std::vector<Scene>& others, bool of_accelerations,
           std::vector<double> inputs);
  bool any() const { return !laws_.empty() || evaluation_; }
  bool takes_rates() const { return evaluation_ || (values_ && values_->takes_rates()); }
  /// q and u at a time in a step; false: none.
  using Motion = std::function<bool(double t, Eigen::VectorXd& q, Eigen::VectorXd& u)>;
  /// The first jump in the step, one sentence; empty: none.
  std::string in_step(double t0, double t1, const Motion& motion);

 private:
  std::string of_laws(double t0, double t1, const Motion& motion);
  /// Of bias and forces without accelerations (EquationRows::joint_forces).
  std::string of_forces(double t0, double t1, const Motion& motion);

  std::vector<std::string> laws_;  ///< descriptions of forces, then drives
  std::unique_ptr<EventValues> values_;
  std::vector<MotionLaw> drives_;
  bool of_accelerations_;
  std::vector<double> inputs_;
  std::unique_ptr<Evaluation<double>> evaluation_;  ///< null: forces jump by formulas alone
  std::vector<std::string> rates_;                  ///< names of u
  Eigen::VectorXd slopes_;                          ///< of the forces in the step before
  double largest_ = 0;                              ///< force so far
};

}  // namespace momenta
