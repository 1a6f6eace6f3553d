#pragma once
// Times at which inputs change: parts of formulas that take the time alone, and laws of drives.
// Steps with error control could miss a short pulse, so steps end at these times:
//
//   a < b, sign(a), floor(a)               where the argument, linear in t, has its zero: just
//                                          before and just behind it
//   abs(a), min(a, b), max(a, b)           the same: at it
//   anything else                          looked at in 4096 places of the span: where it jumps,
//                                          and where it begins and ends to vary
//
// A pulse of the last kind, shorter than the distance of two places, may be missed.

#include <momenta/core/expression/expression.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

namespace momenta {

class InputTimes {
 public:
  /// Times of a run from t0 to end [s].
  InputTimes(double t0, double end) : t0_(t0), end_(end) {}

  /// Adds a formula, with its variable t and the numbers of variables that stay constant.
  void add(const Expression& formula, int time,
           const std::function<std::optional<double>(int)>& number = {});
  /// Adds an input that varies between these times alone: eighths of the interval, for methods that
  /// evaluate only ends of steps.
  void add_pulse(double from, double to);

  /// All times inside the run, ascending, none twice.
  std::vector<double> all() const;

 private:
  /// Adds a function of the time.
  void add(const std::function<double(double)>& input);
  /// Adds a single time.
  void add_corner(double t);
  /// Distance of the times before and behind a jump from it.
  double beside_jump() const {
    return std::max(1e-12 * (end_ - t0_), 16 * std::numeric_limits<double>::epsilon() *
                                              std::max(std::abs(t0_), std::abs(end_)));
  }
  void add_jump(double before, double behind);
  /// Whether a switch's argument is linear in t; then adds its zeros, or passages of whole numbers.
  bool add_linear(const Expression& argument, bool jumps, bool whole);
  void add_change(const std::function<double(double)>& input, double from, double to, double low,
                  double high, double least);

  double t0_, end_;
  std::vector<double> times_;
};

}  // namespace momenta
