// Explicit methods notice stiffness: where a spring or a damper makes a fast mode that has long
// died out, and nowhere else.

#include "equations/ensemble.h"
#include "equations/linkages.h"

#include <gtest/gtest.h>
#include <momenta/dae/solver/stiffness.h>
#include <momenta/dae/solver/tableau_dop853.h>
#include <momenta/dae/solver/tableau_dp5.h>
#include <momenta/dae/solver/tableau_vern9.h>
#include <momenta/dae/study/run_form.h>

#include <cmath>

namespace momenta {
namespace {

using namespace equations;

/// A pendulum of two rods, the second damped: |λ| of that mode goes with the damping.
RunResult damped(double damping, const std::string& integrator,
                 const std::string& form = "momentum") {
  Scene s;
  s.name = "damped finger";
  s.gravity = {0, -9.81, 0};
  s.bodies = {rod("a"), rod("b")};
  s.joints = {hinge("A", "ground", "a", {0, 0, 0}, 0.5), hinge("B", "a", "b", {1, 0, 0}, 0.2)};
  s.joints[1].damping = damping;
  const Mechanism mechanism(s);
  RunRequest request;
  request.settings.form = form;
  request.settings.integrator = integrator;
  request.settings.rtol = request.settings.atol = 1e-6;
  request.settings.end_time = 2;
  request.settings.samples = 10;
  return run_form(mechanism, start_of(mechanism), request);
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
    for (const char* method : {"dp5", "dop853", "vern9"}) {
      RunRequest request;
      request.settings.form = "momentum";
      request.settings.integrator = method;
      request.settings.gauge = "leak:3";
      request.settings.end_time = 5;
      const RunResult r = run_form(mechanism, start_of(mechanism), request);
      EXPECT_EQ(r.status, "done") << r.reason;
      EXPECT_TRUE(std::isnan(r.stiff_from)) << name << " " << method << " " << r.stiff_from;
    }
  }
}

}  // namespace
}  // namespace momenta
