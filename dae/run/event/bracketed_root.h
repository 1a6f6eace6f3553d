#pragma once
// The root of g between two places where it has opposite signs, by Chandrupatla's method: the three
// latest places (a, b, c), with b and c on the two sides of the root, give
//
//   ξ = (a − b)/(c − b),  φ = (g(a) − g(b))/(g(c) − g(b)),
//
// and the next place is that of inverse quadratic interpolation where the inverse parabola through
// the three is monotonic between b and c,  φ² < ξ and (1 − φ)² < 1 − ξ,  else the middle. The
// bracket never loses the root, and halves at least as often as it must. Source: T. R.
// Chandrupatla, A new hybrid quadratic/bisection algorithm for finding the zero of a nonlinear
// function without using derivatives, Advances in Engineering Software 28 (1997).

#include <algorithm>
#include <cmath>
#include <limits>

namespace momenta {

/// Where g was found to be nearest to zero, and g at the ends of the last bracket.
struct BracketedRoot {
  double at = 0;
  double before = 0, after = 0;
};

/// Root of g between a and b, where g has opposite signs, to within `tolerance` and rounding of the
/// place. NaN where g is on the way. About ten values of a smooth g.
template <class G>
BracketedRoot bracketed_root(G&& g, double a, double at_a, double b, double at_b,
                             double tolerance) {
  double c = a, at_c = at_a, part = 0.5;
  for (int trial = 0; trial < 200; ++trial) {
    const double x = a + part * (b - a), at_x = g(x);
    if (std::isnan(at_x)) return {at_x, at_x, at_x};
    if (std::signbit(at_x) == std::signbit(at_a)) {
      c = a, at_c = at_a;
    } else {
      c = b, at_c = at_b;
      b = a, at_b = at_a;
    }
    a = x, at_a = at_x;
    const bool nearer = std::abs(at_a) < std::abs(at_b);
    const double best = nearer ? a : b, value = nearer ? at_a : at_b;
    const double least =
        (2 * std::numeric_limits<double>::epsilon() * std::abs(best) + 0.5 * tolerance) /
        std::abs(b - a);
    if (!(least < 0.5) || value == 0)
      return a < b ? BracketedRoot{best, at_a, at_b} : BracketedRoot{best, at_b, at_a};
    const double xi = (a - b) / (c - b), phi = (at_a - at_b) / (at_c - at_b);
    part = phi * phi < xi && (1 - phi) * (1 - phi) < 1 - xi
               ? at_a / (at_b - at_a) * at_c / (at_b - at_c) +
                     (c - a) / (b - a) * at_a / (at_c - at_a) * at_b / (at_c - at_b)
               : 0.5;
    part = std::clamp(part, least, 1 - least);
  }
  return {a, at_a, at_b};
}

}  // namespace momenta
