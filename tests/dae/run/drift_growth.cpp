// How drifts grow on the planar four-bar: like t for momenta with bounded impulses, like t² for
// accelerations; not at all where positions are corrected. And the order of the method underneath.

#include "equations/ensemble.h"
#include "equations/examples.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/dae/run/run_form.h>

#include <algorithm>
#include <cmath>

namespace momenta::dae_drift_growth {
namespace {

using namespace equations;

const Mechanism& four_bar() {
  static const Mechanism mechanism(equations::example("four_bar"));
  return mechanism;
}

RunResult run(RunSettings settings) {
  RunRequest request;
  request.settings = std::move(settings);
  request.keep_trajectory = true;
  return run_form(four_bar(), equations::start_of(four_bar()), request);
}
RunSettings long_run(const std::string& form, const std::string& gauge, bool project = false) {
  RunSettings s;
  s.form = form;
  s.gauge = gauge;
  s.integrator = "rk4";
  s.step = 0.005;
  s.end_time = 200;
  s.samples = 2000;
  s.project = project;
  return s;
}

TEST(DriftGrowth, LinearForMomentaWithBoundedImpulses) {
  for (const char* gauge : {"leak:3", "leak", "reset"}) {
    const RunResult r = run(long_run("momentum", gauge));
    ASSERT_EQ(r.status, "done") << r.reason;
    // With a reset after each step 200 s are still the plain of the first swings, 4e-8 m.
    if (std::string(gauge) != "reset") {
      EXPECT_GT(r.position_growth.exponent, 0.8) << gauge;
    }
    EXPECT_LT(r.position_growth.exponent, 1.2) << gauge;
    EXPECT_LT(r.velocity_drift_max, 1e-12) << gauge;  // an algebraic row of (7)
    EXPECT_LT(r.position_drift_max, 1e-5) << gauge;
    RecordProperty(std::string(gauge), std::to_string(r.position_growth.exponent));
  }
}

TEST(DriftGrowth, QuadraticForAccelerations) {
  const RunResult r = run(long_run("acceleration", ""));
  ASSERT_EQ(r.status, "done") << r.reason;
  EXPECT_GT(r.position_growth.exponent, 1.7);
  EXPECT_LT(r.position_growth.exponent, 2.3);
  EXPECT_GT(r.velocity_growth.exponent, 0.7);
  EXPECT_LT(r.velocity_growth.exponent, 1.3);
  RecordProperty("acceleration", std::to_string(r.position_growth.exponent));
}

TEST(DriftGrowth, BareImpulsesSpoilTheLaw) {
  // Under gravity σ grows like t without a gauge, the local error with it.
  const RunResult bare = run(long_run("momentum", "none")),
                  leak = run(long_run("momentum", "leak:3"));
  EXPECT_GT(bare.series.impulse.back(), 20 * leak.series.impulse.back());
  EXPECT_GT(bare.position_drift_max, 10 * leak.position_drift_max);
}

TEST(DriftGrowth, CorrectedPositionsStayAtRounding) {
  for (const auto& [form, gauge] : {std::pair{"momentum", "leak:3"}, std::pair{"momentum", "reset"},
                                    std::pair{"projected", ""}, std::pair{"partitioned", ""}}) {
    const RunResult r = run(long_run(form, gauge, true));
    ASSERT_EQ(r.status, "done") << r.reason;
    EXPECT_LT(r.position_drift_max, 1e-14) << form << gauge;
    EXPECT_LT(r.velocity_drift_max, 1e-12) << form << gauge;
    EXPECT_GT(r.position_drift_max, 0) << form << gauge;  // rounding: it was looked at
    EXPECT_GT(r.velocity_drift_max, 0) << form << gauge;
    EXPECT_LT(r.energy_error_max, 0.1) << form << gauge;  // 1e-3 of what moves
    double largest = 0;  // in size, whether energy is gained or lost
    for (const double e : r.series.energy_error) largest = equations::larger(largest, std::abs(e));
    EXPECT_EQ(r.energy_error_max, largest) << form << gauge;
  }
}

TEST(Order, MomentumWithRk4IsOfOrderFour) {
  RunSettings s;
  s.gauge = "leak:3";
  s.rtol = s.atol = 1e-13;
  s.end_time = 1.5;
  s.samples = 50;  // the error crosses zero at single times
  const auto exact = run(s).trajectory.rows;
  for (const char* gauge : {"none", "leak:3", "reset"}) {
    std::vector<double> errors;
    for (const double h : {0.001, 0.0005}) {
      s.gauge = gauge;
      s.integrator = "rk4";
      s.step = h;
      const auto found = run(s).trajectory.rows;
      double error = 0;
      for (std::size_t row = 0; row < exact.size(); ++row)
        for (std::size_t i = 1; i <= 6; ++i)
          error = equations::larger(error, std::abs(found[row][i] - exact[row][i]));
      errors.push_back(error);
    }
    for (std::size_t i = 1; i < errors.size(); ++i) {
      const double order = std::log2(errors[i - 1] / errors[i]);
      EXPECT_NEAR(order, 4, 0.35) << gauge << errors[i];
    }
  }
}

}  // namespace
}  // namespace momenta::dae_drift_growth
