#pragma once
// Place of the minimum of a function that has one between two places.

#include <momenta/dae/analysis/kinematics/move.h>
#include <momenta/dae/analysis/kinematics/pose_curve.h>
#include <momenta/dae/analysis/kinematics/transmission.h>

#include <optional>

namespace momenta {

/// Golden section, to `within`; corners do no harm, f may be infinite.
template <class F>
double least_between(F&& f, double a, double b, double within) {
  constexpr double golden = 0.6180339887498949;
  double x = b - golden * (b - a), y = a + golden * (b - a), fx = f(x), fy = f(y);
  while (b - a > within) {
    if (fx < fy) {
      b = y;
      y = x;
      fy = fx;
      x = b - golden * (b - a);
      fx = f(x);
    } else {
      a = x;
      x = y;
      fx = fy;
      y = a + golden * (b - a);
      fy = f(y);
    }
  }
  return fx < fy ? x : y;
}

// Extremes of angle and force at an output along a curve of poses, located between its points, and
// their limits at dead points. There a unit effort on the output takes an infinite effort, and so
// an infinite force f: with power f·v = 1 of the output at unit rate, sin μ = 1/(|f| |v|) = 0.
// Where f stays finite, μ has another limit.

class PassedExtremes {
 public:
  /// Both must outlive it. @param unit of s on the curve [rad or m]
  PassedExtremes(Transmission& transmission, double unit, MoveResult::Passed& found)
      : transmission_(transmission), unit_(unit), found_(found) {}
  /// The next point of the curve.
  Transmitting pass(PoseCurve& curve, const CurvePoint& at, bool is_dead_point);

 private:
  struct Seen {
    CurvePoint at;
    Transmitting passed;
  };
  Transmitting limit(PoseCurve& curve, const CurvePoint& at);
  void locate(PoseCurve& curve, const Seen& next);
  void widen(const CurvePoint& at, const Transmitting& passed);

  Transmission& transmission_;
  double unit_;
  MoveResult::Passed& found_;
  std::optional<Seen> before_, last_;
};

}  // namespace momenta
