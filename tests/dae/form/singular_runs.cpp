// Runs of ten seconds through singular poses and along redundant loops, over many step sizes and
// orientations, each from a start of its own (equations/ensemble.h). The error that a pose leaves
// goes with 1 / distance of the nearest step, so of N runs the worst has some N times the median:
// quantiles are bound tightly, the worst by that law.

#include "equations/ensemble.h"
#include "equations/examples.h"
#include "equations/linkages.h"
#include "equations/random_tree.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/integrator/integration.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <cstdio>
#include <numbers>

namespace momenta::dae_singular_runs {
namespace {

using namespace equations;
using Eigen::VectorXd;

struct Outcome {
  Snapshot end;
  double energy_error = 0, position_drift = 0;
};

/// Ten seconds of the momentum form with rk4 at step h.
Outcome ten_seconds(const Mechanism& mechanism, const Start& start, double h, double leak,
                    bool project) {
  FormOptions options;
  options.gauge = {Gauge::Kind::leak, leak};
  options.project = project;
  const auto form = make_form("momentum", mechanism, options, start);
  const auto e = mechanism.evaluation<double>();
  const auto energy = [&](const VectorXd& q, const VectorXd& u) {
    e->place(0, q.data());
    e->move(u.data());
    return e->kinetic() + e->potential(q.data());
  };
  const double before = energy(start.q, start.u);
  const int steps = static_cast<int>(std::ceil(10 / h));
  const auto run = integrate_explicit("rk4", *form->ode(), 0, form->initial(start), {10.0},
                                      {.step = 10.0 / steps}, {});
  EXPECT_TRUE(run.done) << run.reason;
  Outcome result;
  EXPECT_TRUE(form->read(10, run.y.data(), nullptr, result.end));
  result.energy_error = std::abs(energy(result.end.q, result.end.u) - before);
  VectorXd phi(mechanism.m());
  e->positions(phi.data());
  result.position_drift = phi.cwiseAbs().maxCoeff();
  return result;
}

Scene turned_by(const Scene& scene, double angle) {
  return turned(scene, Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ())));
}

/// θ of θ'' = −λ cos θ after ten seconds: the wanted motion of a row of N four-bars.
double row_angle(int n, double angle, double rate) {
  const long double lambda = 9.81L * 3 * (3 * n + 1) / (2 * (4 * n + 1)), h = 1e-3L;
  long double x = angle, v = rate;
  const auto f = [&](long double at) { return -lambda * std::cos(at); };
  for (int i = 0; i < 10000; ++i) {  // Nyström's method of order 5
    const long double k1 = f(x), k2 = f(x + h * v / 5 + h * h * k1 / 50),
                      k3 = f(x + 2 * h * v / 3 + h * h * (-k1 / 27 + 7 * k2 / 27)),
                      k4 = f(x + h * v + h * h * (3 * k1 / 10 - 2 * k2 / 35 + 9 * k3 / 35));
    x += h * v + h * h * (14 * k1 + 100 * k2 + 54 * k3) / 336;
    v += h * (14 * k1 + 125 * k2 + 162 * k3 + 35 * k4) / 336;
  }
  return static_cast<double>(x);
}

/// Errors of an ensemble: its median within `median`, its worst within as many times that as there
/// are members.
void expect_within(const std::vector<double>& errors, double median, const std::string& what) {
  EXPECT_LT(quantile(errors, 0.5), median) << what;
  EXPECT_LT(quantile(errors, 0.75), 4 * median) << what;
  EXPECT_LT(quantile(errors, 1), static_cast<double>(errors.size()) * median) << what;
  char text[80];
  std::snprintf(text, sizeof text, "median %.1e, worst %.1e", quantile(errors, 0.5),
                quantile(errors, 1));
  testing::Test::RecordProperty(what, text);
}

TEST(SingularRuns, RowOfFourBarsThroughItsFlatPoses) {
  const int n = 40;
  const double exact = row_angle(n, std::numbers::pi / 2, -1);
  for (const double angle : {0.0, 0.7}) {
    const Mechanism mechanism(turned_by(row_of_four_bars(n, std::numbers::pi / 2, -1), angle));
    ASSERT_EQ(mechanism.solver().kkt(), KktChoice::sweeps);
    std::vector<double> errors, energies;
    for (const Start& start : starts_of(mechanism)) {
      const double h = 0.6e-3 + static_cast<double>(errors.size()) * 0.6e-3 / 19;
      const Outcome run = ten_seconds(mechanism, start, h, 3, true);
      errors.push_back(std::abs(run.end.q[0] - exact));
      energies.push_back(run.energy_error);
    }
    const std::string where = " turned by " + std::to_string(angle);
    expect_within(errors, 1e-6, "angle" + where);
    expect_within(energies, 1e-4, "energy" + where);
  }
}

TEST(SingularRuns, EqualLinkSliderCrankAtItsBifurcation) {
  const Scene scene = equations::example("slider_crank");
  const double exact = 20.4724231148819971;  // the last line of its reference.csv
  for (const double angle : {0.0, 0.7}) {
    const Mechanism mechanism(turned_by(scene, angle));
    std::vector<double> errors;
    for (const Start& start : starts_of(mechanism, 40)) {
      const double h = 0.65e-3 + static_cast<double>(errors.size()) * 0.35e-3 / 39;
      errors.push_back(std::abs(ten_seconds(mechanism, start, h, 3, true).end.q[0] - exact));
    }
    expect_within(errors, 1e-8, "angle turned by " + std::to_string(angle));
  }
}

TEST(SingularRuns, BricardAlwaysRedundant) {
  RandomTree random(1);
  for (const bool is_turned : {false, true}) {
    Scene scene = bricard();
    if (is_turned) scene = turned(scene, random.turn());
    const Mechanism mechanism(scene);
    ASSERT_EQ(mechanism.solver().kkt(), KktChoice::sweeps);
    std::vector<double> drifts, energies;
    for (const Start& start : starts_of(mechanism, 10)) {
      const Outcome run = ten_seconds(mechanism, start, 5e-4, 30, false);
      drifts.push_back(run.position_drift);
      energies.push_back(run.energy_error);
    }
    const std::string where = is_turned ? " turned" : " aligned";
    expect_within(drifts, 2e-13, "drift" + where);
    expect_within(energies, 5e-12, "energy" + where);
  }
}

}  // namespace
}  // namespace momenta::dae_singular_runs
