#pragma once
// Formulas of a whole motion, as users write them: functions of one argument take a formula of
// single poses, or times, to a number,
//
//   max(g)  min(g)  mean(g)  integral(g)  first(g)  last(g)
//
// and what stands around them is a formula of these numbers and of parameters:
// "integral(O.effort^2) + 0.1*mass". max and min of two arguments are what they are in every
// formula. A condition compares two: "max(P.y) - min(P.y) <= 0.02"; one of single poses holds at
// each of them, "C.transmission >= 40*pi/180" stands for max(40*pi/180 - C.transmission) <= 0.

#include <momenta/core/expression/expression.h>

#include <Eigen/Core>
#include <string>
#include <vector>

namespace momenta {

/// A formula of single poses or times, and how it becomes a number.
struct MotionPart {
  /// Ways to a number.
  enum class Kind { most, least, mean, integral, first, last };
  Kind kind = Kind::most;  ///< way to a number
  std::string formula;     ///< g, of columns and parameters
  /// Whether it is a maximum or a minimum.
  bool is_extreme() const { return kind == Kind::most || kind == Kind::least; }
};

/// A formula with derivatives, of any names.
class SmoothFormula {
 public:
  /// @throws std::invalid_argument: one sentence
  SmoothFormula(const std::string& formula, const std::vector<std::string>& names);
  /// Value at x, one number per name, and ∂/∂x unless null.
  double operator()(const Eigen::VectorXd& x, Eigen::VectorXd* by) const;
  /// Places of the names it takes.
  const std::vector<int>& used() const { return used_; }

 private:
  std::unique_ptr<Expression> formula_;
  std::vector<int> used_;
};

/// A formula of a motion, read.
struct MotionFormula {
  std::string text;               ///< as written
  std::string outer;              ///< with name_of(k) in the place of part k
  std::vector<MotionPart> parts;  ///< parts in order

  /// @throws std::invalid_argument: one sentence
  static MotionFormula from_text(const std::string& text);
  /// Name that stands for a part.
  static std::string name_of(std::size_t part) { return "motion.part" + std::to_string(part); }
};

/// less ≤ more, or less = more.
struct MotionCondition {
  std::string text;    ///< as written
  bool equal = false;  ///< an equation
  MotionFormula gap;   ///< less − more: ≤ 0, or 0, where kept

  /// `parameters`: names known without a motion. < and > count as ≤ and ≥. @throws
  /// std::invalid_argument: one sentence
  static MotionCondition from_text(const std::string& text,
                                   const std::vector<std::string>& parameters);
};

}  // namespace momenta
