#include <momenta/core/arguments.h>
#include <momenta/core/share.h>
#include <momenta/dae/chain/closed_chain.h>
#include <momenta/dae/dense_blocks.h>
#include <momenta/dae/kkt/loop_solver.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace momenta {

struct ClosedChain::Inside {
  Inside(const Scene& scene, const MechanismOptions& options)
      : mechanism(scene, options), e(mechanism.evaluation<double>()), u(mechanism.nv()) {
    if (mechanism.m() > 0) {
      solver = make_loop_solver(mechanism, *e);
      sigma.resize(mechanism.m());
    } else {
      tree = std::make_unique<OpenChain>(scene, options.algebra);
    }
  }

  /// Whether what a call was given is finite; else failure() names what is not.
  bool finite(double t, const char* name, const ConstVectorRef& x) {
    failure.clear();
    if (!std::isfinite(t)) failure = "t is not finite, expected a time in seconds";
    for (Eigen::Index i = 0; i < x.size() && failure.empty(); ++i)
      if (!std::isfinite(x[i])) failure = not_finite(name, i, x[i]);
    return failure.empty();
  }
  bool noted(bool ok, double t, const double* q) {
    if (!ok)
      failure = tree ? tree->failure() : mechanism.no_inertia(solver->singular_joint(), t, q);
    return ok;
  }
  bool momentum(double t, const double* q, const double* p, double* rates, double* impulses,
                double* pdot, double leak) {
    return noted(solver->momentum(t, q, p, nullptr, fade_evaluation, leak, rates, impulses, pdot),
                 t, q);
  }
  void place(double t, const ConstVectorRef& q, const ConstVectorRef& rates) {
    e->place(t, q.data());
    e->move(rates.data());
  }
  /// q̇ where bodies are placed by the last call.
  void rates_of_coordinates(double t, const double* q, const double* rates, double* qdot) {
    if (!mechanism.plan().quasi_velocities) {
      std::copy_n(rates, mechanism.nv(), qdot);
      return;
    }
    e->place(t, q);
    e->coordinate_rates(q, rates, qdot);
  }

  /// Many states in the lanes of the sweeps' registers. False where they do not carry the loops,
  /// or some state has no rates or asks for the matrix.
  bool side_by_side(double t, const ConstStatesRef& q, const ConstStatesRef& p, StatesRef qdot,
                    StatesRef pdot, double leak, int threads) {
    const Eigen::Index count = q.cols();
    if (mechanism.kkt() != KktChoice::sweeps || mechanism.has_body_forces() || count == 0 ||
        !std::isfinite(t))
      return false;
    const StateMatrix from_q = q, from_p = p;  // rows of one stride
    StateMatrix rates(mechanism.nv(), count), impulses(mechanism.m(), count),
        forces(mechanism.nv(), count);
    if (batches.empty()) batches.push_back(mechanism.looped_sweeps());
    // Packs are whole, so that the number of threads does not change the bits.
    const auto width = static_cast<Eigen::Index>(batches.front()->width());
    const Eigen::Index packs = (count + width - 1) / width,
                       parts = std::min<Eigen::Index>(threads, packs);
    while (static_cast<Eigen::Index>(batches.size()) < parts)
      batches.push_back(mechanism.looped_sweeps());
    std::atomic<bool> all = true;
    share(static_cast<int>(parts), static_cast<std::size_t>(parts), [&](std::size_t part) {
      const auto k = static_cast<Eigen::Index>(part);
      const Eigen::Index first = packs * k / parts * width,
                         last = std::min(count, packs * (k + 1) / parts * width);
      LoopedSweeps& sweeps = *batches[part];
      const bool ok =
          sweeps.momentum(t,
                          {from_q.data() + first, from_p.data() + first, rates.data() + first,
                           impulses.data() + first, forces.data() + first, count,
                           static_cast<std::size_t>(last - first)},
                          fade_evaluation, leak);
      if (!ok || sweeps.weak_looped_branch()) all = false;
    });
    if (!all || !rates.allFinite() || !forces.allFinite()) return false;
    pdot = forces;
    if (!mechanism.plan().quasi_velocities) {
      qdot = rates;
      return true;
    }
    Eigen::VectorXd one_qdot(mechanism.nq());
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::VectorXd one_q = q.col(i), one_u = rates.col(i);
      rates_of_coordinates(t, one_q.data(), one_u.data(), one_qdot.data());
      qdot.col(i) = one_qdot;
    }
    return true;
  }

  Mechanism mechanism;
  std::unique_ptr<Evaluation<double>> e;
  std::unique_ptr<LoopSolver> solver;                  ///< with loops
  std::unique_ptr<OpenChain> tree;                     ///< without
  Eigen::VectorXd u, sigma;                            // scratch
  std::vector<std::unique_ptr<LoopedSweeps>> batches;  ///< one for each thread
  std::string failure;
};

namespace {

/// q, u or p, and what else a call on one state takes or gives.
void expect_sizes(const char* call,
                  std::initializer_list<std::pair<const char*, Eigen::Index>> found,
                  std::initializer_list<int> expected) {
  auto size = expected.begin();
  for (const auto& [name, is] : found) expect_size(call, name, is, *size++);
}

}  // namespace

ClosedChain::ClosedChain(const Scene& scene, MechanismOptions options)
    : inside_(std::make_unique<Inside>(scene, options)) {}
ClosedChain::~ClosedChain() = default;
ClosedChain::ClosedChain(ClosedChain&&) noexcept = default;
ClosedChain& ClosedChain::operator=(ClosedChain&&) noexcept = default;

const Mechanism& ClosedChain::mechanism() const {
  return inside_->mechanism;
}
const std::string& ClosedChain::failure() const {
  return inside_->failure;
}
Assembly ClosedChain::assemble() const {
  return momenta::assemble(inside_->mechanism);
}

bool ClosedChain::rates(double t, const ConstVectorRef& q, const ConstVectorRef& p, VectorRef qdot,
                        VectorRef pdot, double leak) {
  Inside& in = *inside_;
  expect_sizes("rates",
               {{"q", q.size()}, {"p", p.size()}, {"qdot", qdot.size()}, {"pdot", pdot.size()}},
               {nq(), nv(), nq(), nv()});
  if (!in.finite(t, "q", q) || !in.finite(t, "p", p)) return false;
  if (in.tree) return in.noted(in.tree->rates(t, q, p, qdot, pdot), t, q.data());
  if (!in.momentum(t, q.data(), p.data(), in.u.data(), in.sigma.data(), pdot.data(), leak))
    return false;
  in.rates_of_coordinates(t, q.data(), in.u.data(), qdot.data());
  return true;
}

bool ClosedChain::rates(double t, const ConstVectorRef& q, const ConstVectorRef& p,
                        const ConstVectorRef& tau, VectorRef qdot, VectorRef pdot, double leak) {
  expect_size("rates", "tau", tau.size(), nv());
  if (!inside_->finite(t, "tau", tau) || !rates(t, q, p, qdot, pdot, leak)) return false;
  pdot += tau;  // u and σ follow from p alone
  return true;
}

bool ClosedChain::rates_of_states(double t, const ConstStatesRef& q, const ConstStatesRef& p,
                                  StatesRef qdot, StatesRef pdot, double leak, int threads) {
  Inside& in = *inside_;
  const char* call = "rates_of_states";
  expect_sizes(call,
               {{"a column of q", q.rows()},
                {"a column of p", p.rows()},
                {"a column of qdot", qdot.rows()},
                {"a column of pdot", pdot.rows()}},
               {nq(), nv(), nq(), nv()});
  const Eigen::Index count = q.cols();
  expect_size(call, "a row of p", p.cols(), count);
  expect_size(call, "a row of qdot", qdot.cols(), count);
  expect_size(call, "a row of pdot", pdot.cols(), count);
  if (threads < 1)
    throw std::invalid_argument("rates_of_states: threads is " + std::to_string(threads) +
                                ", expected 1 or more");
  in.failure.clear();
  if (in.tree) return in.noted(in.tree->rates_of_states(t, q, p, qdot, pdot, threads), t, q.data());
  if (in.side_by_side(t, q, p, qdot, pdot, leak, threads)) return true;
  std::string first;
  Eigen::VectorXd one_qdot(nq()), one_pdot(nv());
  for (Eigen::Index i = 0; i < count; ++i) {
    if (!rates(t, q.col(i), p.col(i), one_qdot, one_pdot, leak)) {
      one_qdot.setConstant(std::numeric_limits<double>::quiet_NaN());
      one_pdot.setConstant(std::numeric_limits<double>::quiet_NaN());
      if (first.empty()) first = "state " + std::to_string(i) + ": " + in.failure;
    }
    qdot.col(i) = one_qdot;
    pdot.col(i) = one_pdot;
  }
  in.failure = first;
  return first.empty();
}

bool ClosedChain::velocities(double t, const ConstVectorRef& q, const ConstVectorRef& p,
                             VectorRef u, VectorRef sigma) {
  Inside& in = *inside_;
  expect_sizes("velocities",
               {{"q", q.size()}, {"p", p.size()}, {"u", u.size()}, {"sigma", sigma.size()}},
               {nq(), nv(), nv(), m()});
  if (!in.finite(t, "q", q) || !in.finite(t, "p", p)) return false;
  if (in.tree) return in.noted(in.tree->velocities(t, q, p, u), t, q.data());
  return in.momentum(t, q.data(), p.data(), u.data(), sigma.data(), nullptr, 0);
}

void ClosedChain::momenta(double t, const ConstVectorRef& q, const ConstVectorRef& u, VectorRef p) {
  expect_sizes("momenta", {{"q", q.size()}, {"u", u.size()}, {"p", p.size()}}, {nq(), nv(), nv()});
  inside_->place(t, q, u);
  inside_->e->momenta(nullptr, p.data());
}

bool ClosedChain::accelerations(double t, const ConstVectorRef& q, const ConstVectorRef& u,
                                VectorRef udot, VectorRef lambda) {
  Inside& in = *inside_;
  expect_sizes("accelerations",
               {{"q", q.size()}, {"u", u.size()}, {"udot", udot.size()}, {"lambda", lambda.size()}},
               {nq(), nv(), nv(), m()});
  if (!in.finite(t, "q", q) || !in.finite(t, "u", u)) return false;
  if (in.tree) return in.noted(in.tree->accelerations(t, q, u, udot), t, q.data());
  return in.noted(
      in.solver->acceleration(t, q.data(), u.data(), nullptr, 0, 0, udot.data(), lambda.data()), t,
      q.data());
}

bool ClosedChain::accelerations(double t, const ConstVectorRef& q, const ConstVectorRef& u,
                                const ConstVectorRef& tau, VectorRef udot, VectorRef lambda) {
  Inside& in = *inside_;
  expect_size("accelerations", "tau", tau.size(), nv());
  if (!in.finite(t, "tau", tau)) return false;
  if (in.tree) {
    expect_size("accelerations", "lambda", lambda.size(), 0);
    return in.noted(in.tree->accelerations(t, q, u, tau, udot), t, q.data());
  }
  in.solver->push(tau.data());
  const bool ok = accelerations(t, q, u, udot, lambda);
  in.solver->push(nullptr);
  return ok;
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
  inside_->place(t, q, u);
  inside_->e->joint_forces(q.data(), u.data(), udot.data(), m() > 0 ? lambda.data() : nullptr,
                           tau.data());
}

void ClosedChain::constraints(double t, const ConstVectorRef& q, const ConstVectorRef& u,
                              VectorRef phi, VectorRef phidot) {
  expect_sizes("constraints",
               {{"q", q.size()}, {"u", u.size()}, {"phi", phi.size()}, {"phidot", phidot.size()}},
               {nq(), nv(), m(), m()});
  inside_->place(t, q, u);
  inside_->e->positions(phi.data());
  inside_->e->velocities(phidot.data());
}

bool ClosedChain::correct(double t, VectorRef q, VectorRef u) {
  constexpr int most_steps = 20;
  Inside& in = *inside_;
  expect_sizes("correct", {{"q", q.size()}, {"u", u.size()}}, {nq(), nv()});
  if (!in.finite(t, "q", q) || !in.finite(t, "u", u)) return false;
  if (in.tree) return true;
  Eigen::VectorXd p(nv()), delta(nv()), qdot(nq()), moved(nq()), phi(m());
  double last = std::numeric_limits<double>::infinity();
  for (int step = 0;; ++step) {
    in.e->place(t, q.data());
    in.e->positions(phi.data());
    const double open = phi.cwiseAbs().maxCoeff();
    // Quadratic until rounding is all that is left.
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
  momenta(t, q, u, p);
  return in.momentum(t, q.data(), p.data(), u.data(), in.sigma.data(), nullptr, 0);
}

Eigen::MatrixXd ClosedChain::jacobian(double t, const ConstVectorRef& q) {
  expect_size("jacobian", "q", q.size(), nq());
  inside_->e->place(t, q.data());
  return dense_constraints(inside_->mechanism, *inside_->e);
}

Eigen::MatrixXd ClosedChain::mass_matrix(double t, const ConstVectorRef& q) {
  expect_size("mass_matrix", "q", q.size(), nq());
  inside_->e->place(t, q.data());
  return dense_mass(inside_->mechanism, *inside_->e);
}

Energies ClosedChain::energies(double t, const ConstVectorRef& q, const ConstVectorRef& u) {
  Inside& in = *inside_;
  momenta(t, q, u, in.u);
  Energies all;
  all.kinetic = in.e->kinetic();
  all.potential = in.e->potential(q.data());
  all.hamiltonian = in.u.dot(u) - all.kinetic + all.potential;
  return all;
}

Reactions ClosedChain::reactions(double t, const ConstVectorRef& q, const ConstVectorRef& u) {
  Eigen::VectorXd udot(nv()), lambda(m());
  if (!accelerations(t, q, u, udot, lambda)) throw std::runtime_error("reactions: " + failure());
  return momenta::reactions(inside_->mechanism, t, q, u, udot, lambda);
}

void ClosedChain::coordinate_rates(double t, const ConstVectorRef& q, const ConstVectorRef& u,
                                   VectorRef qdot) {
  expect_sizes("coordinate_rates", {{"q", q.size()}, {"u", u.size()}, {"qdot", qdot.size()}},
               {nq(), nv(), nq()});
  inside_->rates_of_coordinates(t, q.data(), u.data(), qdot.data());
}

}  // namespace momenta
