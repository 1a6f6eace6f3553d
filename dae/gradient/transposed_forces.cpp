#include <momenta/core/kernel/model.h>
#include <momenta/dae/gradient/transposed_forces.h>

#include <algorithm>

namespace momenta {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// Whether a force at a point has, or may have, no potential.
template <class Space>
bool without_potential_at_points(const Model<Space>& model) {
  const auto any = [](const auto& forces, auto&& is) {
    return std::any_of(forces.begin(), forces.end(), is);
  };
  return !model.bushings.empty() ||
         any(model.springs, [](const auto& s) { return s.damping != 0 || s.stop.acts(); }) ||
         any(model.coordinate_springs,
             [](const auto& s) { return s.damping != 0 || s.stop.acts(); }) ||
         any(model.formula_forces, [](const auto& f) { return !f.is_potential; }) ||
         any(model.wrenches, [](const auto& w) {
           if constexpr (Space::dimension == 6) {
             const auto& c = w.torque;
             return w.in_body_axes || c[0] != 0 || c[1] != 0 || c[2] != 0;
           } else {
             return w.in_body_axes;
           }
         });
}

}  // namespace

TransposedForces::TransposedForces(const Mechanism& mechanism)
    : tau_(static_cast<std::size_t>(mechanism.nv())) {
  const Tree& tree = mechanism.tree();
  if (mechanism.scene().lagrangian)
    at_points_ = true;
  else if (mechanism.has_body_forces())
    at_points_ = mechanism.plan().planar
                     ? without_potential_at_points(
                           build_planar_model(tree, mechanism.scene(), mechanism.plan().basis))
                     : without_potential_at_points(build_spatial_model(tree, mechanism.scene()));
  any_ = at_points_ || std::any_of(tree.bodies.begin(), tree.bodies.end(), [](const auto& b) {
           return b.damping != 0 || b.friction != 0 || b.stop_stiffness != 0;
         });
  if (any_) e_ = mechanism.evaluation<Dual8>();
}

void TransposedForces::still(const VectorXd& q, const VectorXd& u) {
  const auto n = static_cast<std::size_t>(q.size());
  x_.resize(2 * n);
  for (std::size_t i = 0; i < n; ++i) {
    x_[i] = Dual8(q[static_cast<Index>(i)]);
    x_[n + i] = Dual8(u[static_cast<Index>(i)]);
  }
}

void TransposedForces::along(double t, const VectorXd& q, const VectorXd& u, const VectorXd& dq,
                             const VectorXd& du, VectorXd& dQ) {
  still(q, u);
  const auto n = static_cast<std::size_t>(q.size());
  for (std::size_t i = 0; i < n; ++i) {
    x_[i].b[0] = dq[static_cast<Index>(i)];
    x_[n + i].b[0] = du[static_cast<Index>(i)];
  }
  e_->applied_forces(t, x_.data(), x_.data() + n, tau_.data(), at_points_);
  for (std::size_t i = 0; i < n; ++i) dQ[static_cast<Index>(i)] = tau_[i].b[0];
}

void TransposedForces::transposed(double t, const VectorXd& q, const VectorXd& u, const VectorXd& b,
                                  VectorXd& by_q, VectorXd& by_u) {
  const auto n = static_cast<std::size_t>(q.size());
  const auto evaluate = [&] {
    e_->applied_forces(t, x_.data(), x_.data() + n, tau_.data(), at_points_);
  };
  if (!at_points_) {
    still(q, u);
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
    still(q, u);
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
