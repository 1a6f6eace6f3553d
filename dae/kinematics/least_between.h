#pragma once
// Place of the minimum of a function that has one between two places.

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

}  // namespace momenta
