#include <momenta/dae/kkt/loop_rank.h>
#include <momenta/dae/mechanism/joint_places.h>
#include <momenta/dae/topology/assembly/scaled_loops.h>

#include <algorithm>
#include <cmath>

namespace momenta {

ScaledLoops::ScaledLoops(const Mechanism& mechanism)
    : columns(static_cast<std::size_t>(mechanism.nv()), true),
      rows(static_cast<std::size_t>(mechanism.m()), true),
      mechanism_(mechanism),
      e_(mechanism.evaluation<double>()),
      pattern_(mechanism.constraint_pattern()),
      units_(mechanism) {
  const std::vector<bool>& of_velocities = mechanism.nonholonomic();
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = !of_velocities[i];
}

void ScaledLoops::hold_joints() {
  const std::vector<std::string>& held = mechanism_.scene().held;
  if (held.empty()) return;
  for (const JointPlace& joint : joint_places(mechanism_))
    if (std::find(held.begin(), held.end(), joint.name) != held.end())
      for (const int i : joint.u) columns[static_cast<std::size_t>(i)] = false;
}

Eigen::VectorXd ScaledLoops::gap(double t, const Eigen::VectorXd& q) {
  Eigen::VectorXd phi(mechanism_.m());
  e_->place(t, q.data());
  e_->positions(phi.data());
  return in_units(std::move(phi));
}

std::vector<double> ScaledLoops::jacobian() {
  std::vector<double> values = scaled_entries(mechanism_, *e_, units_);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!columns[static_cast<std::size_t>(pattern_[i].column)] ||
        !rows[static_cast<std::size_t>(pattern_[i].row)])
      values[i] = 0;
  return values;
}

Eigen::VectorXd ScaledLoops::moved(const Eigen::VectorXd& q, const Eigen::VectorXd& step) {
  const Eigen::VectorXd rates = step.cwiseProduct(units_.rates);
  Eigen::VectorXd qdot = Eigen::VectorXd::Zero(mechanism_.nq());
  e_->coordinate_rates(q.data(), rates.data(), qdot.data());
  Eigen::VectorXd next = q + qdot;
  mechanism_.tree().normalise(next);
  return next;
}

Eigen::VectorXd ScaledLoops::in_units(Eigen::VectorXd x) const {
  for (Eigen::Index i = 0; i < x.size(); ++i)
    x[i] = rows[static_cast<std::size_t>(i)] ? x[i] / units_.equations[i] : 0;
  return x;
}

double ScaledLoops::apart(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
  double largest = 0;
  for (const auto& body : mechanism_.tree().bodies)
    for (int i = 0; i < body.nq; ++i) {
      const double unit = i < body.nv ? units_.rates[body.u + i] : 1;
      largest = std::max(largest, std::abs(a[body.q + i] - b[body.q + i]) / unit);
    }
  return largest;
}

}  // namespace momenta
