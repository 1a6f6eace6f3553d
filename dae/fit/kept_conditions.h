#pragma once
// Conditions of users as rows c(θ) ≤ 0 and e(θ) = 0. One with a single extreme that it bounds from
// outside, max(g) ≤ b or g ≤ b at every pose, is a row a pose, each smooth, where the extreme
// itself has corners; others take the pose at which the extreme is.

#include <momenta/dae/fit/motion_parts.h>

#include <string>
#include <vector>

namespace momenta {

/// How far a condition is kept.
struct KeptCondition {
  std::string text;       ///< as written
  bool equal = false;     ///< an equation
  double before = 0;      ///< of the scene as it is: how much room there is, negative where it is
                          ///< broken; of an equation the difference of its sides; NaN: no motion
  double after = 0;       ///< the same of the best
  double multiplier = 0;  ///< by how much less the best would be for a unit of room [1/unit]
};

class KeptConditions {
 public:
  /// `parts` take what the conditions are made of. @throws std::invalid_argument: one sentence
  KeptConditions(const std::vector<std::string>& texts, MotionParts& parts);

  /// Counts rows for motions like this one.
  void count(const MotionValues& values);
  int inequalities() const { return inequalities_; }
  int equalities() const { return equalities_; }
  /// Rows of c, then of e, and their derivatives by θ where these are asked for.
  void at(const MotionValues& values, Eigen::VectorXd& rows, Eigen::MatrixXd* by) const;
  /// Room of each condition, as in KeptCondition.
  std::vector<double> room(const MotionValues& values) const;
  /// Of each condition the sum of multipliers of its rows.
  std::vector<double> multipliers(const Eigen::VectorXd& of_rows) const;
  std::size_t size() const { return conditions_.size(); }
  const MotionCondition& condition(std::size_t i) const { return conditions_[i].read; }

 private:
  struct Condition {
    MotionCondition read;
    MotionFunction gap;
    int extreme = -1;  ///< the part of which each pose is a row; −1: one row
    Eigen::Index rows = 1, first = 0;
  };
  std::vector<Condition> conditions_;
  int inequalities_ = 0, equalities_ = 0;
};

}  // namespace momenta
