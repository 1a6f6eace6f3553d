#include <momenta/dae/analysis/linear/local_pencil.h>

#include <algorithm>
#include <cmath>

namespace momenta {

using Eigen::VectorXd;

LocalPencil::LocalPencil(const Mechanism& mechanism)
    : mechanism_(mechanism),
      local_(mechanism.evaluation<LocalDual>()),
      q_(static_cast<std::size_t>(mechanism.nq())),
      u_(static_cast<std::size_t>(mechanism.nv())),
      udot_(u_.size()),
      lambda_(static_cast<std::size_t>(mechanism.m())),
      qdot_(q_.size()),
      phi_(lambda_.size()),
      of_rates_(lambda_.size()),
      out_(lambda_.size(), false) {}

void LocalPencil::leave_out(const std::vector<int>& rows) {
  std::fill(out_.begin(), out_.end(), false);
  for (const int row : rows) out_[static_cast<std::size_t>(row)] = true;
}

bool LocalPencil::factor(double t, const VectorXd& q, const VectorXd& lambda, double a, double c) {
  const auto nv = u_.size(), m = lambda_.size();
  cuts_.begin(static_cast<int>(nv + m), !mechanism_.plan().drives);
  // q ∘ exp δ to first order: q + q̇(δ).
  for (std::size_t i = 0; i < q_.size(); ++i) q_[i] = LocalDual(q[static_cast<long>(i)]);
  for (std::size_t i = 0; i < nv; ++i) u_[i] = LocalDual::variable(0, static_cast<int>(i));
  local_->place(t, q_.data());
  local_->coordinate_rates(q_.data(), u_.data(), qdot_.data());
  // A δ of nonholonomic rows, which have no Φ.
  const bool of_rates = mechanism_.has_nonholonomic();
  if (of_rates) {
    local_->move(u_.data());
    local_->velocities(of_rates_.data());
  }
  for (std::size_t i = 0; i < q_.size(); ++i) q_[i] += qdot_[i];
  for (std::size_t i = 0; i < nv; ++i) {
    u_[i] = c == 0 ? LocalDual(0) : LocalDual::variable(0, static_cast<int>(i), c);
    udot_[i] = a == 0 ? LocalDual(0) : LocalDual::variable(0, static_cast<int>(i), a);
  }
  for (std::size_t i = 0; i < m; ++i) {
    const double value = lambda[static_cast<long>(i)];
    lambda_[i] = out_[i] ? LocalDual(value) : LocalDual::variable(value, static_cast<int>(nv + i));
  }
  local_->place(t, q_.data());
  local_->positions(phi_.data());
  for (std::size_t i = 0; of_rates && i < m; ++i)
    if (mechanism_.nonholonomic()[i]) phi_[i] = of_rates_[i];
  local_->move(u_.data());
  r_.resize(nv);
  local_->joint_forces(q_.data(), u_.data(), udot_.data(), lambda_.data(), r_.data());
  for (std::size_t i = 0; i < m; ++i) {
    const auto place = static_cast<int>(nv + i);
    if (out_[i])
      phi_[i] = LocalDual::variable(0, place);
    else if (!compliance_.empty())
      phi_[i] -= LocalDual::variable(0, place, compliance_[i]);
    r_.push_back(phi_[i]);
  }
  cuts_.stop();
  rows_.take(r_, cuts_);
  if (std::any_of(rows_.values().begin(), rows_.values().end(),
                  [](double x) { return !std::isfinite(x); }))
    return false;
  if (!matrix_ || version_ != rows_.version()) {
    matrix_ = make_local_matrix(rows_.pattern());
    version_ = rows_.version();
  }
  std::copy(rows_.values().begin(), rows_.values().end(), matrix_->values());
  return matrix_->factor();
}

void LocalPencil::solve(VectorXd& f, VectorXd& g) {
  work_.assign(static_cast<std::size_t>(rows_.size()), 0.0);
  std::copy(f.begin(), f.end(), work_.begin());
  std::copy(g.begin(), g.end(), work_.begin() + f.size());
  matrix_->solve(work_.data());
  std::copy_n(work_.begin(), f.size(), f.begin());
  std::copy_n(work_.begin() + f.size(), g.size(), g.begin());
}

}  // namespace momenta
