// What Gauss collocation keeps on the canonical form.
//
//   Sᵀ J S = J, S = ∂y_1/∂y_0 of one step: without loops, and with them on all of R²ⁿ in a free
//   gauge ρF (FΦ_h)ⁿ ρF (FΦ_h)ⁿ = 1: with gauge flip F the method is reversible, ρ: p → −p the
//   energy error has no trend, where that of rk4 has one, and that of reset a small one
//
// S by central differences, the slow and obvious way.

#include <gtest/gtest.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/integrator/implicit_methods.h>
#include <momenta/dae/run/run_form.h>

#include "equations/ensemble.h"
#include "equations/examples.h"
#include "equations/linkages.h"
#include "equations/runs.h"
#include "equations/tolerance.h"

#include <numbers>
#include <numeric>

namespace momenta::dae_symplectic {
namespace {

using namespace equations;
using Eigen::MatrixXd;

/// `lift` from hanging at rest [rad]: small, and the motion is regular.
Scene double_pendulum(double lift) {
  Scene s;
  s.name = "double pendulum";
  s.gravity = {0, -9.81, 0};
  s.bodies = {rod("upper"), rod("lower")};
  s.joints = {hinge("A", "ground", "upper", {0, 0, 0}, lift - std::numbers::pi / 2),
              hinge("B", "upper", "lower", {1, 0, 0}, 0.5 * lift)};
  return s;
}

struct Canonical {
  Mechanism mechanism;
  Start start;
  std::unique_ptr<Form> form;
  Canonical(const Scene& scene, const std::string& gauge)
      : mechanism(scene), start(equations::start_of(mechanism)) {
    FormOptions options;
    options.gauge = parse_gauge(gauge);
    form = make_form("momentum", mechanism, options, start);
  }
  /// So many steps of length h from y.
  std::vector<double> steps(const std::string& method, const std::vector<double>& y, double h,
                            int count) {
    IntegrationOptions options;
    options.step = h;
    const std::vector<double> end{h * count};
    const auto run =
        method == "rattle" ? integrate_rattle(*form->ode(), 0, y, end, options, {})
        : method == "rk4"
            ? integrate_explicit(method, *form->ode(), 0, y, end, options, {})
            : integrate_gauss(method == "gauss4" ? 2 : 3, *form->ode(), 0, y, end, options, {});
    EXPECT_TRUE(run.done) << run.reason;
    EXPECT_EQ(run.counters.steps, count);
    return run.y;
  }
};

/// Largest entry of Sᵀ J S − J for one step, q and p in units of the mechanism's own size.
double defect(Canonical& c, const std::string& method, double h) {
  // Somewhere in the middle of the motion.
  const auto y0 = c.steps("gauss6", c.form->initial(c.start), 0.01, 60);
  const auto n = static_cast<Eigen::Index>(y0.size());
  MatrixXd s(n, n);
  const double d = 1e-5;
  for (Eigen::Index i = 0; i < n; ++i) {
    auto ahead = y0, behind = y0;
    ahead[static_cast<std::size_t>(i)] += d;
    behind[static_cast<std::size_t>(i)] -= d;
    const auto a = c.steps(method, ahead, h, 1), b = c.steps(method, behind, h, 1);
    for (Eigen::Index k = 0; k < n; ++k)
      s(k, i) = (a[static_cast<std::size_t>(k)] - b[static_cast<std::size_t>(k)]) / (2 * d);
  }
  MatrixXd j = MatrixXd::Zero(n, n);
  j.topRightCorner(n / 2, n / 2).setIdentity();
  j.bottomLeftCorner(n / 2, n / 2) = -MatrixXd::Identity(n / 2, n / 2);
  return (s.transpose() * j * s - j).cwiseAbs().maxCoeff();
}

TEST(Symplectic, GaussWithAndWithoutLoops) {
  for (const Scene& scene : {double_pendulum(2), equations::example("four_bar")}) {
    Canonical c(scene, "none");
    const double h = 0.05;
    // d² of the difference, ε/d of rounding
    EXPECT_LT(defect(c, "gauss4", h), 2e-7) << scene.name;
    EXPECT_LT(defect(c, "gauss6", h), 2e-7) << scene.name;
    EXPECT_GT(defect(c, "rk4", h), 1e-5) << scene.name;  // and the law can fail
  }
}

/// A state of the constraint manifold of the four-bar, one degree of freedom: at crank angle and
/// rate, p = M u.
std::vector<double> four_bar_state(const std::vector<double>& near, double angle, double rate) {
  Scene scene = equations::example("four_bar");
  const Mechanism shape(scene);
  for (std::size_t i = 0; i < scene.joints.size(); ++i) scene.joints[i].position = {near[i]};
  scene.joints[0].position = {angle};
  scene.joints[0].velocity = {rate};
  scene.held = {scene.joints[0].name};
  const Mechanism mechanism(scene);
  const Start start = equations::start_of(mechanism);
  return make_form("momentum", mechanism, {}, start)->initial(start);
}

TEST(Symplectic, RattleOnTheConstraintManifold) {
  Canonical c(equations::example("four_bar"), "reset");
  const double h = 0.02, d = 1e-5;
  const auto middle = c.steps("rattle", c.form->initial(c.start), h, 20);
  Snapshot now;
  ASSERT_TRUE(c.form->read(0, middle.data(), nullptr, now));
  const double angle = now.q[0], rate = now.u[0];
  const auto difference = [&](double along_angle, double along_rate, int steps) {
    auto a = four_bar_state(middle, angle + d * along_angle, rate + d * along_rate);
    auto b = four_bar_state(middle, angle - d * along_angle, rate - d * along_rate);
    if (steps > 0) a = c.steps("rattle", a, h, steps), b = c.steps("rattle", b, h, steps);
    Eigen::VectorXd x(static_cast<Eigen::Index>(a.size()));
    for (std::size_t i = 0; i < a.size(); ++i)
      x[static_cast<Eigen::Index>(i)] = (a[i] - b[i]) / (2 * d);
    return x;
  };
  const auto form = [](const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
    const Eigen::Index n = x.size() / 2;
    return x.head(n).dot(y.tail(n)) - x.tail(n).dot(y.head(n));
  };
  const double before = form(difference(1, 0, 0), difference(0, 1, 0));
  const double after = form(difference(1, 0, 30), difference(0, 1, 30));
  EXPECT_GT(std::abs(before), 0.1);
  EXPECT_NEAR(after, before, 1e-6 * std::abs(before));
}

double far_from_start(const std::string& gauge, const std::string& method, int count) {
  Canonical c(equations::example("four_bar"), gauge);
  const double h = 0.02;
  const auto start = c.form->initial(c.start);
  const auto turn = [&](std::vector<double> y) {
    bool changed = false;
    if (c.form->ode()->has_after_step()) {
      EXPECT_TRUE(c.form->ode()->after_step(0, y.data(), changed));
    }
    for (std::size_t i = static_cast<std::size_t>(c.mechanism.nq()); i < y.size(); ++i)
      y[i] = -y[i];
    return y;
  };
  const auto back = turn(c.steps(method, turn(c.steps(method, start, h, count)), h, count));
  double worst = 0;
  for (std::size_t i = 0; i < back.size(); ++i)
    worst = equations::larger(worst, std::abs(back[i] - start[i]) / (1 + std::abs(start[i])));
  return worst;
}

TEST(Reversible, GaussWithFlippedGauge) {
  EXPECT_LT(far_from_start("flip", "gauss4", 200), 1e-10);
  EXPECT_LT(far_from_start("flip", "gauss6", 200), 1e-10);
  EXPECT_LT(far_from_start("none", "rattle", 200), 1e-9);
  EXPECT_GT(far_from_start("reset", "gauss4", 200), 1e-8);
  EXPECT_GT(far_from_start("flip", "rk4", 200), 1e-6);
}

/// Mean of the energy error over the last quarter less that over the first, and the largest error.
std::pair<double, double> trend(const Scene& scene, const std::string& integrator,
                                const std::string& gauge, double step, double end) {
  const Mechanism mechanism(scene);
  const RunResult run = run_form(mechanism, equations::start_of(mechanism),
                                 equations::stepped("momentum", integrator, gauge, step, end,
                                                    static_cast<int>(std::lround(end / step / 4))));
  EXPECT_EQ(run.status, "done") << run.reason;
  const auto& e = run.series.energy_error;
  const auto quarter = static_cast<std::ptrdiff_t>(e.size() / 4);
  const double first = std::accumulate(e.begin(), e.begin() + quarter, 0.0),
               last = std::accumulate(e.end() - quarter, e.end(), 0.0);
  return {(last - first) / static_cast<double>(quarter), run.energy_error_max};
}

TEST(EnergyOverLongTimes, HasNoTrendWithGauss) {
  for (const auto& [method, step] : {std::pair{"gauss4", 0.02}, std::pair{"gauss6", 0.04}}) {
    const auto [slope, largest] = trend(equations::example("four_bar"), method, "flip", step, 1600);
    EXPECT_LT(std::abs(slope), 0.02 * largest) << method;
    EXPECT_LT(largest, 1e-3) << method;
  }
  const auto [second, second_largest] =
      trend(equations::example("four_bar"), "rattle", "reset", 0.005, 100);
  EXPECT_LT(std::abs(second), 0.02 * second_largest);
  EXPECT_LT(second_largest, 0.1);
  const auto [rk4, rk4_largest] = trend(equations::example("four_bar"), "rk4", "flip", 0.02, 400);
  EXPECT_GT(std::abs(rk4), 0.5 * rk4_largest);
  EXPECT_GT(rk4_largest, 0.1);
  const auto [reset, reset_largest] =
      trend(equations::example("four_bar"), "gauss4", "reset", 0.02, 400);
  EXPECT_GT(std::abs(reset), 0.2 * reset_largest);

  const auto [open, open_largest] = trend(double_pendulum(0.7), "gauss4", "none", 0.05, 400);
  EXPECT_LT(std::abs(open), 0.05 * open_largest);
  const auto [open_rk4, open_rk4_largest] = trend(double_pendulum(0.7), "rk4", "none", 0.05, 400);
  EXPECT_GT(std::abs(open_rk4), 0.5 * open_rk4_largest);
}

}  // namespace
}  // namespace momenta::dae_symplectic
