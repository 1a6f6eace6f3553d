#include <momenta/core/scene/bearings_refused.h>
#include <momenta/dae/analysis/chain/closed_chain_impl.h>

#include <limits>

namespace momenta {

ClosedChain::ClosedChain(const Scene& scene, MechanismOptions options)
    : impl_(std::make_unique<Impl>(scene, options)) {
  refuse_bearings(scene, "ClosedChain");
}
ClosedChain::~ClosedChain() = default;
ClosedChain::ClosedChain(ClosedChain&&) noexcept = default;
ClosedChain& ClosedChain::operator=(ClosedChain&&) noexcept = default;

const Mechanism& ClosedChain::mechanism() const {
  return impl_->mechanism;
}
const std::string& ClosedChain::failure() const {
  return impl_->failure;
}
Assembly ClosedChain::assemble() const {
  return momenta::assemble(impl_->mechanism);
}

bool ClosedChain::rates(double t, const ConstVectorRef& q, const ConstVectorRef& p, VectorRef qdot,
                        VectorRef pdot, double leak) {
  Impl& in = *impl_;
  expect_sizes("rates",
               {{"q", q.size()}, {"p", p.size()}, {"qdot", qdot.size()}, {"pdot", pdot.size()}},
               {nq(), nv(), nq(), nv()});
  expect_leak("rates", leak);
  if (!given_finite(in.failure, t, {"q", q}, {"p", p})) return false;
  if (in.tree) return in.noted(in.tree->rates(t, q, p, qdot, pdot), t, q.data());
  if (!in.momentum(t, q.data(), p.data(), in.u.data(), in.sigma.data(), pdot.data(), leak))
    return false;
  in.rates_of_coordinates(t, q.data(), in.u.data(), qdot.data());
  return !mechanism().plan().quasi_velocities || found_finite(in.failure, qdot);
}

bool ClosedChain::rates(double t, const ConstVectorRef& q, const ConstVectorRef& p,
                        const ConstVectorRef& tau, VectorRef qdot, VectorRef pdot, double leak) {
  expect_size("rates", "tau", tau.size(), nv());
  if (!given_finite(impl_->failure, t, {"q", q}, {"tau", tau}) || !rates(t, q, p, qdot, pdot, leak))
    return false;
  pdot += tau;  // u and σ follow from p alone
  return found_finite(impl_->failure, pdot);
}

bool ClosedChain::velocities(double t, const ConstVectorRef& q, const ConstVectorRef& p,
                             VectorRef u, VectorRef sigma) {
  Impl& in = *impl_;
  expect_sizes("velocities",
               {{"q", q.size()}, {"p", p.size()}, {"u", u.size()}, {"sigma", sigma.size()}},
               {nq(), nv(), nv(), m()});
  if (!given_finite(in.failure, t, {"q", q}, {"p", p})) return false;
  if (in.tree) return in.noted(in.tree->velocities(t, q, p, u), t, q.data());
  return in.momentum(t, q.data(), p.data(), u.data(), sigma.data(), nullptr, 0);
}

bool ClosedChain::accelerations(double t, const ConstVectorRef& q, const ConstVectorRef& u,
                                VectorRef udot, VectorRef lambda) {
  Impl& in = *impl_;
  expect_sizes("accelerations",
               {{"q", q.size()}, {"u", u.size()}, {"udot", udot.size()}, {"lambda", lambda.size()}},
               {nq(), nv(), nv(), m()});
  if (!given_finite(in.failure, t, {"q", q}, {"u", u})) return false;
  if (in.tree) return in.noted(in.tree->accelerations(t, q, u, udot), t, q.data());
  return in.acceleration(t, q.data(), u.data(), udot.data(), lambda.data()) &&
         found_finite(in.failure, udot, lambda);
}

bool ClosedChain::accelerations(double t, const ConstVectorRef& q, const ConstVectorRef& u,
                                const ConstVectorRef& tau, VectorRef udot, VectorRef lambda) {
  Impl& in = *impl_;
  expect_sizes("accelerations",
               {{"tau", tau.size()},
                {"q", q.size()},
                {"u", u.size()},
                {"udot", udot.size()},
                {"lambda", lambda.size()}},
               {nv(), nq(), nv(), nv(), m()});
  if (!given_finite(in.failure, t, {"q", q}, {"tau", tau})) return false;
  if (in.tree) {
    return in.noted(in.tree->accelerations(t, q, u, tau, udot), t, q.data());
  }
  in.push(tau.data());
  const bool ok = accelerations(t, q, u, udot, lambda);
  in.push(nullptr);
  return ok;
}

bool ClosedChain::correct(double t, VectorRef q, VectorRef u) {
  constexpr int most_steps = 20;
  Impl& in = *impl_;
  expect_sizes("correct", {{"q", q.size()}, {"u", u.size()}}, {nq(), nv()});
  if (!given_finite(in.failure, t, {"q", q}, {"u", u})) return false;
  if (m() == 0) return true;
  Eigen::VectorXd p(nv()), delta(nv()), qdot(nq()), moved(nq()), phi(m());
  double last = std::numeric_limits<double>::infinity();
  for (int step = 0;; ++step) {
    in.e->place(t, q.data());
    in.e->positions(phi.data());
    const double open = phi.cwiseAbs().maxCoeff();
    // Convergence is quadratic until only rounding is left.
    if (step > 0 && open >= 0.5 * last) break;
    if (step == most_steps || !std::isfinite(open)) {
      in.failure = "the loops do not close from these positions";
      return false;
    }
    last = open;
    if (!in.noted(in.solver->position_correction(t, q.data(), delta.data()), t, q.data()))
      return false;
    in.rates_of_coordinates(t, q.data(), delta.data(), qdot.data());
    moved = q + qdot;
    mechanism().tree().normalise(moved);
    q = moved;
  }
  if (!(last <= 1e-9 * length_of(mechanism().scene()))) {
    in.failure = "the loops do not close from these positions";
    return false;
  }
  in.place(t, q, u);
  in.e->momenta(nullptr, p.data());
  return in.momentum(t, q.data(), p.data(), u.data(), in.sigma.data(), nullptr, 0);
}

}  // namespace momenta
