// Gradients of runs: against differences of the same runs, against runs in quadruple precision, and
// against closed formulas; by numbers of tables, formulas, laws, stops, dead bands and friction.

#include <gtest/gtest.h>
#include <momenta/core/scalar/sixth_order.h>
#include <momenta/core/scene/file_text.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/run/run_form.h>

#include <cmath>
#include <complex>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "equations/gradient_runs.h"
#include "equations/gradient_twin.h"
#include "equations/linkages.h"
#include "equations/refusal.h"
#include "equations/tolerance.h"

namespace momenta::dae_gradient {
namespace {

using Eigen::VectorXd;
using equations::asked, equations::driven, equations::four_bar, equations::of_scene,
    equations::of_text;

/// The value alone, as if nothing were differentiated: of the scene with one number changed. Its
/// gradient is not looked at.
double value_at(const SceneText& scene, GradientRequest request, const RunVariable& v,
                double value) {
  SceneText other = scene;
  if (v.kind == RunVariable::Kind::parameter) {
    other.fixed.push_back({v.name, value});
  } else {
    const std::string joint = v.name.substr(0, v.name.rfind('.'));
    other.fixed.push_back(
        {"joint." + joint + (v.kind == RunVariable::Kind::position ? ".position" : ".velocity"),
         value});
  }
  request.by = {v.name};
  return gradient(other, request).value;
}

/// dJ/dθ by differences of runs, of the second order with step h.
double difference(const SceneText& scene, const GradientRequest& request, const RunVariable& v,
                  double h) {
  return (value_at(scene, request, v, v.value + h) - value_at(scene, request, v, v.value - h)) /
         (2 * h);
}
/// Of the sixth.
double difference6(const SceneText& scene, const GradientRequest& request, const RunVariable& v) {
  const double h = v.size / 512;
  return (15 * difference(scene, request, v, h) - 6 * difference(scene, request, v, 2 * h) +
          difference(scene, request, v, 3 * h)) /
         10;
}

/// Every derivative within a part of the largest relative one, counted in sizes of the variables.
void expect_differences(const SceneText& scene, const GradientRequest& request, double within) {
  const GradientResult r = gradient(scene, request);
  double largest = 0;
  for (Eigen::Index j = 0; j < r.gradient.size(); ++j)
    largest =
        std::max(largest, std::abs(r.gradient[j]) * r.variables[static_cast<std::size_t>(j)].size);
  ASSERT_GT(largest, 0);
  for (Eigen::Index j = 0; j < r.gradient.size(); ++j) {
    const RunVariable& v = r.variables[static_cast<std::size_t>(j)];
    EXPECT_NEAR(r.gradient[j] * v.size, difference6(scene, request, v) * v.size, within * largest)
        << request.settings.form << " " << request.settings.gauge << " by " << v.name;
  }
}

const std::vector<std::string> all_of_four_bar{"g", "crank", "coupler", "mass",
                                               "k", "O.q",   "O.u",     "body.rocker.mass"};

TEST(Gradient, IsThatOfTheSameRunByDifferences) {
  const SceneText scene = of_text(four_bar);
  for (const auto& [form, gauge] :
       std::vector<std::pair<std::string, std::string>>{{"momentum", "reset"},
                                                        {"momentum", "leak:3"},
                                                        {"momentum", "none"},
                                                        {"momentum", "flip"},
                                                        {"acceleration", ""},
                                                        {"projected", ""},
                                                        {"baumgarte", ""}})
    // Starts are closed to 1e-12, which differences of runs divide by h.
    expect_differences(scene, asked("P.x + 0.3*C.u^2 - P.vy", all_of_four_bar, form, gauge), 1e-8);
}

TEST(Gradient, IsThatOfCorrectedPositionsAndOfFeedback) {
  const SceneText scene = of_text(four_bar);
  GradientRequest request =
      asked("P.x + 0.3*C.u^2", {"crank", "mass", "O.q", "O.u"}, "momentum", "reset", 0.5, 0.02);
  request.settings.project = true;
  expect_differences(scene, request, 1e-8);
  request.settings.project = false;
  request.settings.beta = 20;
  request.settings.gauge = "leak:3";
  expect_differences(scene, request, 1e-8);
  // Where steps are long the corrections matter: repeated ones.
  expect_differences(
      scene, asked("P.x + 0.3*C.u^2", {"crank", "mass", "O.q", "O.u"}, "projected", "", 0.6, 0.2),
      1e-8);
}

TEST(Gradient, IsThatOfDrivenLoops) {
  const SceneText scene = of_text(driven());
  for (const char* form : {"momentum", "projected", "acceleration"})
    expect_differences(
        scene,
        asked("tip.x + 0.1*M.u", {"swing", "long", "body.pendulum.mass", "M.q", "M.u"}, form,
              form[0] == 'm' ? "leak:3" : ""),
        1e-8);
}

TEST(Gradient, IsThatOfTheIntegral) {
  const SceneText scene = of_text(four_bar);
  for (const char* form : {"momentum", "projected"}) {
    GradientRequest request = asked("(P.x - 0.5*crank)^2 + 0.1*energy + t*O.u", all_of_four_bar,
                                    form, form[0] == 'm' ? "reset" : "");
    request.integral = true;
    expect_differences(scene, request, 1e-8);
  }
}

TEST(Gradient, DifferencesComeNearItLikeTheSquareOfTheirStep) {
  const SceneText scene = of_text(four_bar);
  const GradientRequest request = asked("P.x", {"coupler"}, "momentum", "reset");
  const GradientResult r = gradient(scene, request);
  const double far = difference(scene, request, r.variables[0], 0.04) - r.gradient[0],
               near = difference(scene, request, r.variables[0], 0.02) - r.gradient[0];
  EXPECT_NEAR(far / near, 4, 0.15);
}

TEST(Gradient, IsThatOfAdaptiveRunsUpToTheirTolerance) {
  const SceneText scene = of_text(four_bar);
  GradientRequest request = asked("P.x + 0.3*C.u^2", {"crank", "mass", "k", "O.q", "O.u"},
                                  "momentum", "reset", 1, 0.0005);
  const VectorXd fine = gradient(scene, request).gradient;
  for (const char* method : {"dp5", "dop853", "vern9"}) {
    request.settings.integrator = method;
    request.settings.rtol = request.settings.atol = 1e-11;
    const GradientResult r = gradient(scene, request);
    EXPECT_LT((r.gradient - fine).norm(), 1e-8 * fine.norm()) << method;
    // Steps follow tangents too.
    RunRequest plain;
    plain.settings = r.settings;
    const Mechanism mechanism(scene.scene(), scene.options);
    const RunResult run = run_form(mechanism, assemble(mechanism).start, plain);
    EXPECT_GE(r.steps, run.counters.steps - 1) << method;
    EXPECT_LT(r.steps, 2 * run.counters.steps) << method;
  }
}

/// q(T) and u(T) by θ against quadruple precision.
void expect_quad(const SceneText& scene, const std::vector<std::string>& by,
                 const std::string& gauge, double h, int steps, double within,
                 double dependent = 1e-20) {
  GradientRequest request = asked("t", by, "momentum", gauge, h * steps, h);
  request.trajectory = true;
  const GradientResult r = gradient(scene, request);
  ASSERT_EQ(r.steps, steps);
  const double leak = gauge.starts_with("leak:") ? std::stod(gauge.substr(5)) : 0;
  const auto run = [&](const Mechanism& mechanism, VectorXd q) {
    const Start start = assemble(mechanism, 0, q, VectorXd::Zero(mechanism.nv())).start;
    const auto y =
        equations::QuadRun(mechanism, gauge == "reset", leak, dependent)(start.q, h, steps);
    VectorXd numbers(static_cast<Eigen::Index>(y.size()));
    for (std::size_t i = 0; i < y.size(); ++i)
      numbers[static_cast<Eigen::Index>(i)] = value_of(y[i]);
    return numbers;
  };
  const Mechanism own(scene.scene(), scene.options);
  for (std::size_t j = 0; j < by.size(); ++j) {
    const RunVariable& v = r.variables[j];
    const VectorXd exact = equations::differenced(
        [&](double value) {
          if (v.kind == RunVariable::Kind::position) {
            VectorXd q = own.tree().q0;
            q[v.place] = value;
            return run(own, q);
          }
          const Mechanism other(scene.scene({{v.name, value}}), scene.options);
          return run(other, other.tree().q0);
        },
        v.value, v.size / 256);
    const VectorXd found = r.tangents.back().col(static_cast<Eigen::Index>(j));
    ASSERT_GT(exact.norm(), 0) << v.name;
    EXPECT_LT((found - exact).norm(), within * (1 / v.size + exact.norm())) << v.name;
  }
}

TEST(Gradient, IsThatOfQuadruplePrecision) {
  std::string at_rest = four_bar;
  at_rest.replace(at_rest.find("velocity = 0.7"), 14, "velocity = 0.0");
  expect_quad(of_text(at_rest), {"crank", "coupler", "mass", "k", "g", "O.q"}, "reset", 0.01, 40,
              1e-10);
  expect_quad(of_text(at_rest), {"crank", "mass", "k"}, "none", 0.01, 40, 1e-10);
}

TEST(Gradient, IsThatOfQuadruplePrecisionOfSpatialAndRedundantLoops) {
  const std::string folder = MOMENTA_SOURCE_DIR "/examples/";
  // Five rows of rank four.
  expect_quad(of_text(reading::text_of(folder + "bricard/scene.toml")),
              {"body.rod1.mass", "body.rod3.mass", "gravity.1"}, "reset", 0.005, 40, 1e-10, 1e-6);
  expect_quad(of_text(reading::text_of(folder + "andrews/scene.toml")), {"body.crank.mass"},
              "reset", 5e-5, 40, 1e-10);
}

TEST(Gradient, OfAnOscillatorIsThatOfTheFormula) {
  // x = a cos ωt, ω² = k/m
  const SceneText scene = of_text(R"toml(
[parameters]
k = 40
m = 1.6
[[body]]
name = "cart"
mass = "m"
shape = { kind = "point" }
[[joint]]
name = "S"
kind = "prismatic"
child = "cart"
axis = "x"
position = 0.3
stiffness = "k"
)toml");
  for (const char* form : {"momentum", "acceleration"}) {
    GradientRequest request = asked("S.q", {"k", "m", "S.q", "S.u"}, form, "", 1.1, 5e-4);
    const GradientResult r = gradient(scene, request);
    const double w = 5, t = 1.1, a = 0.3, by_w = -a * t * std::sin(w * t);
    EXPECT_NEAR(r.value, a * std::cos(w * t), 1e-11);
    EXPECT_NEAR(r.gradient[0], by_w * w / (2 * 40), 1e-11);
    EXPECT_NEAR(r.gradient[1], -by_w * w / (2 * 1.6), 1e-11);
    EXPECT_NEAR(r.gradient[2], std::cos(w * t), 1e-11);
    EXPECT_NEAR(r.gradient[3], std::sin(w * t) / w, 1e-11);
  }
}

TEST(Gradient, OfTheEnergyThatIsKeptIsThatOfTheStart) {
  std::string conservative = four_bar;
  conservative.replace(conservative.find("damping = 0.4"), 13, "damping = 0.0");
  const SceneText scene = of_text(conservative);
  for (const char* form : {"momentum", "projected"}) {
    GradientRequest request = asked("energy", {"g", "crank", "mass", "k", "O.q", "O.u"}, form,
                                    form[0] == 'm' ? "reset" : "", 0.5, 5e-4);
    const VectorXd last = gradient(scene, request).gradient;
    request.settings.end_time = request.settings.step = 1e-9;
    const VectorXd first = gradient(scene, request).gradient;
    EXPECT_LT((last - first).norm(), 1e-7 * first.norm()) << form;
  }
}

TEST(Gradient, PassesQuaternions) {
  const SceneText scene = of_scene(equations::flying_rod());
  const Mechanism mechanism(scene.scene(), scene.options);
  const std::vector<Column> rates = mechanism.rate_columns();
  for (const char* form : {"momentum", "acceleration"}) {
    const GradientRequest request =
        asked("energy + " + rates.front().name, {"body." + scene.scene().bodies[0].name + ".mass"},
              form, form[0] == 'm' ? "reset" : "", 0.4, 0.01);
    expect_differences(scene, request, 1e-8);
  }
}

TEST(Gradient, ByANumberIsThatByTheParameterItIsMadeOf) {
  const GradientResult r =
      gradient(of_text(four_bar), asked("P.x", {"mass", "body.coupler.mass"}, "momentum", "reset"));
  EXPECT_EQ(r.variables[1].value, 2);  // a formula there
  EXPECT_NE(r.gradient[0], 0);
  EXPECT_EQ(r.gradient[0], r.gradient[1]);
}

TEST(Gradient, ByParametersThatStandInFormulas) {
  const auto changed = [](const std::string& from, const std::string& to) {
    std::string text = four_bar;
    text.replace(text.find(from), from.size(), to);
    return text;
  };
  const std::string spring = "stiffness = \"k\"\ndamping = 0.4\nrest = 0.6\n";
  const std::string loop = R"toml(kind = "revolute"
parent = "coupler"
child = "rocker"
origin = { parent = ["coupler", 0, 0], child = ["rocker", 0, 0] }
)toml";
  for (const auto& [text, first] : std::vector<std::pair<std::string, std::string>>{
           {changed(spring, "law = \"k*(length-0.6) + g*(length-0.6)^3 + 0.4*rate\"\n"), "k"},
           {four_bar + "[[drive]]\njoint = \"O\"\nkind = \"formula\"\n"
                       "law = \"1.2 + mass*sin(idle*t)\"\n",
            "idle"},
           {changed(loop,
                    "kind = \"equation\"\nequation = \"(E.x - F.x)^2 + (E.y - F.y)^2 + "
                    "2*(E.x - F.x) + (idle/3 - 1) = 0\"\n") +
                "[[marker]]\nname = \"E\"\nbody = \"coupler\"\npoint = [2, 0, 0]\n"
                "[[marker]]\nname = \"F\"\nbody = \"rocker\"\npoint = [1.5, 0, 0]\n",
            "idle"},
           {four_bar + "[[force]]\nkind = \"torque\"\njoint = \"O\"\n"
                       "law = \"-idle*q - 0.2*k*u\"\n[[force]]\nkind = \"potential\"\n"
                       "V = \"0.5*k*P.x^2 + idle*P.y\"\n",
            "k"}}) {
    const SceneText scene = of_text(text);
    GradientRequest request =
        asked("P.x + 0.3*C.u", {"parameters." + first, "mass"}, "momentum", "reset", 0.1, 0.01);
    request.mode = GradientMode::forward;
    const GradientResult forward = gradient(scene, request);
    EXPECT_EQ(forward.variables[0].name, first);
    EXPECT_GT(std::abs(forward.gradient[0]), 1e-4);
    request.mode = GradientMode::adjoint;
    const GradientResult adjoint = gradient(scene, request);
    EXPECT_LT((forward.gradient - adjoint.gradient).norm(), 1e-12 * forward.gradient.norm());
    request.mode = GradientMode::forward;
    expect_differences(scene, request, 1e-8);
  }
}

TEST(Gradient, TellsWhatDoesNotMatterAndWhatIsNotSmooth) {
  const SceneText scene = of_text(four_bar);
  const GradientResult r =
      gradient(scene, asked("if(P.x > 0, P.x, 2*P.x)", {"crank", "idle"}, "momentum", "reset"));
  EXPECT_EQ(r.without_effect, std::vector<std::string>{"idle"});
  EXPECT_EQ(r.gradient[1], 0);
  ASSERT_EQ(r.remarks.size(), 1u);
  EXPECT_TRUE(equations::says(r.remarks[0], "'if' in the functional has corners or jumps"));
}

/// The sentence with which it is refused.
std::string refusal(const SceneText& scene, const GradientRequest& request) {
  return equations::thrown([&] { gradient(scene, request); });
}

TEST(Gradient, RefusesInOneSentence) {
  const SceneText scene = of_text(four_bar);
  EXPECT_EQ(refusal(scene, asked("P.x", {"crnk"}, "momentum", "reset")),
            "'crnk' is no parameter of the scene and no start value; did you mean 'crank'?");
  EXPECT_EQ(
      refusal(of_text("[[body]]\nname = \"b\"\nmass = 1\ninertia = [1, 1, 1]\n"
                      "[[joint]]\nname = \"O\"\nkind = \"weld\"\nchild = \"b\"\n"),
              asked("1", {"w"}, "momentum", "reset")),
      "'w' is no parameter of the scene and no start value, expected a number by its place, as in "
      "body.crank.mass");
  EXPECT_EQ(refusal(scene, asked("P.x", {"crank", "crank"}, "momentum", "reset")),
            "'crank' is named twice; expected it once");
  EXPECT_EQ(refusal(scene, asked("P.x", {"crank", "parameters.crank"}, "momentum", "reset")),
            "'crank' is named twice; expected it once");
  EXPECT_EQ(refusal(scene, asked("P.x > 1", {"crank"}, "momentum", "reset")),
            "'P.x > 1' is a comparison; expected a formula with a value");
  EXPECT_TRUE(
      equations::says(refusal(scene, asked("P.z1", {"crank"}, "momentum", "reset")), "P.z1"));
  EXPECT_EQ(refusal(scene, asked("P.x", {"crank"}, "partitioned", "")),
            "form 'partitioned' has no gradient; expected one of: momentum, acceleration, "
            "projected or baumgarte");
  EXPECT_TRUE(
      equations::says(refusal(scene, asked("log(P.x - 100)", {"crank"}, "momentum", "reset")),
                      "is not a finite number"));
  EXPECT_TRUE(
      equations::says(refusal(scene, asked("P.x", {"body.crank.drag"}, "momentum", "reset")),
                      "the scene leaves it out"));
  EXPECT_TRUE(equations::says(
      refusal(of_text(reading::text_of(MOMENTA_SOURCE_DIR "/examples/stops/scene.toml")),
              asked("C.q", {"body.crank.mass"}, "momentum", "reset")),
      "joint 'C' has rigid stops, and a run with impacts no gradient here"));
}

TEST(Gradient, RefusesMechanismsThatAreTooLarge) {
  const auto row = [](int n) {
    return refusal(of_scene(equations::row_of_four_bars(n, 1.1, 1)),
                   asked("energy", {"gravity.1"}, "momentum", "reset", 0.01));
  };
  const std::string sentence = row(300);
  EXPECT_TRUE(
      equations::says(sentence, "rates and loop equations; expected at most 1000 for a gradient"));
  EXPECT_EQ(row(3), "");
}

TEST(Gradient, TellsSingularPosesThatItPasses) {
  // Equal links: the slider passes the crank's pivot, and a second motion crosses the wanted one.
  const SceneText scene =
      of_text(reading::text_of(MOMENTA_SOURCE_DIR "/examples/slider_crank/scene.toml"));
  GradientRequest request = asked("B.x", {"O.u"}, "momentum", "reset", 0.2);
  request.settings.project = true;
  request.settings.step = 0.004;
  request.settings.end_time = 0.8;
  EXPECT_TRUE(gradient(scene, request).remarks.empty());
  request.settings.end_time = 1.2;
  const GradientResult r = gradient(scene, request);
  ASSERT_EQ(r.remarks.size(), 1u);
  EXPECT_TRUE(equations::says(r.remarks[0], "s the run passes a singular pose"));
}

TEST(Gradient, HasNoneFromASingularStart) {
  // Flat four-bars move in two ways from there.
  EXPECT_TRUE(equations::says(refusal(of_scene(equations::row_of_four_bars(1, 0, 1)),
                                      asked("energy", {"gravity.1"}, "momentum", "reset")),
                              "become dependent"));
}

GradientRequest adaptive(const std::string& of, const std::vector<std::string>& by,
                         const std::string& form, double end, const std::string& method = "dop853",
                         double rtol = 1e-11) {
  GradientRequest request = equations::asked(of, by, form, "", end, 0);
  request.settings.integrator = method;
  request.settings.rtol = request.settings.atol = rtol;
  request.settings.baumgarte_alpha = request.settings.baumgarte_beta = 0;
  return request;
}

/// dJ/dθ by differences of runs, of the sixth order.
double by_runs(const SceneText& scene, GradientRequest request, const std::string& by, double value,
               double h) {
  request.by = {by};
  request.settings.rtol = request.settings.atol = 1e-13;
  double sum = 0;
  for (const auto& [k, weight] : sixth_order::points) {
    SceneText other = scene;
    other.fixed.push_back({by, value + k * h});
    sum += weight / h * gradient(other, request).value;
  }
  return sum;
}

/// Every derivative against differences of runs of h parts of the number.
void expect_runs(const std::string& text, const GradientRequest& request, double h, double within) {
  const SceneText scene = of_text(text);
  const GradientResult r = gradient(scene, request);
  for (std::size_t j = 0; j < r.variables.size(); ++j) {
    const RunVariable& v = r.variables[j];
    const double expected = by_runs(scene, request, v.name, v.value, h * v.size);
    EXPECT_GT(std::abs(expected), 0) << v.name;
    EXPECT_NEAR(r.gradient[static_cast<Eigen::Index>(j)], expected, within * std::abs(expected))
        << request.settings.form << ", " << request.settings.integrator << ", by " << v.name;
  }
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

const std::string slide = R"toml(
[[body]]
name = "m"
mass = 1
inertia = 1
[[joint]]
name = "X"
kind = "prismatic"
child = "m"
axis = "x"
)toml";

/// x" + c x' + k x = F sin ωt from rest: with A = F/(k − ω² + icω), x = Im(A e^{iωt}) and what
/// dies.
TEST(Gradient, ByAFrequencyHasItsDigitsHoweverOftenItTurns) {
  const SceneText scene = of_text("[parameters]\nw = 30\nF = 40\n" + slide +
                                  "stiffness = 400\ndamping = 1\n[[force]]\nkind = \"torque\"\n"
                                  "joint = \"X\"\nlaw = \"F*sin(w*t)\"\n");
  using Complex = std::complex<double>;
  const double w = 30, c = 1, k = 400, end = 20;
  const Complex i(0, 1), amplitude = 40.0 / (k - w * w + i * c * w),
                         by_w = amplitude * amplitude * (2 * w - i * c) / 40.0,
                         turned = std::exp(i * w * end);
  const double own = std::sqrt(k - c * c / 4), dies = std::exp(-c * end / 2), b = -by_w.imag(),
               a = (c / 2 * b - amplitude.real() - w * by_w.real()) / own,
               expected = (by_w * turned + amplitude * i * end * turned).imag() +
                          dies * (b * std::cos(own * end) + a * std::sin(own * end));
  EXPECT_NEAR(expected, 1.596366, 1e-6);
  for (const char* form : {"momentum", "acceleration"})
    for (const GradientMode mode : {GradientMode::forward, GradientMode::adjoint}) {
      GradientRequest request = adaptive("X.q", {"w"}, form, end);
      request.mode = mode;
      EXPECT_NEAR(gradient(scene, request).gradient[0], expected, 1e-8) << form;
    }
}

/// A pendulum on a cart that a law moves.
std::string on_a_cart(const std::string& drive) {
  return "gravity = [0, -9.81, 0]\n" + drive + slide +
         "[[body]]\nname = \"p\"\nmass = 1\nshape = { kind = \"rod\", length = 1 }\n"
         "[[joint]]\nname = \"J\"\nkind = \"revolute\"\nparent = \"m\"\nchild = \"p\"\n"
         "position = -1.2\n";
}

TEST(Gradient, ByNumbersOfLawsOfDrives) {
  struct Row {
    std::string drive;
    std::vector<std::string> by;
    double end;
  };
  const std::string begun = "[[drive]]\njoint = \"X\"\nkind = ";
  for (const auto& [drive, by, end] : std::vector<Row>{
           {"[parameters]\nt0 = 0.4\nT = 0.05\nto = 0.3\n" + begun +
                "\"step\"\nto = \"to\"\nstart = \"t0\"\nduration = \"T\"\n",
            {"t0", "T", "to"},
            0.7},
           {"[parameters]\nA = 0.1\nw = 9\nph = 0.4\n" + begun +
                "\"harmonic\"\namplitude = \"A\"\nfrequency = \"w\"\nphase = \"ph\"\n",
            {"A", "w", "ph"},
            2.5},
           {"[parameters]\nt0 = 0.4\nsharp = 200\n" + begun +
                "\"formula\"\nlaw = \"0.15*(1 + sinh((t-t0)*sharp)/cosh((t-t0)*sharp))\"\n",
            {"t0", "sharp"},
            0.7},
           {"[parameters]\nc = 0.2\n" + begun +
                "\"polynomial\"\ncoefficients = [0, 0, \"c\", \"-c/2\"]\n",
            {"c"},
            0.7},
           {"[parameters]\nlate = 0.4\nhigh = 0.2\n" + begun +
                "\"table\"\ntimes = [0, 0.2, \"late\", 1]\nvalues = [0, \"high\", 0.1, 0]\n",
            {"late", "high"},
            0.7}})
    for (const char* form : {"momentum", "acceleration"})
      expect_runs(on_a_cart(drive), adaptive("J.q", by, form, end), 1e-4, 1e-5);
}

/// Rates of tangents that jump by more than a step of any length has the tolerance of.
TEST(Gradient, GetsOverTheSteepestLaws) {
  const std::string text = on_a_cart(
      "[parameters]\nt0 = 4\nT = 0.02\n[[drive]]\njoint = \"X\"\nkind = \"step\"\nto = 0.3\n"
      "start = \"t0\"\nduration = \"T\"\n");
  expect_runs(text, adaptive("J.q", {"t0"}, "acceleration", 4.2, "vern9", 1e-11), 1e-6, 1e-5);
}

TEST(Gradient, ByNumbersOfStopsDeadBandsAndFriction) {
  struct Row {
    std::string text, of;
    std::vector<std::string> by;
    double end;
  };
  const auto falls = [](const std::string& parameters) {
    return "gravity = [-9.81, 0, 0]\n[parameters]\n" + parameters + slide + "position = 1.2\n";
  };
  for (const auto& [text, of, by, end] : std::vector<Row>{
           {falls("L = 1\nk = 1e4\nc = 3\nw = 0.001\n") +
                "limits = [\"L\", 100.0]\nstop_stiffness = \"k\"\nstop_damping = \"c\"\n"
                "stop_width = \"w\"\n",
            "X.q",
            {"L", "k", "c", "w"},
            0.35},
           {replaced(falls("L = 10\n"), "position = 1.2", "position = 11") +
                "limits = [\"L\", 100.0]\nstop_stiffness = 1e4\nstop_damping = 3\n"
                "stop_width = 0.001\n",
            "X.q",
            {"L"},
            0.7},
           {falls("L = 1\nk = 1e6\n") +
                "[[force]]\nkind = \"torque\"\njoint = \"X\"\nlaw = \"k*max(0, L - q)^2\"\n",
            "X.q",
            {"L", "k"},
            0.35},
           {falls("L = 1\nk = 1e4\n") +
                "[[force]]\nkind = \"potential\"\nV = \"if(X.q < L, k/2*(L - X.q)^2, 0)\"\n",
            "X.q",
            {"L", "k"},
            0.35},
           {falls("band = 0.1\nk = 1e4\nrest = 0.9\n") +
                "[[force]]\nkind = \"coordinate-spring\"\njoints = [\"X\"]\nratios = [1]\n"
                "stiffness = \"k\"\nrest = \"rest\"\ndead_band = \"band\"\n",
            "X.q",
            {"band", "k", "rest"},
            0.3},
           {"[parameters]\nmu = 2\nv = 0.1\n" + slide +
                "velocity = 1\nstiffness = 50\nfriction = \"mu\"\nfriction_rate = \"v\"\n",
            "X.q",
            {"mu", "v"},
            1}})
    for (const auto& [form, method] : std::vector<std::pair<std::string, std::string>>{
             {"momentum", "dp5"}, {"momentum", "vern9"}, {"acceleration", "dop853"}})
      expect_runs(text, adaptive(of, by, form, end, method), 1e-3, 1e-5);
}

/// Steps that do not follow derivatives around corners: fixed ones. Those of a sweep back follow
/// one tangent.
TEST(Gradient, AtCornersIsRefusedWhereStepsAreTooLong) {
  const SceneText scene = of_text("gravity = [-9.81, 0, 0]\n[parameters]\nL = 10\n" + slide +
                                  "position = 11\nlimits = [\"L\", 100.0]\nstop_stiffness = 1e4\n"
                                  "stop_damping = 3\nstop_width = 0.001\n");
  const auto expect_refused = [&](const GradientRequest& request, const std::string& with) {
    try {
      gradient(scene, request);
      ADD_FAILURE() << with;
    } catch (const SceneError& e) {
      const std::string what = e.what();
      EXPECT_TRUE(equations::says(what, "the derivative by 'L' is "));
      EXPECT_TRUE(equations::says(what, with));
    }
  };
  GradientRequest request = equations::asked("X.q", {"L"}, "momentum", "", 0.8, 1e-3);
  expect_refused(request, " with half the step");
  request.settings.step = 0;
  request.settings.integrator = "dop853";
  request.settings.rtol = request.settings.atol = 1e-8;
  const double right = by_runs(scene, request, "L", 10, 1e-4);
  request.mode = GradientMode::adjoint;
  EXPECT_NEAR(gradient(scene, request).gradient[0], right, 1e-3);
  request.mode = GradientMode::forward;
  EXPECT_NEAR(gradient(scene, request).gradient[0], right, 1e-5);
}

/// A force that jumps where the motion passes, at a moment that moves with all that it is made of.
TEST(Gradient, RefusesJumpsThatTheMotionPasses) {
  const auto text = [](const std::string& law) {
    return "[parameters]\nF = 1\n" + slide +
           "velocity = 1\nstiffness = 9\n[[force]]\nkind = \"torque\"\njoint = \"X\"\nlaw = \"" +
           law + "\"\n";
  };
  for (const char* law : {"-F*sign(u)", "if(q > 0.2, F, -F)", "F*floor(5*X.q)", "-F*u/abs(u)",
                          "-F*u*(u^2)^(-0.5)", "F*atan2(u, -q)"})
    for (const char* form : {"momentum", "acceleration"}) try {
        gradient(of_text(text(law)), adaptive("X.q", {"F"}, form, 1, "dop853", 1e-8));
        ADD_FAILURE() << law;
      } catch (const SceneError& e) {
        EXPECT_TRUE(equations::says(e.what(), " s the force by '"));
        EXPECT_TRUE(equations::says(e.what(), " jumps from "));
      }
  for (const char* law : {"if(q > 0.2, -F*(q - 0.2), 0)", "-F*abs(q)", "if(t > 0.5, F, 0)",
                          "-F*u/(1e-3 + u^2)", "-F*(1 + q)^(-0.5)", "F*atan2(u, 2 + q)"})
    EXPECT_NO_THROW(
        gradient(of_text(text(law)), adaptive("X.q", {"F"}, "momentum", 1, "dop853", 1e-8)))
        << law;
}

/// Forces that no formula has jump too: of energies with corners, of a bushing at half a turn, of a
/// spring whose ends pass each other; and tan at its poles.
TEST(Gradient, RefusesJumpsOfForcesWithoutAFormula) {
  const auto pushed = [](const std::string& force) {
    return "[parameters]\nF = 3\nw = 2\n" + slide +
           "velocity = \"w\"\nposition = -0.6\n[[force]]\n" + force;
  };
  const auto swung = [](const std::string& force) {
    return "[parameters]\nF = 3\nw = 8\n[[body]]\nname = \"b\"\nmass = 1\ninertia = "
           "0.4\n[[joint]]\nname = \"X\"\nkind = \"revolute\"\nchild = \"b\"\nvelocity = "
           "\"w\"\nposition = 2\n[[force]]\n" +
           force;
  };
  const auto by_lagrangian = [](const std::string& energy) {
    return "[parameters]\nF = 3\nw = 2\n[lagrangian]\ncoordinates = [\"X\"]\nvelocity = "
           "[\"w\"]\nposition = [-0.6]\nkinetic = \"X.dot^2/2\"\npotential = \"" +
           energy + "\"\n";
  };
  const std::string spring = "kind = \"spring-damper\"\nchild = \"m\"\nstiffness = \"F\"\n",
                    bushing = "kind = \"bushing\"\nchild = \"b\"\nrotational_stiffness = ",
                    potential = "kind = \"potential\"\nV = ";
  struct Row {
    std::string text, of;
    bool refused;
  };
  for (const auto& [text, of, refused] : std::vector<Row>{
           {pushed(spring + "rest = 0.5\n"), "X.q", true},
           {pushed(spring), "X.q", false},
           {pushed(spring + "rest = 0.5\norigin = { parent = [0, 0.1, 0] }\n"), "X.q", false},
           {pushed(potential + "\"F*max(X.q - 0.2, 0)\"\n"), "X.q", true},
           {pushed(potential + "\"F*sqrt((X.q - 0.2)^2)\"\n"), "X.q", true},
           {pushed(potential + "\"F*max(X.q - 0.2, 0)^2\"\n"), "X.q", false},
           {pushed(potential + "\"F*max(X.q + 9, 0)\"\n"), "X.q", false},
           {by_lagrangian("F*abs(X - 0.2)"), "X", true},
           {by_lagrangian("F*abs(X - 0.2)^3"), "X", false},
           {swung(bushing + "\"F\"\n"), "X.q", true},
           {swung(bushing + "\"F\"\nrotation = { axis = [0, 0, 1], angle = 3 }\n"), "X.q", false},
           {swung("kind = \"torque\"\njoint = \"X\"\nlaw = \"-F*atan(tan(q/2))\"\n"), "X.q",
            true}}) {
    if (!refused) {
      expect_runs(text, adaptive(of, {"F", "w"}, "momentum", 0.7), 1e-4, 1e-5);
      continue;
    }
    for (const char* form : {"momentum", "acceleration"})
      EXPECT_TRUE(equations::says(
          equations::thrown<SceneError>([&] {
            gradient(of_text(text), adaptive(of, {"F", "w"}, form, 0.7, "dop853", 1e-8));
          }),
          " jumps from "))
          << text;
  }
}

/// Continuous forces that change in less than a thousandth of a step, which no tangent follows.
TEST(Gradient, RefusesForcesTooSteepForItsSteps) {
  const auto pushed = [](const std::string& law, const std::string& more = "") {
    return "[parameters]\nF = 3\na = 0.3\n" + slide +
           "position = 1\nstiffness = 100\ndamping = 0.3\n[[force]]\nkind = "
           "\"torque\"\njoint = \"X\"\nlaw = \"" +
           law + "\"\n" + more;
  };
  const auto rising = [](const std::string& width) {
    return "[[function]]\nname = \"f\"\nx = [-1, \"a\", \"a + " + width +
           "\", 1]\ny = [0, 0, 1, 1]\nkind = \"linear\"\n";
  };
  for (const std::string& text : {pushed("F*f(q)", rising("1e-9")), pushed("F*tanh(1e9*(q - a))")})
    EXPECT_TRUE(equations::says(
        equations::thrown<SceneError>([&] {
          gradient(of_text(text), adaptive("X.q", {"F", "a"}, "momentum", 0.7, "dop853", 1e-8));
        }),
        "; expected one that is "));
  expect_runs(pushed("F*tanh(20*(q - a))"), adaptive("X.q", {"F", "a"}, "momentum", 0.7), 1e-5,
              1e-6);
  expect_runs(pushed("F*f(q)", rising("0.2")), adaptive("X.q", {"F", "a"}, "momentum", 0.7), 1e-4,
              1e-4);
}

/// What nothing moves freely in has gradients of what drives do.
TEST(Gradient, OfWhatDrivesDoAlone) {
  const SceneText scene = of_text(
      "[parameters]\na = 0.7\n[[body]]\nname = \"b\"\nmass = 2\ninertia = 0.4\n[[joint]]\nname = "
      "\"X\"\nkind = \"revolute\"\nchild = \"b\"\n[[drive]]\njoint = \"X\"\nkind = "
      "\"polynomial\"\ncoefficients = [0, 0, \"a\"]\n[[marker]]\nname = \"P\"\nbody = "
      "\"b\"\npoint = [1, 0, 0]\n");
  for (const char* form : {"momentum", "acceleration", "projected", "baumgarte"}) {
    const double angle = 0.7 * 0.25;
    EXPECT_NEAR(gradient(scene, adaptive("P.x", {"a"}, form, 0.5)).gradient[0],
                -0.25 * std::sin(angle), 1e-10)
        << form;
    // 0.2 (2 a t)², with t = 0.5
    EXPECT_NEAR(gradient(scene, adaptive("energy", {"a"}, form, 0.5)).gradient[0], 0.4 * 0.7, 1e-9)
        << form;
  }
  GradientRequest request = adaptive("P.x", {"a"}, "momentum", 0.5);
  request.mode = GradientMode::adjoint;
  EXPECT_TRUE(
      equations::says(equations::thrown<std::invalid_argument>([&] { gradient(scene, request); }),
                      "nothing moves freely"));
}

TEST(Gradient, RefusesParametersThatMoveTheEnd) {
  const SceneText scene = of_text("[parameters]\nw = 2\nk = 9\n" + slide +
                                  "velocity = 1\nstiffness = \"k\"\n[run]\nend = \"2*w\"\n");
  EXPECT_TRUE(equations::says(equations::thrown<SceneError>([&] {
                                gradient(scene, adaptive("X.q", {"k", "w"}, "momentum", 4));
                              }),
                              "run.end follows 'w'"));
  EXPECT_NO_THROW(gradient(scene, adaptive("X.q", {"k"}, "momentum", 4)));
  EXPECT_NO_THROW(gradient(scene, adaptive("X.q", {"w"}, "momentum", 3)));
}

/// A force or a law that jumps at a time that a number decides on, by that number alone.
// Where the motion rests, or an integrand is faster than it, its own steps say nothing of either.
TEST(Gradient, FollowsTangentsAndIntegrandsWhereTheMotionRests) {
  const SceneText rod = of_text(
      "gravity = [0, -9.81, 0]\n[[body]]\nname = \"p\"\nmass = 1\nshape = { kind = \"rod\", "
      "length = 1 }\n[[joint]]\nname = \"J\"\nkind = \"revolute\"\nchild = \"p\"\nposition = "
      "-1.5707963267948966\n[[marker]]\nname = \"P\"\nbody = \"p\"\npoint = [1, 0, 0]\n");
  const SceneText spring = of_text(
      "[parameters]\nk = 400.0\nc = 1.0\nr = 0.0\nF = 0.0\n[[body]]\nname = \"m\"\nmass = 1\n"
      "inertia = 1\n[[joint]]\nname = \"X\"\nkind = \"prismatic\"\nchild = \"m\"\naxis = "
      "\"x\"\nstiffness = \"k\"\ndamping = \"c\"\nrest = \"r\"\n[[force]]\nkind = "
      "\"torque\"\njoint = \"X\"\nlaw = \"F*cos(19*t)\"\n");
  const SceneText slow = of_text(
      "[parameters]\nk = 0.1\nw = 80.0\n[[body]]\nname = \"m\"\nmass = 1\ninertia = "
      "1\n[[joint]]\nname = \"X\"\nkind = \"prismatic\"\nchild = \"m\"\naxis = "
      "\"x\"\nstiffness = \"k\"\nvelocity = 1\n");
  for (const char* form : {"momentum", "acceleration"})
    for (const char* method : {"dp5", "dop853", "vern9"})
      for (const GradientMode mode : {GradientMode::forward, GradientMode::adjoint}) {
        const auto of = [&](const SceneText& scene, const std::string& formula,
                            const std::vector<std::string>& by, double end, bool integral) {
          GradientRequest request = asked(formula, by, form, "", end, 0);
          request.settings.integrator = method;
          request.settings.rtol = request.settings.atol = 1e-9;
          request.integral = integral;
          request.mode = mode;
          return gradient(scene, request);
        };
        const double t = 20, g = 9.81, swing = std::cos(std::sqrt(1.5 * g) * t);
        const VectorXd rest = of(rod, "P.x", {"J.q", "gravity.0"}, t, false).gradient;
        EXPECT_NEAR(rest[0], swing, 1e-5) << form << method;
        EXPECT_NEAR(rest[1], (1 - swing) / g, 1e-6) << form << method;
        const double end = 15, omega = std::sqrt(400 - 0.25), fading = std::exp(-0.5 * end);
        const VectorXd moved = of(spring, "X.q", {"r", "F"}, end, false).gradient;
        EXPECT_NEAR(moved[0],
                    1 - fading * (std::cos(omega * end) + 0.5 / omega * std::sin(omega * end)),
                    1e-6);
        const std::complex<double> steady =
            std::exp(std::complex<double>(0, 19 * end)) / std::complex<double>(400 - 361, 19);
        EXPECT_NEAR(moved[1], steady.real(), 1e-4);  // but for what has faded: e^−7.5/39
        // ∫ sin(νt)/ν sin(wt) dt over 5 s, ν² = k
        const auto integral = [](double k, double w) {
          const double nu = std::sqrt(k), T = 5;
          return (std::sin((nu - w) * T) / (nu - w) - std::sin((nu + w) * T) / (nu + w)) / (2 * nu);
        };
        const GradientResult fast = of(slow, "X.q*sin(w*t)", {"k", "w"}, 5, true);
        EXPECT_NEAR(fast.value, integral(0.1, 80), 1e-7) << form << method;
        const double h = 1e-4;
        EXPECT_NEAR(fast.gradient[0], (integral(0.1 + h, 80) - integral(0.1 - h, 80)) / (2 * h),
                    1e-5);
        EXPECT_NEAR(fast.gradient[1], (integral(0.1, 80 + h) - integral(0.1, 80 - h)) / (2 * h),
                    1e-5);
      }
}

TEST(Gradient, IsTakenWhereNumbersAreSet) {
  SceneText set = of_text(four_bar);
  for (const auto& [place, value] :
       std::vector<std::pair<std::string, double>>{{"joint.C.origin.parent.0", 2.1},
                                                   {"body.rocker.mass", 2.5},
                                                   {"gravity.0", 1},
                                                   {"joint.O.velocity", -0.3}}) {
    set.fixed = {{place, value}};
    const GradientRequest request = asked("P.x + 0.3*C.u^2", {place}, "momentum", "reset");
    const GradientResult r = gradient(set, request);
    EXPECT_EQ(r.variables.front().value, value) << place;
    EXPECT_NEAR(r.gradient[0], difference6(set, request, r.variables.front()),
                1e-7 * (1 + std::abs(r.gradient[0])))
        << place;
  }
}

TEST(Gradient, RefusesTimesOfJumpsThatNumbersMove) {
  const auto pushed = [](const std::string& law) {
    return "[parameters]\nF = 1\nt0 = 0.4\n" + slide +
           "stiffness = 9\n[[force]]\nkind = \"torque\"\njoint = \"X\"\nlaw = \"" + law + "\"\n";
  };
  const auto by_lagrangian = [](const std::string& law) {
    return "[parameters]\nF = 2\nt0 = 0.4\n[lagrangian]\ncoordinates = [\"x\"]\nposition = [0.1]\n"
           "kinetic = \"x.dot^2/2\"\npotential = \"4.5*x^2\"\nforce.x = \"" +
           law + "\"\n";
  };
  const auto moved = [](const std::string& law) {
    return on_a_cart(
        "[parameters]\nF = 0.3\nt0 = 0.4\n[[drive]]\njoint = \"X\"\nkind = "
        "\"formula\"\nlaw = \"" +
        law + "\"\n");
  };
  struct Row {
    std::string text, of, form;
    bool refused;
  };
  for (const auto& [text, of, form, refused] : std::vector<Row>{
           {pushed("if(t > t0, F, 0)"), "X.q", "momentum", true},
           {pushed("F*floor(2*t/t0)"), "X.q", "acceleration", true},
           {by_lagrangian("if(t > t0, F, 0)"), "x", "momentum", true},
           {by_lagrangian("F*max(0, t - t0) - F*max(0, 0.01 - x)"), "x", "momentum", false},
           {pushed("F*max(0, t - t0)"), "X.q", "acceleration", false},
           {moved("F*max(0, t - t0)"), "J.q", "momentum", true},
           {moved("F*max(0, t - t0)^2"), "J.q", "momentum", false},
           {moved("F*max(0, t - t0)^2"), "J.q", "acceleration", true},
           {moved("F*max(0, t - t0)^3"), "J.q", "acceleration", false}}) {
    if (!refused) {
      expect_runs(text, adaptive(of, {"t0", "F"}, form, 0.7), 1e-4, 1e-5);
      continue;
    }
    EXPECT_NO_THROW(gradient(of_text(text), adaptive(of, {"F"}, form, 0.7, "dop853", 1e-8)));
    for (const GradientMode mode : {GradientMode::forward, GradientMode::adjoint})
      EXPECT_TRUE(equations::says(equations::thrown<SceneError>([&] {
                                    GradientRequest request =
                                        adaptive(of, {"t0"}, form, 0.7, "dop853", 1e-8);
                                    request.mode = mode;
                                    gradient(of_text(text), request);
                                  }),
                                  " jumps from "))
          << text;
  }
}

/// A scene far from the origin, whose neighbours at a part of its places cannot be assembled.
TEST(Gradient, OfPlacesFarAwayNeedsNoFarNeighbours) {
  const auto text = [](double x0) {
    const auto at = [&](double x) { return reading::digits(x0 + x); };
    return "gravity = [0, -9.81, 0]\n[parameters]\nx0 = " + at(0) + "\nxc = " + at(1.3) +
           "\n[[body]]\nname = \"crank\"\nmass = 1\nshape = { kind = \"rod\", length = 0.4 }\n"
           "[[body]]\nname = \"coupler\"\nmass = 1\nshape = { kind = \"rod\", length = 1.2 }\n"
           "[[body]]\nname = \"rocker\"\nmass = 1\nshape = { kind = \"rod\", length = 1 }\n"
           "[[joint]]\nname = \"O\"\nkind = \"revolute\"\nchild = \"crank\"\n"
           "origin = { parent = [\"x0\", 0, 0] }\nposition = 1\n"
           "[[joint]]\nname = \"A\"\nkind = \"revolute\"\nparent = \"crank\"\nchild = \"coupler\"\n"
           "origin = { parent = [0.4, 0, 0] }\nposition = -0.4175694067314675\n"
           "[[joint]]\nname = \"C\"\nkind = \"revolute\"\nchild = \"rocker\"\n"
           "origin = { parent = [\"xc\", 0, 0] }\nposition = 1.6526128646081344\n"
           "[[loop]]\nname = \"B\"\nkind = \"revolute\"\nparent = \"coupler\"\nchild = \"rocker\"\n"
           "origin = { parent = [1.2, 0, 0], child = [1, 0, 0] }\n"
           "[[marker]]\nname = \"P\"\nbody = \"coupler\"\npoint = [0.55, 0.3, 0]\n"
           "[assembly]\nhold = [\"O\"]\n";
  };
  for (const char* gauge : {"reset", "leak:3"}) {
    GradientRequest request = equations::asked("P.y", {"xc", "x0"}, "momentum", gauge, 0.2, 0.01);
    const Eigen::VectorXd near = gradient(of_text(text(0)), request).gradient,
                          far = gradient(of_text(text(100)), request).gradient;
    EXPECT_LT((far - near).norm(), 1e-8 * near.norm()) << gauge;
  }
}

/// All parameters of the examples with bodies or a Lagrangian, over a short time.
TEST(Gradient, ByEveryParameterOfTheExamplesIsThatOfRuns) {
  const std::string folder = MOMENTA_SOURCE_DIR "/examples/";
  for (const char* file : {"iftomm/diagonal_spring", "straight_line/chebyshev",
                           "straight_line/scene", "balancing/scene", "path_synthesis/scene",
                           "identification/scene", "lagrangian/double_pendulum",
                           "lagrangian/car_axis", "formulas/motor", "formulas/magnets"}) {
    std::string path = folder + file + ".toml";
    if (!std::filesystem::exists(path)) path = folder + "suites/" + file + ".toml";
    std::string text = reading::text_of(path);
    if (std::string(file) == "balancing/scene") {  // as it is written it is at rest
      text = replaced(text, "child = \"crank\"\n", "child = \"crank\"\nvelocity = 6\n");
      text = replaced(text, "crank_centre = 0.0", "crank_centre = 0.05");
      text = replaced(text, "rocker_centre = 0.0", "rocker_centre = 0.05");
    }
    const SceneText scene = of_text(text);
    const Mechanism mechanism(scene.scene(), scene.options);
    std::vector<std::string> by;
    for (const ParameterSpec& p : mechanism.scene().parameters) by.push_back(p.name);
    // Of drives that run on the motion is none of the parameters.
    const std::string of =
        mechanism.scene().drives.empty() ? mechanism.coordinate_columns().back().name : "energy";
    GradientRequest request =
        equations::asked(of, by, "momentum", mechanism.m() > 0 ? "reset" : "", 0.02, 0.002);
    const GradientResult r = gradient(scene, request);
    double largest = 0;
    for (Eigen::Index j = 0; j < r.gradient.size(); ++j)
      largest = equations::larger(
          largest, std::abs(r.gradient[j]) * r.variables[static_cast<std::size_t>(j)].size);
    EXPECT_GT(largest, 0) << file;
    for (Eigen::Index j = 0; j < r.gradient.size(); ++j) {
      const RunVariable& v = r.variables[static_cast<std::size_t>(j)];
      EXPECT_NEAR(r.gradient[j] * v.size,
                  by_runs(scene, request, v.name, v.value, 1e-3 * v.size) * v.size, 1e-7 * largest)
          << file << " by " << v.name;
    }
  }
}

// What rounding leaves of a number stands beside larger ones: 1 + 1.2e-16.
TEST(Gradient, ByANumberNextToZeroIsThatAtZero) {
  std::string text = four_bar;
  text.replace(text.find("crank = 0.5"), 11, "crank = \"0.5*(1 + e)\"\ne = 0");
  const auto by_e = [&](double e) {
    SceneText scene = of_text(text);
    scene.fixed.push_back({"e", e});
    return gradient(scene, asked("A.q", {"e"}, "momentum", "none")).gradient[0];
  };
  const double at_zero = by_e(0);
  EXPECT_GT(std::abs(at_zero), 0.01);
  for (const double e : {1.2246e-16, -3e-14})
    EXPECT_NEAR(by_e(e), at_zero, 1e-9 * std::abs(at_zero)) << e;
}

}  // namespace
}  // namespace momenta::dae_gradient
