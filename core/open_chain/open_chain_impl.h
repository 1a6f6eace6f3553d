#pragma once
// The inside of an OpenChain, for its sources alone: tree, plan and the kernel of the plan.

#include <momenta/core/kernel/levels/batch_sweeps.h>
#include <momenta/core/kernel/levels/lazy.h>
#include <momenta/core/kernel/levels/open_sweeps.h>
#include <momenta/core/kernel/mass_matrix.h>
#include <momenta/core/kernel/massless_joints.h>
#include <momenta/core/kernel/reactions.h>
#include <momenta/core/open_chain/arguments.h>
#include <momenta/core/open_chain/centroidal_sums.h>
#include <momenta/core/open_chain/open_chain.h>
#include <momenta/core/open_chain/parallel_for.h>

#include <algorithm>
#include <optional>
#include <variant>

namespace momenta {

template <class Space>
struct Kernel {
  using Links = decltype(build_links(std::declval<const Model<Space>&>()));
  // Links, branches, sweeps and workspace point at the model: it must not move.
  Kernel(Model<Space> m, int level, [[maybe_unused]] bool branches_side_by_side)
      : model(std::make_unique<Model<Space>>(std::move(m))),
        links(std::make_unique<Links>(build_links(*model))),
        w(*model) {
    if constexpr (Space::dimension == 6) {
      if (branches_side_by_side) branches = find_branches(*links, branch_lanes_at(level));
      sweeps = make_sweeps(*links, level, branches.get());
    } else {
      sweeps = make_sweeps(*links, level);
    }
    batches.push_back(make_batch_sweeps(*links, level));
  }
  std::unique_ptr<Model<Space>> model;
  std::unique_ptr<Links> links;
  std::unique_ptr<Branches> branches;
  std::unique_ptr<OpenSweeps> sweeps;
  std::vector<std::unique_ptr<BatchSweeps>> batches;  ///< one for each thread
  Lazy<ReactionPass<Space>> reactions;
  Workspace<Space, double> w;
};

struct OpenChain::Impl {
  Tree tree;
  Plan plan;
  std::variant<Kernel<Planar>, Kernel<Spatial>> kernel;
  std::optional<Scene>
      flat;  ///< scene of a planar kernel; `in_space` is made from it when first needed
  std::unique_ptr<CentroidalSweep> in_space;
  Eigen::VectorXd u, p;  // scratch, nv
  bool has_user_joints = false;
  bool placed = false;  ///< the sweeps hold, or can find, M* of the last call's place
  int singular = -1;
  Eigen::Index failed_state = -1;  ///< first state of the last batch that failed; −1: none
  double failed_t = 0;             ///< where the last call failed for want of inertia [s]
  Eigen::VectorXd failed_q;
  /// The sentence on a number of the last call that is not finite, given or found; empty: none.
  std::string not_a_number;

  Impl(Tree t, Plan pl, const Scene& from, int level, bool branches_side_by_side)
      : tree(std::move(t)),
        plan(std::move(pl)),
        kernel(plan.planar ? decltype(kernel)(Kernel<Planar>(
                                 build_planar_model(tree, from, plan.basis), level, false))
                           : decltype(kernel)(Kernel<Spatial>(build_spatial_model(tree, from),
                                                              level, branches_side_by_side))),
        u(tree.nv),
        p(tree.nv) {
    if (plan.planar) flat = from;
    for (const auto& b : tree.bodies) has_user_joints |= b.kind == JointKind::user;
  }

  /// Records where a joint without inertia was met: (t, q), coordinates `stride` apart.
  void note_place(double t, const double* q, Eigen::Index stride = 1) {
    failed_t = t;
    failed_q = Eigen::Map<const Eigen::VectorXd, 0, Eigen::InnerStride<>>(
        q, tree.nq, Eigen::InnerStride<>(stride));
  }
  /// All joints without inertia at the recorded place.
  template <class K>
  std::vector<MasslessJoint> massless(K& k) {
    poses_outward(k.w, failed_t, failed_q.data(), false);
    Eigen::VectorXd diagonal(tree.nv);
    mass_diagonal_inward(k.w, diagonal.data());
    Eigen::MatrixXd mass;
    if (tree.nv <= most_pivots) {
      mass.setZero(tree.nv, tree.nv);
      mass_matrix_inward(k.w, [&](int i, int j, double x) { mass(i, j) = mass(j, i) = x; });
    }
    return massless_joints(tree, failed_q.data(), diagonal, mass,
                           tree.bodies[static_cast<std::size_t>(singular)].u);
  }

  /// Why the first of many states has no result, given x and y besides q.
  bool told_of_state(bool ok, const ConstStatesRef& q, const char* x_name, const ConstStatesRef& x,
                     const char* y_name = "", const ConstStatesRef& y = StateMatrix()) {
    not_a_number.clear();
    if (ok) return true;
    const Eigen::VectorXd of_q = q.col(failed_state), of_x = x.col(failed_state),
                          of_y = y.size() > 0 ? Eigen::VectorXd(y.col(failed_state))
                                              : Eigen::VectorXd();
    if (given_finite(not_a_number, 0, {"q", of_q}, {x_name, of_x}, {y_name, of_y}) && singular < 0)
      not_a_number = too_large;
    if (!not_a_number.empty())
      not_a_number = "state " + std::to_string(failed_state) + ": " + not_a_number;
    return false;
  }

  /// The momentum recursion and its third sweep.
  template <class K>
  bool momentum(K& k, double t, const double* q, const double* momenta, double* rates,
                double* pdot) {
    failed_state = -1;
    placed = k.sweeps->momentum(t, q, momenta, rates, pdot);
    if (!placed) {
      singular = k.sweeps->singular_joint();
      note_place(t, q);
      return false;
    }
    singular = -1;
    if (k.model->has_body_forces()) {
      body_force_rates(k.w, t, q, static_cast<const double*>(rates));
      for (int i = 0; i < tree.nv; ++i) pdot[i] += k.w.generalised[static_cast<std::size_t>(i)];
    }
    return true;
  }
  template <class K>
  bool acceleration(K& k, double t, const double* q, const double* rates, double* udot,
                    const double* tau = nullptr) {
    applied_forces(k.w, t, q, rates);
    if (tau)
      for (int i = 0; i < tree.nv; ++i) k.w.generalised[static_cast<std::size_t>(i)] += tau[i];
    const bool ok = k.sweeps->acceleration(t, q, rates, k.w.generalised.data(), udot);
    singular = ok ? -1 : k.sweeps->singular_joint();
    failed_state = -1;
    if (!ok) note_place(t, q);
    return ok;
  }

  /// Records the outcome of a call on one state.
  template <class Sweeps>
  bool noted_one(const Sweeps& sweeps, double t, const double* q, bool ok) {
    singular = ok ? -1 : sweeps.singular_joint();
    failed_state = -1;
    if (!ok) note_place(t, q);
    return ok;
  }
  /// Runs many states at t, consecutive ones on each thread. Parts end where packs do: results do
  /// not depend on the number of threads.
  template <class K, class Run>
  bool batch(K& k, double t, int threads, const States& all, Run&& run) {
    if (take_batch(k, threads, all, std::forward<Run>(run))) return true;
    note_place(t, all.q + failed_state, all.stride);
    return false;
  }
  template <class K, class Run>
  bool take_batch(K& k, int threads, const States& all, Run&& run) {
    const auto width = static_cast<std::size_t>(k.batches[0]->width());
    const std::size_t packs = (all.count + width - 1) / width;
    std::size_t parts = has_user_joints ? 1 : static_cast<std::size_t>(threads);
    parts = std::max<std::size_t>(1, std::min(parts, packs));
    singular = -1;
    failed_state = -1;
    if (parts == 1) {
      BatchSweeps& sweeps = *k.batches[0];
      if (run(sweeps, all)) return true;
      singular = sweeps.singular_joint();
      failed_state = static_cast<Eigen::Index>(sweeps.failed_state());
      return false;
    }
    while (k.batches.size() < parts)
      k.batches.push_back(make_batch_sweeps(*k.links, k.sweeps->level()));
    const auto begin = [&](std::size_t i) {
      return std::min(all.count, packs * i / parts * width);
    };
    std::vector<char> failed(parts, 0);
    parallel_for(static_cast<int>(parts), parts, [&](std::size_t i) {
      const std::size_t first = begin(i);
      failed[i] = !run(*k.batches[i], all.part(first, begin(i + 1) - first));
    });
    for (std::size_t i = 0; i < parts && failed_state < 0; ++i)
      if (failed[i]) {
        singular = k.batches[i]->singular_joint();
        failed_state = static_cast<Eigen::Index>(begin(i) + k.batches[i]->failed_state());
      }
    return failed_state < 0;
  }
  bool accelerations_of_states(OpenChain& chain, double t, const ConstStatesRef& q,
                               const ConstStatesRef& rates, const ConstStatesRef* tau,
                               StatesRef udot, int threads);
  /// State by state, for scenes with forces between bodies.
  template <class F>
  bool one_by_one(Eigen::Index count, F&& f) {
    Eigen::Index failed = -1;
    int singular_joint = -1;
    Eigen::VectorXd q;
    for (Eigen::Index i = 0; i < count; ++i)
      if (!f(i) && failed < 0) {
        failed = i;
        singular_joint = singular;
        q = failed_q;
      }
    failed_state = failed;
    singular = singular_joint;
    if (failed >= 0) failed_q = q;
    return failed < 0;
  }

  template <class F>
  decltype(auto) visit(F&& f) {
    return kernel.index() == 0 ? f(std::get<0>(kernel)) : f(std::get<1>(kernel));
  }
};

}  // namespace momenta
