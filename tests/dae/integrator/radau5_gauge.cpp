// radau5 with gauge reset: its order, steps that do not depend on how fast a mechanism turns,
// bodies so heavy that rounding of their loops is all that Newton's corrections have, and
// oscillations of many periods.

#include "equations/ensemble.h"
#include "equations/examples.h"
#include "equations/runs.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/integrator/implicit_methods.h>
#include <momenta/dae/run/run_form.h>

#include <cmath>

namespace momenta::dae_radau5_gauge {
namespace {

/// q at the end, by fixed steps.
std::vector<double> by_steps(const Mechanism& mechanism, const std::string& form_name,
                             const char* gauge, double h, double end) {
  const Start start = equations::start_of(mechanism);
  FormOptions options;
  options.gauge = parse_gauge(gauge);
  const auto form = make_form(form_name, mechanism, options, start);
  IntegrationOptions how;
  how.rtol = how.atol = 1e-13;
  how.step = h;
  const IntegrationResult run = integrate_radau5(*form->dae(), 0, {end}, how, {});
  EXPECT_TRUE(run.done) << run.reason;
  return {run.y.begin(), run.y.begin() + mechanism.nq()};
}

// The shift of y, y' and of the stages foreseen changes no step: of the order of the method in
// every form with impulses, and not in the gauge in which σ grows.
TEST(Radau5, OrderWithReset) {
  const Mechanism mechanism(equations::example("four_bar"));
  constexpr double end = 0.6;
  const auto ode = make_form("momentum", mechanism, {}, equations::start_of(mechanism));
  IntegrationOptions tight;
  tight.rtol = tight.atol = 1e-14;
  const auto exact = integrate_explicit(
      "dop853", *ode->ode(), 0, ode->initial(equations::start_of(mechanism)), {end}, tight, {});
  ASSERT_TRUE(exact.done) << exact.reason;
  for (const char* form : {"momentum-index2", "momentum-stabilised", "momentum-index1"}) {
    const auto error = [&](int steps) {
      const auto q = by_steps(mechanism, form, "reset", end / steps, end);
      double largest = 0;
      for (std::size_t i = 0; i < q.size(); ++i)
        largest = equations::larger(largest, std::abs(q[i] - exact.y[i]));
      return largest;
    };
    const double coarse = error(10), fine = error(20);
    EXPECT_NEAR(std::log2(coarse / fine), 5, 0.1) << form << ": " << coarse << ", " << fine;
  }
}

RunResult run(const Scene& scene, double end) {
  const Mechanism mechanism(scene);
  RunRequest request = equations::adaptive("momentum-index2", "radau5", "reset", 1e-8, end, 50);
  request.max_cpu_seconds = 60;
  return run_form(mechanism, equations::start_of(mechanism), request);
}

// Sixteen turns at any speed, gravity small beside it, are one motion on another clock: σ of a leak
// of 3/s adds up over them, σ of a reset is that of a step.
TEST(Radau5, StepsAtAnySpeed) {
  double steps = 0;
  for (const double rate : {1e3, 1e4, 1e5, 1e6}) {
    Scene scene = equations::example("four_bar");
    for (JointSpec& joint : scene.joints)
      if (joint.name == "O") joint.velocity = {rate};
    const RunResult r = run(scene, 100 / rate);
    ASSERT_EQ(r.status, "done") << rate << ": " << r.reason;
    EXPECT_LT(r.energy_error_max, 1e-5 * r.energy_scale) << rate;
    const auto taken = static_cast<double>(r.counters.steps);
    if (steps > 0) {
      EXPECT_NEAR(taken, steps, 0.1 * steps) << rate;
    }
    steps = taken;
  }
}

// Rounding of q opens the loop by ε |q|; the impulse that closes it is that of the heavy body.
TEST(Radau5, HeavyCoupler) {
  for (const double factor : {1e6, 1e9, 1e12}) {
    Scene scene = equations::example("four_bar");
    for (BodySpec& body : scene.bodies)
      if (body.name == "coupler") body.mass *= factor, body.inertia *= factor;
    const RunResult r = run(scene, 10);
    ASSERT_EQ(r.status, "done") << factor << ": " << r.reason;
    EXPECT_LT(r.energy_error_max, 1e-5 * r.energy_scale) << factor;
    EXPECT_LT(r.counters.steps, 20000) << factor;
  }
}

// What the formula takes from an undamped oscillation adds up over its periods: an energy error
// four times as large after four times as long, unless a step's share of the tolerance shrinks as
// their number grows (local_newton.h).
TEST(Radau5, EnergyOfAnOscillationOverManyPeriods) {
  Scene scene = equations::example("four_bar");
  for (JointSpec& joint : scene.joints)
    if (joint.name == "C") joint.stiffness = 1e6, joint.rest = 1.74;
  const auto after = [&](double end) {
    const RunResult r =
        equations::run_of(Mechanism(scene), "momentum-index2", "radau5", "reset", 1e-6, end, 60);
    EXPECT_EQ(r.status, "done") << r.reason;
    return r;
  };
  const RunResult shorter = after(10), longer = after(40);
  EXPECT_GT(shorter.counters.steps, 20000);
  EXPECT_GT(longer.counters.steps, 100000);
  EXPECT_LT(longer.energy_error_max, 2 * shorter.energy_error_max);
}

}  // namespace
}  // namespace momenta::dae_radau5_gauge
