#include <momenta/dae/gradient/transposed_forces.h>

#include <algorithm>

namespace momenta {

using Eigen::Index;
using Eigen::VectorXd;

TransposedForces::TransposedForces(const Mechanism& mechanism)
    : any_(mechanism.scene().lagrangian || mechanism.has_body_forces() ||
           mechanism.has_joint_forces()),
      at_points_(mechanism.scene().lagrangian || mechanism.has_body_forces()),
      tau_(static_cast<std::size_t>(mechanism.nv())) {
  if (any_) e_ = mechanism.evaluation<Dual8>();
}

void TransposedForces::transposed(double t, const VectorXd& q, const VectorXd& u, const VectorXd& b,
                                  VectorXd& by_q, VectorXd& by_u) {
  const auto n = static_cast<std::size_t>(q.size());
  x_.resize(2 * n);
  const auto still = [&] {
    for (std::size_t i = 0; i < n; ++i) {
      x_[i] = Dual8(q[static_cast<Index>(i)]);
      x_[n + i] = Dual8(u[static_cast<Index>(i)]);
    }
  };
  const auto evaluate = [&] {
    e_->applied_forces(t, x_.data(), x_.data() + n, tau_.data(), at_points_);
  };
  if (!at_points_) {
    still();
    for (std::size_t i = 0; i < n; ++i) x_[i].b[0] = x_[n + i].b[1] = 1;
    evaluate();
    for (std::size_t i = 0; i < n; ++i) {
      const auto at = static_cast<Index>(i);
      by_q[at] = tau_[i].b[0] * b[at];
      by_u[at] = tau_[i].b[1] * b[at];
    }
    return;
  }
  constexpr std::size_t width = 8;
  for (std::size_t first = 0; first < 2 * n; first += width) {
    const std::size_t count = std::min(width, 2 * n - first);
    still();
    for (std::size_t k = 0; k < count; ++k) x_[first + k].b[k] = 1;
    evaluate();
    for (std::size_t k = 0; k < count; ++k) {
      double sum = 0;
      for (std::size_t i = 0; i < n; ++i) sum += b[static_cast<Index>(i)] * tau_[i].b[k];
      const std::size_t at = first + k;
      (at < n ? by_q : by_u)[static_cast<Index>(at < n ? at : at - n)] = sum;
    }
  }
}

}  // namespace momenta
