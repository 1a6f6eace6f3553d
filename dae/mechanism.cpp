#include <momenta/core/kernel/levels/open_sweeps.h>
#include <momenta/core/kernel/limbs/limbs.h>
#include <momenta/dae/kkt/kkt.h>
#include <momenta/dae/mechanism.h>
#include <momenta/dae/sweeps/legs/legs.h>

#include <cmath>
#include <cstdio>

namespace momenta {
namespace {

// Below this size a dense Cholesky of M and a pivoted LDLᵀ of the loops' small matrix beat sparse
// bookkeeping.
constexpr int dense_limit = 60;

Plan plan_with_loops(const Tree& tree, const Scene& scene, Algebra algebra) {
  Plan plan = make_plan(tree, scene, algebra);
  if (!plan.planar) return plan;
  const std::string why = loops_leave_plane(scene, tree, plan.basis);
  if (why.empty()) return plan;
  if (algebra == Algebra::planar)
    throw SceneError(scene.where({}) + "the planar kernel was asked for, but " + why);
  plan = make_plan(tree, scene, Algebra::spatial);
  plan.planar_reason = why;
  return plan;
}

/// User joints move in open chains alone.
Tree open_or_closed(const Scene& scene) {
  for (const JointSpec& joint : scene.joints)
    if (joint.kind == JointKind::user)
      throw SceneError(scene.where(joint.at) + "joint '" + joint.name +
                       "' is a user joint, which an OpenChain can move but no Mechanism");
  return build_tree(scene);
}

}  // namespace

Mechanism::Mechanism(Scene scene, MechanismOptions options)
    : scene_(std::move(scene)),
      tree_(open_or_closed(scene_)),
      plan_(plan_with_loops(tree_, scene_, options.algebra)) {
  const auto cast_into = [&](auto& cast, auto&& model) {
    cast.model = std::move(model);
    cast.loops = build_loops(scene_, tree_, cast.model);
  };
  if (plan_.planar)
    cast_into(cast_.emplace<0>(), build_planar_model(tree_, scene_, plan_.basis));
  else
    cast_into(cast_.emplace<1>(), build_spatial_model(tree_, scene_));
  row_names_ = row_names(scene_, plan_.planar);
  rows_ = static_cast<int>(row_names_.size());
  plan_.loops = rows_ > 0;
  plan_.drives |= visit([](const auto& cast) { return !cast.loops.motions.empty(); });
  dense_ = options.kkt == KktChoice::dense ||
           (options.kkt != KktChoice::sparse && tree_.nv + rows_ <= dense_limit);
  const auto group = [&](const auto& cast) {
    int index = 0;
    for (const auto& l : cast.loops.loops) {
      const int points = l.first_rows();
      for (int i = 0; i < points; ++i) row_groups_.push_back(index);
      for (int i = points; i < l.rows; ++i) row_groups_.push_back(index + 1);
      index += 2;
    }
  };
  visit(group);
  if (rows_ == 0) return;
  weigh_loops();
  choose_kkt(options.kkt);
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
    cast.swept = swept_loops(cast.model, in_link_frames(cast.loops, cast.links));
    if (!cast.swept.shared.empty()) {
      cast.as_given.loops = in_link_frames(cast.loops, cast.links);
      cast.as_given.plan = plan_loops(cast.model, cast.as_given.loops);
    }
    if (!cast.swept.plan.fits())
      kkt_reason_ =
          (cast.swept.plan.lanes > 64 ? std::string("more than 64")  // no more are counted
                                      : std::to_string(cast.swept.plan.lanes)) +
          " loop equations are open at once, more than " + std::to_string(LoopPlan::most_lanes);
  };
  if (plan_.planar)
    plan(std::get<0>(cast_));
  else
    plan(std::get<1>(cast_));
  const bool far_apart = !light_.empty();
  if (!far_apart) light_ = joint_without_inertia(kkt_reason_.empty());
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
  if (asked == KktChoice::sweeps)
    throw SceneError(scene_.where({}) + "the sweeps were asked to carry the loops, but " +
                     kkt_reason_ + "; expected --kkt sparse" + (far_apart ? "" : " or dense"));
  kkt_ = KktChoice::sparse;
  dense_ = false;
}

/// Scales of the loops at the start, and joints too light for the others: beside a mobility 10⁶
/// times theirs the filter of the pivots takes what the others have of a row. A joint's inertia is
/// weighed at the end of the way from it to the loop's point: so a uniform chain stays a chain of
/// equals, whatever its length.
void Mechanism::weigh_loops() {
  constexpr double least_lever = 1e-4, usual_spread = 1e6;
  const double length = length_of(scene_);
  std::vector<double> inertia(static_cast<std::size_t>(tree_.nv));
  const auto e = evaluation<double>();
  e->place(0, tree_.q0.data());
  e->mass_diagonal(inertia.data());
  const auto poses = tree_.zero_poses();
  const auto slides = [](const Tree::Body& b, int i) {
    return b.nv == 6 ? i < 3 : b.nv == 1 && b.kind == JointKind::prismatic;
  };
  const auto weigh = [&](auto& cast) {
    double lightest_of_all = HUGE_VAL, heaviest_of_all = 0;
    for (auto& l : cast.loops.loops) {
      double sum = 0, least = 0;
      int lightest = -1, heaviest = -1;
      double of_lightest = 0, of_heaviest = 0;
      const auto pass = [&](int k, double lever) {
        const Tree::Body& b = tree_.bodies[static_cast<std::size_t>(k)];
        for (int i = 0; i < b.nv; ++i) {
          const double along = inertia[static_cast<std::size_t>(b.u + i)];
          if (!(along > 0)) continue;
          sum += slides(b, i) ? 1 / along : length * length / along;
          if (!slides(b, i) && !(lever > least_lever * length)) continue;
          const double mass = slides(b, i) ? along : along / (lever * lever);
          if (lightest < 0 || mass < of_lightest) lightest = k, of_lightest = mass;
          if (heaviest < 0 || mass > of_heaviest) heaviest = k, of_heaviest = mass;
        }
      };
      if (l.is_coupler()) {
        for (const auto& c : l.joints) pass(c.body, length);
      } else {
        double way_a = std::sqrt(dot(l.at_a, l.at_a)), way_b = std::sqrt(dot(l.at_b, l.at_b));
        for (int a = l.a, b = l.b; a != b;) {
          int& later = a > b ? a : b;
          double& way = a > b ? way_a : way_b;
          pass(later, way);
          const Eigen::Vector3d from = poses[static_cast<std::size_t>(later)].translation();
          later = tree_.bodies[static_cast<std::size_t>(later)].parent;
          if (later >= 0)
            way += (from - poses[static_cast<std::size_t>(later)].translation()).norm();
        }
        least = least_lever * least_lever * sum;
      }
      l.least_scale = least;
      for (int i = 0; i < l.rows; ++i) least_scales_.push_back(i < l.first_rows() ? least : 0.0);
      if (lightest >= 0) {
        lightest_of_all = std::min(lightest_of_all, of_lightest);
        heaviest_of_all = std::max(heaviest_of_all, of_heaviest);
        spread_beyond_usual_ = std::max(1.0, heaviest_of_all / lightest_of_all / usual_spread);
      }
      if (light_.empty() && of_heaviest > usual_spread * of_lightest) {
        char times[32];
        std::snprintf(times, sizeof times, "%.0e", of_heaviest / of_lightest);
        light_ = "what turns about " + tree_.joint_in_words(lightest) + " is " + times +
                 " times lighter than what turns about " + tree_.joint_in_words(heaviest) +
                 " in its loop";
      }
    }
  };
  if (plan_.planar)
    weigh(std::get<0>(cast_));
  else
    weigh(std::get<1>(cast_));
}

/// A joint may have no inertia until a loop closes above it: one solution at the start tells.
std::string Mechanism::joint_without_inertia(bool swept) const {
  const auto size = static_cast<std::size_t>(tree_.nv);
  std::vector<double> p(size, 0.0), u(size), sigma(row_names_.size());
  if (!swept) {
    const auto e = evaluation<double>();
    if (solved_by_bodies(*this)) return "";  // pivots are sought there
    const auto kkt = make_sparse_kkt(*this);
    return kkt->factor(*e, 0, tree_.q0.data(), fade_evaluation) || kkt->stuck() < 0
               ? ""
               : no_inertia(kkt->stuck());
  }
  const auto sweeps = looped_sweeps();
  if (!sweeps->momentum(0, tree_.q0.data(), p.data(), {}, u.data(), sigma.data(), nullptr))
    return tree_.joint_in_words(sweeps->stuck()) + " has no inertia before its loops close";
  return "";
}

std::unique_ptr<LoopedSweeps> Mechanism::looped_sweeps(int level, bool legs_side_by_side) const {
  return visit([&](const auto& cast) {
    return make_looped_sweeps(cast.links, cast.swept, level > 0 ? level : best_level(),
                              legs_side_by_side);
  });
}
std::unique_ptr<LoopedSweeps> Mechanism::looped_sweeps_as_given() const {
  return visit([](const auto& cast) {
    const auto& loops = cast.swept.shared.empty() ? cast.swept : cast.as_given;
    return make_looped_sweeps(cast.links, loops, best_level());
  });
}
bool Mechanism::pairs_anew() const {
  return visit([](const auto& cast) { return !cast.swept.shared.empty(); });
}
bool Mechanism::has_body_forces() const {
  return visit([](const auto& cast) { return cast.model.has_body_forces(); });
}
bool Mechanism::has_joint_forces() const {
  return visit([](const auto& cast) { return cast.model.has_joint_forces; });
}

Mechanism::~Mechanism() = default;

namespace {

/// What a one-dof joint adds to the name of its scene joint: "q", or the number of its coordinate
/// behind it where the scene's joint has several.
std::string one_dof_column(const Tree::Body& b, const char* letter) {
  return b.joint + "." + letter + (b.parts > 1 ? std::to_string(b.coordinate) : "");
}

}  // namespace

std::vector<Column> Mechanism::coordinate_columns() const {
  std::vector<Column> columns;
  for (const auto& b : tree_.bodies) {
    if (b.nq == 1)
      columns.push_back({one_dof_column(b, "q"), b.kind == JointKind::prismatic ? "m" : "rad"});
    if (b.nq == 7)
      for (const char* axis : {".x", ".y", ".z"}) columns.push_back({b.joint + axis, "m"});
    if (b.nq >= 4)
      for (const char* part : {".qw", ".qx", ".qy", ".qz"})
        columns.push_back({b.joint + part, "1"});
  }
  return columns;
}

std::vector<Column> Mechanism::rate_columns() const {
  std::vector<Column> columns;
  for (const auto& b : tree_.bodies) {
    if (b.nv == 1)
      columns.push_back({one_dof_column(b, "u"), b.kind == JointKind::prismatic ? "m/s" : "rad/s"});
    if (b.nv == 6)
      for (const char* axis : {".vx", ".vy", ".vz"}) columns.push_back({b.joint + axis, "m/s"});
    if (b.nv >= 3)
      for (const char* axis : {".wx", ".wy", ".wz"}) columns.push_back({b.joint + axis, "rad/s"});
  }
  return columns;
}

std::vector<Column> Mechanism::marker_columns() const {
  std::vector<Column> columns;
  for (const auto& marker : scene_.markers) {
    for (const char* axis : {".x", ".y", ".z"}) columns.push_back({marker.name + axis, "m"});
    for (const char* axis : {".vx", ".vy", ".vz"}) columns.push_back({marker.name + axis, "m/s"});
  }
  return columns;
}

std::string Mechanism::legs_in_words() const {
  if (plan_.planar) return "";
  const auto& cast = std::get<Cast<Spatial>>(cast_);
  return momenta::legs_in_words(
      find_legs(cast.links, cast.swept.loops, cast.swept.plan, leg_lanes_at(best_level())));
}

std::vector<std::pair<std::string, std::string>> Mechanism::plan_lines() const {
  auto lines = plan_.lines();
  if (!plan_.planar) {
    const LinkTree links = build_links(std::get<Cast<Spatial>>(cast_).model);
    lines.emplace_back("joints", links_in_words(links));
    if (rows_ == 0) {
      const std::string limbs = limbs_in_words(links, limb_lanes_at(best_level()));
      lines.emplace_back("limbs", limbs.empty() ? "none of one shape: body by body" : limbs);
    }
  }
  if (rows_ == 0) {
    lines.emplace_back("loops", "none: no KKT system, no σ, forward dynamics by the two sweeps");
    return lines;
  }
  lines.emplace_back("loops", std::to_string(scene_.loops.size()) + " with " +
                                  std::to_string(rows_) + " equations");
  const std::string legs = legs_in_words();
  std::string how = "dense: Cholesky of M, pivoted and filtered LDLᵀ of the loops";
  if (kkt_ == KktChoice::sweeps)
    how = "loops carried by the sweeps, at most " +
          std::to_string(visit([](const auto& cast) { return cast.swept.plan.lanes; })) +
          " equations open at once" +
          (pairs_anew() ? ", loops that meet in one point paired along the tree" : "") +
          (legs.empty() ? "" : ", " + legs);
  else if (kkt_ == KktChoice::sparse)
    how = std::string(
              solved_by_bodies(*this)
                  ? "sparse: KLU on the equations of the bodies, the tree being deep; poses are "
                    "not filtered,"
              : tips_first() ? "sparse: filtered LDLᵀ"
                             : "sparse: KLU") +
          " on a pattern analysed once" + (kkt_reason_.empty() ? "" : " (" + kkt_reason_ + ")");
  lines.emplace_back("solving (7)", how + ", " + std::to_string(tree_.nv + rows_) + " unknowns");
  return lines;
}

std::string Mechanism::no_inertia(int rate) const {
  for (std::size_t k = 0; k < tree_.bodies.size(); ++k) {
    const Tree::Body& b = tree_.bodies[k];
    if (rate < b.u || rate >= b.u + b.nv) continue;
    const auto carried = static_cast<std::size_t>(tree_.carried_by(b.joint));
    return tree_.joint_in_words(static_cast<int>(k)) + " has no inertia to move: body '" +
           tree_.bodies[carried].name + "' and what it carries weigh nothing along it";
  }
  return "the mass matrix is not finite";
}

}  // namespace momenta
