#pragma once
// How long the run of a trial may take. A search without bounds tries numbers with which a motion
// has no end, as where a damper drives: such a trial counts as one that has no value.

#include <algorithm>
#include <functional>
#include <utility>

namespace momenta {

class TrialLimit {
 public:
  /// Asked along runs; false ends them. Empty: never.
  void ask(std::function<bool()> going_on) { going_on_ = std::move(going_on); }
  /// To be called after each step of the next run; false ends it.
  std::function<bool(double)> next() {
    steps_ = 0;
    return [this](double) {
      constexpr long between = 64;  // looks at the clock
      return ++steps_ <= most_ && (steps_ % between != 0 || !going_on_ || going_on_());
    };
  }
  /// The run has arrived: those to come may take a hundred times its steps, and ten thousand.
  void arrived() { most_ = std::min(most_, 100 * steps_ + 10'000); }

 private:
  std::function<bool()> going_on_;
  long steps_ = 0, most_ = 1'000'000;
};

}  // namespace momenta
