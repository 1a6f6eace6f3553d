#include <momenta/dae/integrator/radau5_error.h>

#include <algorithm>
#include <cmath>

namespace momenta::radau5 {
namespace {

constexpr std::array<double, 3> error_weights{gamma0 * (-13 - 7 * root6) / 3,
                                              gamma0*(-13 + 7 * root6) / 3, gamma0 * -1.0 / 3};
/// Part at which errors of what moves are held: about their part of the whole where σ is small.
constexpr double moving_part = 1.0 / 3;

}  // namespace

LocalError::LocalError(const DaeSystem& system, GaugeSymmetry* gauge,
                       const IntegrationOptions& options, double span)
    : gauge_(gauge),
      options_(options),
      share_(span, options.rtol),
      inner_(0.1 * std::pow(options.rtol, 2.0 / 3)),
      norm_(system, inner_, inner_ * options.atol / options.rtol),
      error_(static_cast<std::size_t>(system.size())) {}

const WeightedNorm& LocalError::norm(const double* y, double h) {
  if (weighed_for_ != h) norm_.set(y, weighed_for_ = h, share());
  return norm_;
}

double LocalError::fraction() const {
  return std::max(norm_.rounding(), std::min(0.03, std::sqrt(inner_)));
}

double LocalError::share() const {
  return std::pow(share_.now(), 2.0 / 3);
}

bool LocalError::rounding_is_left(const Stages& stages, const StepStart& start) {
  if (gauge_ == nullptr) return false;
  const double share = 0.1 * share_.now();
  gauge_->measure_at(start.t, start.y, start.ydot, share * options_.rtol, share * options_.atol);
  stages.last_correction(error_.data());
  return gauge_->motion_squares(error_.data()) <= 1;
}

double LocalError::of(Stages& stages, const Factors& factors, const StepStart& start, double h,
                      const StageValues& z, bool doubtful) {
  for (std::size_t k = 0; k < error_.size(); ++k)
    error_[k] = gamma0 * h * start.ydot[k] + error_weights[0] * z[0][k] +
                error_weights[1] * z[1][k] + error_weights[2] * z[2][k];
  stages.filter(factors, h, error_.data());
  double error = size(start);
  if (error >= 1 && doubtful) {
    stages.filter(factors, h, error_.data());
    error = size(start);
  }
  return error;
}

double LocalError::size(const StepStart& start) {
  if (gauge_ == nullptr || !gauge_->resets()) return norm_.of(error_.data());
  const double rtol = share() * inner_ * moving_part;
  gauge_->measure_at(start.t, start.y, start.ydot, rtol, rtol * options_.atol / options_.rtol);
  return std::sqrt(gauge_->motion_squares(error_.data()));
}

}  // namespace momenta::radau5
