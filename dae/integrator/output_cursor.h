#pragma once
// Steps of one length from t0: step k ends at t0 + k h without summed rounding, the last one at the
// end of the run, which takes the place of a grid point 1e-9 h off.

#include <momenta/dae/integrator/memory.h>

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

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

// Walks through the requested output times in order.

class OutputCursor {
 public:
  /// @throws std::invalid_argument unless times ascend from t0 and there is at least one.
  OutputCursor(double t0, const std::vector<double>& times) : times_(times) {
    if (times.empty()) throw std::invalid_argument("an integration needs at least one output time");
    double last = t0;
    for (const double t : times) {
      if (!(t >= last) || !std::isfinite(t))
        throw std::invalid_argument("output times must be finite and ascend from the start time");
      last = t;
    }
  }
  double end() const { return times_.back(); }
  bool done() const { return next_ == times_.size(); }
  double time() const { return times_[next_]; }
  void advance() { ++next_; }

  /// Whether the next output time is not after t.
  bool due(double t) const { return !done() && time() <= t; }

  void carry(Memory& memory) { memory(next_); }

 private:
  const std::vector<double>& times_;
  std::size_t next_ = 0;
};

}  // namespace momenta
