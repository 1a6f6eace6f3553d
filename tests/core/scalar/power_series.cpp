// Taylor coefficients against series known in closed form, and against derivatives of derivatives.

#include <gtest/gtest.h>
#include <momenta/core/scalar/power_series.h>

namespace momenta::core_power_series {
namespace {

using S = PowerSeries<6>;
constexpr double eps = 4e-15;

S along(double at, double slope = 1) {
  S x(at);
  x.c[1] = slope;
  return x;
}

TEST(PowerSeries, KnownExpansions) {
  const double x = 0.7;
  const S sine = sin(along(x)), cosine = cos(along(x)), root = sqrt(along(x)),
          inverse = S(1.0) / along(x);
  double factorial = 1, binomial = 1;
  for (int k = 0; k <= 6; ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (k > 0) factorial *= k;
    EXPECT_NEAR(sine.c[at], std::sin(x + k * M_PI / 2) / factorial, eps) << k;
    EXPECT_NEAR(cosine.c[at], std::cos(x + k * M_PI / 2) / factorial, eps) << k;
    EXPECT_NEAR(inverse.c[at] * std::pow(x, k + 1), k % 2 ? -1 : 1, eps) << k;
    if (k > 0) binomial *= (0.5 - (k - 1)) / k;
    EXPECT_NEAR(root.c[at] * std::pow(x, k - 0.5), binomial, eps) << k;
  }
}

TEST(PowerSeries, IdentitiesHoldTermByTerm) {
  S x(0.4), y(1.3);
  for (std::size_t k = 1; k < S::terms; ++k) {
    x.c[k] = 0.3 - 0.1 * static_cast<double>(k);
    y.c[k] = 0.2 * static_cast<double>(k) - 0.5;
  }
  const S one = sin(x) * sin(x) + cos(x) * cos(x), same = x / y * y, square = sqrt(y) * sqrt(y),
          sum = sin(x + y) - (sin(x) * cos(y) + cos(x) * sin(y));
  for (std::size_t k = 0; k < S::terms; ++k) {
    EXPECT_NEAR(one.c[k], k == 0, 10 * eps) << k;
    EXPECT_NEAR(same.c[k], x.c[k], 10 * eps) << k;
    EXPECT_NEAR(square.c[k], y.c[k], 10 * eps) << k;
    EXPECT_NEAR(sum.c[k], 0, 10 * eps) << k;
  }
}

/// f(x, y) of kernels' operations, on any scalar.
template <class T>
T formula(const T& x, const T& y) {
  return sin(x * y) / (2.0 + cos(x)) + sqrt(x * x + y * y) * (y - 0.5 * x);
}

TEST(PowerSeries, AgreesWithNestedDualNumbers) {
  using D1 = Dual<double, 1>;
  using D2 = Dual<D1, 1>;
  using D3 = Dual<D2, 1>;
  // x = 0.4 + 2 s, y = 1.1 − s: every level of dual numbers differentiates by s once more.
  const auto line = [](double at, double slope) {
    D3 x(at);
    x.b[0] = D2(slope);
    x.a.b[0] = D1(slope);
    x.a.a.b[0] = slope;
    return x;
  };
  const D3 slow = formula(line(0.4, 2), line(1.1, -1));
  const S fast = formula(along(0.4, 2), along(1.1, -1));
  EXPECT_NEAR(fast.c[0], slow.a.a.a, eps);
  EXPECT_NEAR(fast.c[1], slow.a.a.b[0], 10 * eps);
  EXPECT_NEAR(2 * fast.c[2], slow.a.b[0].b[0], 100 * eps);
  EXPECT_NEAR(6 * fast.c[3], slow.b[0].b[0].b[0], 1000 * eps);
}

TEST(PowerSeries, DirectionsAreDerivativesOfCoefficients) {
  using J = Dual<S, 1>;
  const S x0 = along(0.4, 2), y0 = along(1.1, -1);
  J x, y;
  x.a = x0;
  y.a = y0;
  x.b[0] = S(1.0);  // x + ε
  const J exact = formula(x, y);
  const double h = 1e-6;
  const S above = formula(S(h) + x0, y0), below = formula(x0 - S(h), y0);
  for (std::size_t k = 0; k < S::terms; ++k)
    EXPECT_NEAR(exact.b[0].c[k], (above.c[k] - below.c[k]) / (2 * h),
                1e-8 * (1 + std::abs(exact.b[0].c[k])))
        << k;
}

TEST(PowerSeries, TimeRunsAlongTheCurve) {
  EXPECT_EQ(Moment<double>::at(2), 2);
  EXPECT_EQ(Moment<Dual8>::at(2).b, Dual8(2.0).b);
  EXPECT_EQ(Moment<S>::at(2).c, along(2).c);
  EXPECT_EQ(Moment<Jet>::at(2).a.c[1], 1);
}

}  // namespace
}  // namespace momenta::core_power_series
