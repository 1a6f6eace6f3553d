#include <momenta/core/scene/lagrangian/lagrangian_model.h>
#include <momenta/dae/run/measure/drive_power.h>

#include <limits>

namespace momenta {

DrivePower::DrivePower(const Mechanism& mechanism, Evaluation<double>& e, LoopSolver* solver)
    : mechanism_(mechanism),
      e_(e),
      solver_(solver),
      friction_(bearing_friction(mechanism)),
      any_(mechanism.scene().lagrangian ? mechanism.lagrangian().moving : mechanism.plan().drives),
      udot_(static_cast<std::size_t>(mechanism.nv())),
      lambda_(static_cast<std::size_t>(mechanism.m())),
      none_(lambda_.size()),
      moving_(lambda_.size()) {
  if (any_ && !mechanism.scene().lagrangian) sweep_ = make_wrench_sweep(mechanism);
}

double DrivePower::at(double t, const double* q, const double* u) {
  const bool solved =
      (!solver_ && udot_.empty()) ||
      rubbed_accelerations(friction_.get(), e_, solver_, t, q, u, udot_.data(), lambda_.data());
  if (!solved) return std::numeric_limits<double>::quiet_NaN();
  double power = 0;
  if (sweep_) {
    sweep_->move(t, q, u, udot_.data(), none_.data());
    power = sweep_->prescribed_power();
  }
  if (lambda_.empty()) return power;
  e_.place(t, q);
  e_.move(nullptr);
  e_.velocities(moving_.data());
  for (std::size_t i = 0; i < lambda_.size(); ++i) power += lambda_[i] * moving_[i];
  return power;
}

}  // namespace momenta
