#pragma once
// A minimum with conditions,
//
//   min f(x),   c(x) ≤ 0,   e(x) = 0,   least ≤ x ≤ most,
//
// of functions with gradients, by sequential quadratic programming: each step minimises a quadratic
// model of the Lagrangian, its second derivatives gathered from gradients, within the conditions
// made linear. NLopt, whose SLSQP does it, is seen by constrained_search.cpp alone. The search
// restarts where it stops until it gains nothing more. Where f does not exist a step is cut to a
// tenth. A minimum is tested afterwards: with multipliers λ ≥ 0 of conditions that hold as
// equalities, and μ of equations,
//
//   ∇f + Σ λ ∇c + Σ μ ∇e = 0                                                                (a)
//
// bounds being conditions like others. Unknowns are scaled by their sizes.
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
  /// f and `conditions` (rows of c, then of e) at x, and unless null their gradients, rows ×
  /// unknowns. False: f does not exist here.
  std::function<bool(const Eigen::VectorXd& x, double& f, Eigen::VectorXd& conditions,
                     Eigen::VectorXd* df, Eigen::MatrixXd* dconditions)>
      at;
  std::function<bool()> going;  ///< false ends the search
};

/// End of a search.
struct ConstrainedEnd {
  bool began = false;    ///< f and gradients could be evaluated where the search began
  bool stopped = false;  ///< stopped by `going`
  int iterations = 0;    ///< evaluations of gradients
  double f = std::numeric_limits<double>::quiet_NaN();  ///< at the end
  Eigen::VectorXd conditions;                           ///< at the end
  Eigen::VectorXd multipliers;  ///< λ, μ of (a), by condition; 0: inactive
  double violation = 0;         ///< largest of c and |e|; 0: all kept
  bool kept = false;            ///< all conditions hold within kept_within
  /// |(a)|, unknowns in their sizes, over the largest of |f| and a thousandth of |∇f| here and at
  /// the beginning: 0 at a minimum.
  double slope = std::numeric_limits<double>::quiet_NaN();
};

/// Largest slope of a claimed minimum.
inline constexpr double converged_slope = 1e-6;
/// Violation up to which conditions count as kept, over their change as x changes by its size, or
/// over 1 where that is less.
inline constexpr double kept_within = 1e-10;

/// Searches from x; bounds may be infinite; `sizes` of x, > 0. Leaves the best point in x: least f
/// among points that keep the conditions; if none does, the nearest to them.
ConstrainedEnd constrained_search(const ConstrainedProblem& problem, const Eigen::VectorXd& least,
                                  const Eigen::VectorXd& most, const Eigen::VectorXd& sizes,
                                  int most_iterations, Eigen::VectorXd& x);

}  // namespace momenta
