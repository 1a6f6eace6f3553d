#include <momenta/core/open_chain_inside.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace momenta {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

Tree checked_tree(const Scene& scene) {
  if (!scene.loops.empty())
    throw SceneError(scene.where(scene.loops.front().at) + "loop '" + scene.loops.front().name +
                     "' closes the tree, but an open chain has no loops");
  return build_tree(scene);
}

void check_threads(int threads) {
  if (threads < 1)
    throw std::invalid_argument("found " + std::to_string(threads) +
                                " threads for a batch of states, expected 1 or more");
}
}  // namespace

OpenChain::OpenChain(const Scene& scene, Algebra algebra, int level, bool branches_side_by_side) {
  Tree tree = checked_tree(scene);
  Plan plan = make_plan(tree, scene, algebra);
  inside_ = std::make_unique<Inside>(std::move(tree), std::move(plan), scene,
                                     level == 0 ? best_level() : level_at_most(level),
                                     branches_side_by_side);
}
OpenChain::~OpenChain() = default;
OpenChain::OpenChain(OpenChain&&) noexcept = default;
OpenChain& OpenChain::operator=(OpenChain&&) noexcept = default;

const Tree& OpenChain::tree() const {
  return inside_->tree;
}
const Plan& OpenChain::plan() const {
  return inside_->plan;
}

int OpenChain::level() const {
  return inside_->visit([](auto& kernel) { return kernel.sweeps->level(); });
}

bool OpenChain::rates(double t, const ConstVectorRef& q, const ConstVectorRef& p, VectorRef qdot,
                      VectorRef pdot) {
  return inside_->visit([&](auto& kernel) {
    if (!inside_->plan.quasi_velocities)  // q̇ = u
      return inside_->momentum(kernel, t, q.data(), p.data(), qdot.data(), pdot.data());
    const bool ok =
        inside_->momentum(kernel, t, q.data(), p.data(), inside_->u.data(), pdot.data());
    if (ok) momenta::coordinate_rates(*kernel.model, q.data(), inside_->u.data(), qdot.data());
    return ok;
  });
}

bool OpenChain::rates_of_states(double t, const ConstStatesRef& q, const ConstStatesRef& p,
                                StatesRef qdot, StatesRef pdot, int threads) {
  check_threads(threads);
  return inside_->visit([&](auto& kernel) {
    const auto stride = q.outerStride();
    if (!kernel.model->has_body_forces() && stride == p.outerStride() &&
        stride == qdot.outerStride() && stride == pdot.outerStride())
      return inside_->batch(
          kernel, threads,
          {q.data(), p.data(), qdot.data(), pdot.data(), stride,
           static_cast<std::size_t>(q.cols())},
          [t](BatchSweeps& sweeps, const States& part) { return sweeps.momentum(t, part); });
    Eigen::VectorXd one_qdot(nq()), one_pdot(nv());
    return inside_->one_by_one(q.cols(), [&](Eigen::Index i) {
      const bool ok = rates(t, q.col(i), p.col(i), one_qdot, one_pdot);
      if (!ok) one_qdot.setConstant(nothing), one_pdot.setConstant(nothing);
      qdot.col(i) = one_qdot;
      pdot.col(i) = one_pdot;
      return ok;
    });
  });
}

bool OpenChain::accelerations_of_states(double t, const ConstStatesRef& q, const ConstStatesRef& u,
                                        StatesRef udot, int threads) {
  check_threads(threads);
  return inside_->visit([&](auto& kernel) {
    const auto stride = q.outerStride();
    if (!kernel.model->has_body_forces() && !kernel.model->has_joint_forces &&
        stride == u.outerStride() && stride == udot.outerStride())
      return inside_->batch(
          kernel, threads,
          {q.data(), u.data(), nullptr, udot.data(), stride, static_cast<std::size_t>(q.cols())},
          [t](BatchSweeps& sweeps, const States& part) { return sweeps.acceleration(t, part); });
    Eigen::VectorXd one(nv());
    return inside_->one_by_one(q.cols(), [&](Eigen::Index i) {
      const bool ok = accelerations(t, q.col(i), u.col(i), one);
      if (!ok) one.setConstant(nothing);
      udot.col(i) = one;
      return ok;
    });
  });
}

bool OpenChain::jacobian_times(double t, const ConstVectorRef& q, const ConstVectorRef& p,
                               const ConstVectorRef& dq, const ConstVectorRef& dp, VectorRef dqdot,
                               VectorRef dpdot) {
  return inside_->visit([&](auto& kernel) {
    return inside_->noted_one(*kernel.sweeps,
                              kernel.sweeps->derivative(t, q.data(), p.data(), dq.data(), dp.data(),
                                                        dqdot.data(), dpdot.data()));
  });
}

bool OpenChain::jacobian(double t, const ConstVectorRef& q, const ConstVectorRef& p, MatrixRef J) {
  return inside_->visit([&](auto& kernel) {
    BatchSweeps& sweeps = *kernel.batches[0];
    return inside_->noted_one(sweeps,
                              sweeps.jacobian(t, q.data(), p.data(), J.data(), J.outerStride()));
  });
}
Eigen::MatrixXd OpenChain::jacobian(double t, const ConstVectorRef& q, const ConstVectorRef& p) {
  Eigen::MatrixXd J(nq() + nv(), nq() + nv());
  if (!jacobian(t, q, p, J)) J.resize(0, 0);
  return J;
}

bool OpenChain::velocities(double t, const ConstVectorRef& q, const ConstVectorRef& p,
                           VectorRef u) {
  return inside_->visit([&](auto& kernel) {
    return inside_->momentum(kernel, t, q.data(), p.data(), u.data(), inside_->p.data());
  });
}

bool OpenChain::inverse_mass_times(double t, const ConstVectorRef& q, const ConstVectorRef& x,
                                   VectorRef result) {
  return inside_->visit([&](auto& kernel) {
    return inside_->noted_one(
        *kernel.sweeps, kernel.sweeps->inverse_mass_times(t, q.data(), x.data(), result.data()));
  });
}

void OpenChain::momenta(double t, const ConstVectorRef& q, const ConstVectorRef& u, VectorRef p) {
  inside_->visit(
      [&](auto& kernel) { momenta_from_rates(kernel.w, t, q.data(), u.data(), p.data()); });
}

bool OpenChain::accelerations(double t, const ConstVectorRef& q, const ConstVectorRef& u,
                              VectorRef udot) {
  return inside_->visit([&](auto& kernel) {
    return inside_->acceleration(kernel, t, q.data(), u.data(), udot.data());
  });
}

void OpenChain::coordinate_rates(const ConstVectorRef& q, const ConstVectorRef& u,
                                 VectorRef qdot) const {
  inside_->visit([&](auto& kernel) {
    momenta::coordinate_rates(*kernel.model, q.data(), u.data(), qdot.data());
  });
}

std::string OpenChain::failure() const {
  if (inside_->singular < 0) return "";
  const Tree& t = inside_->tree;
  const auto& b = t.bodies[static_cast<std::size_t>(inside_->singular)];
  const auto& carried = t.bodies[static_cast<std::size_t>(t.carried_by(b.joint))];
  const std::string state =
      inside_->failed_state < 0 ? "" : "state " + std::to_string(inside_->failed_state) + ": ";
  return state + t.joint_in_words(inside_->singular) +
         " has no inertia to move: the articulated inertia of body '" + carried.name +
         "' along it is not positive";
}

}  // namespace momenta
