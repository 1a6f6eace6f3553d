// Many states of a mechanism at once: in the lanes of the sweeps' registers and shared among
// threads where they carry the loops, else one by one.

#include <momenta/core/open_chain/parallel_for.h>
#include <momenta/dae/analysis/chain/closed_chain_impl.h>
#include <momenta/dae/kkt/body_matrix.h>
#include <momenta/dae/kkt/solver_choice.h>

#include <array>
#include <atomic>
#include <limits>

namespace momenta {

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

void expect_states(const char* call, double t, Eigen::Index count, int threads,
                   std::initializer_list<std::pair<const char*, Eigen::Index>> columns) {
  for (const auto& [name, found] : columns) expect_size(call, name, found, count);
  if (threads < 1)
    throw std::invalid_argument(std::string(call) + ": threads is " + std::to_string(threads) +
                                ", expected 1 or more");
  if (!std::isfinite(t)) throw std::invalid_argument(std::string(call) + ": t is not finite");
}

}  // namespace

bool ClosedChain::Impl::side_by_side(double t, const LoopedStates& all, bool of_momenta,
                                     double leak, int threads) {
  if (all.count == 0 || !solver || mechanism.solver().kkt() != KktChoice::sweeps ||
      (mechanism.has_body_forces() && !mechanism.plan().planar) || mechanism.has_forces_apart())
    return false;
  if (batches.empty()) batches.push_back(mechanism.solver().sweeps());
  // Packs are whole, so that the number of threads does not change the bits.
  const auto width = static_cast<std::size_t>(batches.front()->width());
  const std::size_t packs = (all.count + width - 1) / width,
                    parts = std::min(static_cast<std::size_t>(threads), packs);
  while (batches.size() < parts) batches.push_back(mechanism.solver().sweeps());
  std::atomic<bool> done = true;
  parallel_for(static_cast<int>(parts), parts, [&](std::size_t part) {
    const std::size_t first = packs * part / parts * width,
                      last = std::min(all.count, packs * (part + 1) / parts * width);
    LoopedStates states = all.part(first, last - first);
    states.body_forces = mechanism.has_body_forces();
    LoopedSweeps& sweeps = *batches[part];
    const double fade = fade_beside(fade_evaluation, mechanism.masses_apart());
    const bool ok =
        of_momenta ? sweeps.momentum(t, states, fade, leak) : sweeps.acceleration(t, states, fade);
    if (!ok || sweeps.weak_looped_branch()) done = false;
  });
  return done;
}

/// Calls act(i) state by state; where it is false, fills the columns of the state with NaN.
template <class Act>
bool ClosedChain::Impl::one_by_one(Act&& act, StatesRef a, StatesRef b) {
  std::string first;
  for (Eigen::Index i = 0; i < a.cols(); ++i) {
    if (act(i)) continue;
    a.col(i).setConstant(nothing);
    b.col(i).setConstant(nothing);
    if (first.empty()) first = "state " + std::to_string(i) + ": " + failure;
  }
  failure = first;
  return first.empty();
}

bool ClosedChain::Impl::rates_of_states(ClosedChain& chain, double t, const ConstStatesRef& q,
                                        const ConstStatesRef& p, const ConstStatesRef* tau,
                                        StatesRef qdot, StatesRef pdot, double leak, int threads) {
  const char* call = "rates_of_states";
  const int nq = mechanism.nq(), nv = mechanism.nv();
  expect_sizes(call,
               {{"a column of q", q.rows()},
                {"a column of p", p.rows()},
                {"a column of tau", tau ? tau->rows() : nv},
                {"a column of qdot", qdot.rows()},
                {"a column of pdot", pdot.rows()}},
               {nq, nv, nv, nq, nv});
  const Eigen::Index count = q.cols();
  expect_states(call, t, count, threads,
                {{"a row of p", p.cols()},
                 {"a row of tau", tau ? tau->cols() : count},
                 {"a row of qdot", qdot.cols()},
                 {"a row of pdot", pdot.cols()}});
  expect_leak(call, leak);
  failure.clear();
  if (tree)
    return noted(tau ? tree->rates_of_states(t, q, p, *tau, qdot, pdot, threads)
                     : tree->rates_of_states(t, q, p, qdot, pdot, threads),
                 t, q.data());

  const StateMatrix from_q = q, from_p = p;  // rows of one stride
  StateMatrix rates(nv, count), impulses(mechanism.m(), count), forces(nv, count);
  if (side_by_side(t,
                   {from_q.data(), from_p.data(), rates.data(), impulses.data(), forces.data(),
                    count, static_cast<std::size_t>(count)},
                   true, leak, threads)) {
    if (tau) forces += *tau;  // u and σ follow from p alone
    if (rates.allFinite() && forces.allFinite()) {
      pdot = forces;
      if (!mechanism.plan().quasi_velocities) qdot = rates;
      Eigen::VectorXd one_qdot(nq);
      for (Eigen::Index i = 0; mechanism.plan().quasi_velocities && i < count; ++i) {
        const Eigen::VectorXd one_q = q.col(i), one_u = rates.col(i);
        rates_of_coordinates(t, one_q.data(), one_u.data(), one_qdot.data());
        qdot.col(i) = one_qdot;
      }
      return true;
    }
  }
  Eigen::VectorXd one_qdot(nq), one_pdot(nv);
  return one_by_one(
      [&](Eigen::Index i) {
        const bool ok =
            tau ? chain.rates(t, q.col(i), p.col(i), tau->col(i), one_qdot, one_pdot, leak)
                : chain.rates(t, q.col(i), p.col(i), one_qdot, one_pdot, leak);
        qdot.col(i) = one_qdot;
        pdot.col(i) = one_pdot;
        return ok;
      },
      qdot, pdot);
}

bool ClosedChain::Impl::accelerations_of_states(ClosedChain& chain, double t,
                                                const ConstStatesRef& q,
                                                const ConstStatesRef& rates,
                                                const ConstStatesRef* tau, StatesRef udot,
                                                StatesRef lambda, int threads) {
  const char* call = "accelerations_of_states";
  const int nq = mechanism.nq(), nv = mechanism.nv(), m = mechanism.m();
  expect_sizes(call,
               {{"a column of q", q.rows()},
                {"a column of u", rates.rows()},
                {"a column of tau", tau ? tau->rows() : nv},
                {"a column of udot", udot.rows()},
                {"a column of lambda", lambda.rows()}},
               {nq, nv, nv, nv, m});
  const Eigen::Index count = q.cols();
  expect_states(call, t, count, threads,
                {{"a row of u", rates.cols()},
                 {"a row of tau", tau ? tau->cols() : count},
                 {"a row of udot", udot.cols()},
                 {"a row of lambda", lambda.cols()}});
  failure.clear();
  if (tree)
    return noted(tau ? tree->accelerations_of_states(t, q, rates, *tau, udot, threads)
                     : tree->accelerations_of_states(t, q, rates, udot, threads),
                 t, q.data());

  const StateMatrix from_q = q, from_u = rates, from_tau = tau ? StateMatrix(*tau) : StateMatrix();
  StateMatrix found(nv, count), multipliers(m, count);
  if (side_by_side(t,
                   {from_q.data(), from_u.data(), found.data(), multipliers.data(), nullptr, count,
                    static_cast<std::size_t>(count), tau ? from_tau.data() : nullptr},
                   false, 0, threads) &&
      found.allFinite() && multipliers.allFinite()) {
    udot = found;
    lambda = multipliers;
    return true;
  }
  Eigen::VectorXd one_udot(nv), one_lambda(m);
  return one_by_one(
      [&](Eigen::Index i) {
        const bool ok =
            tau ? chain.accelerations(t, q.col(i), rates.col(i), tau->col(i), one_udot, one_lambda)
                : chain.accelerations(t, q.col(i), rates.col(i), one_udot, one_lambda);
        udot.col(i) = one_udot;
        lambda.col(i) = one_lambda;
        return ok;
      },
      udot, lambda);
}

bool ClosedChain::rates_of_states(double t, const ConstStatesRef& q, const ConstStatesRef& p,
                                  StatesRef qdot, StatesRef pdot, double leak, int threads) {
  return impl_->rates_of_states(*this, t, q, p, nullptr, qdot, pdot, leak, threads);
}
bool ClosedChain::rates_of_states(double t, const ConstStatesRef& q, const ConstStatesRef& p,
                                  const ConstStatesRef& tau, StatesRef qdot, StatesRef pdot,
                                  double leak, int threads) {
  return impl_->rates_of_states(*this, t, q, p, &tau, qdot, pdot, leak, threads);
}
bool ClosedChain::accelerations_of_states(double t, const ConstStatesRef& q,
                                          const ConstStatesRef& u, StatesRef udot, StatesRef lambda,
                                          int threads) {
  return impl_->accelerations_of_states(*this, t, q, u, nullptr, udot, lambda, threads);
}
bool ClosedChain::accelerations_of_states(double t, const ConstStatesRef& q,
                                          const ConstStatesRef& u, const ConstStatesRef& tau,
                                          StatesRef udot, StatesRef lambda, int threads) {
  return impl_->accelerations_of_states(*this, t, q, u, &tau, udot, lambda, threads);
}

void ClosedChain::momenta(double t, const ConstVectorRef& q, const ConstVectorRef& u, VectorRef p) {
  expect_sizes("momenta", {{"q", q.size()}, {"u", u.size()}, {"p", p.size()}}, {nq(), nv(), nv()});
  expect_given_finite("momenta", impl_->failure, t, {"q", q}, {"u", u});
  impl_->place(t, q, u);
  impl_->e->momenta(nullptr, p.data());
  expect_found_finite("momenta", impl_->failure, p);
}

void ClosedChain::joint_forces(double t, const ConstVectorRef& q, const ConstVectorRef& u,
                               const ConstVectorRef& udot, const ConstVectorRef& lambda,
                               VectorRef tau) {
  expect_sizes("joint_forces",
               {{"q", q.size()},
                {"u", u.size()},
                {"udot", udot.size()},
                {"lambda", lambda.size()},
                {"tau", tau.size()}},
               {nq(), nv(), nv(), m(), nv()});
  expect_given_finite("joint_forces", impl_->failure, t, {"q", q}, {"u", u}, {"udot", udot},
                      {"lambda", lambda});
  impl_->place(t, q, u);
  impl_->e->joint_forces(q.data(), u.data(), udot.data(), m() > 0 ? lambda.data() : nullptr,
                         tau.data());
  expect_found_finite("joint_forces", impl_->failure, tau);
}

void ClosedChain::constraints(double t, const ConstVectorRef& q, const ConstVectorRef& u,
                              VectorRef phi, VectorRef phidot) {
  expect_sizes("constraints",
               {{"q", q.size()}, {"u", u.size()}, {"phi", phi.size()}, {"phidot", phidot.size()}},
               {nq(), nv(), m(), m()});
  expect_given_finite("constraints", impl_->failure, t, {"q", q}, {"u", u});
  impl_->place(t, q, u);
  impl_->e->positions(phi.data());
  impl_->e->velocities(phidot.data());
  expect_found_finite("constraints", impl_->failure, phi, phidot);
}

Eigen::MatrixXd ClosedChain::jacobian(double t, const ConstVectorRef& q) {
  expect_size("jacobian", "q", q.size(), nq());
  expect_given_finite("jacobian", impl_->failure, t, {"q", q});
  impl_->e->place(t, q.data());
  Eigen::MatrixXd found = dense_constraints(impl_->mechanism, *impl_->e);
  expect_found_finite("jacobian", impl_->failure, found);
  return found;
}

Eigen::MatrixXd ClosedChain::mass_matrix(double t, const ConstVectorRef& q) {
  expect_size("mass_matrix", "q", q.size(), nq());
  expect_given_finite("mass_matrix", impl_->failure, t, {"q", q});
  impl_->e->place(t, q.data());
  Eigen::MatrixXd found = dense_mass(impl_->mechanism, *impl_->e);
  expect_found_finite("mass_matrix", impl_->failure, found);
  return found;
}

Energies ClosedChain::energies(double t, const ConstVectorRef& q, const ConstVectorRef& u) {
  Impl& in = *impl_;
  momenta(t, q, u, in.u);
  Energies all;
  all.kinetic = in.e->kinetic();
  all.potential = in.e->potential(q.data());
  all.hamiltonian = in.u.dot(u) - all.kinetic + all.potential;
  const std::array found{all.kinetic, all.potential, all.hamiltonian};
  expect_found_finite("energies", in.failure, found);
  return all;
}

Reactions ClosedChain::reactions(double t, const ConstVectorRef& q, const ConstVectorRef& u) {
  Eigen::VectorXd udot(nv()), lambda(m());
  if (!accelerations(t, q, u, udot, lambda)) throw std::runtime_error("reactions: " + failure());
  return momenta::reactions(impl_->mechanism, t, q, u, udot, lambda);
}

void ClosedChain::coordinate_rates(double t, const ConstVectorRef& q, const ConstVectorRef& u,
                                   VectorRef qdot) {
  expect_sizes("coordinate_rates", {{"q", q.size()}, {"u", u.size()}, {"qdot", qdot.size()}},
               {nq(), nv(), nq()});
  expect_given_finite("coordinate_rates", impl_->failure, t, {"q", q}, {"u", u});
  impl_->rates_of_coordinates(t, q.data(), u.data(), qdot.data());
  expect_found_finite("coordinate_rates", impl_->failure, qdot);
}

}  // namespace momenta
