#pragma once
// The error of p without its gauge. p of (7) holds Φ_qᵀσ, which moves nothing and which a gauge
// chooses; so what is compared is what of a difference e_p of momenta moves at the pose q,
//
//   M v + Φ_qᵀν = e_p,   Φ_q v = 0            error = M v = e_p − Φ_qᵀν.
//
// Any Φ_qᵀc in p or in its reference goes into ν. With p = M u + Φ_qᵀσ, e_p = M u − p_ref will do
// in every form, those on accelerations too.

#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/mechanism/joint_places.h>
#include <momenta/dae/run/measure/growth.h>
#include <momenta/dae/run/measure/reference.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/run/trajectory_row.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace momenta {

class MomentumError {
 public:
  /// `e` and, where there are loops, `solver` (else null) are used as workspaces.
  MomentumError(const Mechanism& mechanism, Evaluation<double>& e, LoopSolver* solver)
      : e_(e),
        solver_(solver),
        error_(static_cast<std::size_t>(mechanism.nv())),
        moved_(error_.size()),
        prescribed_(error_.size()) {}

  /// max |M v| / (1 + |reference|) at (t, q, u), `reference` (nv) up to Φ_qᵀc; NaN where (7) has no
  /// solution, 0 without coordinates. Cost: a solution of (7). No allocation.
  double at(double t, const double* q, const double* u, const double* reference) {
    e_.place(t, q);
    e_.move(u);
    e_.momenta(nullptr, error_.data());
    for (std::size_t i = 0; i < error_.size(); ++i) error_[i] -= reference[i];
    if (solver_) {
      if (!solver_->free_velocity(t, q, error_.data(), moved_.data())) return not_measured;
      e_.place(t, q);
      e_.move(nullptr);
      e_.momenta(nullptr, prescribed_.data());
      e_.move(moved_.data());
      e_.momenta(nullptr, error_.data());
      for (std::size_t i = 0; i < error_.size(); ++i) error_[i] -= prescribed_[i];
    }
    double largest = 0;
    for (std::size_t i = 0; i < error_.size(); ++i) {
      const double error = std::abs(error_[i]) / (1 + std::abs(reference[i]));
      if (!(error <= largest)) largest = error;
    }
    return largest;
  }

 private:
  Evaluation<double>& e_;
  LoopSolver* solver_;
  std::vector<double> error_, moved_, prescribed_;
};

// Errors of reactions joint by joint: the largest |error|/(1 + |reference|) over a joint's six
// columns and the reference's times; and at how many of these times redundant loops leave the
// joint's reaction open, where there is nothing to compare.

class ReactionErrors {
 public:
  /// `reference` is bound to measured_columns(). Joints without a column are reported only if not
  /// unique.
  ReactionErrors(const Mechanism& mechanism, const Reference& reference) : reference_(reference) {
    if (mechanism.scene().lagrangian) return;
    const std::vector<JointPlace> places = joint_places(mechanism);
    first_ = trajectory_columns(mechanism, true).size() - of_one * places.size();
    for (std::size_t i = 0; i < of_one * places.size(); ++i)
      columns_.push_back(reference.column_at(first_ + i));
    for (const JointPlace& joint : places) all_.push_back({joint.name, not_measured, 0});
  }

  /// Takes the row, with reactions, at the reference's time of index `at`.
  void sample(std::size_t at, const TrajectoryRow& row) {
    const auto& open = row.not_unique();
    for (std::size_t j = 0; j < all_.size(); ++j) {
      RunResult::ReactionError& joint = all_[j];
      if (std::binary_search(open.begin(), open.end(), first_ + of_one * j)) {
        ++joint.not_unique;
        continue;
      }
      for (std::size_t i = of_one * j; i < of_one * (j + 1); ++i) {
        if (columns_[i] == reference_.columns().size()) continue;
        const double reference = reference_.values()[at][columns_[i]],
                     error = std::abs(row.numbers()[first_ + i] - reference) /
                             (1 + std::abs(reference));
        if (!(error <= joint.error_max)) joint.error_max = error;
      }
    }
  }

  /// Joints that have an error or are not unique.
  std::vector<RunResult::ReactionError> told() const {
    std::vector<RunResult::ReactionError> some;
    for (const RunResult::ReactionError& joint : all_)
      if (!std::isnan(joint.error_max) || joint.not_unique > 0) some.push_back(joint);
    return some;
  }
  void carry(Memory& memory) {
    for (RunResult::ReactionError& joint : all_) memory(joint.error_max), memory(joint.not_unique);
  }

 private:
  static constexpr std::size_t of_one = 6;

  const Reference& reference_;
  std::size_t first_ = 0;  ///< place of the first reaction
  std::vector<std::size_t> columns_;
  std::vector<RunResult::ReactionError> all_;
};

}  // namespace momenta
