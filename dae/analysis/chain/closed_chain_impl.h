#pragma once
// Parts of a ClosedChain, for the files that implement it.

#include <momenta/core/open_chain/arguments.h>
#include <momenta/dae/analysis/chain/closed_chain.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/kkt/unheld_joints.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace momenta {

struct ClosedChain::Impl {
  Impl(const Scene& scene, const MechanismOptions& options)
      : mechanism(scene, options),
        e(mechanism.evaluation<double>()),
        u(mechanism.nv()),
        sigma(mechanism.m()),
        unasked(mechanism.nv()) {
    if (mechanism.m() > 0) {
      solver = make_loop_solver(mechanism, *e);
    } else if (!scene.lagrangian) {
      tree = std::make_unique<OpenChain>(scene, options.algebra);
    }
  }

  /// Notes why the solver failed; returns `ok`.
  bool noted(bool ok, double t, const double* q) {
    if (!ok)
      failure = tree ? tree->failure()
                     : no_inertia(mechanism,
                                  solver ? solver->singular_joint() : e->singular_joint(), t, q);
    return ok;
  }
  static std::span<const double> list(const double* x, int n) {
    return {x, static_cast<std::size_t>(n)};
  }
  bool momentum(double t, const double* q, const double* p, double* rates, double* impulses,
                double* pdot, double leak) {
    const bool ok =
        solver ? solver->momentum(t, q, p, nullptr, fade_evaluation, leak, rates, impulses, pdot)
               : e->open_momentum_rates(t, q, p, rates, pdot ? pdot : unasked.data());
    return noted(ok, t, q) &&
           found_finite(failure, list(rates, mechanism.nv()), list(impulses, mechanism.m()),
                        list(pdot, pdot ? mechanism.nv() : 0));
  }
  bool acceleration(double t, const double* q, const double* rates, double* udot, double* lambda) {
    return noted(solver ? solver->acceleration(t, q, rates, nullptr, 0, 0, udot, lambda)
                        : e->open_accelerations(t, q, rates, udot),
                 t, q);
  }
  /// Sets τ that acceleration() adds; null: none.
  void push(const double* tau) {
    if (solver)
      solver->push(tau);
    else
      e->push(tau);
  }
  void place(double t, const ConstVectorRef& q, const ConstVectorRef& rates) {
    e->place(t, q.data());
    e->move(rates.data());
  }
  /// q̇ from `rates`.
  void rates_of_coordinates(double t, const double* q, const double* rates, double* qdot) {
    if (!mechanism.plan().quasi_velocities) {
      std::copy_n(rates, mechanism.nv(), qdot);
      return;
    }
    e->place(t, q);
    e->coordinate_rates(q, rates, qdot);
  }

  /// Many states in the lanes of the sweeps' registers, on momenta or on accelerations. False where
  /// the sweeps do not carry the loops or the forces, or some state has no result or needs the
  /// matrix.
  bool side_by_side(double t, const LoopedStates& all, bool of_momenta, double leak, int threads);
  template <class Act>
  bool one_by_one(Act&& act, StatesRef a, StatesRef b);
  bool rates_of_states(ClosedChain& chain, double t, const ConstStatesRef& q,
                       const ConstStatesRef& p, const ConstStatesRef* tau, StatesRef qdot,
                       StatesRef pdot, double leak, int threads);
  bool accelerations_of_states(ClosedChain& chain, double t, const ConstStatesRef& q,
                               const ConstStatesRef& rates, const ConstStatesRef* tau,
                               StatesRef udot, StatesRef lambda, int threads);

  Mechanism mechanism;
  std::unique_ptr<Evaluation<double>> e;
  std::unique_ptr<LoopSolver> solver;                  ///< null without loops
  std::unique_ptr<OpenChain> tree;                     ///< null with loops or without bodies
  Eigen::VectorXd u, sigma, unasked;                   // scratch
  std::vector<std::unique_ptr<LoopedSweeps>> batches;  ///< one for each thread
  std::string failure;
};

/// Expects arguments of a call on one state to have their sizes.
inline void expect_sizes(const char* call,
                         std::initializer_list<std::pair<const char*, Eigen::Index>> found,
                         std::initializer_list<int> expected) {
  auto size = expected.begin();
  for (const auto& [name, is] : found) expect_size(call, name, is, *size++);
}

}  // namespace momenta
