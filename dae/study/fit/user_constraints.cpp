#include <momenta/dae/study/fit/user_constraints.h>

#include <algorithm>
#include <cmath>

namespace momenta {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Ref;
using Eigen::VectorXd;

UserConstraints::UserConstraints(const std::vector<std::string>& texts, MotionParts& parts) {
  for (const std::string& text : texts) {
    MotionCondition read = MotionCondition::from_text(text, parts.parameter_names());
    auto gap = std::make_unique<MotionFunction>(read.gap, parts);
    const BoundedFunction bounded(*gap);
    conditions_.push_back({std::move(read), std::move(gap), -1, bounded});
  }
}

void UserConstraints::count(const MotionValues& values) {
  inequalities_ = equalities_ = 0;
  unknowns_ = 0;
  for (const bool equal : {false, true})
    for (Condition& c : conditions_) {
      if (c.read.equal != equal) continue;
      c.extreme = -1;
      c.rows = 1;
      if (!equal) {
        c.bounded.choose(values);
        if (c.bounded.unknowns() == 1) {
          const std::size_t part = c.gap->bounded(values).front();
          c.extreme = static_cast<int>(part);
          c.rows = values.parts[c.gap->places()[part]].size();
        } else {
          c.rows += c.bounded.rows();
          c.unknown = unknowns_;
          unknowns_ += c.bounded.unknowns();
        }
      }
      c.first = inequalities_ + equalities_;
      (equal ? equalities_ : inequalities_) += static_cast<int>(c.rows);
    }
}

void UserConstraints::start(const MotionValues& values, Ref<VectorXd> tau,
                            Ref<VectorXd> sizes) const {
  for (const Condition& c : conditions_)
    if (c.extreme < 0 && !c.read.equal)
      c.bounded.start(values, tau.segment(c.unknown, c.bounded.unknowns()),
                      sizes.segment(c.unknown, c.bounded.unknowns()));
}

void UserConstraints::at(const MotionValues& values, const VectorXd& tau, VectorXd& rows,
                         MatrixXd* by) const {
  rows.resize(inequalities_ + equalities_);
  const Index n = by ? values.parameters_by.cols() : 0;
  if (by) by->setZero(rows.size(), n + unknowns_);
  VectorXd slope, slope_of_tau;
  MatrixXd by_theta, by_tau;
  for (const Condition& c : conditions_) {
    std::vector<Index> at = c.gap->rows(values);
    if (c.extreme >= 0 || c.read.equal) {
      for (Index i = 0; i < c.rows; ++i) {
        if (c.extreme >= 0) at[static_cast<std::size_t>(c.extreme)] = i;
        rows[c.first + i] = c.gap->at(values, at, VectorXd(), by ? &slope : nullptr, nullptr);
        if (by) by->row(c.first + i).head(n) = slope.transpose();
      }
      continue;
    }
    const Index more = c.bounded.unknowns();
    const VectorXd own = tau.segment(c.unknown, more);
    rows[c.first] = c.bounded.at(values, own, by ? &slope : nullptr, by ? &slope_of_tau : nullptr);
    c.bounded.bounds(values, own, rows.segment(c.first + 1, c.rows - 1), by ? &by_theta : nullptr,
                     by ? &by_tau : nullptr);
    if (!by) continue;
    by->row(c.first).head(n) = slope.transpose();
    by->row(c.first).segment(n + c.unknown, more) = slope_of_tau.transpose();
    by->block(c.first + 1, 0, c.rows - 1, n) = by_theta;
    by->block(c.first + 1, n + c.unknown, c.rows - 1, more) = by_tau;
  }
}

std::vector<UserConstraint> UserConstraints::before(const MotionValues* values) const {
  std::vector<UserConstraint> all;
  for (const Condition& c : conditions_)
    all.push_back({c.read.text, c.read.equal, values ? c.room(*values) : NAN, NAN, 0});
  return all;
}

void UserConstraints::take_after(const MotionValues& values, const std::vector<double>& multipliers,
                                 std::vector<UserConstraint>& kept) const {
  for (std::size_t i = 0; i < conditions_.size(); ++i) {
    kept[i].after = conditions_[i].room(values);
    if (i < multipliers.size()) kept[i].multiplier = multipliers[i];
  }
}

double UserConstraints::violation(const MotionValues& values) const {
  double most = 0;
  for (const Condition& c : conditions_) {
    const double gap = c.gap->value(values);
    most = std::max(most, c.read.equal ? std::abs(gap) : gap);
  }
  return most;
}

std::vector<double> UserConstraints::multipliers(const VectorXd& of_rows) const {
  std::vector<double> all;
  for (const Condition& c : conditions_)
    all.push_back(c.extreme >= 0 ? of_rows.segment(c.first, c.rows).sum() : of_rows[c.first]);
  return all;
}

}  // namespace momenta
