#pragma once
// Conditions of users as rows c(θ, τ) ≤ 0 and e(θ) = 0. A condition that bounds a single extreme
// from outside, max(g) ≤ b or g ≤ b at every pose, is one smooth row per pose, where the extreme
// itself has corners; several extremes are replaced by unknowns τ (bounded_function.h).

#include <momenta/dae/study/fit/bounded_function.h>

#include <string>
#include <vector>

namespace momenta {

/// A condition and how far it is kept.
struct UserConstraint {
  std::string text;    ///< as written
  bool equal = false;  ///< an equation
  double before = 0;   ///< room in the given scene, < 0: broken; equation: difference of its sides;
                       ///< NaN: no motion
  double after = 0;    ///< the same for the best; NaN: no motion
  double multiplier = 0;  ///< decrease of the best per unit of room [1/unit]
};

/// Conditions as rows, and their values for reports.
class UserConstraints {
 public:
  /// Adds what the conditions are made of to `parts`. @throws std::invalid_argument: one sentence
  UserConstraints(const std::vector<std::string>& texts, MotionParts& parts);

  /// Counts rows and unknowns for motions like this one.
  void count(const MotionValues& values);
  int inequalities() const { return inequalities_; }   ///< rows of c
  int equalities() const { return equalities_; }       ///< rows of e
  Eigen::Index unknowns() const { return unknowns_; }  ///< entries of τ
  /// τ at the extremes, and its sizes, > 0.
  void start(const MotionValues& values, Eigen::Ref<Eigen::VectorXd> tau,
             Eigen::Ref<Eigen::VectorXd> sizes) const;
  /// Rows of c, then of e, and their derivatives by (θ, τ) unless null.
  void at(const MotionValues& values, const Eigen::VectorXd& tau, Eigen::VectorXd& rows,
          Eigen::MatrixXd* by) const;
  /// Conditions with their room in the given scene; `values` null: without a motion.
  std::vector<UserConstraint> before(const MotionValues* values) const;
  /// Sets room and multipliers of the best.
  void take_after(const MotionValues& values, const std::vector<double>& multipliers,
                  std::vector<UserConstraint>& kept) const;
  /// Largest violation; 0: all kept.
  double violation(const MotionValues& values) const;
  /// Multiplier of each condition, of all its poses together.
  std::vector<double> multipliers(const Eigen::VectorXd& of_rows) const;
  std::size_t size() const { return conditions_.size(); }  ///< count
  /// Condition i, as read.
  const MotionCondition& condition(std::size_t i) const { return conditions_[i].read; }

 private:
  struct Condition {
    MotionCondition read;
    std::unique_ptr<MotionFunction> gap;
    int extreme = -1;         ///< part with a row per pose; −1: one row, then bounds
    BoundedFunction bounded;  ///< for several extremes
    Eigen::Index rows = 1, first = 0, unknown = 0;
    /// As in UserConstraint.
    double room(const MotionValues& values) const {
      return read.equal ? gap->value(values) : -gap->value(values);
    }
  };
  std::vector<Condition> conditions_;
  int inequalities_ = 0, equalities_ = 0;
  Eigen::Index unknowns_ = 0;
};

}  // namespace momenta
