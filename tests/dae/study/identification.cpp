// Parameters of a scene found for a measured motion: against closed formulas of the motion, against
// differences, and, of their standard deviations, against the spread of many measurements.

#include <gtest/gtest.h>
#include <momenta/core/scalar/sixth_order.h>
#include <momenta/dae/study/fit/identification.h>

#include <cmath>
#include <fstream>
#include <random>

namespace momenta::dae_identification {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A mass on a spring with a damper: x = e^(−δt) (a cos ωt + (v + δa)/ω sin ωt), δ = c/2m,
/// ω² = k/m − δ².
const char* const oscillator = R"toml(
name = "oscillator"
gravity = [0.0, 0.0, 0.0]
[parameters]
k = 30.0
c = 0.5
[[body]]
name = "mass"
mass = 2.0     # weighed
inertia = [1.0, 1.0, 1.0]
[[joint]]
name = "S"
kind = "prismatic"
child = "mass"
axis = [1, 0, 0]
position = 0.3
velocity = -0.2
stiffness = "k"
damping = "c"
)toml";

struct Truth {
  double k = 41.0, c = 0.9, m = 2.0, a = 0.3, v = -0.2;
  double x(double t) const {
    const double d = c / (2 * m), w = std::sqrt(k / m - d * d);
    return std::exp(-d * t) * (a * std::cos(w * t) + (v + d * a) / w * std::sin(w * t));
  }
};

MeasuredMotion measured_of(const Truth& truth, int times, double every) {
  MeasuredMotion measured;
  measured.file = "closed formula";
  measured.quantities = {{"S.q", "m"}};
  measured.values.resize(times, 1);
  for (int i = 0; i < times; ++i) {
    measured.times.push_back(every * (i + 1));
    measured.values(i, 0) = truth.x(measured.times.back());
  }
  return measured;
}

IdentificationRequest request_for(const std::string& text, const std::vector<std::string>& vary) {
  IdentificationRequest request;
  for (const std::string& name : vary)
    request.parameters.push_back(FittedParameter::from_text(name));
  request.scene = {text, "identified.toml", {}, {}};
  request.scene.options.cut = CutChoice::scene;
  request.settings.integrator = "dop853";
  request.settings.rtol = 1e-11;
  request.settings.atol = 1e-11;
  return request;
}

Identification identified(const std::string& text, const MeasuredMotion& measured,
                          const std::vector<std::string>& vary) {
  const IdentificationRequest request = request_for(text, vary);
  std::vector<std::string> names;
  for (const FittedParameter& p : request.parameters) names.push_back(p.name);
  return identify(ParametricMechanism(text, "identified.toml", {}, names), measured, request);
}

TEST(Identification, FindsTheSpringAndTheDamperOfAClosedFormula) {
  const Identification found = identified(oscillator, measured_of({}, 40, 0.11), {"k", "c"});
  EXPECT_TRUE(found.starts[0].converged) << found.starts[0].why;
  EXPECT_NEAR(found.found[0], 41, 41e-8);
  EXPECT_NEAR(found.found[1], 0.9, 0.9e-8);
  EXPECT_LT(found.errors(found.after)(0, 1), 1e-9);
  EXPECT_GT(found.errors(found.before)(0, 1), 0.1);
  EXPECT_LT(found.deviations[0], 1e-6);
  EXPECT_EQ(found.undetermined, "");
}

// A number that is no parameter, by its place; start values too, and cells that are empty.
TEST(Identification, FindsNumbersByTheirPlaces) {
  Truth truth;
  truth.k = 30;
  truth.c = 0.5;
  truth.m = 2.3;
  truth.a = 0.35;
  MeasuredMotion measured = measured_of(truth, 40, 0.11);
  measured.values(3, 0) = measured.values(17, 0) = NAN;
  ASSERT_EQ(measured.count(), 38);
  const std::vector<std::string> vary{"body.mass.mass", "joint.S.position"};
  const Identification found = identified(oscillator, measured, vary);
  EXPECT_TRUE(found.starts[0].converged) << found.starts[0].why;
  EXPECT_NEAR(found.found[0], 2.3, 2.3e-8);
  EXPECT_NEAR(found.found[1], 0.35, 0.35e-8);

  const ParametricMechanism family(oscillator, "identified.toml", {}, vary);
  std::string expected = oscillator;
  expected.replace(expected.find("mass = 2.0 "), 11, "mass = 2.5 ");
  expected.replace(expected.find("position = 0.3"), 14, "position = 0.25");
  EXPECT_EQ(family.text(Eigen::Vector2d(2.5, 0.25)), expected);
}

// Of a hundred measurements with Gaussian errors, the estimates spread as their deviations say.
TEST(Identification, StandardDeviationsAreTheSpreadOfManyMeasurements) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> error(0, 0.01);
  const MeasuredMotion exact = measured_of({}, 25, 0.16);
  constexpr int draws = 100;
  MatrixXd estimates(draws, 2), deviations(draws, 2);
  for (int i = 0; i < draws; ++i) {
    MeasuredMotion measured = exact;
    for (double& y : measured.values.reshaped()) y += error(random);
    IdentificationRequest request = request_for(oscillator, {"k", "c"});
    request.settings.integrator = "rk4";
    request.settings.step = 0.04;
    const Identification found = identify(
        ParametricMechanism(oscillator, "identified.toml", {}, {"k", "c"}), measured, request);
    EXPECT_TRUE(found.starts[0].converged) << found.starts[0].why;
    estimates.row(i) = found.found.transpose();
    deviations.row(i) = found.deviations.transpose();
  }
  for (Index j = 0; j < 2; ++j) {
    const double mean = estimates.col(j).mean(),
                 spread = std::sqrt((estimates.col(j).array() - mean).square().sum() / (draws - 1)),
                 told = deviations.col(j).mean();
    // The spread of 100 draws is itself known to 1/sqrt(200) = 7 %: four of these.
    EXPECT_NEAR(told / spread, 1, 0.28) << j;
    EXPECT_NEAR(mean, j == 0 ? 41 : 0.9, 4 * spread / std::sqrt(draws)) << j;
  }
}

/// A four-bar with a damper, which a marker and rates are measured on.
std::string damped_four_bar() {
  return R"toml(
name = "damped four-bar"
gravity = [0.0, -9.81, 0.0]
[parameters]
coupler = 2.0
damping = 0.3
weight = 1.5
[assembly]
hold = ["O"]
[[body]]
name = "crank"
mass = 1
shape = { kind = "rod", length = 1, axis = "x" }
[[body]]
name = "coupler"
mass = "weight"
shape = { kind = "rod", length = "coupler", axis = "x" }
[[body]]
name = "rocker"
mass = 1
shape = { kind = "rod", length = 2, axis = "x" }
[[joint]]
name = "O"
kind = "revolute"
child = "crank"
axis = [0, 0, 1]
position = 1.2
damping = "damping"
[[joint]]
name = "A"
kind = "revolute"
parent = "crank"
child = "coupler"
origin = { parent = [1, 0, 0] }
axis = [0, 0, 1]
position = -1
[[joint]]
name = "C"
kind = "revolute"
child = "rocker"
origin = { parent = [2, 0, 0] }
axis = [0, 0, 1]
position = 1.5
[[loop]]
name = "B"
kind = "revolute"
parent = "coupler"
child = "rocker"
origin = { parent = ["coupler", 0, 0], child = [2, 0, 0] }
axis = [0, 0, 1]
[[marker]]
name = "P"
body = "coupler"
point = ["coupler / 2", 0.3, 0]
)toml";
}

// ∂r/∂θ against differences of runs with the same steps, of coordinates, rates and markers.
TEST(Identification, DerivativesAreThoseOfTheRun) {
  const std::string text = damped_four_bar();
  const std::vector<std::string> names{"coupler", "damping", "weight"};
  const ParametricMechanism family(text, "identified.toml", {}, names);
  MeasuredMotion measured;
  measured.quantities = {{"C.q", "rad"}, {"O.u", "rad/s"}, {"P.x", "m"}, {"P.vy", "m/s"}};
  measured.times = {0, 0.13, 0.4, 0.75, 1};
  measured.values = MatrixXd::Random(5, 4);
  SceneText scene{text, "identified.toml", {}, {}};
  scene.options.cut = CutChoice::scene;
  RunSettings settings;
  settings.integrator = "rk4";
  settings.step = 0.01;
  settings.gauge = "reset";
  MeasuredError error(family, scene, settings, measured);
  VectorXd r;
  MatrixXd jacobian;
  ASSERT_TRUE(error.evaluate(family.own(), r, &jacobian)) << error.why();
  ASSERT_EQ(r.size(), 20);
  for (Index j = 0; j < 3; ++j) {
    VectorXd sum = VectorXd::Zero(20);
    for (const auto& point : sixth_order::points) {
      VectorXd theta = family.own(), at;
      constexpr double h = 0.01;
      theta[j] += point.k * h;
      ASSERT_TRUE(error.evaluate(theta, at, nullptr)) << error.why();
      sum += point.weight / h * at;
    }
    EXPECT_LT((sum - jacobian.col(j)).norm(), 1e-7 * jacobian.col(j).norm()) << names[j];
  }
}

// A pendulum tells g over l alone, and nothing of its mass.
TEST(Identification, TellsWhatTheMotionDoesNotDependOn) {
  const char* const pendulum = R"toml(
[parameters]
m = 1.3
l = 0.8
g = 9.81
[[body]]
name = "bob"
mass = "m"
com = [0, "-l", 0]
inertia = [0.0, 0.0, 0.0]
[[joint]]
name = "O"
kind = "revolute"
child = "bob"
axis = [0, 0, 1]
position = 0.9
)toml";
  const std::string text = std::string("gravity = [0, \"-g\", 0]\n") + pendulum;
  MeasuredMotion measured;
  measured.quantities = {{"O.q", "rad"}};
  for (int i = 1; i <= 20; ++i) measured.times.push_back(0.1 * i);
  measured.values.resize(20, 1);
  for (int i = 0; i < 20; ++i) measured.values(i, 0) = 0.9 * std::cos(3.3 * measured.times[i]);
  const Identification found = identified(text, measured, {"m=0.5:2", "l=0.3:2", "g=5:15"});
  EXPECT_NE(found.undetermined.find("'l'"), std::string::npos) << found.undetermined;
  EXPECT_NE(found.undetermined.find("'m'"), std::string::npos) << found.undetermined;
  EXPECT_NE(found.undetermined.find("2 ways"), std::string::npos) << found.undetermined;
  EXPECT_TRUE(found.deviations.array().isNaN().all());
  EXPECT_NEAR(found.starts[0].to[0], 1.3, 0.01);
}

TEST(Identification, RefusesFilesThatAreNoMeasurement) {
  const Mechanism mechanism(parse_scene(oscillator, "identified.toml", {}), {});
  const std::string file = testing::TempDir() + "/measured_identification.csv";
  const auto refusal = [&](const std::string& text) -> std::string {
    std::ofstream(file) << text;
    try {
      (void)read_measured(file, mechanism);
    } catch (const SceneError& e) {
      return std::string(e.what()).substr(file.size());
    }
    return "read";
  };
  EXPECT_EQ(refusal("t [s],S.q [m]\n0,1\n1,\n"), "read");
  EXPECT_EQ(refusal("S.q [m]\n1\n"),
            ":1: there is no column 't [s]'; expected the times of a measured motion, or, for "
            "wanted poses, --sweep NAME");
  EXPECT_EQ(refusal("t,S.q\n0.1,1\n\n0.1,2\n"),
            ":4: found the time 0.1; expected times from 0 on, each after the one before");
  EXPECT_EQ(refusal("t,S.q\n0,1\n"),
            ":2: the last time is 0; expected one after the start of the motion");
  EXPECT_EQ(refusal("t,S.q\n0,\n1,\n"),
            ":3: all cells are empty; expected a number for what is asked");
  EXPECT_EQ(refusal("t,S.q\n0,one\n"), ":2: found 'one'; expected a finite number");
  EXPECT_EQ(refusal("t\n0\n"),
            ":1: the times are the only column; expected what was measured then");
  EXPECT_EQ(refusal("t,S.q [mm]\n0,1\n"),
            ":1: column 'S.q [mm]' is in another unit; expected 'S.q [m]'");
  EXPECT_EQ(refusal("t,x\n0,1\n"),
            ":1: column 'x' is no time, coordinate, rate or marker; expected of 't', 'S.q', "
            "'S.u'");
}

// A trial whose motion does not end has no value, and a search that is stopped leaves its run.
TEST(Identification, RunsOfTrialsEnd) {
  TrialLimit limit;
  const auto steps_of = [&] {
    const auto goes_on = limit.next();
    long steps = 0;
    while (goes_on(0)) ++steps;
    return steps;
  };
  const auto first = limit.next();
  for (int i = 0; i < 200; ++i) EXPECT_TRUE(first(0));
  limit.arrived();
  EXPECT_EQ(steps_of(), 100 * 200 + 10'000);
  limit.ask([] { return false; });
  EXPECT_LT(steps_of(), 64);

  IdentificationRequest request = request_for(oscillator, {"k", "c"});
  const ParametricMechanism family(oscillator, "identified.toml", {}, {"k", "c"});
  long asked = 0, most = 1'000'000;
  request.progress = [&](int, double) { return ++asked < most; };
  EXPECT_FALSE(identify(family, measured_of({}, 40, 0.11), request).stopped);
  most = asked / 2;
  asked = 0;
  const Identification half = identify(family, measured_of({}, 40, 0.11), request);
  EXPECT_TRUE(half.stopped);
  EXPECT_EQ(half.starts[0].why, "it was stopped");
}

}  // namespace
}  // namespace momenta::dae_identification
