#pragma once
// Errors at the samples of a run, against a reference: of its row of the trajectory, of p without
// its gauge, of the loops' impulses and of work; and of the form's own λ, against the reference and
// against λ of (3).

#include <momenta/dae/run/force_columns.h>
#include <momenta/dae/run/measure/reference.h>
#include <momenta/dae/run/own_multipliers.h>
#include <momenta/dae/run/reference_errors.h>
#include <momenta/dae/run/trajectory_row.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace momenta {

class SampleErrors {
 public:
  /// `reference` may be null. Errors go to `series`.
  SampleErrors(const Mechanism& mechanism, const Reference* reference, double end_time,
               Series& series)
      : mechanism_(mechanism), reference_(reference), end_time_(end_time), series_(series) {
    if (!reference) return;
    extras_ = trajectory_columns(mechanism, true).size();
    measured_.resize(measured_columns(mechanism).size());
    // A reference of momenta is one of forces too: it has the reactions that are unique.
    if (reference->has(Kind::reaction) || reference->has(Kind::momentum))
      reactions_.emplace(mechanism, *reference);
  }

  /// Whether the row has to have reactions.
  bool takes_reactions() const { return reactions_.has_value(); }
  /// Compares p, if the reference has all of it. `e` and, where there are loops, `solver` (else
  /// null) are used as workspaces after each row is set.
  void measure_momenta(Evaluation<double>& e, LoopSolver* solver) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(mechanism_.nv()); ++i) {
      momenta_.push_back(reference_->column_at(extras_ + i));
      if (momenta_.back() == reference_->columns().size()) return;
    }
    momentum_error_.emplace(mechanism_, e, solver);
  }
  /// Measures the form's own λ too, in a run of the scene as written.
  void measure_own(Form& form) {
    own_.emplace(form, mechanism_.m(), reference_ && reference_->has(Reference::Kind::impulse));
  }
  bool measures_own() const { return own_.has_value(); }
  /// Whether step() has to see steps without samples too.
  bool sees_every_step() const { return own_ && own_->sums(); }
  /// Looks at the step just taken. `state`: work space for the integrator's.
  void step(double t0, double t1, const Interpolant& between, std::vector<double>& state) {
    own_->step(t0, t1, between, state);
  }

  /// Takes a sample, whose row is set; `state` has the form's own multipliers (m). `work`: done so
  /// far [J].
  void sample(double t, const Snapshot& state, const TrajectoryRow& row, double work) {
    if (own_) compare_own(t, row, state.multipliers);
    if (reference_) compare(t, state, row, work);
  }
  /// Samples at times of the reference.
  int compared() const { return compared_; }
  /// Errors by joint, if the reference has reactions.
  std::vector<RunResult::ReactionError> of_reactions() const {
    return reactions_ ? reactions_->told() : std::vector<RunResult::ReactionError>{};
  }
  void carry(Memory& memory) {
    memory(compared_);
    if (own_) own_->carry(memory);
    if (reactions_) reactions_->carry(memory);
  }

 private:
  using Kind = Reference::Kind;

  void compare_own(double t, const TrajectoryRow& row, const Eigen::VectorXd& multipliers) {
    series_.multiplier_difference.push_back(not_measured);
    const Eigen::VectorXd& own = own_->at(t, multipliers);
    own_row_.clear();
    if (own.size() == 0) return;
    own_row_ = row.numbers();
    double& difference = series_.multiplier_difference.back();
    const auto& rows = mechanism_.rows();
    std::size_t place = row.first_force();
    for (Eigen::Index i = 0; i < own.size(); ++i) {
      own_row_[place] = own[i];
      // Among the columns of forces, `undetermined` stands behind the rows of each loop.
      const auto next = static_cast<std::size_t>(i) + 1;
      place += next < rows.size() && rows[next - 1].loop != rows[next].loop ? 2 : 1;
      const double solved = row.forces()->lambda()[i],
                   apart = std::abs(own[i] - solved) / (1 + std::abs(solved));
      if (row.forces()->unique()[static_cast<std::size_t>(i)] && !(apart <= difference))
        difference = apart;
    }
    own_row_.resize(measured_.size(), not_measured);
  }

  void compare(double t, const Snapshot& state, const TrajectoryRow& row, double work) {
    const auto& times = reference_->times();
    const double apart = 1e-9 * end_time_;
    const auto at = std::lower_bound(times.begin(), times.end(), t - apart);
    const bool hit = at != times.end() && *at <= t + apart;
    series_.position_error.push_back(not_measured);
    series_.velocity_error.push_back(not_measured);
    const bool own = own_ && reference_->has(Kind::force);
    begin(Kind::force, series_.force_error);
    begin(Kind::effort, series_.effort_error);
    begin(Kind::reaction, series_.reaction_error);
    begin(Kind::impulse, series_.impulse_error);
    begin(Kind::work, series_.work_error);
    if (own) series_.multiplier_error.push_back(not_measured);
    if (momentum_error_) series_.momentum_error.push_back(not_measured);
    if (!hit) return;
    const auto place = static_cast<std::size_t>(at - times.begin());
    ++compared_;
    take_measured(t, row, work);
    const Reference::Error error = reference_->error(place, measured_, not_unique_);
    series_.position_error.back() = error.position;
    series_.velocity_error.back() = error.velocity;
    end(Kind::force, series_.force_error, error.force);
    end(Kind::effort, series_.effort_error, error.effort);
    end(Kind::reaction, series_.reaction_error, error.reaction);
    end(Kind::impulse, series_.impulse_error, error.impulse);
    end(Kind::work, series_.work_error, error.work);
    if (own && !own_row_.empty())
      series_.multiplier_error.back() = reference_->error(place, own_row_, not_unique_).force;
    if (reactions_) reactions_->sample(place, row);
    if (!momentum_error_) return;
    p_.clear();
    for (const std::size_t column : momenta_) p_.push_back(reference_->values()[place][column]);
    series_.momentum_error.back() =
        momentum_error_->at(t, state.q.data(), state.u.data(), p_.data());
  }
  void begin(Kind kind, std::vector<double>& errors) const {
    if (reference_->has(kind)) errors.push_back(not_measured);
  }
  void end(Kind kind, std::vector<double>& errors, double error) const {
    if (reference_->has(kind)) errors.back() = error;
  }

  /// Sets the row by measured_columns(), and the places that are not unique.
  void take_measured(double t, const TrajectoryRow& row, double work) {
    std::fill(measured_.begin(), measured_.end(), not_measured);
    std::copy(row.numbers().begin(), row.numbers().end(), measured_.begin());
    not_unique_ = row.not_unique();
    measured_.back() = work;
    if (!sees_every_step()) return;
    const std::size_t first = extras_ + static_cast<std::size_t>(mechanism_.nv());
    const Eigen::VectorXd impulses = own_->impulses(t);
    for (Eigen::Index i = 0; i < impulses.size(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      measured_[first + k] = impulses[i];
      if (!row.forces()->unique()[k]) not_unique_.push_back(first + k);
    }
  }

  const Mechanism& mechanism_;
  const Reference* reference_;
  double end_time_;
  Series& series_;
  std::optional<OwnMultipliers> own_;
  std::optional<MomentumError> momentum_error_;
  std::optional<ReactionErrors> reactions_;
  std::size_t extras_ = 0;            ///< place of the first column behind the trajectory's
  std::vector<std::size_t> momenta_;  ///< columns of p in the reference
  std::vector<double> own_row_, measured_, p_;
  std::vector<std::size_t> not_unique_;
  int compared_ = 0;
};

}  // namespace momenta
