#pragma once
// The row of the trajectory at a state: its time, coordinates, rates, markers, energy and drifts,
// and what acts at joints and loops.

#include <momenta/dae/form/form.h>
#include <momenta/dae/run/drift.h>
#include <momenta/dae/run/force_columns.h>
#include <momenta/dae/run/run_result.h>

#include <optional>
#include <string>
#include <vector>

namespace momenta {

class TrajectoryRow {
 public:
  /// Row of trajectory_columns(), without forces until take_forces_of().
  TrajectoryRow(const Mechanism& mechanism, bool reactions);

  /// Adds the forces of `acting`: the mechanism, or it with loops of stops that hold. `e` and
  /// `solver` (null without loops) are of `acting`, used as workspaces.
  void take_forces_of(const Mechanism& acting, Evaluation<double>& e, LoopSolver* solver);
  /// Null without forces.
  const ForceColumns* forces() const { return forces_ ? &*forces_ : nullptr; }

  /// @pre `e` of the mechanism is placed and moved to the state
  void set(double t, const Snapshot& state, Evaluation<double>& e, double energy,
           const Drift& position, const Drift& velocity);
  const std::vector<double>& numbers() const { return row_; }
  const std::vector<std::string>& columns() const { return columns_; }
  /// Place of the first force.
  std::size_t first_force() const { return first_force_; }
  /// Columns of forces that are not unique at the state.
  const std::vector<std::size_t>& not_unique() const { return not_unique_; }
  /// Counts the columns not unique at a sample, among the first `columns`.
  void note_undetermined(double t, std::size_t columns, std::vector<RunResult::Undetermined>& all);

 private:
  void append_forces(double t, const Snapshot& state);

  const Mechanism& mechanism_;
  bool reactions_, both_;  ///< rows in m and rows in rad
  std::vector<std::string> columns_;
  std::optional<ForceColumns> forces_;
  std::vector<std::size_t> places_;  ///< by column: place among the acting's; empty: the same
  std::vector<double> markers_, row_, acting_;
  std::size_t first_force_ = 0;
  std::vector<std::size_t> not_unique_, not_unique_acting_;
  std::vector<std::size_t> noted_;  ///< by column: place in note_undetermined()'s list
};

}  // namespace momenta
