// Runs of ten seconds through singular poses and along redundant loops: judged by the worst of many
// step sizes and orientations, never by one run.

#include "equations/ensemble.h"
#include "equations/linkages.h"
#include "equations/random_tree.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/scene/read_scene.h>
#include <momenta/dae/assembly/assembly.h>
#include <momenta/dae/solver/integration.h>

#include <filesystem>
#include <numbers>

namespace momenta {
namespace {

using namespace equations;
using Eigen::VectorXd;

struct Outcome {
  Snapshot end;
  double energy_error = 0, position_drift = 0;
};

/// Ten seconds of the momentum form with rk4 at step h.
Outcome ten_seconds(const Mechanism& mechanism, double h, double leak, bool project) {
  const Start start = equations::start_of(mechanism);
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

TEST(SingularRuns, RowOfFourBarsThroughItsFlatPoses) {
  const int n = 40;
  const double exact = row_angle(n, std::numbers::pi / 2, -1);
  for (const double angle : {0.0, 0.7}) {
    const Mechanism mechanism(turned_by(row_of_four_bars(n, std::numbers::pi / 2, -1), angle));
    ASSERT_EQ(mechanism.kkt(), KktChoice::sweeps);
    double error = 0, energy = 0;
    for (int i = 0; i < 20; ++i) {
      const Outcome run = ten_seconds(mechanism, 0.6e-3 + i * 0.6e-3 / 19, 3, true);
      error = std::max(error, std::abs(run.end.q[0] - exact));
      energy = std::max(energy, run.energy_error);
    }
    EXPECT_LT(error, 1e-5) << "turned by " << angle;
    EXPECT_LT(energy, 1e-3) << "turned by " << angle;
    RecordProperty("error at " + std::to_string(angle), std::to_string(error * 1e9) + "e-9");
    RecordProperty("energy at " + std::to_string(angle), std::to_string(energy * 1e9) + "e-9");
  }
}

TEST(SingularRuns, EqualLinkSliderCrankAtItsBifurcation) {
  const Scene scene =
      read_scene(std::filesystem::path(MOMENTA_SOURCE_DIR) / "examples/slider_crank/scene.toml");
  const double exact = 20.4724231148819971;  // the last line of its reference.csv
  for (const double angle : {0.0, 0.7}) {
    const Mechanism mechanism(turned_by(scene, angle));
    double error = 0;
    for (int i = 0; i < 40; ++i)
      error = std::max(
          error,
          std::abs(ten_seconds(mechanism, 0.65e-3 + i * 0.35e-3 / 39, 3, true).end.q[0] - exact));
    EXPECT_LT(error, 1e-7) << "turned by " << angle;  // worst of 40
    RecordProperty("error at " + std::to_string(angle), std::to_string(error * 1e9) + "e-9");
  }
}

TEST(SingularRuns, BricardAlwaysRedundant) {
  RandomTree random(1);
  for (const bool is_turned : {false, true}) {
    Scene scene = bricard();
    if (is_turned) scene = turned(scene, random.turn());
    const Mechanism mechanism(scene);
    ASSERT_EQ(mechanism.kkt(), KktChoice::sweeps);
    const Outcome run = ten_seconds(mechanism, 5e-4, 30, false);
    EXPECT_LT(run.position_drift, 1e-12);
    EXPECT_LT(run.energy_error, 1e-11);
    RecordProperty(is_turned ? "turned" : "aligned",
                   std::to_string(run.energy_error * 1e15) + "e-15");
  }
}

}  // namespace
}  // namespace momenta
