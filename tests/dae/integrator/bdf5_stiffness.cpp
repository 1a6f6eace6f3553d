// bdf5 where F is stiff: what a filter leaves of an error, starts beside dampers of any size, and
// oscillations of many periods.

#include "equations/ensemble.h"
#include "equations/examples.h"

#include <gtest/gtest.h>
#include <momenta/dae/integrator/bdf_step.h>
#include <momenta/dae/integrator/local_newton.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/study/extremes.h>

#include <cmath>

namespace momenta::dae_bdf5_stiffness {
namespace {

/// y' = −(y − cos t)/τ, a off cos t at the start.
class Relaxation final : public DaeSystem {
 public:
  Relaxation(double tau, double a) : tau_(tau), a_(a) {}
  int size() const override { return 1; }
  bool residual(double t, const double* y, const double* ydot, double* r) override {
    r[0] = ydot[0] + (y[0] - std::cos(t)) / tau_;
    return true;
  }
  bool jacobian(double, const double*, const double*, double c, double* j) override {
    j[0] = 1 / tau_ + c;
    return true;
  }
  const JacobianPattern& pattern() const override { return pattern_; }
  bool start(double, double* y, double* ydot) override {
    y[0] = 1 + a_, ydot[0] = -a_ / tau_;
    return true;
  }
  bool differential(int) const override { return true; }
  double scale(int) const override { return 1; }

 private:
  JacobianPattern pattern_;
  double tau_, a_;
};

// One step of implicit Euler, by hand: y_1 − (y_0 + h y'_0), half of it the error, divided by
// 1 + h/τ for each filter where that leaves less than a tenth.
TEST(Bdf5, WhatFiltersLeaveOfAnError) {
  constexpr double tau = 1e-6, a = 1e-5, tol = 1e-8;
  for (const double h : {1e-7, 1e-5, 1e-3})
    for (const int filters : {1, 2}) {
      Relaxation system(tau, a);
      double y = 0, ydot = 0;
      ASSERT_TRUE(system.start(0, &y, &ydot));
      BdfStep step(system, tol, tol);
      step.begin(0, &y, &ydot);
      ASSERT_EQ(step.attempt(h, 1, true, {1, filters}), BdfStep::Outcome::solved);
      const double end = (1 + a + h / tau * std::cos(h)) / (1 + h / tau),
                   error = 0.5 * std::abs(end - (1 + a - h * a / tau)) / (tol * (2 + a)),
                   share = std::pow(1 + h / tau, -filters),
                   left = error > 1 && share < 0.1 ? error * share : error;
      EXPECT_NEAR(step.error(), left, 1e-6 * left) << h << " " << filters;
    }
}

JointSpec& rocker_of(Scene& scene) {
  for (JointSpec& joint : scene.joints)
    if (joint.name == "C") return joint;
  throw std::logic_error("no joint C");
}

RunResult run(const Scene& scene, const std::string& form, const std::string& integrator,
              const std::string& gauge, double tolerance, double end) {
  return equations::run_of(Mechanism(scene), form, integrator, gauge, tolerance, end, 300);
}

// A damper of 10⁸ N m s/rad stops the mechanism within 10⁻⁸ s: the transient is of the size of the
// tolerance, and steps that would resolve it are of the size of rounding.
TEST(Bdf5, StartsBesideADamperOfAnySize) {
  for (const double damping : {1e5, 1e6, 1e7, 1e8, 1e9, 1e10}) {
    Scene scene = equations::example("four_bar");
    rocker_of(scene).damping = damping;
    // Powers of such a damper at rates within the tolerance are none of the motion's.
    const Mechanism mechanism(scene);
    for (const Start& start : equations::starts_of(mechanism, 8)) {
      RunRequest request;
      request.settings = default_settings(scene.run, "momentum-index2", "bdf5", 1e-8);
      request.settings.gauge = "reset";
      request.settings.end_time = 10;
      request.settings.samples = 20;
      const RunResult moved = run_form(mechanism, start, request);
      EXPECT_TRUE(reliable(moved)) << damping << ": " << moved.reason << moved.departure;
    }
    const RunResult r = run(scene, "momentum-index2", "bdf5", "reset", 1e-8, 10),
                    twin = run(scene, "momentum", "bdf", "leak", 1e-10, 10);
    ASSERT_EQ(r.status, "done") << damping << ": " << r.reason;
    ASSERT_EQ(twin.status, "done") << damping << ": " << twin.reason;
    EXPECT_LT(r.counters.steps, 200) << damping;
    const auto &end = r.trajectory.rows.back(), &same = twin.trajectory.rows.back();
    for (int joint = 0; joint < 3; ++joint)
      EXPECT_NEAR(end[static_cast<std::size_t>(joint)], same[static_cast<std::size_t>(joint)], 3e-8)
          << damping;
  }
}

// The error in energy of an undamped oscillation does not grow with its periods: 10⁴ tolerances of
// the energy exchanged, after 10⁵ steps as after 4·10⁵.
TEST(Bdf5, EnergyOfAnOscillationOverManyPeriods) {
  Scene scene = equations::example("four_bar");
  rocker_of(scene).stiffness = 1e6;
  rocker_of(scene).rest = 1.74;
  constexpr double tolerance = 1e-7;
  for (const double end : {20, 60}) {
    const RunResult r = run(scene, "momentum-index2", "bdf5", "reset", tolerance, end);
    ASSERT_EQ(r.status, "done") << r.reason;
    EXPECT_GT(r.counters.steps, 100000);
    EXPECT_LT(r.energy_error_max, 1.5e4 * tolerance * r.energy_scale) << end;
  }
}

// A mechanism a hundred or a million times as large moves alike, ten or a thousand times as slowly:
// rates weigh the absolute tolerance times its own rate.
TEST(Bdf5, StepsOfLargeMechanisms) {
  double steps = 0;
  for (const double factor : {1e2, 1e4, 1e6}) {
    const Scene scene = driven_to(equations::example("four_bar"), Extreme::size, factor);
    const RunResult r =
        run(scene, "momentum-index2", "bdf5", "reset", 1e-8, 10 * std::sqrt(factor));
    ASSERT_EQ(r.status, "done") << factor << ": " << r.reason;
    EXPECT_LT(r.energy_error_max, 2e-6 * r.energy_scale) << factor;
    const auto taken = static_cast<double>(r.counters.steps);
    if (steps > 0) {
      EXPECT_NEAR(taken, steps, 0.1 * steps) << factor;
    }
    steps = taken;
  }
}

// Where loops bear little at the start, the rate found there is none to weigh by: that of Cassie,
// at rest, is 4·10⁻⁵/s.
TEST(Bdf5, AtRest) {
  const Scene cassie = equations::example("models/agility_cassie/cassie.xml");
  const RunResult r = run(cassie, "momentum-index2", "bdf5", "reset", 1e-8, 1);
  ASSERT_EQ(r.status, "done") << r.reason;
  EXPECT_LT(r.counters.steps, 200);
}

// N steps of T/N are held to N₀/N, whatever shorter steps are among the first, and never to less
// than rounding.
TEST(LocalShare, MeanOfTheLastSteps) {
  constexpr double span = 7;
  LocalShare share(span, 1e-8);
  EXPECT_EQ(share.now(), 1);
  for (int i = 0; i < 20; ++i) share.passed(1e-12);
  EXPECT_GT(share.now(), 0.97);
  for (int i = 0; i < 20000; ++i) share.passed(span / 5e3);
  EXPECT_NEAR(share.now(), 1, 1e-6);
  for (int i = 0; i < 20000; ++i) share.passed(span / 4e5);
  EXPECT_NEAR(share.now(), 1e4 / 4e5, 1e-6);
  for (int i = 0; i < 40000; ++i) share.passed(span / 1e15);
  EXPECT_NEAR(share.now(), 2.2e-5, 1e-6);
  EXPECT_EQ(LocalShare(span, 1e-14).now(), 1);
}

}  // namespace
}  // namespace momenta::dae_bdf5_stiffness
