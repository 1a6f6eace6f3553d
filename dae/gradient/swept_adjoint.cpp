// Sweeps of StageAdjoint: no matrix, and nothing is allocated unless rows are taken for a θ.

#include <momenta/dae/gradient/stage_adjoint.h>

namespace momenta {

using Eigen::Map;
using Eigen::VectorXd;

bool StageAdjoint::sweep(const AdjointState& at, const VectorXd& w, VectorXd& product,
                         VectorXd& by_parameters) {
  const auto a = w.head(nv_), b = w.tail(nv_);
  along_q_ = -b;
  along_p_ = a;
  if (forces_.any()) {
    still_ = b;
    if (losses_)
      losses_->at(at.q, at.u, still_, by_q_, by_u_);
    else
      forces_.transposed(at.t, at.q, at.u, still_, by_q_, by_u_);
    along_p_ += by_u_;
  }
  SweptTangent& f = *swept_;
  if (!f(at.t, at.q.data(), at.p.data(), along_q_.data(), along_p_.data())) return false;
  const Map<const VectorXd> du(f.du.data(), nv_), dpdot(f.dpdot.data(), nv_);
  product.resize(2 * nv_);
  product.head(nv_) = -dpdot;
  product.tail(nv_) = du;
  if (forces_.any()) {
    // ṗ has Q: its derivative along the direction goes, its transposed product comes.
    still_ = du;
    if (losses_)
      losses_->along_rates(still_, by_u_);
    else
      forces_.along(at.t, at.q, at.u, along_q_, still_, by_u_);
    product.head(nv_) += by_q_ + by_u_;
  }
  if (numbers_) {
    numbers_->add(-1, {at.t, at.q.data(), f.u.data(), f.sigma.data(), along_q_.data(), f.du.data(),
                       f.dsigma.data()});
    take_drives(at.t, by_parameters);
  }
  if (!any_rows_) return true;
  VectorXd weights(2 * nv_ + m_);
  weights << -du, -Map<const VectorXd>(f.dsigma.data(), m_), b;
  add_by_rows(at, weights, false, by_parameters);
  return true;
}

/// p' = c M u − (c − 1) p. u is the same on both sides.
bool StageAdjoint::sweep_gauge(const AdjointState& at, double c, VectorXd& lambda,
                               VectorXd& by_parameters) {
  SweptTangent& f = *swept_;
  still_.setZero();
  u_ = at.u;
  if (u_.size() == 0) {
    if (!f(at.t, at.q.data(), at.p.data(), still_.data(), still_.data())) return false;
    u_ = Map<const VectorXd>(f.u.data(), nv_);
  }
  const auto of_p = lambda.tail(nv_);
  along_q_ = of_p;
  kinetic_->along(at.t, at.q.data(), u_.data(), along_q_.data(), rates_.data(), along_p_.data());
  if (!f(at.t, at.q.data(), at.p.data(), still_.data(), along_p_.data())) return false;
  const Map<const VectorXd> du(f.du.data(), nv_), dpdot(f.dpdot.data(), nv_);
  rates_ -= dpdot;
  if (forces_.any()) {
    along_p_ = du;
    if (losses_) {
      losses_->at(at.q, u_, still_, by_q_, by_u_);
      losses_->along_rates(along_p_, by_u_);
    } else {
      forces_.along(at.t, at.q, u_, still_, along_p_, by_u_);
    }
    rates_ += by_u_;
  }
  along_p_ = of_p - du;
  if (numbers_) {
    for (double& x : f.dsigma) x = -x;
    add_gauge(
        c,
        {at.t, at.q.data(), f.u.data(), f.sigma.data(), nullptr, along_p_.data(), f.dsigma.data()},
        along_q_.data(), by_parameters);
    for (double& x : f.dsigma) x = -x;
  }
  if (any_rows_) {
    VectorXd weights(2 * nv_ + m_);
    weights << c * along_p_, -c * Map<const VectorXd>(f.dsigma.data(), m_), -c * of_p;
    add_by_rows(at, weights, true, by_parameters);
  }
  lambda.head(nv_) += c * rates_;
  lambda.tail(nv_) -= c * along_p_;
  return true;
}

}  // namespace momenta
