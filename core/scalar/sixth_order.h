#pragma once
// Derivatives by a number of a scene. It is a plain number there, so that what is made of it knows
// no derivatives; central differences of sixth order of what is made at the same state take their
// place,
//
//   f' = [45 (f₁ − f₋₁) − 9 (f₂ − f₋₂) + (f₃ − f₋₃)] / 60h + O(h⁶),    f_k = f(θ + k h).
//
// With h = 2⁻⁸ of the number's size rounding and truncation leave about 1e-13 of f/θ, since nothing
// is integrated or iterated between them.
// Source: Fornberg, Generation of finite difference formulas, Math. Comp. 51 (1988).

#include <array>

namespace momenta::sixth_order {

inline constexpr double part = 1.0 / 256;  ///< h beside the size of a number

struct Point {
  int k = 0;          ///< f is taken at θ + k h
  double weight = 0;  ///< and counts so much, over h
};
inline constexpr std::array<Point, 6> points{{{1, 45.0 / 60},
                                              {-1, -45.0 / 60},
                                              {2, -9.0 / 60},
                                              {-2, 9.0 / 60},
                                              {3, 1.0 / 60},
                                              {-3, -1.0 / 60}}};
/// The same of the fourth order, of the first four points: what it differs by tells how smooth f
/// is.
inline constexpr std::array<double, 4> fourth{8.0 / 12, -8.0 / 12, -1.0 / 12, 1.0 / 12};

}  // namespace momenta::sixth_order
