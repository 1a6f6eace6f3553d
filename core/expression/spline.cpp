#include <momenta/core/expression/spline.h>
#include <momenta/core/scalar/all_finite.h>

namespace momenta {

std::string spline_fault(const std::vector<double>& x, const std::vector<double>& y,
                         const std::string& x_name, const std::string& y_name) {
  const std::size_t n = x.size();
  if (n < 2) return x_name + " has fewer than 2 entries, expected at least 2";
  if (y.size() != n)
    return y_name + " has " + std::to_string(y.size()) + " entries and " + x_name + " " +
           std::to_string(n) + ", expected as many";
  if (!all_finite(x) || !all_finite(y)) return x_name + " and " + y_name + " must be finite";
  for (std::size_t i = 1; i < n; ++i)
    if (!(x[i - 1] < x[i]))
      return x_name + "[" + std::to_string(i) + "] is not after " + x_name + "[" +
             std::to_string(i - 1) + "], expected increasing " + x_name;
  return "";
}

namespace {

int sign_of(double x) {
  return x > 0 ? 1 : x < 0 ? -1 : 0;
}

/// Slope at an end from the slopes of the two gaps beside it, h and next wide: that of the parabola
/// through three points, limited to keep the sign.
double end_slope(double h, double next, double slope, double beyond) {
  const double s = ((2 * h + next) * slope - h * beyond) / (h + next);
  if (sign_of(s) != sign_of(slope)) return 0;
  if (sign_of(slope) != sign_of(beyond) && std::abs(s) > 3 * std::abs(slope)) return 3 * slope;
  return s;
}

std::vector<double> monotone_slopes(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t n = x.size();
  const auto gap = [&](std::size_t i) { return x[i + 1] - x[i]; };
  const auto slope = [&](std::size_t i) { return (y[i + 1] - y[i]) / gap(i); };
  if (n == 2) return {slope(0), slope(0)};
  std::vector<double> s(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = slope(i - 1), after = slope(i);
    if (sign_of(before) * sign_of(after) <= 0) continue;
    const double w = 2 * gap(i) + gap(i - 1), v = gap(i) + 2 * gap(i - 1);
    s[i] = (w + v) / (w / before + v / after);
  }
  s.front() = end_slope(gap(0), gap(1), slope(0), slope(1));
  s.back() = end_slope(gap(n - 2), gap(n - 3), slope(n - 2), slope(n - 3));
  return s;
}

}  // namespace

/// Cubics through given slopes, and straight lines outside.
void CubicSpline::go_through(const std::vector<double>& x, const std::vector<double>& y,
                             const std::vector<double>& s) {
  const std::size_t n = x.size();
  knots_ = x;
  segments_.resize(n + 1);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double h = x[i + 1] - x[i], slope = (y[i + 1] - y[i]) / h;
    segments_[i + 1] = {x[i],
                        {y[i], s[i], (3 * slope - 2 * s[i] - s[i + 1]) / h,
                         (s[i] + s[i + 1] - 2 * slope) / (h * h)}};
  }
  segments_.front() = {x.front(), {y.front(), s.front(), 0, 0}};
  segments_.back() = {x.back(), {y.back(), s.back(), 0, 0}};
}

CubicSpline::CubicSpline(const std::vector<double>& x, const std::vector<double>& y,
                         Interpolation between)
    : between_(between) {
  const std::size_t n = x.size();
  if (between == Interpolation::monotone) {
    go_through(x, y, monotone_slopes(x, y));
    return;
  }
  const auto gap = [&](std::size_t i) { return x[i + 1] - x[i]; };
  const auto slope = [&](std::size_t i) { return (y[i + 1] - y[i]) / gap(i); };
  if (between == Interpolation::linear) {
    knots_ = x;
    segments_.resize(n + 1);
    for (std::size_t i = 0; i + 1 < n; ++i) segments_[i + 1] = {x[i], {y[i], slope(i), 0, 0}};
    segments_.front() = segments_[1];
    segments_.back() = {x.back(), {y.back(), slope(n - 2), 0, 0}};
    return;
  }

  // the tridiagonal system of the inner second derivatives, eliminated forwards: mᵢ = right[i] −
  // upper[i] mᵢ₊₁. It is diagonally dominant, so no pivoting is needed.
  std::vector<double> m(n, 0.0), upper(n, 0.0), right(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double pivot = 2 * (gap(i - 1) + gap(i)) - gap(i - 1) * upper[i - 1];
    upper[i] = gap(i) / pivot;
    right[i] = (6 * (slope(i) - slope(i - 1)) - gap(i - 1) * right[i - 1]) / pivot;
  }
  for (std::size_t i = n - 1; i-- > 1;) m[i] = right[i] - upper[i] * m[i + 1];

  // one cubic per gap, and a line on either side
  knots_ = x;
  segments_.resize(n + 1);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double h = gap(i);
    segments_[i + 1] = {
        x[i],
        {y[i], slope(i) - h * (2 * m[i] + m[i + 1]) / 6, m[i] / 2, (m[i + 1] - m[i]) / (6 * h)}};
  }
  const double last = slope(n - 2) + gap(n - 2) * (m[n - 2] + 2 * m[n - 1]) / 6;
  segments_.front() = {x.front(), {y.front(), segments_[1].c[1], 0, 0}};
  segments_.back() = {x.back(), {y.back(), last, 0, 0}};
}

CubicSpline::CubicSpline(const std::vector<double>& times, const std::vector<double>& values,
                         double period)
    : period_(period) {
  const std::size_t n = times.size();
  const auto gap = [&](std::size_t i) {
    return (i + 1 < n ? times[i + 1] : times[0] + period) - times[i];
  };
  const auto slope = [&](std::size_t i) { return (values[(i + 1) % n] - values[i]) / gap(i); };
  const auto jump = [&](std::size_t i) { return 6 * (slope(i) - slope((i + n - 1) % n)); };

  // Rows 1 … n − 1 forwards, mᵢ = right[i] − upper[i] mᵢ₊₁ − round[i] m₀, then backwards from m_n =
  // m₀ to mᵢ = right[i] − round[i] m₀; row 0 gives m₀.
  std::vector<double> upper(n, 0.0), right(n + 1, 0.0), round(n + 1, 0.0), m(n + 1);
  round[0] = round[n] = -1;
  for (std::size_t i = 1; i < n; ++i) {
    const double pivot = 2 * (gap(i - 1) + gap(i)) - gap(i - 1) * upper[i - 1];
    upper[i] = gap(i) / pivot;
    right[i] = (jump(i) - gap(i - 1) * right[i - 1]) / pivot;
    round[i] = -gap(i - 1) * round[i - 1] / pivot;
  }
  for (std::size_t i = n; i-- > 1;) {
    right[i] -= upper[i] * right[i + 1];
    round[i] -= upper[i] * round[i + 1];
  }
  m[0] = m[n] = (jump(0) - gap(n - 1) * right[n - 1] - gap(0) * right[1]) /
                (2 * (gap(n - 1) + gap(0)) - gap(n - 1) * round[n - 1] - gap(0) * round[1]);
  for (std::size_t i = 1; i < n; ++i) m[i] = right[i] - round[i] * m[0];

  knots_ = times;
  segments_.resize(n + 1);
  for (std::size_t i = 0; i < n; ++i) {
    const double h = gap(i);
    segments_[i + 1] = {times[i],
                        {values[i], slope(i) - h * (2 * m[i] + m[i + 1]) / 6, m[i] / 2,
                         (m[i + 1] - m[i]) / (6 * h)}};
  }
  segments_.front() = segments_[1];  // before the first knot by rounding alone
}

}  // namespace momenta
