#pragma once
// Interpolating cubic splines, twice continuously differentiable.
//
// Through (tᵢ, yᵢ). With x = t − tᵢ, h = tᵢ₊₁ − tᵢ, mᵢ = f̈(tᵢ), in each gap
//   f = yᵢ + bᵢ x + mᵢ/2 x² + (mᵢ₊₁ − mᵢ)/(6h) x³,  bᵢ = (yᵢ₊₁ − yᵢ)/h − h (2mᵢ + mᵢ₊₁)/6
// Continuity of ḟ: hᵢ₋₁ mᵢ₋₁ + 2 (hᵢ₋₁ + hᵢ) mᵢ + hᵢ mᵢ₊₁ = 6 (Δyᵢ/hᵢ − Δyᵢ₋₁/hᵢ₋₁).
//
// Natural: m = 0 at both ends; outside, the straight line of the end slope, where f̈ is continuous
// too. Periodic: the last gap leads back to y₀ at t₀ + T, and the indices of the rows go round.
//
// Within each gap the derivatives are exact; a dual number takes the gap of its value.

#include <momenta/core/scalar/dual.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace momenta {

/// p, ṗ, p̈ of Σ cᵢ xⁱ. The second derivative is accumulated halved.
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

class CubicSpline {
 public:
  /// Natural. @pre two ascending times at least, as many values. O(n)
  CubicSpline(const std::vector<double>& times, const std::vector<double>& values);
  /// Periodic. @pre three ascending times at least, as many values, times[0] + period beyond the
  /// last. O(n)
  CubicSpline(const std::vector<double>& times, const std::vector<double>& values, double period);

  /// f, ḟ, f̈. No allocation, O(log n). S needs + − ×, a constructor from double, S < double.
  template <class S>
  void evaluate(const S& t, S& f, S& fdot, S& fddot) const {
    const S at = period_ > 0 ? within(t) : t;
    // segments_[k] holds between knots k − 1 and k; find the number k of knots at or before t
    std::size_t low = 0, high = knots_.size();
    while (low < high) {
      const std::size_t middle = (low + high) / 2;
      if (at < knots_[middle])
        high = middle;
      else
        low = middle + 1;
    }
    const Segment& segment = segments_[low];
    const S x = at - S(segment.from);
    horner(segment.c, 4, x, f, fdot, fddot);
  }

 private:
  /// A cubic in t − from.
  struct Segment {
    double from = 0;
    double c[4] = {0, 0, 0, 0};
  };
  template <class S>
  S within(const S& t) const {
    const double turns = std::floor((value_of(t) - knots_.front()) / period_);
    return turns == 0 ? t : t - S(turns) * S(period_);
  }

  double period_ = 0;  ///< 0: natural
  std::vector<double> knots_;
  std::vector<Segment> segments_;  ///< one more than knots_: those before the first and behind the
                                   ///< last too
};

}  // namespace momenta
