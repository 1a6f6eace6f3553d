// Explicit methods notice stiffness: where a spring or a damper makes a fast mode that has long
// died out, and nowhere else.

#include "equations/ensemble.h"
#include "equations/examples.h"
#include "equations/linkages.h"
#include "equations/runs.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/dae/integrator/stiffness.h>
#include <momenta/dae/integrator/tableau_dop853.h>
#include <momenta/dae/integrator/tableau_dp5.h>
#include <momenta/dae/integrator/tableau_vern9.h>
#include <momenta/dae/run/run_form.h>

#include <cmath>

namespace momenta::dae_stiffness {
namespace {

using namespace equations;

/// A pendulum of two rods, the second damped: |λ| of that mode goes with the damping.
Scene finger(double damping) {
  Scene s;
  s.name = "damped finger";
  s.gravity = {0, -9.81, 0};
  s.bodies = {rod("a"), rod("b")};
  s.joints = {hinge("A", "ground", "a", {0, 0, 0}, 0.5), hinge("B", "a", "b", {1, 0, 0}, 0.2)};
  s.joints[1].damping = damping;
  return s;
}

RunResult damped(double damping, const std::string& integrator,
                 const std::string& form = "momentum") {
  const Mechanism mechanism(finger(damping));
  return run_form(mechanism, start_of(mechanism),
                  equations::adaptive(form, integrator, "none", 1e-6, 2, 10));
}

TEST(Stiffness, IntervalsAreThoseOfTheLiterature) {
  // Hairer, Wanner II, IV.2: DOPRI5 3.3, DOP853 6.1 in their codes' tests.
  EXPECT_NEAR(explicit_rk::stability_interval<explicit_rk::TableauDp5>(), 3.31, 0.03);
  EXPECT_NEAR(explicit_rk::stability_interval<explicit_rk::TableauDop853>(), 6.2, 0.2);
  EXPECT_GT(explicit_rk::stability_interval<explicit_rk::TableauVern9>(), 3);
}

TEST(Stiffness, IsNoticedWhereItIsAlone) {
  for (const char* form : {"momentum", "acceleration"})
    for (const char* method : {"dp5", "dop853", "vern9"}) {
      const RunResult smooth = damped(0.1, method, form), stiff = damped(3000, method, form);
      EXPECT_EQ(smooth.status, "done");
      EXPECT_EQ(stiff.status, "done");
      EXPECT_TRUE(std::isnan(smooth.stiff_from)) << method << " " << smooth.stiff_from;
      EXPECT_LT(stiff.stiff_from, 0.5) << method;
      EXPECT_GT(stiff.counters.steps, 10 * smooth.counters.steps) << method;
    }
  const RunResult implicit = damped(3000, "bdf");
  EXPECT_TRUE(std::isnan(implicit.stiff_from));
  EXPECT_LT(10 * implicit.counters.steps, damped(3000, "dop853").counters.steps);
}

TEST(Stiffness, IsNotSeenInTheExamples) {
  for (const char* name : {"bricard", "row"}) {
    const Mechanism mechanism(std::string(name) == "bricard" ? bricard()
                                                             : row_of_four_bars(3, 1.1));
    for (const char* method : {"dp5", "dop853", "vern9"})
      for (const char* gauge : {"leak:3", "reset", "flip"}) {
        const RunResult r = run_form(mechanism, start_of(mechanism),
                                     equations::adaptive("momentum", method, gauge, 1e-8, 5));
        const std::string where = std::string(name) + " " + method + " " + gauge;
        EXPECT_EQ(r.status, "done") << where << r.reason;
        EXPECT_TRUE(std::isnan(r.stiff_from)) << where << " " << r.stiff_from;
      }
  }
}

/// The crank-rocker of the examples with a damped rod on its crank.
Scene four_bar_with_finger() {
  Scene s = equations::example("four_bar");
  s.bodies.push_back(rod("finger"));
  s.joints.push_back(hinge("F", s.joints.front().child, "finger", {0.2, 0, 0}, 0.2));
  s.joints.back().damping = 3000;
  return s;
}

/// As `momenta run` does it where no integrator is named, or where one is.
RunResult run_of(const Scene& scene, const std::string& form, const std::string& method,
                 const std::string& gauge = "", double rtol = 1e-8) {
  const Mechanism mechanism(scene);
  RunDefaults defaults = scene.run;
  defaults.end_time = 2;
  defaults.samples = 40;
  RunRequest request;
  request.settings = default_settings(defaults, form, method, rtol);
  if (!gauge.empty()) request.settings.gauge = gauge;
  request.keep_trajectory = true;
  return run_form(mechanism, start_of(mechanism), request);
}

/// Largest difference of coordinates and rates, samples at the same times.
double apart(const RunResult& a, const RunResult& b, std::size_t unknowns) {
  double largest = 0;
  EXPECT_EQ(a.trajectory.rows.size(), b.trajectory.rows.size());
  for (std::size_t i = 0; i < std::min(a.trajectory.rows.size(), b.trajectory.rows.size()); ++i) {
    const auto &x = a.trajectory.rows[i], &y = b.trajectory.rows[i];
    EXPECT_EQ(x[0], y[0]);
    for (std::size_t k = 1; k <= unknowns; ++k)
      largest = equations::larger(largest, std::abs(x[k] - y[k]));
  }
  return largest;
}

TEST(Stiffness, AnotherMethodGoesOnWhereNoneWasNamed) {
  const Scene bar = four_bar_with_finger();
  for (const char* form : {"momentum", "acceleration", "baumgarte"})
    for (const bool loops : {false, true}) {
      if (!loops && std::string(form) == "baumgarte") continue;
      const Scene scene = loops ? bar : finger(3000);
      const std::string where = std::string(form) + (loops ? ", loops" : "");
      const RunResult changing = run_of(scene, form, ""), named = run_of(scene, form, "dop853"),
                      tight = run_of(scene, form, "dop853", "", 1e-11);
      ASSERT_EQ(changing.status, "done") << where << changing.reason;
      EXPECT_TRUE(changed(changing)) << where;
      EXPECT_FALSE(changed(named)) << where;
      EXPECT_GE(changing.changed_at, changing.stiff_from) << where;
      EXPECT_LT(changing.changed_at, 0.5) << where;
      EXPECT_EQ(changing.series.t.size(), 41u) << where;
      EXPECT_LT(5 * changing.counters.steps, named.counters.steps) << where;
      // As accurate as a method of its tolerance is: an error that falls with the tolerance, by 40
      // and more for a hundredth of it. At one tolerance, bdf's own error differs tenfold between
      // starts a unit in the last place apart, 3e-6 to 4e-5: no bound for another run's.
      const RunResult finer = run_of(scene, form, "", "", 1e-10);
      const std::size_t unknowns = 2 * scene.joints.size();
      const double error = apart(changing, tight, unknowns);
      EXPECT_LT(error, 2e-4) << where;
      EXPECT_LT(10 * apart(finer, tight, unknowns), error) << where;
    }
}

TEST(Stiffness, NothingChangesWhereAMethodWithMemoryIsOutOfPlace) {
  const Scene bar = four_bar_with_finger();
  for (const char* gauge : {"reset", "flip"}) {
    const RunResult r = run_of(bar, "momentum", "", gauge);
    EXPECT_EQ(r.status, "done") << r.reason;
    EXPECT_LT(r.stiff_from, 0.5) << gauge;
    EXPECT_FALSE(changed(r)) << gauge;
    EXPECT_EQ(r.settings.when_stiff, "") << gauge;  // it is decided before the first step
  }
  EXPECT_EQ(run_of(bar, "momentum", "", "leak:3").settings.when_stiff, "bdf");
  const RunResult projected = run_of(bar, "projected", "");
  EXPECT_LT(projected.stiff_from, 0.5);
  EXPECT_FALSE(changed(projected));
  EXPECT_EQ(projected.settings.when_stiff, "");
  EXPECT_FALSE(changed(run_of(finger(0.1), "momentum", "")));
}

/// Two rods in line from a base to a pin on the ground; the base slides both ways against dampers
/// that all but hold it. The loops are next to a singular pose, and the fast modes are the base's.
TEST(Stiffness, IsNoticedNextToASingularPose) {
  Scene s;
  s.name = "braked base";
  s.gravity = {0, -9.81, 0};
  s.bodies = {rod("carriage"), rod("base"), rod("arm"), rod("fore")};
  s.bodies[1].mass = 64;
  s.joints = {hinge("x", "ground", "carriage", {0, 0, 0}, 0),
              hinge("y", "carriage", "base", {0, 0, 0}, 0),
              hinge("shoulder", "base", "arm", {0, 0.4, 0}, 0),
              hinge("elbow", "arm", "fore", {1, 0, 0}, 0)};
  for (std::size_t i = 0; i < 2; ++i) {
    s.joints[i].kind = JointKind::prismatic;
    s.joints[i].axis = Eigen::Vector3d::Unit(static_cast<int>(i));
    s.joints[i].damping = 1e11;
  }
  LoopSpec pin;
  pin.name = "pin";
  pin.kind = LoopKind::point;
  pin.parent = "ground";
  pin.child = "fore";
  pin.origin_parent = {2, 0.4, 0};
  pin.origin_child = {1, 0, 0};
  s.loops = {pin};
  const Mechanism mechanism(s);
  for (const char* gauge : {"leak", "reset", "none"}) {
    RunRequest request;
    request.settings = default_settings(s.run, "momentum", "", 1e-8);
    request.settings.gauge = gauge;
    request.settings.end_time = 1e-6;
    const RunResult run = run_form(mechanism, start_of(mechanism), request);
    EXPECT_EQ(run.status, "done") << gauge << run.reason;
    EXPECT_LT(run.stiff_from, 1e-6) << gauge;
    EXPECT_EQ(changed(run), std::string(gauge) != "reset") << gauge;
  }
}

}  // namespace
}  // namespace momenta::dae_stiffness
