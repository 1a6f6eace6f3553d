// Scenes in other units and in turned rooms move alike: q(t) of the one is q(τt) of the other,
// lengths times s, in the same steps. So do scenes of another size, and scenes that start at rest
// at another speed.

#include "equations/ensemble.h"
#include "equations/examples.h"
#include "equations/linkages.h"
#include "equations/other_trees.h"
#include "equations/runs.h"
#include "equations/scissor.h"
#include "equations/small_scenes.h"

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/study/extremes.h>

#include <cmath>
#include <random>

namespace momenta::dae_extremes {
namespace {

using equations::example;

/// Everything a scene can have that has a unit, in one mechanism: springs, dampers, drives of
/// lengths and angles, a coupler between the two, a wrench, a moving point.
Scene rich() {
  return parse_scene(R"(
name = "rich"
gravity = [0.3, -9.81, 0.0]
[run]
end = 1.5
[[body]]
name = "cart"
mass = 2.0
shape = { kind = "box", size = [0.2, 0.1, 0.1] }
[[body]]
name = "arm"
mass = 0.7
shape = { kind = "rod", length = 0.6, axis = "x" }
[[body]]
name = "screw"
mass = 0.4
com = [0.1, 0.0, 0.05]
inertia = [0.02, 0.03, 0.04]
[[body]]
name = "crank"
mass = 0.5
shape = { kind = "rod", length = 0.3, axis = "x" }
[[body]]
name = "rod"
mass = 0.3
shape = { kind = "rod", length = 1.1, axis = "x" }
[[joint]]
name = "track"
kind = "prismatic"
parent = "ground"
child = "cart"
axis = [1, 0, 0]
position = 0.2
velocity = 0.4
stiffness = 40.0
rest = 0.1
damping = 0.8
[[joint]]
name = "pin"
kind = "revolute"
parent = "cart"
child = "arm"
axis = [0, 0, 1]
position = -0.8
velocity = 0.9
stiffness = 1.5
damping = 0.05
[[joint]]
name = "thread"
kind = "helical"
parent = "arm"
child = "screw"
origin = { parent = [0.6, 0, 0] }
axis = [1, 0, 0]
pitch = 0.02
velocity = 3.0
[[joint]]
name = "O"
kind = "revolute"
parent = "ground"
child = "crank"
origin = { parent = [0, 1, 0] }
axis = [0, 0, 1]
[[joint]]
name = "A"
kind = "revolute"
parent = "crank"
child = "rod"
origin = { parent = [0.3, 0, 0] }
axis = [0, 0, 1]
position = -1.2
[[loop]]
name = "string"
kind = "distance"
parent = "ground"
child = "rod"
origin = { parent = [1.3, 0.4, 0], child = [1.1, 0, 0] }
length = 0.5
[[loop]]
name = "gear"
kind = "coupler"
joints = ["track", "thread"]
ratios = [1.0, 0.05]
offset = 0.2
[[drive]]
joint = "O"
kind = "harmonic"
amplitude = 0.4
frequency = 3.0
[[drive]]
loop = "string"
origin = "y"
kind = "polynomial"
coefficients = [0.4, 0.05, -0.03]
[[force]]
kind = "spring-damper"
parent = "ground"
child = "arm"
origin = { parent = [0.5, -1.0, 0.2], child = [0.6, 0, 0] }
stiffness = 25.0
damping = 0.3
rest = 0.4
[[force]]
kind = "torque"
joint = "pin"
value = 0.6
[[force]]
kind = "wrench"
body = "screw"
point = [0.1, 0, 0]
force = [0.5, 0.2, -0.1]
torque = [0.01, 0.02, 0.03]
)");
}

struct Ends {
  Eigen::VectorXd q, u;
};
Ends run_to_end(const Scene& scene) {
  validate(scene);
  const Mechanism mechanism(scene);
  const Start start = equations::start_of(mechanism);
  RunRequest request;
  request.settings.gauge = "reset";
  request.settings.project = mechanism.m() > 0;
  // Steps of one length in the units of the scene: then both take the same ones, and only rounding
  // is left between them.
  request.settings.integrator = "rk4";
  request.settings.step = scene.run.end_time / 3000;
  request.settings.end_time = scene.run.end_time;
  request.settings.samples = 2;
  request.keep_trajectory = true;
  const RunResult run = run_form(mechanism, start, request);
  EXPECT_EQ(run.status, "done") << run.reason;
  const auto& row = run.trajectory.rows.back();
  const auto nq = mechanism.nq(), nv = mechanism.nv();
  return {Eigen::Map<const Eigen::VectorXd>(row.data() + 1, nq),
          Eigen::Map<const Eigen::VectorXd>(row.data() + 1 + nq, nv)};
}

void expect_similar(const Scene& scene, const Units& units, double tolerance) {
  const Ends plain = run_to_end(scene), other = run_to_end(in_units(scene, units));
  const Tree tree = build_tree(scene);
  for (const auto& b : tree.bodies) {
    const double s = b.kind == JointKind::prismatic ? units.length : 1;
    for (int i = 0; i < b.nv; ++i) {
      EXPECT_NEAR(other.q[b.q + i] / s, plain.q[b.q + i], tolerance) << b.joint;
      EXPECT_NEAR(other.u[b.u + i] * units.time / s, plain.u[b.u + i], 10 * tolerance) << b.joint;
    }
  }
}

TEST(Extremes, OtherUnitsSameMotion) {
  for (const Units& units : {Units{1000, 1, 1}, Units{1, 1e-3, 1}, Units{1, 1, 1e6},
                             Units{0.0254, 60, 0.4536}, Units{1e-3, 1e-3, 1e-9}})
    expect_similar(rich(), units, 1e-10);
}

TEST(Extremes, UnitsThatAreLeftOutWouldBeSeen) {
  // The law above has something to compare: the motion is not at rest, and every coordinate moves.
  const Scene scene = rich();
  const Ends end = run_to_end(scene);
  EXPECT_GT(end.u.cwiseAbs().minCoeff(), 1e-2);
}

TEST(Extremes, SizeAndSpeedFromRestAreSimilarMotions) {
  Scene four_bar = example("four_bar/scene.toml");
  four_bar.run.end_time = 3;
  const Ends plain = run_to_end(four_bar);
  for (const double f : {1e-3, 1e-1, 1e2, 1e4}) {
    const Ends sized = run_to_end(driven_to(four_bar, Extreme::size, f));
    EXPECT_LT((sized.q - plain.q).norm(), 1e-10) << f;
    EXPECT_LT((sized.u * std::sqrt(f) - plain.u).norm(), 1e-9) << f;
    const Ends fast = run_to_end(driven_to(four_bar, Extreme::speed, f));
    EXPECT_LT((fast.q - plain.q).norm(), 1e-10) << f;
    EXPECT_LT((fast.u / f - plain.u).norm(), 1e-9) << f;
  }
}

TEST(Extremes, WhatASceneLacksIsSaid) {
  const Scene chain = example("pendulum/scene.toml");
  EXPECT_EQ(lacks(chain, Extreme::stiffness), "no spring in it");
  EXPECT_EQ(lacks(chain, Extreme::mass_ratio), "one body only");
  EXPECT_EQ(lacks(chain, Extreme::size), "");
}

TEST(Extremes, FactorsGoWhereTheyShould) {
  const Scene governor = example("extremes/governor.toml");
  const Scene stiff = driven_to(governor, Extreme::stiffness, 10);
  EXPECT_EQ(stiff.forces[0].stiffness, 8e6);
  EXPECT_EQ(stiff.forces[0].damping, 4e4);
  EXPECT_EQ(driven_to(governor, Extreme::damping, 10).forces[1].damping, 4e5);
  const Scene heavy = driven_to(governor, Extreme::mass_ratio, 10);
  EXPECT_EQ(heavy.bodies[0].mass, governor.bodies[0].mass);
  EXPECT_EQ(heavy.bodies[1].mass, 10 * governor.bodies[1].mass);
  EXPECT_EQ(heavy.bodies[1].inertia(2, 2), 10 * governor.bodies[1].inertia(2, 2));
  EXPECT_EQ(driven_to(governor, Extreme::speed, 10).joints[0].velocity[0],
            10 * governor.joints[0].velocity[0]);
  EXPECT_EQ(driven_to(governor, Extreme::duration, 10).run.end_time, 100);
  const Scene damped = driven_to(example("four_bar/scene.toml"), Extreme::damping, 1);
  for (const JointSpec& j : damped.joints) EXPECT_DOUBLE_EQ(j.damping, 4.5 * 2 * 2);
}

TEST(Extremes, MasslessCouplerMovesLikeOneThatWeighsNextToNothing) {
  // No inertia at one joint: M is singular, (7) is not.
  const auto at_end = [](double mass, const std::string& form, const std::string& method,
                         const std::string& gauge) {
    Scene scene = example("four_bar/scene.toml");
    scene.bodies[1].mass = mass;
    scene.bodies[1].inertia = mass / 3 * Eigen::Matrix3d::Identity();
    const Mechanism mechanism(scene);
    RunRequest request = equations::kept(equations::adaptive(form, method, gauge, 1e-9, 2));
    request.settings.project = method == "dop853" && form == "momentum";
    const RunResult run = run_form(mechanism, equations::start_of(mechanism), request);
    EXPECT_EQ(run.status, "done") << form << ": " << run.reason;
    return Eigen::VectorXd(
        Eigen::Map<const Eigen::VectorXd>(run.trajectory.rows.back().data() + 1, mechanism.nq()));
  };
  const Eigen::VectorXd light = at_end(1e-6, "projected", "dop853", "");
  EXPECT_LT((at_end(0, "momentum", "dop853", "reset") - light).norm(), 1e-5);
  EXPECT_LT((at_end(0, "momentum", "dop853", "leak") - light).norm(), 1e-5);
  EXPECT_LT((at_end(0, "momentum", "dp5", "none") - light).norm(), 1e-5);
  EXPECT_LT((at_end(0, "momentum-index2", "ida", "leak") - light).norm(), 1e-4);
  EXPECT_LT((at_end(0, "projected", "dop853", "") - light).norm(), 1e-5);
}

TEST(Extremes, SingularCrossingsAreListed) {
  // The vertical's angle from upright obeys φ'' = λ sin φ: flat at π/2, 3π/2, …
  const auto run_of = [](const std::string& name) {
    Scene scene = example(name);
    const Mechanism mechanism(scene);
    RunRequest request;
    request.settings.gauge = "reset";
    request.settings.project = true;
    request.settings.end_time = 5;
    request.keep_trajectory = true;
    return run_form(mechanism, equations::start_of(mechanism), request);
  };
  const RunResult regular = run_of("four_bar/scene.toml");
  EXPECT_TRUE(regular.singular_crossings.empty());
  EXPECT_GT(regular.least_pivot, 0.01);
  // The slider-crank with equal links is straight up and straight down where its angle is π/2 + kπ.
  const RunResult crank = run_of("slider_crank/scene.toml");
  ASSERT_EQ(crank.status, "done") << crank.reason;
  std::vector<double> expected;
  const auto& rows = crank.trajectory.rows;
  const auto folded = [](double q) { return std::cos(q); };
  for (std::size_t i = 1; i < rows.size(); ++i)
    if ((folded(rows[i][1]) > 0) != (folded(rows[i - 1][1]) > 0)) {
      const double a = folded(rows[i - 1][1]), b = folded(rows[i][1]);
      expected.push_back(rows[i - 1][0] + (rows[i][0] - rows[i - 1][0]) * a / (a - b));
    }
  ASSERT_GT(expected.size(), 2u);
  ASSERT_EQ(crank.singular_crossings.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(crank.singular_crossings[i].t, expected[i], 0.02);
    EXPECT_LT(crank.singular_crossings[i].pivot, 1e-2);
  }
}

// The uprights of a row of four-bars are a pendulum; its poses are singular where they lie flat,
// whatever joints are cut, and every one is found inside the steps.
TEST(Extremes, EveryFlatPoseOfARowIsACrossing) {
  constexpr int n = 10;
  constexpr double first_angle = 1.1, end = 10;
  // φ'' = −k cos φ by RK4, and when it passes a multiple of π.
  const double k = 9.81 * (0.5 * (n + 1) + n) / ((n + 1) / 3.0 + n);
  std::vector<double> flat;
  constexpr int steps = 100000;
  constexpr double h = end / steps;
  double at = first_angle, rate = 0;
  for (int i = 0; i < steps; ++i) {
    const auto f = [&](double x) { return -k * std::cos(x); };
    const double k1 = f(at), k2 = f(at + h / 2 * rate), k3 = f(at + h / 2 * (rate + h / 2 * k1)),
                 k4 = f(at + h * (rate + h / 2 * k2));
    const double before = std::sin(at);
    at += h * (rate + h / 6 * (k1 + k2 + k3));
    rate += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    if ((std::sin(at) > 0) != (before > 0)) flat.push_back(h * (i + 1));
  }
  ASSERT_GT(flat.size(), 8u);
  for (unsigned seed = 0; seed < 6; ++seed) {
    Scene scene = equations::at_start(equations::row_of_four_bars(n, first_angle));
    scene.run.project = true;
    equations::RandomTree random(seed);
    equations::cut_elsewhere(random, scene);
    const Mechanism mechanism(scene);
    RunRequest request;
    request.settings = default_settings(scene.run, "momentum", "", 1e-8);
    request.settings.end_time = end;
    request.settings.samples = 1;
    const RunResult run = run_form(mechanism, equations::start_of(mechanism), request);
    ASSERT_EQ(run.status, "done") << run.reason;
    ASSERT_EQ(run.singular_crossings.size(), flat.size()) << "tree " << seed;
    for (std::size_t i = 0; i < flat.size(); ++i)
      EXPECT_NEAR(run.singular_crossings[i].t, flat[i], 0.02) << "tree " << seed;
  }
}

// A lift that goes up and down by a few degrees: its pivots, small throughout, go with the shape of
// it and come near no pose at which loops lose rank.
TEST(Extremes, LoopsThatAreWeakThroughoutCrossNothing) {
  const Mechanism mechanism(equations::driven_scissor(LoopKind::prismatic, 0.5),
                            {.algebra = Algebra::spatial});
  RunRequest request;
  request.settings.form = "projected";
  request.settings.end_time = 3;
  const RunResult lift = run_form(mechanism, equations::start_of(mechanism), request);
  ASSERT_EQ(lift.status, "done") << lift.reason;
  EXPECT_LT(lift.least_pivot, 1e-2);
  EXPECT_TRUE(lift.singular_crossings.empty());
}

/// What the program chooses by itself, leaks, gains, tolerances, first steps, verdicts, is the same
/// choice in other units, and runs take the same steps to the same end: within what rounding
/// decides, of explicit methods next to nothing, of Newton's a correction here and there.
struct Case {
  const char* name;
  Scene scene;
  double end;  ///< [s]
};

/// Hinges, slides, balls and a flying body; with loops, redundant ones and without; driven,
/// falling, at rest and thrown.
std::vector<Case> cases() {
  std::vector<Case> all{{"four_bar", example("four_bar/scene.toml"), 0.6},
                        {"bricard", equations::bricard(), 0.4},
                        {"slider_crank", example("slider_crank/scene.toml"), 0.4},
                        {"spatial_slider_crank", example("spatial_slider_crank/scene.toml"), 0.1},
                        {"andrews", example("andrews/scene.toml"), 0.003},
                        {"platform", equations::platform(6), 0.1},
                        {"flying rod", equations::flying_rod(), 0.3},
                        {"pendulum", example("pendulum/scene.toml"), 0.5}};
  for (Case& c : all) {
    c.scene.run.end_time = c.end;
    c.scene.run.leak.reset();
  }
  return all;
}

const Units others[] = {{1e-6, 1, 1}, {1e6, 1, 1},     {1, 1e-6, 1},     {1, 1e6, 1},
                        {1, 1, 1e-6}, {1, 1, 1e6},     {1e3, 1e-3, 1e3}, {1e-6, 1e6, 1e6},
                        {10, 1, 1},   {1e6, 1e6, 1e-6}};

std::string in_words(const Units& u) {
  char text[80];
  std::snprintf(text, sizeof text, "length %g, time %g, mass %g", u.length, u.time, u.mass);
  return text;
}

RunResult run_in(const Scene& scene, const std::string& form, const std::string& method,
                 const std::string& gauge = "") {
  const Mechanism mechanism(scene);
  RunRequest request;
  request.settings = default_settings(scene.run, form, method, 1e-7);
  if (!gauge.empty()) request.settings.gauge = gauge;
  request.settings.samples = 4;
  return run_form(mechanism, equations::start_of(mechanism), request);
}

void expect_same_choices(const RunResult& plain, const RunResult& other, const Units& units,
                         const std::string& where) {
  EXPECT_EQ(other.status, plain.status) << where << ": " << other.reason << plain.reason;
  const bool implicit = is_dae_form(plain.settings.form);
  const auto steps = static_cast<double>(plain.counters.steps + plain.counters.rejected);
  EXPECT_NEAR(static_cast<double>(other.counters.steps + other.counters.rejected), steps,
              implicit ? 4 + 0.15 * steps : 1 + 0.02 * steps)
      << where;
  EXPECT_NEAR(other.settings.baumgarte_beta * units.time, plain.settings.baumgarte_beta,
              1e-9 * plain.settings.baumgarte_beta)
      << where;
  if (plain.settings.gauge.rfind("leak:", 0) == 0) {
    const double kappa = parse_gauge(plain.settings.gauge).kappa;
    EXPECT_NEAR(parse_gauge(other.settings.gauge).kappa * units.time, kappa, 0.05 * kappa) << where;
  }
  EXPECT_EQ(other.rank, plain.rank) << where;
}

class InOtherUnits : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(InOtherUnits, TheSameSteps) {
  const auto [form, method] = GetParam();
  std::size_t turn = 0;
  for (const Case& c : cases()) {
    const RunResult plain = run_in(c.scene, form, method);
    for (int k = 0; k < 2; ++k) {
      const Units& units = others[turn++ % std::size(others)];
      expect_same_choices(plain, run_in(in_units(c.scene, units), form, method), units,
                          std::string(c.name) + ", " + in_words(units));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Forms, InOtherUnits,
    testing::Values(std::pair{"momentum", "dop853"}, std::pair{"acceleration", "dp5"},
                    std::pair{"baumgarte", "vern9"}, std::pair{"partitioned", "dop853"},
                    std::pair{"projected", "dp5"}, std::pair{"momentum-index2", "ida"},
                    std::pair{"stabilised-index2", "ida"}, std::pair{"momentum-index2", "bdf5"},
                    std::pair{"acceleration-index2", "radau5"}),
    [](const auto& form) {
      std::string name = std::string(form.param.first) + "_" + form.param.second;
      std::replace(name.begin(), name.end(), '-', '_');
      return name;
    });

TEST(Extremes, RandomScenesTakeTheSameStepsInOtherUnits) {
  std::mt19937 random(7);
  int compared = 0;
  for (int k = 0; k < 24; ++k) {
    std::vector<unsigned char> bytes(160);
    for (unsigned char& b : bytes) b = static_cast<unsigned char>(random());
    Scene scene = equations::sound_scene(bytes, k % 2 == 0);
    const Units& units = others[static_cast<std::size_t>(k) % std::size(others)];
    const char* form = k % 3 == 0 ? "acceleration" : k % 3 == 1 ? "momentum" : "stabilised-index2";
    RunResult plain;
    try {
      plain = run_in(scene, form, "");
    } catch (const SceneError&) {  // it cannot be assembled
      continue;
    }
    if (plain.status != "done") continue;
    ++compared;
    expect_same_choices(plain, run_in(in_units(scene, units), form, ""), units,
                        "scene " + std::to_string(k) + ", " + in_words(units));
  }
  EXPECT_GT(compared, 10);
}

/// Points tied by a rod, by formulas: a satellite of two masses on a tether, and a pendulum.
Scene tether(double metre) {
  return parse_scene("[parameters]\nm = " + std::to_string(metre) + R"toml(
mu = "3.986e14*m^3"
R = "7e6*m"
L = "1000*m"
[lagrangian]
coordinates = ["x1", "y1", "x2", "y2"]
units = ["m", "m", "m", "m"]
position = ["R", 0, "R+L*cos(0.3)", "L*sin(0.3)"]
velocity = [0, "sqrt(mu/R)", 0, "sqrt(mu/R)"]
kinetic = "250*(x1.dot^2+y1.dot^2)+150*(x2.dot^2+y2.dot^2)"
potential = "-mu*500/hypot(x1,y1)-mu*300/hypot(x2,y2)"
constraints = [{name = "tether", equation = "hypot(x2-x1,y2-y1)-L"}]
[run]
end = 6000
)toml");
}

Scene pendulum(double metre) {
  return parse_scene("[parameters]\nm = " + std::to_string(metre) + R"toml(
[lagrangian]
coordinates = ["x", "y"]
units = ["m", "m"]
position = ["0.9*m*sin(1)", "-0.9*m*cos(1)"]
kinetic = "0.5*(x.dot^2+y.dot^2)"
potential = "9.81*m*y"
constraints = [{name = "r", equation = "hypot(x,y)-0.9*m"}]
[run]
end = 2
)toml");
}

/// The same of bodies, which start far off for their lengths: rounding of v × p turns them by more
/// than the tolerance in steps of the orbit, so that steps are those it allows.
Scene tether_of_bodies(double metre) {
  return parse_scene("[parameters]\nm = " + std::to_string(metre) + R"toml(
mu = "3.986e14*m^3"
R = "7e6*m"
L = "1000*m"
[[body]]
name = "a"
mass = 500
inertia = "50*m^2"
[[body]]
name = "b"
mass = 300
inertia = "30*m^2"
[[joint]]
name = "A"
kind = "planar"
child = "a"
position = ["R", 0, 0]
velocity = [0, "sqrt(mu/R)", 0]
[[joint]]
name = "B"
kind = "planar"
child = "b"
position = ["R+L*cos(0.3)", "L*sin(0.3)", 0]
velocity = [0, "sqrt(mu/R)", 0]
[[marker]]
name = "a"
body = "a"
[[marker]]
name = "b"
body = "b"
[[force]]
kind = "potential"
V = "-mu*500/hypot(a.x,a.y)-mu*300/hypot(b.x,b.y)"
[[loop]]
name = "tether"
kind = "distance"
parent = "a"
child = "b"
length = "L"
[run]
end = 300
)toml");
}

TEST(Extremes, ASatelliteOfBodiesRuns) {
  for (const double metre : {1.0, 1e-3, 1e3})
    for (const auto& [form, gauge] :
         {std::pair{"momentum", "reset"}, std::pair{"momentum", "leak"},
          std::pair{"momentum-index2", "leak"}, std::pair{"stabilised-index2", ""}}) {
      const RunResult run = run_in(tether_of_bodies(metre), form, "", gauge);
      EXPECT_EQ(run.status, "done") << form << " " << metre << ": " << run.reason;
      EXPECT_LT(run.counters.steps, 5000) << form << " " << metre;
    }
}

/// The leak comes from what the loop does, no faster than the orbit, 1.1e-3/s, and not from the
/// speed.
TEST(Extremes, ASatelliteLeaksNoFasterThanItTurns) {
  for (const double metre : {1.0, 1e-3, 1e3}) {
    const Mechanism mechanism(tether(metre));
    const double kappa = default_leak(mechanism, equations::start_of(mechanism));
    EXPECT_LT(kappa, 1.1e-3) << metre;
    const RunResult run = run_in(mechanism.scene(), "momentum", "");
    EXPECT_EQ(run.status, "done") << run.reason;
    EXPECT_LT(run.counters.steps, 200) << metre;
  }
}

TEST(Extremes, APendulumTakesTheSameStepsInMillimetres) {
  for (const char* form : {"momentum", "acceleration", "stabilised-index2", "momentum-index2"}) {
    const RunResult plain = run_in(pendulum(1), form, "");
    EXPECT_EQ(plain.status, "done") << form << plain.reason;
    for (const double metre : {1e-3, 1e3, 1e6})
      expect_same_choices(plain, run_in(pendulum(metre), form, ""), {metre, 1, 1},
                          std::string(form) + " " + std::to_string(metre));
  }
}

/// A linkage on a table that a drive turns, at rest on it: the table's rate opens no loop, and what
/// rounding leaves of it is held against that rate.
TEST(Extremes, ADriveThatTurnsAllLoopsAsOneStarts) {
  std::mt19937 random(11);
  const auto number = [&](double low, double high) {
    return std::to_string(std::uniform_real_distribution(low, high)(random));
  };
  for (int k = 0; k < 40; ++k) {
    const Scene scene = parse_scene(R"toml(
[[body]]
name = "table"
mass = 1
inertia = 1
[[body]]
name = "a"
mass = 1
inertia = 1
[[body]]
name = "b"
mass = 1
inertia = 1
[[joint]]
name = "S"
kind = "revolute"
child = "table"
axis = "z"
[[joint]]
name = "A"
kind = "revolute"
parent = "table"
child = "a"
axis = "z"
origin = { parent = [0.1, 0.2, 0] }
position = )toml" + number(-3, 3) + R"toml(
[[joint]]
name = "B"
kind = "revolute"
parent = "a"
child = "b"
axis = "z"
origin = { parent = [1, 0, 0] }
position = )toml" + number(-3, 3) + R"toml(
[[loop]]
name = "L"
kind = "revolute"
axis = "z"
parent = "table"
child = "b"
origin = { parent = [)toml" + number(0.5, 1.5) +
                                    ", " + number(-1, 1) + R"toml(, 0], child = [1.2, 0, 0] }
[[drive]]
joint = "S"
kind = "polynomial"
coefficients = [0.3, )toml" + number(-9, 9) +
                                    "]\n");
    for (const Units& units :
         {Units{1, 1, 1}, others[static_cast<std::size_t>(k) % std::size(others)]}) {
      const Mechanism mechanism(in_units(scene, units));
      const Start start = equations::start_of(mechanism);
      EXPECT_LT(start.u.cwiseAbs().maxCoeff() * units.time, 1e-12) << k << in_words(units);
    }
  }
}

}  // namespace
}  // namespace momenta::dae_extremes
