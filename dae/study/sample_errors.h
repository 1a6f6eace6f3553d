#pragma once
// Errors at the samples of a run: of its row of the trajectory against a reference, and of the
// form's own λ against that of (3) and against the reference.

#include <momenta/dae/measure/reference.h>
#include <momenta/dae/study/own_multipliers.h>
#include <momenta/dae/study/trajectory_row.h>

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
      : mechanism_(mechanism), reference_(reference), end_time_(end_time), series_(series) {}

  /// The form's own λ are measured too: of a run of the scene as written.
  void measure_own(Form& form) { own_.emplace(form, mechanism_.m()); }
  bool measures_own() const { return own_.has_value(); }
  /// Looks at the step that was just taken. `state`: room for one of the integrator's.
  void step(double t0, double t1, const Interpolant& between, std::vector<double>& state) {
    own_->step(t0, t1, between, state);
  }

  /// At a sample, whose row is set; `multipliers` (m): the form's there.
  void sample(double t, const TrajectoryRow& row, const Eigen::VectorXd& multipliers) {
    if (own_) compare_own(t, row, multipliers);
    if (reference_) compare(t, row);
  }
  /// Samples at times of the reference.
  int compared() const { return compared_; }
  void carry(Memory& memory) { memory(compared_); }

 private:
  void compare_own(double t, const TrajectoryRow& row, const Eigen::VectorXd& multipliers) {
    series_.multiplier_difference.push_back(not_measured);
    const Eigen::VectorXd& own = own_->at(t, multipliers);
    own_row_.clear();
    if (own.size() == 0) return;
    own_row_ = row.numbers();
    std::size_t column = row.first_force();
    double& difference = series_.multiplier_difference.back();
    for (Eigen::Index i = 0; i < own.size(); ++i, ++column) {
      if (i > 0 && new_loop(i)) ++column;  // over `undetermined`
      own_row_[column] = own[i];
      const double solved = row.forces()->lambda()[i],
                   apart = std::abs(own[i] - solved) / (1 + std::abs(solved));
      if (row.forces()->unique()[static_cast<std::size_t>(i)] && !(apart <= difference))
        difference = apart;
    }
  }
  bool new_loop(Eigen::Index i) const {
    const auto at = static_cast<std::size_t>(i);
    return mechanism_.rows()[at].loop != mechanism_.rows()[at - 1].loop;
  }

  void compare(double t, const TrajectoryRow& row) {
    const auto& times = reference_->times();
    const double apart = 1e-9 * end_time_;
    const auto at = std::lower_bound(times.begin(), times.end(), t - apart);
    const bool hit = at != times.end() && *at <= t + apart;
    series_.position_error.push_back(not_measured);
    series_.velocity_error.push_back(not_measured);
    const bool with_forces = reference_->has_forces();
    if (with_forces) series_.force_error.push_back(not_measured);
    if (with_forces && own_) series_.multiplier_error.push_back(not_measured);
    if (!hit) return;
    const auto place = static_cast<std::size_t>(at - times.begin());
    const auto error = reference_->error(place, row.numbers(), row.not_unique());
    series_.position_error.back() = error.position;
    series_.velocity_error.back() = error.velocity;
    ++compared_;
    if (with_forces) series_.force_error.back() = error.force;
    if (with_forces && own_ && !own_row_.empty())
      series_.multiplier_error.back() = reference_->error(place, own_row_, row.not_unique()).force;
  }

  const Mechanism& mechanism_;
  const Reference* reference_;
  double end_time_;
  Series& series_;
  std::optional<OwnMultipliers> own_;
  std::vector<double> own_row_;
  int compared_ = 0;
};

}  // namespace momenta
