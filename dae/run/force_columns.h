#pragma once
// The forces at a state of the motion, as columns of the trajectory: λ of the loops, the efforts of
// drives, the reactions of joints where they are asked for. All are of u̇ and λ of (3) at (t, q,
// u), for every form.
//
// Where redundant loops leave λ open, its columns hold one solution, beside how many of them are
// not unique; efforts and reactions that differ between the solutions are NaN.

#include <momenta/dae/kkt/bearing_friction.h>
#include <momenta/dae/kkt/multipliers.h>
#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/run/measure/reactions.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace momenta {

class ForceColumns {
 public:
  /// `e` and, where there are loops, `solver` (else null) are used as workspaces.
  ForceColumns(const Mechanism& mechanism, Evaluation<double>& e, LoopSolver* solver,
               bool reactions);

  /// Solves (3) at (t, q, u); NaN without a solution. Cost: a solution of (3), two if rows faded.
  void solve(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u);
  /// Replaces u̇ (nv) and λ (m) after solve() by more accurate ones.
  void take(const Eigen::VectorXd& udot, const Eigen::VectorXd& lambda);
  /// λ (m), after solve().
  const Eigen::VectorXd& lambda() const { return lambda_; }
  /// Whether each λ is unique (m); all without a solution.
  const std::vector<bool>& unique() const { return unique_rows_; }
  /// Appends the columns of trajectory_columns() after the drifts; `not_unique`: places of those
  /// that are not. With reactions O(bodies + loops).
  void append(std::vector<double>& row, std::vector<std::size_t>& not_unique);

 private:
  void append_efforts(std::vector<double>& row, std::vector<std::size_t>& not_unique);
  void append_reactions(std::vector<double>& row, std::vector<std::size_t>& not_unique);

  const Mechanism& mechanism_;
  Evaluation<double>& e_;
  LoopSolver* solver_;
  bool reactions_;
  std::unique_ptr<BearingFriction> friction_;
  std::optional<UniqueMultipliers> multipliers_;
  std::unique_ptr<WrenchSweep> sweep_;  ///< null: neither drives of joints nor reactions
  bool found_ = false;
  double t_ = 0;
  Eigen::VectorXd q_, u_, udot_, lambda_, rest_, idle_;
  std::vector<bool> unique_rows_;
  std::vector<double> efforts_, with_, without_;
  Eigen::VectorXd row_units_;         ///< LoopUnits::equations (m)
  std::vector<double> effort_units_;  ///< by drive: a length of the scene, or a radian
};

// Columns that a reference may have: the trajectory's with reactions, and behind them
//
//   JOINT.p     M u [N m s, N s], the momentum without Φ_qᵀσ: that part is the gauge's
//   LOOP.impulse1, …  ∫λ dt from the start, by row of Φ [N s, N m s]: of momentum forms
//                     Δσ + ∫κσ dt, whatever the gauge
//   work        of drives and of what has no potential, from the start [J]

/// Names and units of M u (nv), in the order of u: "O.p [N m s]".
std::vector<Column> momentum_columns(const Mechanism& mechanism);
/// Names and units of ∫λ dt (m), by row of Φ: "B.impulse1 [N s]".
std::vector<Column> impulse_columns(const Mechanism& mechanism);

/// trajectory_columns() with reactions, M u, ∫λ dt and work, in this order.
std::vector<std::string> measured_columns(const Mechanism& mechanism);

}  // namespace momenta
