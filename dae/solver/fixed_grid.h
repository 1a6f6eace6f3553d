#pragma once
// Steps of one length from t0: step k ends at t0 + k h without summed rounding, the last one at the
// end of the run, which takes the place of a grid point 1e-9 h off.

#include <cmath>

namespace momenta {

class FixedGrid {
 public:
  FixedGrid(double t0, double step) : t0_(t0), step_(step) {}
  /// End of the step after `steps` whole ones.
  double next(long steps, double end) const {
    const double grid = t0_ + static_cast<double>(steps + 1) * step_;
    return grid > end - tolerance() ? end : grid;
  }
  /// The length of a step from t to t1: the step itself, to the last bit, unless cut short.
  double length(double t, double t1) const {
    return std::abs(t1 - t - step_) <= tolerance() ? step_ : t1 - t;
  }
  /// Distance of times that are meant as one.
  double tolerance() const { return 1e-9 * step_; }

 private:
  double t0_, step_;
};

}  // namespace momenta
