#pragma once
// When inputs change: parts of formulas that take the time alone, and laws of drives. A step with
// error control may be longer than a pulse and see nothing of it, so that these times are to be
// ends of steps:
//
//   a < b, sign(a), floor(a)               where the argument, linear in t, has its zero: just
//                                          before and just behind it
//   abs(a), min(a, b), max(a, b)           the same: at it
//   anything else                          looked at in 4096 places of the span: where it jumps,
//                                          and where it begins and ends to vary
//
// A pulse shorter than that between two places, by none of the first two, may be missed.

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
  /// Of a run [s].
  InputTimes(double t0, double end) : t0_(t0), end_(end) {}

  /// A formula, its variable t, and the numbers of variables that stay as they are.
  void add(const Expression& formula, int time,
           const std::function<std::optional<double>(int)>& number = {});
  /// What varies between these times alone. Methods that evaluate ends of steps alone have to see
  /// it too: eighths of it.
  void add_pulse(double from, double to);

  /// Inside the run, ascending, none twice.
  std::vector<double> all() const;

 private:
  /// A function of the time.
  void add(const std::function<double(double)>& input);
  /// A time by itself.
  void add_corner(double t);
  /// How far from a jump the times before and behind it are.
  double beside_jump() const {
    return std::max(1e-12 * (end_ - t0_), 16 * std::numeric_limits<double>::epsilon() *
                                              std::max(std::abs(t0_), std::abs(end_)));
  }
  void add_jump(double before, double behind);
  /// Whether the argument of a switch is linear in t; its zeros, or passages of whole numbers, are
  /// added then.
  bool add_linear(const Expression& argument, bool jumps, bool whole);
  void add_change(const std::function<double(double)>& input, double from, double to, double low,
                  double high, double least);

  double t0_, end_;
  std::vector<double> times_;
};

}  // namespace momenta
