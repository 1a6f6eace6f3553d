#pragma once
// What a ClosedChain consists of, for the files that implement it.

#include <momenta/core/arguments.h>
#include <momenta/core/share.h>
#include <momenta/dae/chain/closed_chain.h>
#include <momenta/dae/kkt/loop_solver.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

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

  /// The solver's verdict, in words.
  bool noted(bool ok, double t, const double* q) {
    if (!ok)
      failure = tree ? tree->failure() : mechanism.no_inertia(solver->singular_joint(), t, q);
    return ok;
  }
  static std::span<const double> list(const double* x, int n) {
    return {x, static_cast<std::size_t>(n)};
  }
  bool momentum(double t, const double* q, const double* p, double* rates, double* impulses,
                double* pdot, double leak) {
    return noted(solver->momentum(t, q, p, nullptr, fade_evaluation, leak, rates, impulses, pdot),
                 t, q) &&
           found_finite(failure, list(rates, mechanism.nv()), list(impulses, mechanism.m()),
                        list(pdot, pdot ? mechanism.nv() : 0));
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

/// q, u or p, and what else a call on one state takes or gives.
inline void expect_sizes(const char* call,
                         std::initializer_list<std::pair<const char*, Eigen::Index>> found,
                         std::initializer_list<int> expected) {
  auto size = expected.begin();
  for (const auto& [name, is] : found) expect_size(call, name, is, *size++);
}

}  // namespace momenta
