#include <momenta/core/open_chain/open_chain_impl.h>
#include <momenta/core/scene/bearings_refused.h>

#include <algorithm>
#include <stdexcept>

namespace momenta {
namespace {

Tree checked_tree(const Scene& scene) {
  if (scene.lagrangian)
    throw SceneError(
        scene.where(scene.lagrangian->at) +
        "lagrangian: an open chain needs bodies, expected a ClosedChain for a system of "
        "formulas");
  if (!scene.loops.empty())
    throw SceneError(scene.where(scene.loops.front().at) + "loop '" + scene.loops.front().name +
                     "' closes the tree, but an open chain has no loops, expected a tree");
  return build_tree(scene);
}

}  // namespace

OpenChain::OpenChain(const Scene& scene, Algebra algebra, int level, bool branches_side_by_side) {
  refuse_bearings(scene, "OpenChain");
  Tree tree = checked_tree(scene);
  Plan plan = make_plan(tree, scene, algebra);
  impl_ = std::make_unique<Impl>(std::move(tree), std::move(plan), scene,
                                 level == 0 ? best_level() : level_at_most(level),
                                 branches_side_by_side);
}
OpenChain::~OpenChain() = default;
OpenChain::OpenChain(OpenChain&&) noexcept = default;
OpenChain& OpenChain::operator=(OpenChain&&) noexcept = default;

const Tree& OpenChain::tree() const {
  return impl_->tree;
}
const Plan& OpenChain::plan() const {
  return impl_->plan;
}

int OpenChain::level() const {
  return impl_->visit([](auto& kernel) { return kernel.sweeps->level(); });
}

bool OpenChain::rates(double t, const ConstVectorRef& q, const ConstVectorRef& p, VectorRef qdot,
                      VectorRef pdot) {
  expect_size("rates", "q", q.size(), nq());
  expect_size("rates", "p", p.size(), nv());
  expect_size("rates", "qdot", qdot.size(), nq());
  expect_size("rates", "pdot", pdot.size(), nv());
  if (!given_finite(impl_->not_a_number, t, {"q", q}, {"p", p})) return false;
  const bool found = impl_->visit([&](auto& kernel) {
    if (!impl_->plan.quasi_velocities)  // q̇ = u
      return impl_->momentum(kernel, t, q.data(), p.data(), qdot.data(), pdot.data());
    const bool ok = impl_->momentum(kernel, t, q.data(), p.data(), impl_->u.data(), pdot.data());
    if (ok) momenta::coordinate_rates(*kernel.model, q.data(), impl_->u.data(), qdot.data());
    return ok;
  });
  return found && found_finite(impl_->not_a_number, qdot, pdot);
}

bool OpenChain::rates(double t, const ConstVectorRef& q, const ConstVectorRef& p,
                      const ConstVectorRef& tau, VectorRef qdot, VectorRef pdot) {
  expect_size("rates", "tau", tau.size(), nv());
  if (!given_finite(impl_->not_a_number, t, {"q", q}, {"tau", tau}) || !rates(t, q, p, qdot, pdot))
    return false;
  pdot += tau;
  return found_finite(impl_->not_a_number, pdot);
}

bool OpenChain::jacobian_times(double t, const ConstVectorRef& q, const ConstVectorRef& p,
                               const ConstVectorRef& dq, const ConstVectorRef& dp, VectorRef dqdot,
                               VectorRef dpdot) {
  expect_size("jacobian_times", "q", q.size(), nq());
  expect_size("jacobian_times", "p", p.size(), nv());
  expect_size("jacobian_times", "dq", dq.size(), nq());
  expect_size("jacobian_times", "dp", dp.size(), nv());
  expect_size("jacobian_times", "dqdot", dqdot.size(), nq());
  expect_size("jacobian_times", "dpdot", dpdot.size(), nv());
  if (!given_finite(impl_->not_a_number, t, {"q", q}, {"p", p}, {"dq", dq}, {"dp", dp}))
    return false;
  const bool found = impl_->visit([&](auto& kernel) {
    return impl_->noted_one(*kernel.sweeps, t, q.data(),
                            kernel.sweeps->derivative(t, q.data(), p.data(), dq.data(), dp.data(),
                                                      dqdot.data(), dpdot.data()));
  });
  return found && found_finite(impl_->not_a_number, dqdot, dpdot);
}

bool OpenChain::jacobian(double t, const ConstVectorRef& q, const ConstVectorRef& p, MatrixRef J) {
  expect_size("jacobian", "q", q.size(), nq());
  expect_size("jacobian", "p", p.size(), nv());
  expect_size("jacobian", "a row of J", J.cols(), nq() + nv());
  expect_size("jacobian", "a column of J", J.rows(), nq() + nv());
  if (!given_finite(impl_->not_a_number, t, {"q", q}, {"p", p})) return false;
  const bool found = impl_->visit([&](auto& kernel) {
    BatchSweeps& sweeps = *kernel.batches[0];
    return impl_->noted_one(sweeps, t, q.data(),
                            sweeps.jacobian(t, q.data(), p.data(), J.data(), J.outerStride()));
  });
  if (!found) return false;
  for (Eigen::Index i = 0; i < J.cols(); ++i)
    if (!found_finite(impl_->not_a_number, J.col(i))) return false;
  return true;
}
Eigen::MatrixXd OpenChain::jacobian(double t, const ConstVectorRef& q, const ConstVectorRef& p) {
  Eigen::MatrixXd J(nq() + nv(), nq() + nv());
  if (!jacobian(t, q, p, J)) J.resize(0, 0);
  return J;
}

bool OpenChain::velocities(double t, const ConstVectorRef& q, const ConstVectorRef& p,
                           VectorRef u) {
  expect_size("velocities", "q", q.size(), nq());
  expect_size("velocities", "p", p.size(), nv());
  expect_size("velocities", "u", u.size(), nv());
  if (!given_finite(impl_->not_a_number, t, {"q", q}, {"p", p})) return false;
  return impl_->visit([&](auto& kernel) {
    return impl_->momentum(kernel, t, q.data(), p.data(), u.data(), impl_->p.data());
  }) && found_finite(impl_->not_a_number, u);
}

bool OpenChain::inverse_mass_times(double t, const ConstVectorRef& q, const ConstVectorRef& x,
                                   VectorRef result) {
  expect_size("inverse_mass_times", "q", q.size(), nq());
  expect_size("inverse_mass_times", "x", x.size(), nv());
  expect_size("inverse_mass_times", "result", result.size(), nv());
  if (!given_finite(impl_->not_a_number, t, {"q", q}, {"x", x})) return false;
  return impl_->visit([&](auto& kernel) {
    impl_->placed =
        impl_->noted_one(*kernel.sweeps, t, q.data(),
                         kernel.sweeps->inverse_mass_times(t, q.data(), x.data(), result.data()));
    return impl_->placed;
  }) && found_finite(impl_->not_a_number, result);
}

bool OpenChain::inverse_mass_times(const ConstVectorRef& x, VectorRef result) {
  expect_size("inverse_mass_times", "x", x.size(), nv());
  expect_size("inverse_mass_times", "result", result.size(), nv());
  if (!impl_->placed) {
    impl_->not_a_number =
        "inverse_mass_times: found no evaluation that succeeded, expected one of rates(), "
        "velocities() or inverse_mass_times(t, q, x, result) before";
    return false;
  }
  if (!given_finite(impl_->not_a_number, 0, {"x", x})) return false;
  return impl_->visit([&](auto& kernel) {
    impl_->placed = kernel.sweeps->inverse_mass_times(x.data(), result.data());
    if (!impl_->placed)
      impl_->not_a_number = tree().joint_in_words(kernel.sweeps->singular_joint()) +
                            " has no inertia at the place of the last evaluation";
    return impl_->placed;
  }) && found_finite(impl_->not_a_number, result);
}

void OpenChain::momenta(double t, const ConstVectorRef& q, const ConstVectorRef& u, VectorRef p) {
  expect_size("momenta", "q", q.size(), nq());
  expect_size("momenta", "u", u.size(), nv());
  expect_size("momenta", "p", p.size(), nv());
  expect_given_finite("momenta", impl_->not_a_number, t, {"q", q}, {"u", u});
  impl_->visit(
      [&](auto& kernel) { momenta_from_rates(kernel.w, t, q.data(), u.data(), p.data()); });
  expect_found_finite("momenta", impl_->not_a_number, p);
}

bool OpenChain::accelerations(double t, const ConstVectorRef& q, const ConstVectorRef& u,
                              VectorRef udot) {
  expect_size("accelerations", "q", q.size(), nq());
  expect_size("accelerations", "u", u.size(), nv());
  expect_size("accelerations", "udot", udot.size(), nv());
  if (!given_finite(impl_->not_a_number, t, {"q", q}, {"u", u})) return false;
  return impl_->visit([&](auto& kernel) {
    return impl_->acceleration(kernel, t, q.data(), u.data(), udot.data());
  }) && found_finite(impl_->not_a_number, udot);
}

bool OpenChain::accelerations(double t, const ConstVectorRef& q, const ConstVectorRef& u,
                              const ConstVectorRef& tau, VectorRef udot) {
  expect_size("accelerations", "q", q.size(), nq());
  expect_size("accelerations", "u", u.size(), nv());
  expect_size("accelerations", "tau", tau.size(), nv());
  expect_size("accelerations", "udot", udot.size(), nv());
  if (!given_finite(impl_->not_a_number, t, {"q", q}, {"u", u}, {"tau", tau})) return false;
  return impl_->visit([&](auto& kernel) {
    return impl_->acceleration(kernel, t, q.data(), u.data(), udot.data(), tau.data());
  }) && found_finite(impl_->not_a_number, udot);
}

void OpenChain::coordinate_rates(const ConstVectorRef& q, const ConstVectorRef& u,
                                 VectorRef qdot) const {
  expect_size("coordinate_rates", "q", q.size(), nq());
  expect_size("coordinate_rates", "u", u.size(), nv());
  expect_size("coordinate_rates", "qdot", qdot.size(), nq());
  expect_given_finite("coordinate_rates", impl_->not_a_number, 0, {"q", q}, {"u", u});
  impl_->visit([&](auto& kernel) {
    momenta::coordinate_rates(*kernel.model, q.data(), u.data(), qdot.data());
  });
  expect_found_finite("coordinate_rates", impl_->not_a_number, qdot);
}

std::string OpenChain::failure() const {
  if (!impl_->not_a_number.empty()) return impl_->not_a_number;
  if (impl_->singular < 0) return "";
  const std::string state =
      impl_->failed_state < 0 ? "" : "state " + std::to_string(impl_->failed_state) + ": ";
  const Eigen::VectorXd& q = impl_->failed_q;
  for (Eigen::Index i = 0; i < q.size(); ++i)
    if (!std::isfinite(q[i])) return state + not_finite("q", i, q[i]);
  return state + in_words(impl_->tree, impl_->visit([&](auto& k) { return impl_->massless(k); }));
}

}  // namespace momenta
