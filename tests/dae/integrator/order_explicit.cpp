// Halving the step divides the error by 2^order: end values, and dense output inside one step.
//
//   u' = 2 t u ln v,  v' = -2 t v ln u,  u(0) = 1, v(0) = e:  u = exp(sin t²), v = exp(cos t²)
//
// is nonlinear and non-autonomous, so that all trees of the order conditions take part.
// So is a mechanism whose states are corrected after each step: the four-bar, positions projected
// and the gauge reset. Source of the problem: Hairer, Norsett, Wanner, Solving Ordinary
// Differential Equations I, II.1.

#include <gtest/gtest.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/integrator/integration.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "equations/examples.h"
#include "equations/tolerance.h"

namespace momenta::dae_order_explicit {
namespace {

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

/// Largest error inside one step of length h from an exact start. At 0 the problem is odd or even,
/// and some error terms vanish.
double dense_error(const std::string& method, double start, double h) {
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
      worst = equations::larger(worst, error(t, y));
    }
    return true;
  };
  integrate_explicit(method, system, start, exact(start), {start + h}, options, observer);
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
  EXPECT_NEAR(slope(end_error("vern9", 5, 128), end_error("vern9", 5, 256), 1), 9, 0.3);
}

TEST(ExplicitOrder, DenseOutput) {
  // An interpolant of order p is off by h^(p+1) in one step: rk4 3, dp5 4, dop853 7,
  // vern9 8. For vern9 later, where the motion is faster and errors stay above rounding.
  EXPECT_NEAR(slope(dense_error("rk4", 0.4, 0.1), dense_error("rk4", 0.4, 0.0125), 3), 4, 0.3);
  EXPECT_NEAR(slope(dense_error("dp5", 0.4, 0.1), dense_error("dp5", 0.4, 0.0125), 3), 5, 0.3);
  EXPECT_NEAR(slope(dense_error("dop853", 0.4, 0.2), dense_error("dop853", 0.4, 0.05), 2), 8, 0.3);
  EXPECT_NEAR(slope(dense_error("vern9", 4, 0.1), dense_error("vern9", 4, 0.025), 2), 9, 0.3);
}

/// The four-bar after 2 s: its state with fixed steps, or, with step 0, to a tolerance of 1e-14.
std::vector<double> four_bar(const std::string& method, double step) {
  const Mechanism mechanism(equations::example("four_bar"));
  const Assembly assembly = assemble(mechanism);
  FormOptions corrected;
  corrected.gauge = parse_gauge("reset");
  corrected.project = true;
  const auto form = make_form("momentum", mechanism, corrected, assembly.start);
  IntegrationOptions options;
  options.step = step;
  options.rtol = options.atol = 1e-14;
  const IntegrationResult r = integrate_explicit(method, *form->ode(), 0,
                                                 form->initial(assembly.start), {2.0}, options, {});
  EXPECT_TRUE(r.done) << r.reason;
  return r.y;
}

TEST(ExplicitOrder, MechanismWithCorrectedStates) {
  const std::vector<double> truth = four_bar("dop853", 0);
  const auto error = [&](const std::string& method, double step) {
    const std::vector<double> y = four_bar(method, step);
    double largest = 0;
    for (std::size_t i = 0; i < y.size(); ++i)
      largest = equations::larger(largest, std::abs(y[i] - truth[i]));
    return largest;
  };
  EXPECT_NEAR(slope(error("dop853", 1.0 / 16), error("dop853", 1.0 / 32), 1), 8, 0.3);
  EXPECT_NEAR(slope(error("vern9", 1.0 / 16), error("vern9", 1.0 / 32), 1), 9, 0.3);
}

}  // namespace

}  // namespace momenta::dae_order_explicit
