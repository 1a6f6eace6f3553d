#pragma once
// Derivatives by a number of a scene. It is a plain number there, so that what is made of it knows
// no derivatives; central differences of sixth order of what is made at the same state take their
// place,
//
//   f' = [45 (f₁ − f₋₁) − 9 (f₂ − f₋₂) + (f₃ − f₋₃)] / 60h + O(h⁶),    f_k = f(θ + k h).
//
// With h = 2⁻⁸ of the number's size rounding and truncation leave about 1e-13 of f/θ, since nothing
// is integrated or iterated between them, where f is smooth over that. Whether it is, two more
// formulas of the same points tell: the difference of fourth order, and the value in the middle,
//
//   f₀ = [45 (f₁ + f₋₁) − 18 (f₂ + f₋₂) + 3 (f₃ + f₋₃)] / 60 + O(h⁶),
//
// which what is odd about θ does not pass as what is even about it does not pass the first. Where
// one is apart by more than rounding, as of what turns many times within 3h, or has a corner there,
// narrower widths follow. Source: Fornberg, Generation of finite difference formulas, Math. Comp.
// 51 (1988).

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <exception>
#include <optional>
#include <utility>

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
/// The same of the fourth order, of the first four points.
inline constexpr std::array<double, 4> fourth{8.0 / 12, -8.0 / 12, -1.0 / 12, 1.0 / 12};

/// The place of θ itself behind those of `points`.
inline constexpr std::size_t middle = points.size();
/// θ + k h at this place.
constexpr int k_of(std::size_t point) {
  return point == middle ? 0 : points[point].k;
}

inline constexpr int widths = 6;             ///< h, h/8, …, h/32768
inline constexpr double narrower = 1.0 / 8;  ///< of each beside the one before
inline constexpr double read = 1e-14;        ///< rounding of numbers as they are read
inline constexpr double exact = 1e-13;       ///< and of what is computed, not iterated
inline constexpr double iterated = 1e-10;    ///< and of poses that are solved for

/// f' by one width.
struct Slope {
  Eigen::VectorXd by;   ///< of sixth order
  double apart = 0;     ///< the largest by which the other formulas are off
  int width = 0;        ///< how often h was narrowed
  bool agrees = false;  ///< all three, as f that is smooth over 3h lets them
};

/// By f(i, h), f at θ + k_of(i) h, `at` that of the middle; f has a `rounding` beside its largest
/// value, and f' beside `usual`, that of other states.
template <class F>
Slope slope_at(double h, double rounding, double usual, const Eigen::VectorXd& at, F&& f) {
  Slope slope;
  slope.by.setZero(at.size());
  Eigen::VectorXd lower = slope.by, off = at;
  double largest = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::VectorXd there = f(i, h);
    slope.by += points[i].weight / h * there;
    off -= points[i].k * points[i].weight * there;
    if (i < fourth.size()) lower += fourth[i] / h * there;
    if (there.size() > 0) largest = std::max(largest, there.cwiseAbs().maxCoeff());
  }
  if (at.size() > 0)
    slope.apart = std::max((slope.by - lower).cwiseAbs().maxCoeff(), off.cwiseAbs().maxCoeff() / h);
  const double size = at.size() > 0 ? slope.by.cwiseAbs().maxCoeff() : 0;
  slope.agrees = slope.apart <= 1e-8 * size + rounding * std::max(largest / h, usual);
  return slope;
}

/// By the widest of the widths from h on at which all agree, or that at which they are nearest. A
/// width at which f throws is passed over. @throws what f throws at all of them
template <class F>
Slope slope_of(double h, double rounding, F&& f, double usual = 0) {
  const Eigen::VectorXd at = f(middle, h);
  std::optional<Slope> best;
  std::exception_ptr lost;
  for (int i = 0; i < widths && !(best && best->agrees); ++i, h *= narrower) try {
      Slope slope = slope_at(h, rounding, usual, at, f);
      slope.width = i;
      if (!best || slope.agrees || slope.apart < best->apart || std::isnan(best->apart))
        best = std::move(slope);
    } catch (const std::exception&) {
      lost = std::current_exception();
    }
  if (!best) std::rethrow_exception(lost);
  return *std::move(best);
}

}  // namespace momenta::sixth_order
