// Many states at once: in lanes of vector registers, shared among threads, or one by one.

#include <momenta/core/open_chain_inside.h>

#include <limits>
#include <stdexcept>

namespace momenta {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

void check_threads(int threads) {
  if (threads < 1)
    throw std::invalid_argument("found " + std::to_string(threads) +
                                " threads for a batch of states, expected 1 or more");
}

}  // namespace

bool OpenChain::rates_of_states(double t, const ConstStatesRef& q, const ConstStatesRef& p,
                                StatesRef qdot, StatesRef pdot, int threads) {
  check_threads(threads);
  expect_size("rates_of_states", "a column of q", q.rows(), nq());
  expect_size("rates_of_states", "a column of p", p.rows(), nv());
  expect_size("rates_of_states", "a column of qdot", qdot.rows(), nq());
  expect_size("rates_of_states", "a column of pdot", pdot.rows(), nv());
  expect_size("rates_of_states", "a row of p", p.cols(), q.cols());
  expect_size("rates_of_states", "a row of qdot", qdot.cols(), q.cols());
  expect_size("rates_of_states", "a row of pdot", pdot.cols(), q.cols());
  if (!std::isfinite(t)) throw std::invalid_argument("rates_of_states: t is not finite");
  const bool all = inside_->visit([&](auto& kernel) {
    const auto stride = q.outerStride();
    if (!kernel.model->has_body_forces() && stride == p.outerStride() &&
        stride == qdot.outerStride() && stride == pdot.outerStride())
      return inside_->batch(
          kernel, t, threads,
          {q.data(), p.data(), qdot.data(), pdot.data(), stride,
           static_cast<std::size_t>(q.cols())},
          [t](BatchSweeps& sweeps, const States& part) { return sweeps.momentum(t, part); });
    Eigen::VectorXd one_qdot(nq()), one_pdot(nv());
    return inside_->one_by_one(q.cols(), [&](Eigen::Index i) {
      const bool ok = rates(t, q.col(i), p.col(i), one_qdot, one_pdot);
      qdot.col(i) = ok ? one_qdot : one_qdot.setConstant(nothing);
      pdot.col(i) = ok ? one_pdot : one_pdot.setConstant(nothing);
      return ok;
    });
  });
  return inside_->told_of_state(all, q, "p", p);
}

bool OpenChain::rates_of_states(double t, const ConstStatesRef& q, const ConstStatesRef& p,
                                const ConstStatesRef& tau, StatesRef qdot, StatesRef pdot,
                                int threads) {
  expect_size("rates_of_states", "a column of tau", tau.rows(), nv());
  expect_size("rates_of_states", "a row of tau", tau.cols(), q.cols());
  if (rates_of_states(t, q, p, qdot, pdot, threads)) {
    pdot += tau;  // u follows from p alone
    if (pdot.allFinite()) return true;
  }
  Eigen::VectorXd one_qdot(nq()), one_pdot(nv());
  const bool all = inside_->one_by_one(q.cols(), [&](Eigen::Index i) {
    const bool ok = rates(t, q.col(i), p.col(i), tau.col(i), one_qdot, one_pdot);
    qdot.col(i) = ok ? one_qdot : one_qdot.setConstant(nothing);
    pdot.col(i) = ok ? one_pdot : one_pdot.setConstant(nothing);
    return ok;
  });
  return inside_->told_of_state(all, q, "p", p, "tau", tau);
}

/// `tau` may be null.
bool OpenChain::Inside::accelerations_of_states(OpenChain& chain, double t, const ConstStatesRef& q,
                                                const ConstStatesRef& rates,
                                                const ConstStatesRef* tau, StatesRef udot,
                                                int threads) {
  const char* call = "accelerations_of_states";
  const int nq = tree.nq, nv = tree.nv;
  check_threads(threads);
  expect_size(call, "a column of q", q.rows(), nq);
  expect_size(call, "a column of u", rates.rows(), nv);
  expect_size(call, "a column of udot", udot.rows(), nv);
  expect_size(call, "a row of u", rates.cols(), q.cols());
  expect_size(call, "a row of udot", udot.cols(), q.cols());
  if (tau) {
    expect_size(call, "a column of tau", tau->rows(), nv);
    expect_size(call, "a row of tau", tau->cols(), q.cols());
  }
  if (!std::isfinite(t)) throw std::invalid_argument("accelerations_of_states: t is not finite");
  const bool all = visit([&](auto& k) {
    const auto stride = q.outerStride();
    if (!k.model->has_body_forces() && stride == rates.outerStride() &&
        stride == udot.outerStride() && (!tau || stride == tau->outerStride()))
      return batch(
          k, t, threads,
          {q.data(), rates.data(), nullptr, udot.data(), stride, static_cast<std::size_t>(q.cols()),
           tau ? tau->data() : nullptr},
          [t](BatchSweeps& sweeps, const States& part) { return sweeps.acceleration(t, part); });
    Eigen::VectorXd one(nv);
    return one_by_one(q.cols(), [&](Eigen::Index i) {
      const bool ok = tau ? chain.accelerations(t, q.col(i), rates.col(i), tau->col(i), one)
                          : chain.accelerations(t, q.col(i), rates.col(i), one);
      udot.col(i) = ok ? one : one.setConstant(nothing);
      return ok;
    });
  });
  return tau ? told_of_state(all, q, "u", rates, "tau", *tau) : told_of_state(all, q, "u", rates);
}

bool OpenChain::accelerations_of_states(double t, const ConstStatesRef& q, const ConstStatesRef& u,
                                        StatesRef udot, int threads) {
  return inside_->accelerations_of_states(*this, t, q, u, nullptr, udot, threads);
}
bool OpenChain::accelerations_of_states(double t, const ConstStatesRef& q, const ConstStatesRef& u,
                                        const ConstStatesRef& tau, StatesRef udot, int threads) {
  return inside_->accelerations_of_states(*this, t, q, u, &tau, udot, threads);
}

}  // namespace momenta
