#include <momenta/dae/kkt/loop_units.h>
#include <momenta/dae/run/force_columns.h>
#include <momenta/dae/run/run_form.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace momenta {

namespace {

constexpr double not_there = std::numeric_limits<double>::quiet_NaN();
/// Part of the largest change between two solutions; less is rounding over weak pivots.
constexpr double rounding = 1e-6;

}  // namespace

ForceColumns::ForceColumns(const Mechanism& mechanism, Evaluation<double>& e, LoopSolver* solver,
                           bool reactions)
    : mechanism_(mechanism),
      e_(e),
      solver_(solver),
      reactions_(reactions && !mechanism.scene().lagrangian),
      friction_(bearing_friction(mechanism)),
      udot_(mechanism.nv()),
      lambda_(mechanism.m()),
      rest_(Eigen::VectorXd::Zero(mechanism.nv())),
      unique_rows_(static_cast<std::size_t>(mechanism.m()), true),
      efforts_(mechanism.tree().drives.size()),
      with_(efforts_.size()),
      without_(efforts_.size()) {
  if (solver) multipliers_.emplace(mechanism, e, *solver);
  if (reactions_ || !efforts_.empty()) sweep_ = make_wrench_sweep(mechanism);
  if (!multipliers_ || efforts_.empty()) return;
  row_units_ = LoopUnits(mechanism).equations;
  effort_units_.assign(efforts_.size(), 1);
  for (const Tree::Body& b : mechanism.tree().bodies)
    if (b.drive >= 0 && b.kind == JointKind::prismatic)
      effort_units_[static_cast<std::size_t>(b.drive)] = length_of(mechanism.scene());
}

void ForceColumns::solve(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u) {
  t_ = t, q_ = q, u_ = u;
  found_ =
      (!solver_ && u.size() == 0) || rubbed_accelerations(friction_.get(), e_, solver_, t, q.data(),
                                                          u.data(), udot_.data(), lambda_.data());
  unique_rows_.assign(unique_rows_.size(), true);
  idle_.resize(0);
  if (!found_) lambda_.setConstant(not_there);
  if (!found_ || !multipliers_) return;
  unique_rows_ = multipliers_->find(t, q.data(), u.data(), lambda_.data());
  const std::vector<double>& idle = multipliers_->idle();
  idle_ = Eigen::Map<const Eigen::VectorXd>(idle.data(), static_cast<Eigen::Index>(idle.size()));
}

void ForceColumns::take(const Eigen::VectorXd& udot, const Eigen::VectorXd& lambda) {
  if (!found_) return;
  udot_ = udot;
  lambda_ = lambda;
}

void ForceColumns::append(std::vector<double>& row, std::vector<std::size_t>& not_unique) {
  const auto& rows = mechanism_.rows();
  int open = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!unique_rows_[i]) not_unique.push_back(row.size());
    row.push_back(lambda_[static_cast<Eigen::Index>(i)]);
    open += !unique_rows_[i];
    if (i + 1 < rows.size() && rows[i + 1].loop == rows[i].loop) continue;
    row.push_back(found_ ? open : not_there);
    open = 0;
  }
  if (!sweep_) return;
  if (found_) sweep_->move(t_, q_.data(), u_.data(), udot_.data(), lambda_.data());
  append_efforts(row, not_unique);
  if (reactions_) append_reactions(row, not_unique);
}

void ForceColumns::append_efforts(std::vector<double>& row, std::vector<std::size_t>& not_unique) {
  if (efforts_.empty()) return;
  efforts_.assign(efforts_.size(), not_there);
  if (found_) sweep_->efforts(efforts_.data());
  if (idle_.size() > 0) {
    // Efforts are affine in λ: the part of the idle multipliers, with nothing moving. Forces times
    // lengths of the scene compare with moments [J].
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(lambda_.size());
    sweep_->move(t_, q_.data(), rest_.data(), rest_.data(), none.data());
    sweep_->efforts(without_.data());
    sweep_->move(t_, q_.data(), rest_.data(), rest_.data(), idle_.data());
    sweep_->efforts(with_.data());
    const double largest = idle_.cwiseProduct(row_units_).cwiseAbs().maxCoeff();
    for (std::size_t i = 0; i < efforts_.size(); ++i)
      if (effort_units_[i] * std::abs(with_[i] - without_[i]) >
          rounding * (largest + effort_units_[i] * std::abs(without_[i]))) {
        not_unique.push_back(row.size() + i);
        efforts_[i] = not_there;
      }
    sweep_->move(t_, q_.data(), u_.data(), udot_.data(), lambda_.data());
  }
  row.insert(row.end(), efforts_.begin(), efforts_.end());
}

void ForceColumns::append_reactions(std::vector<double>& row,
                                    std::vector<std::size_t>& not_unique) {
  Reactions all = sweep_->reactions();
  if (idle_.size() > 0) mark_undetermined(all, mechanism_, t_, q_, idle_, rounding);
  for (const Transmitted& r : all.joints)
    for (const Eigen::Vector3d& part : {r.force, r.torque})
      for (const double x : part) {
        if (!r.unique) not_unique.push_back(row.size());
        row.push_back(found_ && r.unique ? x : not_there);
      }
}

std::vector<Column> momentum_columns(const Mechanism& mechanism) {
  std::vector<Column> columns = mechanism.rate_columns();
  for (Column& c : columns) {
    const auto dot = c.name.rfind('.');
    const std::string rate = dot == std::string::npos ? "" : c.name.substr(dot + 1);
    c.name = c.name.substr(0, dot) + ".p" +
             (rate == "dot"           ? ""
              : rate.starts_with('u') ? rate.substr(1)
                                      : rate);
    const std::string of = c.unit.substr(0, c.unit.rfind("/s"));
    c.unit = of == "rad" ? "N m s" : of == "m" ? "N s" : "J s/" + of;
  }
  return columns;
}

std::vector<Column> impulse_columns(const Mechanism& mechanism) {
  std::vector<Column> columns = mechanism.multiplier_columns();
  const std::string lambda = ".lambda";
  for (Column& c : columns) {
    c.name.replace(c.name.rfind(lambda), lambda.size(), ".impulse");
    c.unit += " s";
  }
  return columns;
}

std::vector<std::string> measured_columns(const Mechanism& mechanism) {
  std::vector<std::string> columns = trajectory_columns(mechanism, true);
  for (const Column& c : momentum_columns(mechanism)) columns.push_back(c.label());
  for (const Column& c : impulse_columns(mechanism)) columns.push_back(c.label());
  columns.emplace_back("work [J]");
  return columns;
}

}  // namespace momenta
