// Words for a mechanism: columns of results, lines of the plan, joints that fail.

#include <momenta/core/kernel/branches/branches.h>
#include <momenta/core/kernel/levels/open_sweeps.h>
#include <momenta/core/lagrangian/lagrangian_formulas.h>
#include <momenta/dae/mechanism_inside.h>
#include <momenta/dae/sweeps/branches/looped_branches.h>
#include <momenta/dae/unheld_joints.h>

namespace momenta {
namespace {

/// Name of the column of coordinate i of a joint without a quaternion; numbered where the scene's
/// joint has several coordinates.
std::string one_dof_column(const Tree::Body& b, const char* letter, int i = 0) {
  const bool several = b.parts > 1 || b.nv > 1;
  return b.joint + "." + letter + (several ? std::to_string(b.coordinate + i) : "");
}

/// Work saved at spherical joints of a tree without loops: bodies that carry nothing are eliminated
/// once; where there are no others nothing is swept.
std::string tops_in_words(const LinkTree& tree) {
  std::size_t ends = 0, tops = 0;
  for (const Link& l : tree.links) {
    ends += l.kind == LinkKind::spherical && l.leaf;
    tops += l.kind == LinkKind::spherical && l.leaf && l.parent < 0;
  }
  if (ends == 0) return "";
  return tops == tree.links.size()
             ? "; their bodies carry nothing: ω = I⁻¹ p with I constant, no sweeps"
             : "; spherical joints of bodies that carry nothing, eliminated once: " +
                   std::to_string(ends);
}

}  // namespace

std::vector<Column> Mechanism::coordinate_columns() const {
  std::vector<Column> columns;
  if (scene_.lagrangian)
    for (const auto& c : scene_.lagrangian->coordinates) columns.push_back({c.name, c.unit});
  for (const auto& b : tree_.bodies) {
    if (!b.has_quaternion()) {
      for (int i = 0; i < b.nq; ++i)
        columns.push_back({one_dof_column(b, "q", i), b.is_length(i) ? "m" : "rad"});
      continue;
    }
    if (b.nq == 7)
      for (const char* axis : {".x", ".y", ".z"}) columns.push_back({b.joint + axis, "m"});
    for (const char* part : {".qw", ".qx", ".qy", ".qz"}) columns.push_back({b.joint + part, "1"});
  }
  return columns;
}

std::vector<Column> Mechanism::rate_columns() const {
  std::vector<Column> columns;
  if (scene_.lagrangian)
    for (const auto& c : scene_.lagrangian->coordinates)
      columns.push_back({LagrangianFormulas::rate_name(c.name), c.unit + "/s"});
  for (const auto& b : tree_.bodies) {
    if (!b.has_quaternion()) {
      for (int i = 0; i < b.nv; ++i)
        columns.push_back({one_dof_column(b, "u", i), b.is_length(i) ? "m/s" : "rad/s"});
      continue;
    }
    if (b.nv == 6)
      for (const char* axis : {".vx", ".vy", ".vz"}) columns.push_back({b.joint + axis, "m/s"});
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

std::vector<Column> Mechanism::multiplier_columns() const {
  std::vector<Column> columns;
  int number = 0;
  for (std::size_t i = 0; i < row_names_.size(); ++i) {
    const std::string& loop = row_names_[i].loop;
    number = i > 0 && row_names_[i - 1].loop == loop ? number + 1 : 1;
    columns.push_back({loop + ".lambda" + std::to_string(number), angle_rows_[i] ? "N m" : "N"});
  }
  return columns;
}

std::vector<Column> Mechanism::effort_columns() const {
  std::vector<Column> columns(tree_.drives.size());
  for (const auto& b : tree_.bodies)
    if (b.drive >= 0)
      columns[static_cast<std::size_t>(b.drive)] = {one_dof_column(b, "effort"),
                                                    b.kind == JointKind::prismatic ? "N" : "N m"};
  return columns;
}

std::vector<std::pair<std::string, std::string>> Mechanism::lagrangian_lines() const {
  const LagrangianModel& model = lagrangian();
  std::vector<std::pair<std::string, std::string>> lines;
  const auto count = [](const Expression& f) { return std::to_string(f.tape().size()); };
  lines.emplace_back("equations",
                     "formulas of a Lagrangian, with exact derivatives: " + count(model.momenta) +
                         " instructions for p, " + count(model.momentum_rates) + " for ṗ");
  lines.emplace_back("mass matrix", std::to_string(model.mass.places.size()) + " entries of " +
                                        std::to_string(model.n * (model.n + 1) / 2) +
                                        (model.linear ? "; L has terms linear in the rates" : ""));
  lines.emplace_back("time", model.in_time ? "in the formulas" : "in no formula");
  lines.emplace_back("forces", scene_.lagrangian->forces.empty()
                                   ? "none beside the Lagrangian's"
                                   : std::to_string(scene_.lagrangian->forces.size()));
  return lines;
}

std::string Mechanism::looped_branches_in_words() const {
  if (plan_.planar || kkt_ != KktChoice::sweeps) return "";
  const auto& cast = std::get<Cast<Spatial>>(casts_->cast);
  return momenta::looped_branches_in_words(find_looped_branches(
      cast.links, cast.swept.loops, cast.swept.plan, looped_branch_lanes_at(best_level())));
}

std::vector<std::pair<std::string, std::string>> Mechanism::plan_lines() const {
  auto lines = scene_.lagrangian ? lagrangian_lines() : plan_.lines();
  if (!plan_.planar) {
    const LinkTree links = build_links(std::get<Cast<Spatial>>(casts_->cast).model);
    lines.emplace_back("joints", links_in_words(links) + (rows_ == 0 ? tops_in_words(links) : ""));
    if (rows_ == 0) {
      const std::string branches = branches_in_words(links, branch_lanes_at(best_level()));
      lines.emplace_back("branches",
                         branches.empty() ? "none of one shape: body by body" : branches);
    }
  }
  if (rows_ == 0) {
    if (scene_.lagrangian)
      lines.emplace_back("constraints",
                         "none: no KKT system, no σ, forward dynamics by factors of M");
    else
      lines.emplace_back("loops", "none: no KKT system, no σ, forward dynamics by the two sweeps");
    return lines;
  }
  if (scene_.lagrangian)
    lines.emplace_back("constraints", std::to_string(rows_));
  else
    lines.emplace_back("loops", std::to_string(scene_.loops.size()) + " with " +
                                    std::to_string(rows_) + " equations");
  const std::string looped_branches = looped_branches_in_words();
  std::string how = "dense: Cholesky of M, pivoted and filtered LDLᵀ of the loops";
  if (kkt_ == KktChoice::sweeps)
    how = "loops carried by the sweeps, at most " +
          std::to_string(visit([](const auto& cast) { return cast.swept.plan.slots; })) +
          " equations open at once" +
          (pairs_anew() ? ", loops that meet in one point paired along the tree" : "") +
          (looped_branches.empty() ? "" : ", " + looped_branches);
  else if (kkt_ == KktChoice::sparse)
    how = std::string(
              leaves_first() ? solved_by_bodies() ? "sparse: filtered LDLᵀ of the equations of the "
                                                    "bodies, the tree being deep,"
                                                  : "sparse: filtered LDLᵀ"
              : solved_by_bodies()
                  ? "sparse: KLU on the equations of the bodies, the tree being deep; poses are "
                    "not filtered,"
                  : "sparse: KLU") +
          " on a pattern analysed once" + (kkt_reason_.empty() ? "" : " (" + kkt_reason_ + ")");
  lines.emplace_back("solving (7)", how + ", " + std::to_string(tree_.nv + rows_) + " unknowns");
  return lines;
}

namespace {

/// Whether value i of a formula is the number 0.
bool is_zero(const Expression& formula, std::size_t i) {
  const auto& in = formula.tape()[static_cast<std::size_t>(formula.outputs()[i])];
  return in.operation == formula::Operation::number && in.number == 0;
}

/// A sentence naming a coordinate whose rate no momentum determines; empty: none.
std::string free_coordinate(const LagrangianModel& model, const LagrangianSpec& spec) {
  std::vector<bool> held(spec.coordinates.size(), false);
  for (const auto& place : model.constraint.places)
    held[static_cast<std::size_t>(place.column)] = true;
  for (std::size_t k = 0; k < model.mass.places.size(); ++k) {
    const auto& [row, column] = model.mass.places[k];
    if (is_zero(model.mass.values, k)) continue;
    held[static_cast<std::size_t>(row)] = held[static_cast<std::size_t>(column)] = true;
  }
  for (std::size_t i = 0; i < held.size(); ++i)
    if (!held[i])
      return "coordinate '" + spec.coordinates[i].name + "' has no inertia: " +
             (is_zero(model.momenta, i)
                  ? "its rate is not in the Lagrangian, and it is in no constraint; expected one "
                    "of them"
                  : "the Lagrangian is linear in its rate, and it is in no constraint; expected a "
                    "Lagrangian quadratic in it, or a constraint");
  return "";
}

}  // namespace

std::string Mechanism::no_inertia(int rate, double t, const double* q) const {
  if (scene_.lagrangian) {
    if (const std::string free = free_coordinate(lagrangian(), *scene_.lagrangian); !free.empty())
      return free;
    if (rate < 0)
      return "the equations have no finite solution; expected formulas with values there, "
             "and "
             "constraints that hold every coordinate without inertia";
    return light_before_loops(rate) + "; expected a mass matrix that is positive definite" +
           (rows_ > 0 && dense_ ? ", or --kkt sparse where constraints hold it" : "");
  }
  const auto e = evaluation<double>();
  const UnheldJoints unheld = unheld_joints(*this, *e, t, q, true, rate);
  if (!unheld.joints.empty()) return in_words(*this, unheld);
  return rate < 0 ? "its equations overflow; expected smaller numbers"
                  : light_before_loops(rate) + "; expected --kkt sparse";
}

std::string Mechanism::light_before_loops(int rate) const {
  if (scene_.lagrangian)
    return "coordinate '" + scene_.lagrangian->coordinates[static_cast<std::size_t>(rate)].name +
           "' has no inertia" + (rows_ > 0 ? " before its constraints hold it" : "") +
           ", alone or with those before it";
  for (std::size_t k = 0; k < tree_.bodies.size(); ++k) {
    const Tree::Body& b = tree_.bodies[k];
    if (rate >= b.u && rate < b.u + b.nv)
      return tree_.joint_in_words(static_cast<int>(k)) + " has no inertia before its loops close";
  }
  return "";
}

}  // namespace momenta
