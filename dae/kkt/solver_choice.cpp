#include <momenta/core/kernel/levels/open_sweeps.h>
#include <momenta/core/kernel/link.h>
#include <momenta/core/kernel/planar_joint.h>
#include <momenta/dae/kkt/factor/faded_pivot.h>
#include <momenta/dae/kkt/saddle_point_factor.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/kkt/sweeps/branches/looped_branches.h>
#include <momenta/dae/kkt/sweeps/levels/loop_sweeps.h>
#include <momenta/dae/kkt/unheld_joints.h>
#include <momenta/dae/mechanism/model_data.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

namespace momenta {
namespace {

// Below this size a dense Cholesky of M and a pivoted LDLᵀ of the loops' small matrix beat sparse
// bookkeeping.
constexpr int dense_matrix_limit = 60;
// Mean depth of the bodies of a deep tree [joints].
constexpr double deep_tree = 40;

/// Why the sweeps do not carry these loops; empty: they do.
template <class Space>
std::string not_carried(const LoopModel<Space>& loops, const LoopPlan& plan) {
  if (!plan.linear)
    return !loops.equations.empty() ? "a loop is an equation, which the sweeps do not carry"
           : !loops.wheels.empty()  ? "a loop is a rolling wheel, which the sweeps do not carry"
           : !loops.pairs.empty()
               ? "a loop is a pair of curves, which the sweeps do not carry"
               : "a coupler has powers of a coordinate, and the sweeps carry linear ones";
  if (plan.fits()) return "";
  return (plan.slots > 64 ? std::string("more than 64")  // no more are counted
                          : std::to_string(plan.slots)) +
         " loop equations are open at once, more than " + std::to_string(LoopPlan::most_slots);
}

}  // namespace

/// The links of a tree, and its loops as the sweeps carry them.
template <class Space>
struct SweepPlan {
  explicit SweepPlan(const Mechanism& mechanism, const ModelData<Space>& data)
      : links(build_links(data.model)),
        swept(swept_loops(mechanism.tree(), data.model, in_link_frames(data.loops, links))) {
    if (swept.shared.empty()) return;
    as_given.loops = in_link_frames(data.loops, links);
    as_given.plan = plan_loops(data.model, as_given.loops);
  }

  decltype(build_links(std::declval<const Model<Space>&>())) links;
  SweptLoops<Space> swept, as_given;  ///< as_given: only where `swept` pairs ties anew
};

struct SolverChoice::Plans {
  std::optional<SweepPlan<Planar>> planar;
  std::optional<SweepPlan<Spatial>> spatial;
};

/// Calls f with the SweepPlan of the mechanism's algebra.
template <class F>
decltype(auto) SolverChoice::visit(F&& f) const {
  return plans_->planar ? f(*plans_->planar) : f(*plans_->spatial);
}

const SolverChoice& Mechanism::solver() const {
  std::call_once(solver_known_, [this] { solver_ = std::make_shared<const SolverChoice>(*this); });
  return *solver_;
}

const char* name_of(KktChoice choice) {
  switch (choice) {
    case KktChoice::sweeps:
      return "sweeps";
    case KktChoice::sparse:
      return "sparse";
    case KktChoice::dense:
      return "dense";
    case KktChoice::automatic:
      break;
  }
  return "auto";
}

SolverChoice::SolverChoice(const Mechanism& mechanism)
    : mechanism_(mechanism),
      dense_(mechanism.options().kkt == KktChoice::dense ||
             (mechanism.options().kkt != KktChoice::sparse &&
              mechanism.nv() + mechanism.m() <= dense_matrix_limit)) {
  if (mechanism.m() == 0) return;
  const KktChoice asked = mechanism.options().kkt;
  const Scene& scene = mechanism.scene();
  reason_ = plan_sweeps();
  light_ = joint_without_inertia();
  if (scene.lagrangian && !light_.empty()) reason_ = light_;
  const bool far_apart = light_.empty() && !(light_ = loops_missed()).empty();
  kkt_ = dense_ ? KktChoice::dense : KktChoice::sparse;
  if (far_apart && asked == KktChoice::dense)
    throw SceneError(scene.where({}) + "dense matrices were asked to solve (7), but " + light_ +
                     "; expected --kkt sparse");
  if (asked == KktChoice::dense || asked == KktChoice::sparse) return;
  if (reason_.empty()) reason_ = light_;
  if (reason_.empty()) {
    kkt_ = KktChoice::sweeps;
    return;
  }
  if (scene.lagrangian && asked == KktChoice::automatic && light_.empty()) return;
  if (asked == KktChoice::sweeps)
    throw SceneError(scene.where({}) + "the sweeps were asked to carry the loops, but " + reason_ +
                     "; expected --kkt sparse" + (light_.empty() ? " or dense" : ""));
  kkt_ = KktChoice::sparse;
  dense_ = false;
}

SolverChoice::~SolverChoice() = default;

std::string SolverChoice::plan_sweeps() {
  if (mechanism_.scene().lagrangian) return "formulas have no bodies for sweeps to pass";
  plans_ = std::make_unique<Plans>();
  return mechanism_.visit([&]<class Space>(const ModelData<Space>& data) {
    auto& plan = [&]() -> auto& {
      if constexpr (Space::dimension == 3)
        return plans_->planar;
      else
        return plans_->spatial;
    }
    ();
    plan.emplace(mechanism_, data);
    return not_carried(data.loops, plan->swept.plan);
  });
}

/// A joint may have no inertia until a loop closes above it: one solution at the start fails then,
/// or finds rounding for its inertia.
std::string SolverChoice::joint_without_inertia() const {
  const Tree& tree = mechanism_.tree();
  const auto size = static_cast<std::size_t>(tree.nv);
  std::vector<double> p(size, 0.0), u(size), sigma(static_cast<std::size_t>(mechanism_.m()));
  if (!reason_.empty()) {
    const auto matrix = saddle_point_factor(mechanism_);
    const auto e = mechanism_.evaluation<double>();
    e->place(0, tree.q0.data());
    const bool factorised = matrix->factor(*e, 0, tree.q0.data(), nullptr, fade_evaluation);
    const int rate = matrix->singular_joint();
    if (!factorised) return rate < 0 ? "" : light_before_loops(mechanism_, rate);
  } else {
    const auto sweeps = this->sweeps();
    RightSide<double> right;
    right.fade = fade_beside(
        fade_evaluation,
        mechanism_.masses_apart());  // otherwise redundant rows leave rounding for inertia
    if (!sweeps->momentum(0, tree.q0.data(), p.data(), right, u.data(), sigma.data(), nullptr))
      return light_before_loops(mechanism_,
                                tree.bodies[static_cast<std::size_t>(sweeps->singular_joint())].u);
  }
  const auto e = mechanism_.evaluation<double>();
  const UnheldJoints unheld = unheld_by_rounding(mechanism_, *e, 0, tree.q0.data(), false);
  return unheld.joints.empty() ? "" : light_before_loops(mechanism_, unheld.joints.front().rate);
}

/// How far eliminating joints before loops misses (7) where masses are apart; empty: little.
std::string SolverChoice::loops_missed() const {
  constexpr double nothing_lost = 1e4;
  if (mechanism_.masses_apart() < nothing_lost) return "";
  const auto e = mechanism_.evaluation<double>();
  double error = 0;
  if (reason_.empty()) {
    const auto sweeps = this->sweeps();
    error = elimination_error(mechanism_, *e,
                              [&](const double* q, const double* p, double beta, double fade,
                                  double* v, double* sigma) -> std::optional<bool> {
                                RightSide<double> right;
                                right.fade = fade_beside(fade, mechanism_.masses_apart());
                                right.drives = false;
                                right.positions = beta;
                                const bool ok = sweeps->momentum(0, q, p, right, v, sigma, nullptr);
                                if (sweeps->weak_looped_branch()) return std::nullopt;
                                return ok;
                              });
  } else {
    const auto matrix = saddle_point_factor(mechanism_);
    const auto own = mechanism_.evaluation<double>();
    std::vector<double> x(static_cast<std::size_t>(mechanism_.nv() + mechanism_.m()));
    std::vector<double> place;  // q and fade of the factors at hand
    error =
        elimination_error(mechanism_, *e,
                          [&](const double* q, const double* p, double beta, double fade, double* v,
                              double* sigma) -> std::optional<bool> {
                            std::vector<double> here(q, q + mechanism_.nq());
                            here.push_back(fade);
                            if (here != place) {
                              place.clear();
                              own->place(0, q);
                              if (!matrix->factor(*own, 0, q, nullptr, fade)) return false;
                              place = here;
                            }
                            own->positions(x.data() + mechanism_.nv());
                            std::copy_n(p, mechanism_.nv(), x.data());
                            for (int i = mechanism_.nv(); i < mechanism_.nv() + mechanism_.m(); ++i)
                              x[static_cast<std::size_t>(i)] *= -beta;
                            matrix->solve(x.data());
                            std::copy_n(x.data(), mechanism_.nv(), v);
                            std::copy_n(x.data() + mechanism_.nv(), mechanism_.m(), sigma);
                            return true;
                          });
  }
  if (error <= most_elimination_error) return "";
  char missed[160];
  if (std::isfinite(error))
    std::snprintf(missed, sizeof missed,
                  "joints eliminated before their loops miss (7) by %.0e of its terms, more than "
                  "%.0e, as ",
                  error, most_elimination_error);
  else
    std::snprintf(missed, sizeof missed,
                  "joints eliminated before their loops leave (7) without a solution near the "
                  "start, as ");
  return missed + mechanism_.furthest_apart();
}

bool solved_by_bodies(const Mechanism& mechanism) {
  std::vector<int> depth;
  double sum = 0;
  for (const auto& b : mechanism.tree().bodies) {
    depth.push_back(b.parent < 0 ? 1 : 1 + depth[static_cast<std::size_t>(b.parent)]);
    sum += depth.back();
  }
  return sum > deep_tree * static_cast<double>(depth.size());
}

void SolverChoice::expect_sweeps() const {
  if (plans_ && visit([](const auto& plan) { return plan.swept.plan.fits(); })) return;
  throw std::logic_error("no sweeps carry loops of '" + mechanism_.scene().name +
                         "': " + (mechanism_.m() == 0 ? "it has none" : reason_));
}

std::unique_ptr<LoopedSweeps> SolverChoice::sweeps(int level, bool branches_side_by_side) const {
  expect_sweeps();
  return visit([&](const auto& plan) {
    return make_looped_sweeps(plan.links, plan.swept, level > 0 ? level : best_level(),
                              branches_side_by_side);
  });
}

std::unique_ptr<LoopedSweeps> SolverChoice::sweeps_as_given() const {
  expect_sweeps();
  return visit([](const auto& plan) {
    const auto& loops = plan.swept.shared.empty() ? plan.swept : plan.as_given;
    return make_looped_sweeps(plan.links, loops, best_level());
  });
}

bool SolverChoice::pairs_anew() const {
  return plans_ && visit([](const auto& plan) { return !plan.swept.shared.empty(); });
}

std::string SolverChoice::in_words() const {
  if (kkt_ == KktChoice::dense)
    return "dense: Cholesky of M, pivoted and filtered LDLᵀ of the loops";
  if (kkt_ == KktChoice::sweeps) {
    std::string branches;
    if (plans_->spatial) {
      const auto& [links, swept, as_given] = *plans_->spatial;
      branches = looped_branches_in_words(find_looped_branches(
          links, swept.loops, swept.plan, looped_branch_lanes_at(best_level())));
    }
    return "loops carried by the sweeps, at most " +
           std::to_string(visit([](const auto& plan) { return plan.swept.plan.slots; })) +
           " equations open at once" +
           (pairs_anew() ? ", loops that meet in one point paired along the tree" : "") +
           (branches.empty() ? "" : ", " + branches);
  }
  const bool deep = solved_by_bodies(mechanism_);
  return std::string(leaves_first()
                         ? deep ? "sparse: filtered LDLᵀ of the equations of the bodies, the tree "
                                  "being deep,"
                                : "sparse: filtered LDLᵀ"
                     : deep ? "sparse: KLU on the equations of the bodies, the tree being deep; "
                              "poses are not filtered,"
                            : "sparse: KLU") +
         " on a pattern analysed once" + (reason_.empty() ? "" : " (" + reason_ + ")");
}

}  // namespace momenta
