// Rigid stops: impacts against dense matrices and against known motions, bounces that end in
// holding, release, energy, in forms of every kind.

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/run/event/impact.h>
#include <momenta/dae/run/rigid_stops.h>
#include <momenta/dae/run/run_form.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "equations/examples.h"
#include "equations/kkt_blocks.h"
#include "equations/runs.h"

namespace momenta::dae_rigid_stops {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Method {
  const char *form, *integrator;
  double step, bound;
};
constexpr Method methods[] = {{"momentum", "dop853", 0, 1e-8},
                              {"acceleration", "rk4", 0.002, 1e-8},
                              {"baumgarte", "dp5", 0, 1e-8},
                              {"momentum-index2", "ida", 0, 1e-5},
                              {"stabilised-index2", "radau5", 0, 1e-6},
                              {"acceleration-index2", "hem5", 0, 1e-6},
                              {"momentum-index1", "bdf5", 0, 1e-5}};

RunResult run(const Scene& scene, const Method& m, double end, int samples = 100,
              double tolerance = 1e-10) {
  const Mechanism mechanism(scene);
  RunRequest request = equations::kept(equations::adaptive(
      m.form, m.integrator, takes_gauge(m.form) ? "none" : "", tolerance, end, samples));
  request.settings.step = m.step;
  request.events = true;
  return run_form(mechanism, assemble(mechanism).start, request);
}

/// A slide above its lower stop.
Scene slide(double restitution, const std::string& keys = "position = 0.6\n",
            const std::string& rest = "gravity = [0, 0, -10]\n") {
  return parse_scene(rest + R"(
[[body]]
name = "a"
mass = 2
shape = { kind = "sphere", radius = 0.1 }
[[joint]]
name = "A"
kind = "prismatic"
child = "a"
limits = [0, 5]
restitution = )" + std::to_string(restitution) +
                         "\n" + keys,
                     "slide.toml");
}

std::vector<StopContact> contacts(const RunResult& result, const std::string& what) {
  std::vector<StopContact> all;
  for (const StopContact& s : result.stops)
    if (s.what == what) all.push_back(s);
  return all;
}

// From h the first impact is after √(2h/g), each next one after 2 eᵏ v/g; they come to an end at
// t₁ + 2 v e/(g (1 − e)), and the stop holds m g from then on.
TEST(RigidStops, ABallBouncesAsItIsKnownToAndComesToRest) {
  const double h = 0.6, g = 10, e = 0.5, v = std::sqrt(2 * g * h), first = std::sqrt(2 * h / g);
  for (const Method& m : methods) {
    const RunResult result = run(slide(e), m, 2);
    ASSERT_EQ(result.status, "done") << m.form << result.reason;
    const auto impacts = contacts(result, "impact");
    ASSERT_GT(impacts.size(), 15U) << m.form;
    double t = first;
    for (std::size_t k = 0; k < 12; ++k) {
      const double rate = v * std::pow(e, static_cast<double>(k));
      EXPECT_NEAR(impacts[k].t, t, m.bound) << m.form << k;
      EXPECT_NEAR(impacts[k].before, -rate, 10 * m.bound) << m.form << k;
      EXPECT_NEAR(impacts[k].after, e * rate, 10 * m.bound) << m.form << k;
      EXPECT_NEAR(impacts[k].impulse, 2 * (1 + e) * rate, 40 * m.bound) << m.form << k;
      t += 2 * e * rate / g;
    }
    const auto held = contacts(result, "held");
    ASSERT_EQ(held.size(), 1U) << m.form;
    EXPECT_NEAR(held[0].t, first + 2 * v * e / (g * (1 - e)), m.bound + 1e-7) << m.form;
    EXPECT_NEAR(result.trajectory.rows.back()[1], 0, 1e-9) << m.form;
    EXPECT_NEAR(result.trajectory.rows.back()[2], 0, 1e-9) << m.form;
    EXPECT_TRUE(contacts(result, "released").empty());
    EXPECT_LE(result.energy_error_max, 1e3 * m.bound) << m.form;
    EXPECT_TRUE(result.passed_limits.empty()) << m.form;
  }
}

// The stop lets go where it would have to pull: with the force cos t against it from rest, at π/2,
// and then x = π/2 − t − cos t below it.
TEST(RigidStops, LetGoWhereTheyWouldPull) {
  const Scene scene = slide(0.3,
                            "position = 5\n[[force]]\nkind = \"torque\"\njoint = \"A\"\n"
                            "law = \"2*cos(t)\"\n",
                            "");
  for (const Method& m : methods) {
    const RunResult result = run(scene, m, 3);
    ASSERT_EQ(result.status, "done") << m.form << result.reason;
    ASSERT_EQ(contacts(result, "held").size(), 1U) << m.form;
    EXPECT_EQ(contacts(result, "held")[0].t, 0);
    const auto released = contacts(result, "released");
    ASSERT_EQ(released.size(), 1U) << m.form;
    EXPECT_NEAR(released[0].t, 0.5 * std::numbers::pi, 10 * m.bound) << m.form;
    ASSERT_GE(result.trajectory.rows.size(), 101U) << m.form;
    for (const auto& row : result.trajectory.rows)
      EXPECT_NEAR(row[1],
                  5 + (row[0] < 0.5 * std::numbers::pi
                           ? 0
                           : 0.5 * std::numbers::pi - row[0] - std::cos(row[0])),
                  100 * m.bound)
          << m.form << row[0];
  }
}

Scene four_bar(const char* joint, double restitution, double low, double high) {
  Scene scene = equations::example("four_bar");
  for (JointSpec& j : scene.joints)
    if (j.name == joint) j.limits = {low, high}, j.restitution = restitution;
  return scene;
}

// p⁺ = p⁻ − n Λ with all loops held, by elimination of one dense matrix; no energy is lost at e
// = 1.
TEST(RigidStops, ImpactsAreThoseOfDenseMatrices) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1, 1);
  const Mechanism mechanism(four_bar("C", 1, -9, 9));
  const auto e = mechanism.evaluation<double>();
  Impact impact(mechanism);
  const int nv = mechanism.nv(), m = mechanism.m();
  for (const double restitution : {0.0, 0.4, 1.0})
    for (int k = 0; k < 20; ++k) {
      VectorXd guess = mechanism.tree().q0, rates(nv);
      guess[0] += 2 * any(random);
      for (double& x : rates) x = any(random);
      const Start start = assemble(mechanism, 0, guess, rates).start;
      const int coordinate = k % nv;
      const double side = start.u[coordinate] > 0 ? 1 : -1;
      e->place(0, start.q.data());
      const equations::KktBlocks blocks(mechanism, *e);
      MatrixXd whole = MatrixXd::Zero(nv + m + 1, nv + m + 1);
      whole.topLeftCorner(nv, nv) = blocks.M;
      whole.block(0, nv, nv, m) = blocks.J.transpose();
      whole.block(nv, 0, m, nv) = blocks.J;
      whole(coordinate, nv + m) = whole(nv + m, coordinate) = side;
      VectorXd right(nv + m + 1);
      right << blocks.M * start.u, VectorXd::Zero(m), -restitution * side * start.u[coordinate];
      const VectorXd dense = whole.fullPivLu().solve(right);
      VectorXd u = start.u;
      std::vector<StopAtImpact> stops{{coordinate, side, restitution}};
      const double taken = impact.jump(0, start.q, u, stops);
      const double size = 1 + start.u.norm();
      EXPECT_LE((u - dense.head(nv)).norm(), 1e-12 * size);
      EXPECT_NEAR(stops[0].impulse, dense[nv + m], 1e-12 * size);
      EXPECT_GE(stops[0].impulse, 0);
      const double before = 0.5 * start.u.dot(blocks.M * start.u),
                   after = 0.5 * u.dot(blocks.M * u);
      EXPECT_NEAR(before - after, taken, 1e-13 * before);
      if (restitution == 1) {
        EXPECT_NEAR(after, before, 1e-14 * (1 + before));
      }
    }
}

// A slide that an equation moves in time, or a coupler with a drive the same way, between stops:
// the guide's work at an impact counts.
TEST(RigidStops, TheWorkOfWhatMovesInTimeCounts) {
  const std::string bodies =
      "gravity = [0, -9.81, 0]\n[[body]]\nname = \"x\"\nmass = 2\ninertia = 1\n[[body]]\nname = "
      "\"y\"\nmass = 1\ninertia = 1\n[[joint]]\nname = \"X\"\nkind = \"prismatic\"\nchild = "
      "\"x\"\naxis = \"x\"\n[[joint]]\nname = \"Y\"\nkind = \"prismatic\"\naxis = \"y\"\nparent = "
      "\"x\"\nchild = \"y\"\nposition = 0.5\nlimits = [0, 1]\nrestitution = 0.7\n[[loop]]\nname = "
      "\"E\"\n";
  std::vector<double> ends;
  for (const std::string loop :
       {"kind = \"equation\"\nequation = \"X.q - 0.5*sin(3*t) - 0.4*Y.q + 0.2\"\n",
        "kind = \"coupler\"\njoints = [\"X\", \"Y\"]\nratios = [1, -0.4]\n[[drive]]\nloop = "
        "\"E\"\nkind = \"harmonic\"\namplitude = 0.5\nfrequency = 3\noffset = -0.2\n"}) {
    const Mechanism mechanism(parse_scene(bodies + loop));
    const RunResult run =
        run_form(mechanism, assemble(mechanism).start,
                 equations::kept(equations::adaptive("momentum", "", "", 1e-10, 1.5, 3)));
    EXPECT_EQ(run.status, "done") << run.reason;
    EXPECT_EQ(run.departure, "");
    EXPECT_FALSE(run.stops.empty());
    EXPECT_LT(run.energy_error_max, 1e-7);
    ends.push_back(run.trajectory.rows.back()[2]);
  }
  EXPECT_NEAR(ends[0], ends[1], 1e-7);
}

// The rocker of a four-bar between stops: the same impacts in every form, and no energy lost at
// e = 1 but what the integrators lose.
TEST(RigidStops, OfAFourBarAreTheSameInEveryForm) {
  const Scene scene = four_bar("C", 0.6, 1.5, 2.2);
  const RunResult exact = run(scene, {"momentum", "vern9", 0, 0}, 4);
  ASSERT_EQ(exact.status, "done") << exact.reason;
  ASSERT_GE(contacts(exact, "impact").size(), 4U);
  for (const Method& m : methods) {
    const RunResult result = run(scene, m, 4);
    ASSERT_EQ(result.status, "done") << m.form << result.reason;
    const auto impacts = contacts(result, "impact"), known = contacts(exact, "impact");
    ASSERT_GE(impacts.size(), 3U) << m.form;
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(impacts[k].t, known[k].t, 100 * m.bound) << m.form << k;
      EXPECT_NEAR(impacts[k].after, known[k].after, 1e3 * m.bound) << m.form << k;
      EXPECT_EQ(impacts[k].joint, "C");
    }
    EXPECT_LE(result.energy_error_max, 1e4 * m.bound) << m.form;
  }
  const RunResult elastic = run(four_bar("C", 1, 1.5, 2.2), {"momentum", "vern9", 0, 0}, 4);
  EXPECT_LE(elastic.energy_error_max, 1e-7);
  EXPECT_TRUE(contacts(elastic, "held").empty());
}

// Bounces on a closed loop end at one time in every form and by every integrator, whatever a first
// step behind an impact is worth and drift moves: none holds at its first impact, none slips
// through.
TEST(RigidStops, HoldAtOneTimeInEveryFormAndByEveryIntegrator) {
  const Scene scene = four_bar("C", 0.6, 1.5, 2.2);
  const auto expect_held = [&](const Method& m) {
    const RunResult result = run(scene, m, 4, 100, 1e-8);
    ASSERT_EQ(result.status, "done") << m.form << m.integrator << result.reason;
    ASSERT_GE(contacts(result, "impact").size(), 12U) << m.form << m.integrator;
    const auto held = contacts(result, "held");
    ASSERT_EQ(held.size(), 1U) << m.form << m.integrator;
    EXPECT_NEAR(held[0].t, 1.76483, 1e-3) << m.form << m.integrator;
    EXPECT_TRUE(result.passed_limits.empty()) << m.form << m.integrator;
  };
  for (const std::string& form : form_names()) expect_held({form.c_str(), "", 0, 0});
  for (const Integrator& integrator : integrators()) {
    const std::string form = !integrator.forms.empty()                    ? integrator.forms[0]
                             : integrator.takes == Integrator::Takes::ode ? "momentum"
                                                                          : "momentum-index2";
    expect_held({form.c_str(), integrator.name.c_str(),
                 integrator.step == Integrator::Step::fixed ? 0.002 : 0, 0});
  }
}

// Index 3 by methods of own step sizes: the last flights are as high as the rounding of q, where
// the gap of a stop is zero for steps, and rates behind an impact are off by 1e-16 over the step.
TEST(RigidStops, HoldInIndex3AsTheyDoInOtherForms) {
  for (const double restitution : {0.1, 0.3, 0.6}) {
    const Scene scene = four_bar("C", restitution, 1.5, 2.2);
    const RunResult exact = run(scene, {"momentum", "vern9", 0, 0}, 2.5, 20, 1e-12);
    ASSERT_EQ(contacts(exact, "held").size(), 1U);
    for (const char* form : {"momentum-index3", "acceleration-index3"})
      for (const char* integrator : {"ida", "bdf5", "radau5"})
        for (const double tolerance : {1e-6, 1e-8, 1e-10}) {
          const std::string what = std::string(form) + " " + integrator + " " +
                                   std::to_string(restitution) + " " + std::to_string(tolerance);
          const RunResult result = run(scene, {form, integrator, 0, 0}, 2.5, 20, tolerance);
          ASSERT_EQ(result.status, "done") << what << result.reason;
          const auto held = contacts(result, "held");
          ASSERT_EQ(held.size(), 1U) << what;
          EXPECT_NEAR(held[0].t, contacts(exact, "held")[0].t, 10 * std::sqrt(tolerance)) << what;
          EXPECT_TRUE(result.passed_limits.empty()) << what;
        }
  }
}

// What is left of a rate where bounces end is an error, towards the stop or off it.
TEST(RigidStops, HoldAtRatesOnEitherSide) {
  const Mechanism mechanism(slide(0.5));
  for (const double rate : {-5e-8, -1e-9, 1e-9, 5e-8}) {  // 2 · 5e-8/10 is half of 1e-8 of the run
    RigidStops stops(mechanism, 2);
    const Start start = assemble(mechanism).start;
    RunResult told;
    double taken = 0;
    stops.begin(start, told);
    const VectorXd q = VectorXd::Zero(1), u = VectorXd::Constant(1, rate);
    const Start behind = stops.meet(0.3, q, u, {0}, told, taken);
    EXPECT_TRUE(stops.any_held()) << rate;
    EXPECT_NEAR(behind.u[0], 0, 1e-15) << rate;
    EXPECT_NEAR(taken, rate * rate, 1e-20) << rate;
  }
}

// A slide on a base that is driven: what an impact does to the base is work of its drive, and the
// balance of energy holds across it. In a loop too, a slide and a crank on that base.
TEST(RigidStops, OnDrivenBasesKeepTheBalanceOfEnergy) {
  const char* on_a_base = R"(
gravity = [0, 0, -10]
[[body]]
name = "base"
mass = 0
[[joint]]
name = "D"
kind = "prismatic"
child = "base"
[[drive]]
joint = "D"
kind = "harmonic"
amplitude = 0.2
frequency = 3
[[body]]
name = "a"
mass = 2
shape = { kind = "sphere", radius = 0.1 }
[[joint]]
name = "A"
kind = "prismatic"
parent = "base"
child = "a"
position = 0.6
limits = [0, 5]
restitution = 0.5
)";
  const char* with_a_loop = R"(
[[body]]
name = "rod"
mass = 1
shape = { kind = "rod", length = 1 }
[[joint]]
name = "R"
kind = "revolute"
parent = "a"
child = "rod"
axis = "y"
position = 0.6
[[loop]]
name = "slot"
kind = "slot"
child = "rod"
axis = "x"
origin = { child = [1, 0, 0] }
)";
  for (const std::string& scene : {std::string(on_a_base), std::string(on_a_base) + with_a_loop})
    for (const Method& m : {methods[0], methods[1]}) {
      const RunResult result = run(parse_scene(scene, "base.toml"), m, 1);
      ASSERT_EQ(result.status, "done") << result.reason;
      ASSERT_GE(contacts(result, "impact").size(), 2U);
      EXPECT_LE(result.energy_error_max, 1e-6) << m.form << scene.size();
    }
}

// Two slides that fall side by side meet their stops at one time.
TEST(RigidStops, SeveralAtOnce) {
  Scene scene = slide(0.5);
  BodySpec body = scene.bodies[0];
  body.name = "b";
  JointSpec joint = scene.joints[0];
  joint.name = "B";
  joint.child = "b";
  scene.bodies.push_back(body);
  scene.joints.push_back(joint);
  const RunResult result = run(scene, methods[0], 2);
  ASSERT_EQ(result.status, "done") << result.reason;
  const auto impacts = contacts(result, "impact");
  ASSERT_GE(impacts.size(), 4U);
  EXPECT_EQ(impacts[0].t, impacts[1].t);
  EXPECT_NE(impacts[0].joint, impacts[1].joint);
  EXPECT_EQ(contacts(result, "held").size(), 2U);
}

/// Two slides on legs that meet in a knee, which falls and pushes both against their stops.
Scene toggle(double restitution) {
  return parse_scene(R"(
gravity = [0, 0, -9.81]
body = [
  { name = "a", mass = 1, shape = { kind = "box", size = [0.1, 0.1, 0.1] } },
  { name = "b", mass = 1, shape = { kind = "box", size = [0.1, 0.1, 0.1] } },
  { name = "c", mass = 0.5, shape = { kind = "rod", length = 1 } },
  { name = "d", mass = 0.5, shape = { kind = "rod", length = 1 } },
]
[[joint]]
name = "A"
kind = "prismatic"
child = "a"
axis = "x"
position = 0.5
limits = [-3, 0.7]
restitution = )" + std::to_string(restitution) +
                         R"(
[[joint]]
name = "B"
kind = "prismatic"
child = "b"
axis = "-x"
position = 0.5
limits = [-3, 0.7]
restitution = )" + std::to_string(restitution) +
                         R"(
[[joint]]
name = "C"
kind = "revolute"
parent = "a"
child = "c"
axis = "-y"
position = 2.0943951023931953
[[joint]]
name = "D"
kind = "revolute"
parent = "b"
child = "d"
axis = "-y"
position = 1.0471975511965976
[[loop]]
name = "knee"
kind = "revolute"
parent = "c"
child = "d"
axis = "y"
origin = { parent = [1, 0, 0], child = [1, 0, 0] }
)",
                     "toggle.toml");
}

// Two stops that push each other off come to rest: at rates below what a flight takes the held one
// holds on.
TEST(RigidStops, ThatPushEachOtherOffComeToRest) {
  for (const Method& m :
       {Method{"momentum", "dop853", 0, 0}, Method{"momentum-index2", "radau5", 0, 0},
        Method{"acceleration-index3", "ida", 0, 0}}) {
    const RunResult result = run(toggle(0.6), m, 2, 20, 1e-8);
    ASSERT_EQ(result.status, "done") << m.form << result.reason;
    EXPECT_LT(result.stops.size(), 300U) << m.form;
    EXPECT_EQ(contacts(result, "held").size(), contacts(result, "released").size() + 2) << m.form;
    EXPECT_LT(result.energy_error_max, 1e-3) << m.form;
  }
}

// A flight lower than the rounding of q is none, however short the run: 5e-8²/20 m is half of it.
TEST(RigidStops, HoldWhereAFlightIsLowerThanRounding) {
  const Mechanism mechanism(slide(1));
  RigidStops stops(mechanism, 0.2);
  RunResult told;
  double taken = 0;
  stops.begin(assemble(mechanism).start, told);
  const VectorXd q = VectorXd::Zero(1);
  stops.meet(0.1, q, VectorXd::Constant(1, -1e-6), {0}, told, taken);
  EXPECT_FALSE(stops.any_held());
  stops.meet(0.15, q, VectorXd::Constant(1, -5e-8), {0}, told, taken);
  EXPECT_TRUE(stops.any_held());
}

TEST(RigidStops, HoldOnAtPushesThatAreShorterThanAFlight) {
  Scene scene = toggle(0.6);
  scene.held = {"A", "B"};
  const Mechanism mechanism(scene);
  ASSERT_EQ(mechanism.tree().bodies[2].name, "b");
  const auto at = [&](double right, double rate) {
    VectorXd q = assemble(mechanism).start.q, u = VectorXd::Zero(4);
    q[0] = 0.7, q[2] = right, u[2] = rate;
    return assemble(mechanism, 1, q, u).start;
  };
  RigidStops stops(mechanism, 2);
  RunResult told;
  double taken = 0;
  stops.begin(assemble(mechanism).start, told);
  const Start first = at(0.69, 0), second = at(0.7, 2e-8);
  stops.meet(1, first.q, first.u, {1}, told, taken);
  ASSERT_EQ(contacts(told, "held").size(), 1U);
  stops.meet(1.1, second.q, second.u, {3}, told, taken);
  EXPECT_EQ(contacts(told, "held").size(), 2U);
  EXPECT_TRUE(contacts(told, "released").empty());
}

// An event whose number an impact turns is told at the impact, whatever the rest of the step shows:
// rates of the ball pass zero at each impact and at each top, up and down by turns, and no height
// below the stop is passed.
TEST(RigidStops, TurnTheNumbersOfEvents) {
  const Scene scene = slide(0.5,
                            "position = 0.6\n[[event]]\nwhen = \"A.u\"\n[[event]]\nname = "
                            "\"beyond\"\nwhen = \"A.q + 0.001\"\n");
  for (const Method& m : methods) {
    const RunResult result = run(scene, m, 2);
    ASSERT_EQ(result.status, "done") << m.form << result.reason;
    const auto impacts = contacts(result, "impact");
    ASSERT_GE(impacts.size(), 12U) << m.form;
    std::vector<double> ups, downs;
    for (const auto& event : result.events) {
      ASSERT_NE(event.name, "beyond") << m.form << event.t;
      if (event.t > impacts[11].t) break;
      ASSERT_EQ(event.up, ups.size() == downs.size()) << m.form << event.t;
      (event.up ? ups : downs).push_back(event.t);
    }
    ASSERT_GE(downs.size(), 10U) << m.form;
    for (std::size_t k = 0; k < 10; ++k) {
      EXPECT_NEAR(ups[k], impacts[k].t, 1e-12) << m.form << k;
      EXPECT_NEAR(downs[k], 0.5 * (impacts[k].t + impacts[k + 1].t), 10 * m.bound) << m.form << k;
    }
  }
}

TEST(RigidStops, RefuseAStartBeyondThem) {
  try {
    run(slide(0.5, "position = -0.1\n"), methods[0], 1);
    FAIL();
  } catch (const SceneError& e) {
    EXPECT_EQ(std::string(e.what()),
              "slide.toml: joint 'A' starts at -0.1, beyond its rigid stop at 0, expected a start "
              "within its limits");
  }
}

// W Λ = (1 + e) γ⁻ with the stop that holds, whatever acts behind the impact: slide a lies at its
// wall, b comes at −1 and meets a. Λ = 1.8 on both; then a is drawn along by 2 (v_b − v_a).
TEST(RigidStops, TakePartInAnImpactThatLetsThemGo) {
  const Scene scene = parse_scene(R"(
[[body]]
name = "a"
mass = 1
shape = { kind = "point" }
[[body]]
name = "b"
mass = 1
shape = { kind = "point" }
[[joint]]
name = "P"
kind = "prismatic"
child = "a"
axis = "x"
limits = [0, 9]
restitution = 0.5
[[joint]]
name = "Q"
kind = "prismatic"
parent = "a"
child = "b"
axis = "x"
position = 0.5
velocity = -1
limits = [0, 9]
restitution = 0.8
[[force]]
kind = "torque"
joint = "P"
law = "2*Q.u"
)",
                                  "held.toml");
  for (const Method& m : methods) {
    const RunResult result = run(scene, m, 1);
    ASSERT_EQ(result.status, "done") << m.form << ": " << result.reason;
    const auto impacts = contacts(result, "impact");
    ASSERT_EQ(impacts.size(), 1u) << m.form;
    EXPECT_NEAR(impacts[0].impulse, 1.8, 100 * m.bound) << m.form;
    EXPECT_EQ(contacts(result, "released").size(), 1u) << m.form;
    const double after = result.series.t.back() - impacts[0].t,
                 a = 0.8 * (after - 0.5 * (1 - std::exp(-2 * after)));
    EXPECT_NEAR(result.trajectory.rows.back()[1], a, 100 * m.bound) << m.form;
    EXPECT_NEAR(result.trajectory.rows.back()[2], 0.8 * after - a, 100 * m.bound) << m.form;
  }
}

// Flights of 1e-4 s in a run of 1e5 s: each stop is met again within 1e-8 of the run, and was left.
TEST(RigidStops, AreLeftByFlightsThatAreShortForTheRun) {
  const Mechanism mechanism(parse_scene(R"(
[[body]]
name = "a"
mass = 1
shape = { kind = "point" }
[[joint]]
name = "P"
kind = "prismatic"
child = "a"
position = 5e-5
velocity = 1
limits = [0, 1e-4]
restitution = 1
)",
                                        "flights.toml"));
  RigidStops stops(mechanism, 1e5);
  RunResult told;
  Start at = stops.begin(assemble(mechanism).start, told);
  for (int k = 0; k < 10; ++k) {
    const bool upper = k % 2 == 0;
    double taken = 0;
    const VectorXd q = VectorXd::Constant(1, upper ? 1e-4 : 0), u = at.u;
    at = stops.meet(5e-5 + 1e-4 * k, q, u, {upper ? 1UL : 0UL}, told, taken);
    EXPECT_EQ(at.u[0], -u[0]) << k;
    EXPECT_FALSE(stops.any_held()) << k;
  }
}

// Flights are over before a method looks at its clock.
TEST(RigidStops, ARunOfManyShortFlightsEndsAtItsLimitOfTime) {
  const Mechanism mechanism(slide(1, "position = 1e-4\n"));
  RunRequest request =
      equations::kept(equations::adaptive("momentum", "dop853", "none", 1e-8, 1e5, 10));
  request.max_cpu_seconds = 0.2;
  const RunResult result = run_form(mechanism, assemble(mechanism).start, request);
  EXPECT_EQ(result.status, "time limit");
  EXPECT_NE(result.reason.find("time limit of 0.2 s"), std::string::npos) << result.reason;
  EXPECT_LT(result.cpu_s, 2);
}

}  // namespace
}  // namespace momenta::dae_rigid_stops
