#include <momenta/dae/kinematics/least_pivot.h>

#include <cmath>

namespace momenta {

CurvePoint least_pivot(PoseCurve& curve, const CurvePoint& from, double length,
                       const CurvePoint& first) {
  constexpr double golden = 0.6180339887498949, narrow = 1e-10;
  CurvePoint point, least = first;
  const auto value = [&](double x) -> double {
    if (!curve.step(from, x, point)) return INFINITY;
    if (point.pivot < least.pivot) least = point;
    return point.pivot;
  };
  double a = 0, b = length;
  double x = b - golden * (b - a), y = a + golden * (b - a), fx = value(x), fy = value(y);
  while (b - a > narrow) {
    if (fx < fy) {
      b = y;
      y = x;
      fy = fx;
      x = b - golden * (b - a);
      fx = value(x);
    } else {
      a = x;
      x = y;
      fx = fy;
      y = a + golden * (b - a);
      fy = value(y);
    }
  }
  return least;
}

}  // namespace momenta
