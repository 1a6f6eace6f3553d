#include <momenta/dae/fit/kept_conditions.h>

namespace momenta {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

KeptConditions::KeptConditions(const std::vector<std::string>& texts, MotionParts& parts) {
  for (const std::string& text : texts) {
    MotionCondition read = MotionCondition::from_text(text, parts.parameter_names());
    MotionFunction gap(read.gap, parts);
    conditions_.push_back({std::move(read), std::move(gap)});
  }
}

void KeptConditions::count(const MotionValues& values) {
  inequalities_ = equalities_ = 0;
  for (const bool equal : {false, true})
    for (Condition& c : conditions_) {
      if (c.read.equal != equal) continue;
      const std::vector<std::size_t> bounded =
          equal ? std::vector<std::size_t>{} : c.gap.bounded(values);
      c.extreme = bounded.size() == 1 ? static_cast<int>(bounded.front()) : -1;
      c.rows = c.extreme < 0 ? 1 : values.parts[c.gap.places()[bounded.front()]].size();
      c.first = inequalities_ + equalities_;
      (equal ? equalities_ : inequalities_) += static_cast<int>(c.rows);
    }
}

void KeptConditions::at(const MotionValues& values, VectorXd& rows, MatrixXd* by) const {
  rows.resize(inequalities_ + equalities_);
  if (by) by->resize(rows.size(), values.parameters_by.cols());
  VectorXd slope;
  for (const Condition& c : conditions_) {
    std::vector<Index> at = c.gap.rows(values);
    for (Index i = 0; i < c.rows; ++i) {
      if (c.extreme >= 0) at[static_cast<std::size_t>(c.extreme)] = i;
      rows[c.first + i] = c.gap.at(values, at, VectorXd(), by ? &slope : nullptr, nullptr);
      if (by) by->row(c.first + i) = slope.transpose();
    }
  }
}

std::vector<double> KeptConditions::room(const MotionValues& values) const {
  std::vector<double> room;
  for (const Condition& c : conditions_)
    room.push_back(c.read.equal ? c.gap.value(values) : -c.gap.value(values));
  return room;
}

std::vector<double> KeptConditions::multipliers(const VectorXd& of_rows) const {
  std::vector<double> all;
  for (const Condition& c : conditions_) all.push_back(of_rows.segment(c.first, c.rows).sum());
  return all;
}

}  // namespace momenta
