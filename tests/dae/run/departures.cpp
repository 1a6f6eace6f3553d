// Verdicts on runs whose loops stay closed: the energy turned over against what closed forms give,
// the balance and the rates of loops against it, and runs that are honest at any accuracy.

#include "equations/examples.h"
#include "equations/linkages.h"
#include "equations/runs.h"

#include <gtest/gtest.h>
#include <momenta/dae/output/conclusion.h>
#include <momenta/dae/run/departures.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/study/work_study.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <cmath>
#include <utility>

namespace momenta::dae_departures {
namespace {

using namespace equations;

RunResult run_of(const Mechanism& mechanism, const std::string& form, double end,
                 const std::string& integrator = "dop853", double rtol = 1e-8, double step = 0) {
  RunRequest request = equations::adaptive(form, integrator, "none", rtol, end, 100);
  request.settings.step = step;
  return run_form(mechanism, assemble(mechanism).start, request);
}

/// A rod that turns freely about its end at 2 rad/s, without gravity.
Scene wheel() {
  Scene s;
  s.name = "wheel";
  s.gravity = {0, 0, 0};
  s.bodies = {rod("w")};
  s.joints = {hinge("O", "ground", "w", {0, 0, 0}, 0)};
  s.joints[0].velocity = {2};
  return s;
}

TEST(Departures, EnergyTurnedOverHasDampersAndMotors) {
  // I u̇ = −d u with I = 1/3: T falls from I/2 u₀² by what the damper takes.
  Scene s = wheel();
  s.joints[0].damping = 0.4;
  const double first = 2.0 / 3, left = first * std::exp(-2 * 0.4 * 3 * 1.5);
  const RunResult damped = run_of(Mechanism(s), "momentum", 1.5);
  EXPECT_NEAR(damped.energy_turned_over, first + (first - left), 1e-2);
  EXPECT_TRUE(reliable(damped)) << damped.departure;
  // At a steady rate a motor of d u brings what the damper takes, and neither shows in the balance.
  ForceSpec motor;
  motor.name = "motor";
  motor.kind = "torque";
  motor.joint = "O";
  motor.law = "0.8";
  s.forces = {motor};
  const RunResult steady = run_of(Mechanism(s), "momentum", 1.5);
  EXPECT_NEAR(steady.series.energy.back(), first, 1e-9);
  EXPECT_TRUE(reliable(steady)) << steady.departure;
}

/// A run whose balance is off by `error` [J] at the last of three samples.
RunResult with_error(double error) {
  RunResult r;
  r.settings.end_time = 2;
  r.stopped_at = 2;
  r.series.t = {0, 1, 2};
  r.series.energy_error = {0, 0.6 * error, error};
  r.energy_error_max = error;
  return r;
}

TEST(Departures, JudgesTheBalanceByWhatWasTurnedOver) {
  const Mechanism mechanism(equations::example("four_bar"));
  const auto judged = [&](double error, double turned_over, double between = 0) {
    RunResult r = with_error(error);
    Departures departures(mechanism, r.settings, 2);
    departures.look_between(between);
    for (std::size_t i = 0; i < r.series.t.size(); ++i)
      departures.look_at_energy(r.series.t[i], 0, turned_over / 2, turned_over / 2,
                                r.series.energy_error[i]);
    departures.judge(r);
    return r;
  };
  EXPECT_TRUE(reliable(judged(0.04, 1)));
  const RunResult off = judged(0.2, 1);
  EXPECT_EQ(off.status, "done");
  EXPECT_EQ(off.departure,
            "from t = 1 s on the balance of energy is off by more than a twentieth of the 1 J "
            "turned over, by 0.2 J at the most");
  const RunResult apart = judged(0.4, 1);
  EXPECT_EQ(apart.status, "came apart");
  EXPECT_EQ(apart.stopped_at, 2);
  EXPECT_FALSE(finished(judged(std::numeric_limits<double>::infinity(), 1)));
  // Where nothing moves rounding is no departure.
  EXPECT_TRUE(reliable(judged(1e-12, 1e-15)));
  // What was exchanged between the samples counts.
  EXPECT_TRUE(reliable(judged(0.4, 1, 20)));
}

/// A pendulum seen at the ends of its swings alone exchanges nothing there.
TEST(Departures, OfATreeFewSamplesJudgeNoEnergy) {
  const Mechanism mechanism(wheel());
  for (const bool few : {true, false}) {
    RunResult r = with_error(0.4);
    Departures departures(mechanism, r.settings, 2);
    if (!few) r.series.t.resize(20, 2.0);
    for (const double t : r.series.t) departures.look_at_energy(t, 0, 1e-9, 0, 0.4);
    departures.judge(r);
    EXPECT_EQ(r.status, few ? "done" : "came apart");
  }
}

TEST(Departures, JudgesTheRatesOfLoopsByTheFastestJoint) {
  const Mechanism mechanism(equations::example("four_bar"));
  const auto judged = [&](double opening) {
    RunResult r = with_error(0);
    Departures departures(mechanism, r.settings, 2);
    departures.look_at_rates(0.5, 1e-9, 0, 8);
    departures.look_at_rates(1.5, opening, 1, 4);
    departures.judge(r);
    return r;
  };
  EXPECT_TRUE(reliable(judged(0.3)));
  const RunResult off = judged(0.96);
  EXPECT_EQ(off.departure,
            "at t = 1.5 s loop 'B' opens at 0.12 of the rate of the fastest joint, where it ought "
            "to stay closed");
  const RunResult apart = judged(3);
  EXPECT_EQ(apart.status, "came apart");
  EXPECT_EQ(apart.stopped_at, 1.5);
}

/// RK4 beyond its stability: a rod on a stiff spring gains energy at every step.
TEST(Departures, NoRunThatMakesEnergyIsDone) {
  Scene s = wheel();
  s.joints[0].stiffness = 300;  // ω = 30 rad/s; RK4 is stable to ω h = 2.83
  const Mechanism mechanism(s);
  for (const char* form : {"momentum", "acceleration"}) {
    const RunResult gains = run_of(mechanism, form, 3, "rk4", 1e-8, 0.1);
    EXPECT_EQ(gains.status, "came apart") << form;
    EXPECT_NE(gains.reason.find("the balance of energy"), std::string::npos) << gains.reason;
    EXPECT_LT(gains.stopped_at, 1) << form;
    // At ω h = 0.6 it loses (ω h)⁶/72 of its energy a step, 9 % of it: far off, and honest.
    const RunResult loses = run_of(mechanism, form, 3, "rk4", 1e-8, 0.02);
    EXPECT_EQ(loses.status, "done") << loses.reason;
    EXPECT_FALSE(loses.departure.empty());
    const RunResult good = run_of(mechanism, form, 3, "rk4", 1e-8, 0.01);
    EXPECT_TRUE(reliable(good)) << good.departure;
  }
}

TEST(Departures, AreToldFirstAndNotRecommended) {
  RunResult good = with_error(0.01), off = with_error(0.2);
  good.settings.form = "momentum";
  off.settings.form = "acceleration";
  good.position_drift_max = 1e-6;
  off.position_drift_max = 1e-9;
  good.cpu_s = 1;
  off.cpu_s = 0.1;
  off.departure = "the balance is off";
  StudyResult study;
  study.runs = {off};
  EXPECT_EQ(conclusion(study).rfind("The balance is off.", 0), 0U) << conclusion(study);
  study.runs = {good, off};
  const std::string text = conclusion(study);
  EXPECT_EQ(text.rfind("1 of 2 runs are done and not to be relied on, and are not compared: "
                       "`acceleration`, the balance is off. After 2 s the position drift of "
                       "`momentum`",
                       0),
            0U)
      << text;
  EXPECT_EQ(text.find("acceleration", text.find("After")), std::string::npos) << text;
  EXPECT_EQ(pareto_front(study.runs, false), std::vector<std::size_t>{0});
}

TEST(Departures, BranchesThatDifferAreSaid) {
  RunResult a = with_error(0);
  a.last_pose = {0.3, 1};
  RunResult b = a;
  b.settings.form = "acceleration";
  b.last_pose = {0.3, 0.2};
  EXPECT_FALSE(ambiguity_of({a, b}).differ);  // no singular pose: one of them is inaccurate
  a.singular_crossings = {{1.2, 1e-9, false}, {0.5, 1e-5, false}};
  StudyResult study;
  study.runs = {a, b};
  EXPECT_EQ(conclusion(study).rfind("The motion is ambiguous from t = 0.5 s: ", 0), 0U)
      << conclusion(study);
  EXPECT_EQ(conclusion(study).find("drift"), std::string::npos) << conclusion(study);
  EXPECT_TRUE(pareto_front(study.runs, false).empty());
  b.last_pose = a.last_pose;
  EXPECT_FALSE(ambiguity_of({a, b}).differ);
}

/// The end is no scale of the motion: a run to a time that no run reaches takes the steps of one to
/// a time that it does.
TEST(Departures, NoStepIsTiedToAFarEnd) {
  const Mechanism mechanism(equations::example("four_bar"));
  const Start start = assemble(mechanism).start;
  for (const auto& [form, integrator] : {std::pair{"momentum", "dop853"},
                                         {"acceleration", "vern9"},
                                         {"projected", "dp5"},
                                         {"momentum", "bdf"},
                                         {"acceleration", "adams"},
                                         {"momentum-index2", "ida"},
                                         {"momentum-index2", "bdf5"},
                                         {"stabilised-index2", "radau5"},
                                         {"momentum-index2", "hem5"},
                                         {"momentum-index2", "hem8"}}) {
    RunRequest request = equations::adaptive(form, integrator, "none", 1e-8, 1e300, 1);
    int steps = 0;
    request.going_on = [&] { return ++steps < 200; };
    const RunResult r = run_form(mechanism, start, request);
    EXPECT_EQ(steps, 200) << form << " " << integrator << ": " << r.reason;
    EXPECT_GT(r.stopped_at, 0.2) << form << " " << integrator;
    EXPECT_LT(r.stopped_at, 200) << form << " " << integrator;
  }
}

}  // namespace
}  // namespace momenta::dae_departures
