#pragma once
// Cubic splines through points (xᵢ, yᵢ). With z = x − xᵢ, h = xᵢ₊₁ − xᵢ and mᵢ = f"(xᵢ),
// in each gap
//
//   f = yᵢ + bᵢ z + mᵢ/2 z² + (mᵢ₊₁ − mᵢ)/(6h) z³,  bᵢ = (yᵢ₊₁ − yᵢ)/h − h (2mᵢ + mᵢ₊₁)/6
//
// Continuity of f': hᵢ₋₁ mᵢ₋₁ + 2 (hᵢ₋₁ + hᵢ) mᵢ + hᵢ mᵢ₊₁ = 6 (Δyᵢ/hᵢ − Δyᵢ₋₁/hᵢ₋₁).
//
// Alternatively cubics through given slopes sᵢ,
//
//   f = yᵢ + sᵢ z + (3Δ − 2sᵢ − sᵢ₊₁)/h z² + (sᵢ + sᵢ₊₁ − 2Δ)/h² z³,  Δ = (yᵢ₊₁ − yᵢ)/h
//
// Monotone: sᵢ is the weighted harmonic mean of both Δ, zero where they differ in sign (F. N.
// Fritsch, J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300-304). Linear: straight gaps.
//
// Natural: m = 0 at both ends. Outside, the line of the end slope: f" stays continuous. Periodic: a
// last gap leads back to y₀ at x₀ + period, indices modulo n. Within a gap the derivatives are
// exact; a dual number takes the gap of its value.

#include <momenta/core/scalar/dual.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace momenta {

/// p, ṗ, p̈ of Σ cᵢ xⁱ; the second derivative is accumulated halved.
template <class S>
void horner(const double* c, std::size_t count, const S& x, S& p, S& pdot, S& pddot) {
  S value(0.0), rate(0.0), half(0.0);
  for (std::size_t i = count; i-- > 0;) {
    half = half * x + rate;
    rate = rate * x + value;
    value = value * x + S(c[i]);
  }
  p = value;
  pdot = rate;
  pddot = half + half;
}

/// Interpolation between the points.
enum class Interpolation {
  cubic,     ///< f" is continuous
  monotone,  ///< f' is continuous, and f rises or falls where the points do
  linear     ///< f is continuous
};

/// Why points make no spline, in words with the names of both lists; empty: they do.
std::string spline_fault(const std::vector<double>& x, const std::vector<double>& y,
                         const std::string& x_name, const std::string& y_name);

class CubicSpline {
 public:
  CubicSpline() = default;
  /// A natural spline, or another interpolation. @pre spline_fault() is empty. O(points)
  CubicSpline(const std::vector<double>& x, const std::vector<double>& y,
              Interpolation between = Interpolation::cubic);
  /// A periodic spline. @pre as above, at least three points, x[0] + period beyond the last.
  /// O(points)
  CubicSpline(const std::vector<double>& x, const std::vector<double>& y, double period);

  Interpolation between() const { return between_; }

  /// f, f' and f" of a natural spline. O(log points)
  template <class S>
  void evaluate(const S& x, S& f, S& first, S& second) const {
    const Segment& segment = at(x);
    horner(segment.c, 4, S(x - S(segment.from)), f, first, second);
  }
  /// The same for a periodic spline.
  template <class S>
  void evaluate_round(const S& x, S& f, S& first, S& second) const {
    const double turns = std::floor((value_of(x) - knots_.front()) / period_);
    evaluate(turns == 0 ? x : S(x - S(turns) * S(period_)), f, first, second);
  }
  /// The derivative of an order; order 0 is f. @pre natural. O(log points)
  template <class S>
  S derivative(const S& x, int order) const {
    const Segment& segment = at(x);
    const S z = x - S(segment.from);
    S sum(0.0);
    for (int i = 3; i >= order; --i) {
      double c = segment.c[i];
      for (int k = 0; k < order; ++k) c *= i - k;
      sum = sum * z + S(c);
    }
    return sum;
  }

 private:
  /// A cubic in x − from.
  struct Segment {
    double from = 0;
    double c[4] = {0, 0, 0, 0};
  };
  template <class S>
  const Segment& at(const S& x) const {
    // segments_[k] holds between knots k − 1 and k; k: number of knots at or before x
    std::size_t low = 0, high = knots_.size();
    while (low < high) {
      const std::size_t middle = (low + high) / 2;
      if (x < knots_[middle])
        high = middle;
      else
        low = middle + 1;
    }
    return segments_[low];
  }

  void go_through(const std::vector<double>& x, const std::vector<double>& y,
                  const std::vector<double>& slopes);

  Interpolation between_ = Interpolation::cubic;
  double period_ = 0;  ///< 0: natural
  std::vector<double> knots_;
  std::vector<Segment> segments_;  ///< one more than knots_: first and last are the lines outside
};

}  // namespace momenta
