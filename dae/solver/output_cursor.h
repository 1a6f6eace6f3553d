#pragma once
// Walks through the requested output times in order.

#include <momenta/dae/solver/memory.h>

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

namespace momenta {

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
