#include <momenta/core/kernel/levels/open_sweeps.h>
#include <momenta/core/scene/bearings_refused.h>
#include <momenta/dae/factor/faded_pivot.h>
#include <momenta/dae/leaves_first.h>
#include <momenta/dae/loop/loop_equation.h>
#include <momenta/dae/loop/loop_weights.h>
#include <momenta/dae/mechanism_inside.h>
#include <momenta/dae/unheld_joints.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace momenta {
namespace {

// Below this size a dense Cholesky of M and a pivoted LDLᵀ of the loops' small matrix beat sparse
// bookkeeping.
constexpr int dense_limit = 60;
// Mean depth of the bodies of a deep tree [joints].
constexpr double deep_tree = 40;

Plan plan_with_loops(const Tree& tree, const Scene& scene, Algebra algebra) {
  if (scene.lagrangian) {
    if (algebra != Algebra::automatic)
      throw SceneError(scene.where(scene.lagrangian->at) +
                       "lagrangian: a kernel was asked for, but it has no bodies to compute in a "
                       "plane or in space; expected --algebra auto");
    Plan plan;
    plan.planar = true;
    return plan;
  }
  Plan plan = make_plan(tree, scene, algebra);
  if (!plan.planar) return plan;
  const std::string why = loops_leave_plane(scene, tree, plan.basis);
  if (why.empty()) return plan;
  if (algebra == Algebra::planar)
    throw SceneError(scene.where({}) + "the planar kernel was asked for, but " + why +
                     ", expected a mechanism in a plane, or the spatial kernel");
  plan = make_plan(tree, scene, Algebra::spatial);
  plan.planar_reason = why;
  return plan;
}

/// Couplers that tie angles alone, by place in the scene.
std::vector<bool> couplers_of_angles(const Scene& scene, const Tree& tree) {
  std::vector<bool> of_angles;
  for (const LoopSpec& l : scene.loops) {
    bool slides = l.kind != LoopKind::coupler;
    for (std::size_t i = 0; i < l.joints.size(); ++i) {
      const int k = tree.part_of(l.joints[i], l.coordinates.empty() ? 0 : l.coordinates[i]);
      slides |= tree.bodies[static_cast<std::size_t>(k)].kind == JointKind::prismatic;
    }
    of_angles.push_back(!slides);
  }
  return of_angles;
}

}  // namespace

Mechanism::Mechanism(Scene scene, MechanismOptions options)
    : scene_(std::move(scene)),
      options_(options),
      tree_(build_tree(scene_)),
      plan_(plan_with_loops(tree_, scene_, options.algebra)),
      casts_(std::make_unique<Casts>()) {
  if (scene_.lagrangian)
    take_lagrangian();
  else
    take_bodies();
  dense_ = options.kkt == KktChoice::dense ||
           (options.kkt != KktChoice::sparse && tree_.nv + rows_ <= dense_limit);
  if (rows_ == 0) return;
  if (!scene_.lagrangian) take_weights();
  choose_kkt(options.kkt);
}

void Mechanism::take_bodies() {
  const auto cast_into = [&](auto& cast, auto&& model) {
    cast.model = std::move(model);
    cast.loops = build_loops(scene_, tree_, cast.model);
  };
  if (plan_.planar)
    cast_into(casts_->cast.emplace<0>(), build_planar_model(tree_, scene_, plan_.basis));
  else
    cast_into(casts_->cast.emplace<1>(), build_spatial_model(tree_, scene_));
  row_names_ = row_names(scene_, plan_.planar);
  rows_ = static_cast<int>(row_names_.size());
  plan_.loops = rows_ > 0;
  plan_.joint_forces |= with_bearing(scene_) != nullptr;
  plan_.drives |= visit([](const auto& cast) {
    const auto& equations = cast.loops.equations;
    return !cast.loops.motions.empty() ||
           std::any_of(equations.begin(), equations.end(), [](const auto& e) { return e->moves; });
  });
  const std::vector<bool> of_angles = couplers_of_angles(scene_, tree_);
  nonholonomic_ = visit([](const auto& cast) { return cast.loops.nonholonomic(); });
  const auto group = [&](const auto& cast) {
    int index = 0;
    for (const auto& l : cast.loops.loops) {
      const int points = l.first_rows();
      const bool coupler = of_angles[static_cast<std::size_t>(index / 2)];
      for (int i = 0; i < l.rows; ++i) {
        row_groups_.push_back(i < points ? index : index + 1);
        angle_rows_.push_back(i >= points || coupler);
      }
      index += 2;
    }
  };
  visit(group);
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

void Mechanism::choose_kkt(KktChoice asked) {
  const auto plan = [&](auto& cast) {
    cast.links = build_links(cast.model);
    cast.swept = swept_loops(tree_, cast.model, in_link_frames(cast.loops, cast.links));
    if (!cast.swept.shared.empty()) {
      cast.as_given.loops = in_link_frames(cast.loops, cast.links);
      cast.as_given.plan = plan_loops(cast.model, cast.as_given.loops);
    }
    if (!cast.swept.plan.linear)
      kkt_reason_ =
          !cast.loops.equations.empty() ? "a loop is an equation, which the sweeps do not carry"
          : !cast.loops.wheels.empty()  ? "a loop is a rolling wheel, which the sweeps do not carry"
          : !cast.loops.pairs.empty()
              ? "a loop is a pair of curves, which the sweeps do not carry"
              : "a coupler has powers of a coordinate, and the sweeps carry linear ones";
    else if (!cast.swept.plan.fits())
      kkt_reason_ =
          (cast.swept.plan.slots > 64 ? std::string("more than 64")  // no more are counted
                                      : std::to_string(cast.swept.plan.slots)) +
          " loop equations are open at once, more than " + std::to_string(LoopPlan::most_slots);
  };
  if (scene_.lagrangian)
    kkt_reason_ = "formulas have no bodies for sweeps to pass";
  else if (plan_.planar)
    plan(std::get<0>(casts_->cast));
  else
    plan(std::get<1>(casts_->cast));
  light_ = joint_without_inertia(kkt_reason_.empty());
  if (scene_.lagrangian && !light_.empty()) kkt_reason_ = light_;
  const bool far_apart = light_.empty() && !(light_ = loops_missed(kkt_reason_.empty())).empty();
  kkt_ = dense_ ? KktChoice::dense : KktChoice::sparse;
  if (far_apart && asked == KktChoice::dense)
    throw SceneError(scene_.where({}) + "dense matrices were asked to solve (7), but " + light_ +
                     "; expected --kkt sparse");
  if (asked == KktChoice::dense || asked == KktChoice::sparse) return;
  if (kkt_reason_.empty()) kkt_reason_ = light_;
  if (kkt_reason_.empty()) {
    kkt_ = KktChoice::sweeps;
    return;
  }
  if (scene_.lagrangian && asked == KktChoice::automatic && light_.empty()) return;
  if (asked == KktChoice::sweeps)
    throw SceneError(scene_.where({}) + "the sweeps were asked to carry the loops, but " +
                     kkt_reason_ + "; expected --kkt sparse" + (far_apart ? "" : " or dense"));
  kkt_ = KktChoice::sparse;
  dense_ = false;
}

void Mechanism::take_weights() {
  const auto e = evaluation<double>();
  e->place(0, tree_.q0.data());
  std::vector<double> inertia(static_cast<std::size_t>(tree_.nv));
  e->mass_diagonal(inertia.data());
  const auto take = [&](auto& cast) {
    const LoopWeights weights = weigh_loops(cast.loops, tree_, inertia, length_of(scene_));
    for (std::size_t k = 0; k < weights.least_scales.size(); ++k) {
      auto& l = cast.loops.loops[k];
      l.least_scale = weights.least_scales[k];
      for (int i = 0; i < l.rows; ++i)
        least_scales_.push_back(i < l.first_rows() ? l.least_scale : 0.0);
    }
    mass_spread_ = weights.spread;
    masses_apart_ = weights.apart;
    furthest_apart_ = weights.light;
  };
  if (plan_.planar)
    take(std::get<0>(casts_->cast));
  else
    take(std::get<1>(casts_->cast));
}

/// A joint may have no inertia until a loop closes above it: one solution at the start fails then,
/// or finds rounding for its inertia.
std::string Mechanism::joint_without_inertia(bool swept) const {
  const auto size = static_cast<std::size_t>(tree_.nv);
  std::vector<double> p(size, 0.0), u(size), sigma(row_names_.size());
  if (!swept) {
    const auto matrix = leaves_first_matrix(*this);
    const auto e = evaluation<double>();
    e->place(0, tree_.q0.data());
    const bool factorised = matrix->factor(*e, 0, tree_.q0.data(), nullptr, fade_evaluation);
    const int rate = matrix->singular_joint();
    if (!factorised) return rate < 0 ? "" : light_before_loops(rate);
  } else {
    const auto sweeps = looped_sweeps();
    RightSide<double> right;
    right.fade = fade_beside(fade_evaluation,
                             masses_apart_);  // otherwise redundant rows leave rounding for inertia
    if (!sweeps->momentum(0, tree_.q0.data(), p.data(), right, u.data(), sigma.data(), nullptr))
      return light_before_loops(tree_.bodies[static_cast<std::size_t>(sweeps->singular_joint())].u);
  }
  const auto e = evaluation<double>();
  const UnheldJoints unheld = unheld_by_rounding(*this, *e, 0, tree_.q0.data(), false);
  return unheld.joints.empty() ? "" : light_before_loops(unheld.joints.front().rate);
}

/// How far eliminating joints before loops misses (7) where masses are apart; empty: little.
std::string Mechanism::loops_missed(bool swept) const {
  constexpr double nothing_lost = 1e4;
  if (masses_apart_ < nothing_lost) return "";
  const auto e = evaluation<double>();
  double error = 0;
  if (swept) {
    const auto sweeps = looped_sweeps();
    error = leaves_first_error(*this, *e,
                               [&](const double* q, const double* p, double beta, double fade,
                                   double* v, double* sigma) -> std::optional<bool> {
                                 RightSide<double> right;
                                 right.fade = fade_beside(fade, masses_apart_);
                                 right.drives = false;
                                 right.positions = beta;
                                 const bool ok =
                                     sweeps->momentum(0, q, p, right, v, sigma, nullptr);
                                 if (sweeps->weak_looped_branch()) return std::nullopt;
                                 return ok;
                               });
  } else {
    const auto matrix = leaves_first_matrix(*this);
    const auto own = evaluation<double>();
    std::vector<double> x(static_cast<std::size_t>(nv() + m()));
    std::vector<double> place;  // q and fade of the factors at hand
    error = leaves_first_error(*this, *e,
                               [&](const double* q, const double* p, double beta, double fade,
                                   double* v, double* sigma) -> std::optional<bool> {
                                 std::vector<double> here(q, q + nq());
                                 here.push_back(fade);
                                 if (here != place) {
                                   place.clear();
                                   own->place(0, q);
                                   if (!matrix->factor(*own, 0, q, nullptr, fade)) return false;
                                   place = here;
                                 }
                                 own->positions(x.data() + nv());
                                 std::copy_n(p, nv(), x.data());
                                 for (int i = nv(); i < nv() + m(); ++i)
                                   x[static_cast<std::size_t>(i)] *= -beta;
                                 matrix->solve(x.data());
                                 std::copy_n(x.data(), nv(), v);
                                 std::copy_n(x.data() + nv(), m(), sigma);
                                 return true;
                               });
  }
  if (error <= most_leaves_first_error) return "";
  char missed[160];
  if (std::isfinite(error))
    std::snprintf(missed, sizeof missed,
                  "joints eliminated before their loops miss (7) by %.0e of its terms, more than "
                  "%.0e, as ",
                  error, most_leaves_first_error);
  else
    std::snprintf(missed, sizeof missed,
                  "joints eliminated before their loops leave (7) without a solution near the "
                  "start, as ");
  return missed + furthest_apart_;
}

bool Mechanism::solved_by_bodies() const {
  std::vector<int> depth;
  double sum = 0;
  for (const auto& b : tree_.bodies) {
    depth.push_back(b.parent < 0 ? 1 : 1 + depth[static_cast<std::size_t>(b.parent)]);
    sum += depth.back();
  }
  return sum > deep_tree * static_cast<double>(depth.size());
}

AxisScale Mechanism::axis_scale() const {
  return {tree_, constraint_pattern(), row_groups_, least_scales_, mass_spread_, masses_apart_};
}

void Mechanism::expect_sweeps() const {
  if (rows_ > 0 && visit([](const auto& cast) { return cast.swept.plan.fits(); })) return;
  throw std::logic_error("no sweeps carry loops of '" + scene_.name +
                         "': " + (rows_ == 0 ? "it has none" : kkt_reason_));
}
std::unique_ptr<LoopedSweeps> Mechanism::looped_sweeps(int level,
                                                       bool branches_side_by_side) const {
  expect_sweeps();
  return visit([&](const auto& cast) {
    return make_looped_sweeps(cast.links, cast.swept, level > 0 ? level : best_level(),
                              branches_side_by_side);
  });
}
std::unique_ptr<LoopedSweeps> Mechanism::looped_sweeps_as_given() const {
  expect_sweeps();
  return visit([](const auto& cast) {
    const auto& loops = cast.swept.shared.empty() ? cast.swept : cast.as_given;
    return make_looped_sweeps(cast.links, loops, best_level());
  });
}
bool Mechanism::pairs_anew() const {
  return visit([](const auto& cast) { return !cast.swept.shared.empty(); });
}
bool Mechanism::has_nonholonomic() const {
  return std::find(nonholonomic_.begin(), nonholonomic_.end(), true) != nonholonomic_.end();
}
bool Mechanism::has_lengths() const {
  return std::find(angle_rows_.begin(), angle_rows_.end(), false) != angle_rows_.end();
}
bool Mechanism::has_angles() const {
  return std::find(angle_rows_.begin(), angle_rows_.end(), true) != angle_rows_.end();
}
bool Mechanism::has_body_forces() const {
  return visit([](const auto& cast) { return cast.model.has_body_forces(); });
}
bool Mechanism::has_forces_apart() const {
  return visit([](const auto& cast) { return cast.model.has_forces_apart(); });
}
bool Mechanism::has_joint_forces() const {
  return visit([](const auto& cast) { return cast.model.has_joint_forces; });
}

Mechanism::~Mechanism() = default;

}  // namespace momenta
