#pragma once
// A minimum with conditions,
//
//   min f(x),   c(x) ≤ 0,   e(x) = 0,   least ≤ x ≤ most,
//
// of functions with gradients, by sequential quadratic programming: each step minimises a quadratic
// model of the Lagrangian, its second derivatives gathered from gradients, within the conditions
// made linear. NLopt, whose SLSQP does it, is seen by constrained_search.cpp alone. It is begun
// again from where it stops until it gains nothing more. Where f does not exist a step is cut to a
// tenth. What a minimum is to fulfil is looked at afterwards: with multipliers λ ≥ 0 of conditions
// that hold as equalities, and μ of equations,
//
//   ∇f + Σ λ ∇c + Σ μ ∇e = 0                                                                (a)
//
// bounds being conditions like others. Unknowns count in their sizes.
// Source: D. Kraft, A software package for sequential quadratic programming, DFVLR-FB 88-28 (1988);
// S. G. Johnson, NLopt; Nocedal, Wright, Numerical Optimization, ch. 12, 18.

#include <Eigen/Core>
#include <functional>
#include <limits>

namespace momenta {

/// f and its conditions.
struct ConstrainedProblem {
  int inequalities = 0;  ///< rows of c
  int equalities = 0;    ///< rows of e
  /// f at x, and `conditions`: those of c, then those of e; with their gradients, rows × unknowns,
  /// where these are not null. False: there is no f here.
  std::function<bool(const Eigen::VectorXd& x, double& f, Eigen::VectorXd& conditions,
                     Eigen::VectorXd* df, Eigen::MatrixXd* dconditions)>
      at;
  std::function<bool()> going;  ///< false ends the search
};

/// Where a search ended.
struct ConstrainedEnd {
  bool began = false;    ///< f and gradients could be evaluated where the search began
  bool stopped = false;  ///< by `going`
  int iterations = 0;    ///< how often gradients were computed
  double f = std::numeric_limits<double>::quiet_NaN();  ///< at the end
  Eigen::VectorXd conditions;                           ///< at the end
  Eigen::VectorXd multipliers;  ///< of (a), by condition; 0 where one does not matter
  double violation = 0;         ///< the largest of c and |e|, 0 where all are kept
  bool kept = false;            ///< all conditions are, within kept_within
  /// |(a)|, unknowns in their sizes, over the largest of |f| and a thousandth of |∇f| here and at
  /// the beginning: 0 at a minimum.
  double slope = std::numeric_limits<double>::quiet_NaN();
};

/// Above it no minimum is claimed.
inline constexpr double converged_slope = 1e-6;
/// Conditions count as kept that are missed by no more, beside their change as x changes by its
/// size, or 1 where that is less.
inline constexpr double kept_within = 1e-10;

/// From x, within bounds that are infinite where there are none; `sizes` of x, > 0. Leaves the best
/// point in x: of those that keep the conditions the one of least f; if none does, the nearest to
/// them.
ConstrainedEnd constrained_search(const ConstrainedProblem& problem, const Eigen::VectorXd& least,
                                  const Eigen::VectorXd& most, const Eigen::VectorXd& sizes,
                                  int most_iterations, Eigen::VectorXd& x);

}  // namespace momenta
