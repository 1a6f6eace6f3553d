#pragma once
// Derivatives with respect to a number of a scene. It is a plain number there, without derivatives;
// central differences of sixth order, of what follows from it at the same state, take their place,
//
//   f' = [45 (f₁ − f₋₁) − 9 (f₂ − f₋₂) + (f₃ − f₋₃)] / 60h + O(h⁶),    f_k = f(θ + k h).
//
// With h = 2⁻⁸ of the number's size, rounding and truncation leave about 1e-13 of f/θ where f is
// smooth over that and nothing is integrated or iterated. Two more formulas of the same points tell
// whether it is: the difference of fourth order, and the value in the middle,
//
//   f₀ = [45 (f₁ + f₋₁) − 18 (f₂ + f₋₂) + 3 (f₃ + f₋₃)] / 60 + O(h⁶),
//
// The first fails for a fault odd about θ, the second for an even one. Where one is off by more
// than rounding (many turns or a corner within 3h), narrower widths follow. Source: Fornberg,
// Generation of finite difference formulas, Math. Comp. 51 (1988).

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <exception>
#include <optional>
#include <utility>

namespace momenta::sixth_order {

inline constexpr double part = 1.0 / 256;  ///< h over the size of a number

struct Point {
  int k = 0;          ///< f is taken at θ + k h
  double weight = 0;  ///< weight of f there, over h
};
inline constexpr std::array<Point, 6> points{{{1, 45.0 / 60},
                                              {-1, -45.0 / 60},
                                              {2, -9.0 / 60},
                                              {-2, 9.0 / 60},
                                              {3, 1.0 / 60},
                                              {-3, -1.0 / 60}}};
/// Weights of the fourth order, for the first four points.
inline constexpr std::array<double, 4> fourth{8.0 / 12, -8.0 / 12, -1.0 / 12, 1.0 / 12};

/// Index of θ itself, behind those of `points`.
inline constexpr std::size_t middle = points.size();
/// k of θ + k h at this index.
constexpr int k_of(std::size_t point) {
  return point == middle ? 0 : points[point].k;
}

inline constexpr int widths = 6;             ///< h, h/8, …, h/32768
inline constexpr double narrower = 1.0 / 8;  ///< each width over the one before
inline constexpr double read = 1e-14;        ///< rounding of numbers as they are read
inline constexpr double exact = 1e-13;       ///< rounding of what is computed, not iterated
inline constexpr double iterated = 1e-10;    ///< error of poses that are solved for

/// f' with one width.
struct Slope {
  Eigen::VectorXd by;   ///< f' of sixth order
  double apart = 0;     ///< largest deviation of the other two formulas
  int width = 0;        ///< how often h was narrowed
  bool agrees = false;  ///< all three formulas do, to rounding: f is smooth over 3h
};

/// f' with the width h from f(i, h), f at θ + k_of(i) h; `at`: f at θ. `rounding`: relative to the
/// largest value of f, or to `usual`, the size of f' at other states.
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

/// f' with the widest width, from h on, at which all formulas agree, else the one at which they are
/// nearest. Widths at which f throws are skipped. @throws what f throws at all of them
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
