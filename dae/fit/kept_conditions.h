#pragma once
// Conditions of users as rows c(θ, τ) ≤ 0 and e(θ) = 0. One with a single extreme that it bounds
// from outside, max(g) ≤ b or g ≤ b at every pose, is a row a pose, each smooth, where the extreme
// itself has corners; one with several has unknowns τ in their place (bounded_function.h).

#include <momenta/dae/fit/bounded_function.h>

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

/// Conditions, as rows and as they are told.
class KeptConditions {
 public:
  /// `parts` take what the conditions are made of. @throws std::invalid_argument: one sentence
  KeptConditions(const std::vector<std::string>& texts, MotionParts& parts);

  /// Counts rows and unknowns for motions like this one.
  void count(const MotionValues& values);
  int inequalities() const { return inequalities_; }   ///< rows of c
  int equalities() const { return equalities_; }       ///< rows of e
  Eigen::Index unknowns() const { return unknowns_; }  ///< of τ
  /// τ where extremes are, and what it counts in, > 0.
  void start(const MotionValues& values, Eigen::Ref<Eigen::VectorXd> tau,
             Eigen::Ref<Eigen::VectorXd> sizes) const;
  /// Rows of c, then of e, and their derivatives by (θ, τ) where these are asked for.
  void at(const MotionValues& values, const Eigen::VectorXd& tau, Eigen::VectorXd& rows,
          Eigen::MatrixXd* by) const;
  /// Room of each condition, as in KeptCondition.
  std::vector<double> room(const MotionValues& values) const;
  /// How far they are missed, the worst of them; 0: all are kept.
  double violation(const MotionValues& values) const;
  /// Of each condition the multiplier, that of all poses together.
  std::vector<double> multipliers(const Eigen::VectorXd& of_rows) const;
  std::size_t size() const { return conditions_.size(); }  ///< how many there are
  /// The i-th, as read.
  const MotionCondition& condition(std::size_t i) const { return conditions_[i].read; }

 private:
  struct Condition {
    MotionCondition read;
    std::unique_ptr<MotionFunction> gap;
    int extreme = -1;  ///< the part of which each pose is a row; −1: one row, then those of bounds
    BoundedFunction bounded;  ///< of several extremes
    Eigen::Index rows = 1, first = 0, unknown = 0;
  };
  std::vector<Condition> conditions_;
  int inequalities_ = 0, equalities_ = 0;
  Eigen::Index unknowns_ = 0;
};

}  // namespace momenta
