// Halving the step divides the error by 2^order: end values, and dense output inside one step.
//
//   u' = 2 t u ln v,  v' = -2 t v ln u,  u(0) = 1, v(0) = e:  u = exp(sin t²), v = exp(cos t²)
//
// is nonlinear and non-autonomous, so that all trees of the order conditions take part.
// Source of the problem: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, II.1.

#include <gtest/gtest.h>
#include <momenta/dae/solver/integration.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace {

using namespace momenta;

class Spiral : public OdeSystem {
 public:
  int size() const override { return 2; }
  bool rhs(double t, const double* y, double* ydot) override {
    ydot[0] = 2 * t * y[0] * std::log(y[1]);
    ydot[1] = -2 * t * y[1] * std::log(y[0]);
    return true;
  }
};

std::vector<double> exact(double t) {
  return {std::exp(std::sin(t * t)), std::exp(std::cos(t * t))};
}
double error(double t, const double* y) {
  const std::vector<double> truth = exact(t);
  return std::max(std::abs(y[0] - truth[0]), std::abs(y[1] - truth[1]));
}

double end_error(const std::string& method, double end, int steps) {
  Spiral system;
  IntegrationOptions options;
  options.step = end / steps;
  const IntegrationResult r = integrate_explicit(method, system, 0, exact(0), {end}, options, {});
  EXPECT_TRUE(r.done) << r.reason;
  EXPECT_EQ(r.counters.steps, steps);
  return error(end, r.y.data());
}

/// Largest error inside one step of length h from an exact start.
double dense_error(const std::string& method, double h) {
  Spiral system;
  IntegrationOptions options;
  options.step = h;
  double worst = 0;
  Observer observer;
  observer.step = [&](double t0, double t1, const Interpolant& between) {
    for (int i = 1; i < 20; ++i) {
      double y[2];
      const double t = t0 + (t1 - t0) * i / 20;
      between(t, y);
      worst = std::max(worst, error(t, y));
    }
    return true;
  };
  // 0.4 and not 0: the problem is odd or even there, and some error terms vanish.
  integrate_explicit(method, system, 0.4, exact(0.4), {0.4 + h}, options, observer);
  return worst;
}

double slope(double coarse, double fine, double halvings) {
  return std::log2(coarse / fine) / halvings;
}

TEST(ExplicitOrder, EndValues) {
  // Steps in the asymptotic range, errors well above rounding. The h⁸ term of dop853 is so small
  // that the h⁹ term still shows (slopes 8.6, 8.2 before rounding ends the ladder): hence the
  // longer run.
  EXPECT_NEAR(slope(end_error("rk4", 1.5, 64), end_error("rk4", 1.5, 512), 3), 4, 0.3);
  EXPECT_NEAR(slope(end_error("dp5", 1.5, 32), end_error("dp5", 1.5, 256), 3), 5, 0.3);
  EXPECT_NEAR(slope(end_error("dop853", 3, 64), end_error("dop853", 3, 128), 1), 8, 0.3);
}

TEST(ExplicitOrder, DenseOutput) {
  // An interpolant of order p is off by h^(p+1) in one step: rk4 3, dp5 4, dop853 7.
  EXPECT_NEAR(slope(dense_error("rk4", 0.1), dense_error("rk4", 0.0125), 3), 4, 0.3);
  EXPECT_NEAR(slope(dense_error("dp5", 0.1), dense_error("dp5", 0.0125), 3), 5, 0.3);
  EXPECT_NEAR(slope(dense_error("dop853", 0.2), dense_error("dop853", 0.05), 2), 8, 0.3);
}

}  // namespace
