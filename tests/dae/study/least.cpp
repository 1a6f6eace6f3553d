// Functionals of motions made least: the search against published and known optima, gradients
// against closed formulas in quadruple precision, efforts against inverse dynamics, conditions
// against the formulas they stand for, searches that go on against those that were not stopped.

#include <gtest/gtest.h>
#include <momenta/core/scene/file_text.h>
#include <momenta/dae/analysis/effort/effort.h>
#include <momenta/dae/study/fit/least.h>
#include <momenta/dae/study/fit/swept_poses.h>
#include <momenta/dae/study/journal.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "equations/parts.h"
#include "equations/refusal.h"
#include "equations/tolerance.h"
#include "equations/traced_four_bar.h"

namespace momenta::dae_least {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using std::numbers::pi;
using namespace equations;

VectorXd free_of_bounds(Index n, double sign) {
  return VectorXd::Constant(n, sign * INFINITY);
}

// Problem 71 of Hock, Schittkowski, Test Examples for Nonlinear Programming Codes (1981): an
// inequality, an equation and a bound are active; their optimum is 17.0140173.
TEST(Least, TheSearchMeetsProblem71OfHockAndSchittkowski) {
  ConstrainedProblem p;
  p.inequalities = p.equalities = 1;
  p.at = [](const VectorXd& x, double& f, VectorXd& c, VectorXd* df, MatrixXd* dc) {
    f = x[0] * x[3] * (x[0] + x[1] + x[2]) + x[2];
    c = Eigen::Vector2d(25 - x.prod(), x.squaredNorm() - 40);
    if (!df) return true;
    *df = Eigen::Vector4d(x[3] * (2 * x[0] + x[1] + x[2]), x[0] * x[3], x[0] * x[3] + 1,
                          x[0] * (x[0] + x[1] + x[2]));
    dc->resize(2, 4);
    dc->row(0) = -x.prod() * x.cwiseInverse().transpose();
    dc->row(1) = 2 * x.transpose();
    return true;
  };
  VectorXd x = Eigen::Vector4d(1, 5, 5, 1);
  const ConstrainedEnd end = constrained_search(p, VectorXd::Ones(4), VectorXd::Constant(4, 5.0),
                                                VectorXd::Ones(4), 200, x);
  EXPECT_NEAR(end.f, 17.0140172891563, 1e-9);
  EXPECT_LT((x - Eigen::Vector4d(1, 4.74299963, 3.82114998, 1.37940829)).cwiseAbs().maxCoeff(),
            1e-7);
  EXPECT_LT(end.violation, 1e-10);
  EXPECT_LT(end.slope, converged_slope);
  EXPECT_TRUE(end.kept);
  EXPECT_GT(end.multipliers[0], 0.1);
}

// A convex function that is infinite beyond a wall: steps into it are cut, and the minimum is met.
// Its multipliers tell how f changes with the condition.
TEST(Least, TheSearchMeetsAConvexOptimum) {
  const auto solved = [](double room, ConstrainedEnd& end) {
    ConstrainedProblem p;
    p.inequalities = 1;
    p.at = [room](const VectorXd& x, double& f, VectorXd& c, VectorXd* df, MatrixXd* dc) {
      if (x[0] <= 0.2) return false;
      f = x[0] - std::log(x[0]) + std::exp(x[1]) - 2 * x[1];
      c = VectorXd::Constant(1, x[0] + x[1] - room);
      if (df) {
        *df = Eigen::Vector2d(1 - 1 / x[0], std::exp(x[1]) - 2);
        *dc = MatrixXd::Ones(1, 2);
      }
      return true;
    };
    VectorXd x = Eigen::Vector2d(3, 0.1);
    end = constrained_search(p, free_of_bounds(2, -1), free_of_bounds(2, 1), VectorXd::Ones(2), 200,
                             x);
    return x;
  };
  ConstrainedEnd end, near;
  const VectorXd wide = solved(10, end);
  EXPECT_NEAR(wide[0], 1, 1e-8);
  EXPECT_NEAR(wide[1], std::log(2), 1e-8);
  EXPECT_EQ(end.multipliers[0], 0);
  // With x + y ≤ 1.2: 1 − 1/x = e^y − 2 there.
  const VectorXd narrow = solved(1.2, end);
  double low = 0.5, high = 1.2;
  while (high - low > 1e-14) {
    const double x = 0.5 * (low + high);
    (1 - 1 / x - std::exp(1.2 - x) + 2 > 0 ? high : low) = x;
  }
  EXPECT_NEAR(narrow[0], low, 1e-8);
  EXPECT_LT(std::abs(narrow.sum() - 1.2), 1e-10);
  solved(1.2 + 1e-5, near);
  EXPECT_NEAR(end.multipliers[0], (end.f - near.f) / 1e-5, 1e-4);
}

FittedParameter ranged(const std::string& name, double from, double to) {
  return {name, std::array<double, 2>{from, to}};
}

LeastRequest of_crank(const std::string& least, std::vector<FittedParameter> parameters) {
  LeastRequest request;
  request.least = least;
  request.parameters = std::move(parameters);
  request.way = SweptWay{"O", {{-1.7, 2.9}}, 24, 1};
  return request;
}

std::vector<std::string> names_of(const std::vector<FittedParameter>& parameters) {
  std::vector<std::string> names;
  for (const FittedParameter& p : parameters) names.push_back(p.name);
  return names;
}

// ∂J/∂θ by nine parameters of a four-bar, of functionals of positions, angles and rates of the
// coupler point, against the closed formulas in quadruple precision; J itself as well.
TEST(Least, GradientsOfSweptMotionsInQuadruplePrecision) {
  const ParametricMechanism family(traced_four_bar(), "four-bar", {}, all_names);
  const VectorXd own = family.own();
  constexpr int poses = 24;
  constexpr double from = -1.7, to = 2.9, rate = 1.3;
  SweptParts parts(family, own.cwiseAbs(), {"O", {{from, to}}, poses, rate});
  const MotionFunction f(
      MotionFormula::from_text("integral(P.x^2 + sin(C.q)*P.y) + 0.5*mean(P.vx^2)*crank"), parts);
  MotionValues values;
  ASSERT_TRUE(parts.at(own, true, values)) << parts.why();
  VectorXd by;
  const double found = f.at(values, f.rows(values), VectorXd(), &by, nullptr);
  const auto slow = [&](const std::vector<Quad>& v) {
    const Quad apart = Quad(to - from) / Quad(poses - 1), d = 1e-9;
    Quad sum = 0, mean = 0;
    for (int i = 0; i < poses; ++i) {
      const Quad s = Quad(from) + Quad(i) * apart, weight = i % (poses - 1) == 0 ? 0.5 : 1;
      const auto y = by_trigonometry<Quad>(v, s), y1 = by_trigonometry<Quad>(v, s + d),
                 y2 = by_trigonometry<Quad>(v, s - d);
      const Quad vx = Quad(rate) * (y1[0] - y2[0]) / (d + d);
      sum = sum + weight * apart * (y[0] * y[0] + Quad::of(sinq(y[2].v)) * y[1]);
      mean = mean + weight * vx * vx / Quad(poses - 1);
    }
    return sum + Quad(0.5) * mean * v[0];
  };
  const std::vector<Quad> x(own.begin(), own.end());
  EXPECT_NEAR(found, value_of(slow(x)), 1e-11);
  for (std::size_t j = 0; j < x.size(); ++j)
    EXPECT_NEAR(by[static_cast<Index>(j)], slope(slow, x, j), 2e-9 * by.cwiseAbs().maxCoeff())
        << all_names[j];
}

// The effort that keeps up a motion, against inverse dynamics of the same motion, whose loops are
// eliminated by other means.
TEST(Least, EffortsAsByInverseDynamics) {
  const ParametricMechanism family(
      traced_four_bar("\n") +
          "[[force]]\nkind = \"spring-damper\"\nparent = \"ground\"\nchild = "
          "\"rocker\"\norigin = { parent = [0, 3, 0], child = [\"rocker\", 0, 0] }\n"
          "stiffness = 30\ndamping = 4\nrest = 1\n",
      "four-bar", {}, {"crank"});
  constexpr double rate = 2.5;
  SweptParts parts(family, family.own(), {"O", {{-1.0, 1.0}}, 9, rate});
  parts.add({MotionPart::Kind::most, "O.effort"});
  MotionValues values;
  ASSERT_TRUE(parts.at(family.own(), false, values)) << parts.why();
  const auto mechanism = family.at(family.own());
  const double start = assemble(*mechanism, Assembled::rates).start.q[0];
  EffortRequest request;
  request.motion.drives = {equations::polynomial("O", {start, rate})};
  request.actuated = {"O"};
  for (const double s : parts.places())
    if (s >= start) request.motion.times.push_back((s - start) / rate);
  const EffortResult slow = effort(*mechanism, request);
  const std::size_t skipped = parts.places().size() - request.motion.times.size();
  ASSERT_GE(slow.rows.size(), 1u);
  for (std::size_t i = 0; i < slow.rows.size(); ++i)
    EXPECT_NEAR(values.parts[0][static_cast<Index>(i + skipped)], slow.rows[i].effort[0], 1e-9)
        << i;
}

/// A crank-rocker whose crank and rocker have their centres of mass as asked, and markers at all.
std::string balanced(const std::string& crank, const std::string& rocker) {
  std::string text = reading::text_of(MOMENTA_SOURCE_DIR "/examples/balancing/scene.toml");
  text.replace(text.find("crank_centre = 0.0"), 18, "crank_centre = " + crank);
  text.replace(text.find("rocker_centre = 0.0"), 19, "rocker_centre = " + rocker);
  return text +
         "[[marker]]\nname = \"K\"\nbody = \"crank\"\npoint = [\"crank_centre\", 0, 0]\n"
         "[[marker]]\nname = \"L\"\nbody = \"coupler\"\npoint = [0.2, 0, 0]\n"
         "[[marker]]\nname = \"R\"\nbody = \"rocker\"\npoint = [\"rocker_centre\", 0, 0]\n";
}

// Newton's equation of all bodies and of the crank: what joints transmit is the rate of momentum.
TEST(Least, ReactionsAreTheRatesOfMomentum) {
  constexpr int poses = 401;
  constexpr double rate = 3, to = 2;
  const std::string text = balanced("0.03", "0.07");
  const ParametricMechanism family(text, "balanced", {}, {"crank_centre"});
  SweptParts parts(family, family.own(), {"O", {{0, to}}, poses, rate});
  for (const char* of : {"ground.force_x", "ground.force_y", "O.force_x - A.force_x",
                         "4*K.vx + L.vx + 4*R.vx", "4*K.vy + L.vy + 4*R.vy", "4*K.vx",
                         "ground.torque_z - 0.4*C.force_y - C.torque_z - O.effort",
                         "O.force^2 - O.force_x^2 - O.force_y^2 - O.force_z^2"})
    parts.add({MotionPart::Kind::most, of});
  MotionValues values;
  ASSERT_TRUE(parts.at(family.own(), false, values)) << parts.why();
  double worst = 0, largest = 0;
  const double h = to / (poses - 1) / rate;  // [s]
  for (Index i = 2; i + 2 < poses; ++i)
    for (Index k = 0; k < 3; ++k) {
      const VectorXd& momentum = values.parts[static_cast<std::size_t>(3 + k)];
      const double slope =
          (8 * (momentum[i + 1] - momentum[i - 1]) - momentum[i + 2] + momentum[i - 2]) / (12 * h);
      const double force = values.parts[static_cast<std::size_t>(k)][i];
      largest = equations::larger(largest, std::abs(force));
      worst = equations::larger(worst, std::abs(force - slope));
    }
  EXPECT_LT(worst, 1e-7 * largest);
  // About the origin, where O lies: the effort, and what C has.
  EXPECT_LT(values.parts[6].cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT(values.parts[7].cwiseAbs().maxCoeff(), 1e-9);
}

// Complete force balance of an in-line four-bar, in closed form (Berkof, Lowen 1969):
// m₁ r₁ = −m₂ (1 − r₂/a₂) a₁, m₃ r₃ = −m₂ (r₂/a₂) a₃; and found as what shakes least.
TEST(Least, TheShakingForceOfABalancedFourBarVanishes) {
  const std::vector<std::string> names{"crank_centre", "rocker_centre"};
  const auto largest = [&](const std::string& crank, const std::string& rocker) {
    const ParametricMechanism family(balanced(crank, rocker), "balanced", {}, names);
    SweptParts parts(family, VectorXd::Ones(2), {"O", std::nullopt, 37, 10});
    parts.add({MotionPart::Kind::most, "ground.force"});
    MotionValues values;
    EXPECT_TRUE(parts.at(family.own(), false, values)) << parts.why();
    return values.parts[0].maxCoeff();
  };
  EXPECT_LT(largest("-0.0125", "-0.0375"), 1e-12 * largest("0", "0"));
  LeastRequest request;
  request.least = "max(ground.force)";
  request.parameters = {{"crank_centre", {{-0.1, 0.1}}}, {"rocker_centre", {{-0.2, 0.2}}}};
  request.way = SweptWay{"O", std::nullopt, 37, 10};
  const LeastResult found =
      least(ParametricMechanism(balanced("0.0", "0.0"), "balanced", {}, names), request);
  EXPECT_NEAR(found.found[0], -0.0125, 1e-6);
  EXPECT_NEAR(found.found[1], -0.0375, 1e-6);
}

// In space the loop of a planar four-bar is redundant: forces across its plane are nobody's.
TEST(Least, ReactionsThatAreNotUniqueAreRefused) {
  MechanismOptions options;
  options.algebra = Algebra::spatial;
  const ParametricMechanism family(balanced("0.03", "0.07"), "balanced", {}, {"crank_centre"},
                                   options);
  SweptParts in_plane(family, family.own(), {"O", std::nullopt, 9, 3});
  in_plane.add({MotionPart::Kind::most, "A.force_x"});
  MotionValues values;
  EXPECT_TRUE(in_plane.at(family.own(), false, values)) << in_plane.why();
  SweptParts across(family, family.own(), {"O", std::nullopt, 9, 3});
  across.add({MotionPart::Kind::most, "A.force_z"});
  EXPECT_FALSE(across.at(family.own(), false, values));
  EXPECT_NE(across.why().find("A.force_z is not unique: loop equations are redundant"),
            std::string::npos)
      << across.why();
}

// Hoecken's straight line by its largest deviation, not by squares: ℓ of the smallest difference
// between highest and lowest place, by a search along the closed formulas over the same poses.
TEST(Least, TheSmallestLargestDeviationAsByASearch) {
  constexpr int poses = 37;
  const auto deviation = [&](double length) {
    double most = -INFINITY, least = INFINITY;
    for (int k = 0; k < poses; ++k) {
      const double s = pi / 2 + pi * k / (poses - 1), y = hoecken_height(length, s);
      most = std::max(most, y);
      least = std::min(least, y);
    }
    return most - least;
  };
  const double best = place_of_least(deviation, 2.4, 2.8, 1e-12);
  const ParametricMechanism family(hoecken("length = 2.4\n", "0"), "hoecken", {}, {"length"});
  LeastRequest request = of_crank("max(P.y) - min(P.y)", {{"length", std::nullopt}});
  request.way = SweptWay{"O", {{pi / 2, 3 * pi / 2}}, poses, 1};
  const LeastResult r = least(family, request);
  EXPECT_TRUE(r.starts.front().converged) << r.starts.front().why;
  EXPECT_NEAR(r.found[0], best, 1e-8);
  EXPECT_NEAR(r.after, deviation(best), 1e-10);
  EXPECT_NEAR(r.before, deviation(2.4), 1e-10);
}

// A transmission angle that is kept: at the optimum it is met by the worst pose to 1e-10, by the
// law of cosines; and the result is no worse than any four-bar near it that keeps it.
TEST(Least, ATransmissionAngleIsKept) {
  std::string scene = traced_four_bar();
  const ParametricMechanism family(scene, "four-bar", {}, {"crank"});
  LeastRequest request = of_crank("-crank", {{"crank", std::nullopt}});
  request.way = SweptWay{"O", std::nullopt, 73, 1};
  request.keep = {"C.transmission >= 40*pi/180"};
  const LeastResult r = least(family, request);
  EXPECT_TRUE(r.starts.front().converged) << r.starts.front().why;
  const double coupler = 2.6, rocker = 2.2, ground = 2.4;
  double worst = INFINITY;
  for (const double s : r.places) {
    const double squares =
        r.found[0] * r.found[0] + ground * ground - 2 * r.found[0] * ground * std::cos(s);
    worst = std::min(
        worst, std::asin(std::sqrt(1 - std::pow((coupler * coupler + rocker * rocker - squares) /
                                                    (2 * coupler * rocker),
                                                2))));
  }
  EXPECT_LT(std::abs(worst - 40 * pi / 180), 1e-10);
  EXPECT_LT(std::abs(r.keep[0].after), 1e-10);
  EXPECT_GT(r.keep[0].multiplier, 0.1);
  EXPECT_LT(r.keep[0].before, -0.1);  // the start breaks it
}

// A condition with two extremes, where many poses are as high and as low as may be: no worse than
// what a search over two parameters finds by cutting steps, and kept to 1e-10.
TEST(Least, ConditionsWithSeveralExtremesAreKept) {
  const ParametricMechanism family(traced_four_bar(), "four-bar", {}, {"along", "across"});
  LeastRequest request =
      of_crank("-along - 0.3*across", {ranged("along", 0, 4), ranged("across", -3, 3)});
  request.way = SweptWay{"O", std::nullopt, 25, 1};
  request.keep = {"max(P.y) - min(P.y) <= 2.5", "max(P.x) - min(P.x) <= 2.2"};
  const LeastResult r = least(family, request);
  EXPECT_TRUE(r.starts.front().converged) << r.starts.front().why;
  std::vector<double> v(all_names.size());
  const ParametricMechanism all(traced_four_bar(), "four-bar", {}, all_names);
  for (std::size_t i = 0; i < v.size(); ++i) v[i] = all.own()[static_cast<Index>(i)];
  const auto room = [&](double along, double across) {
    double most[2]{-INFINITY, -INFINITY}, least[2]{INFINITY, INFINITY};
    v[4] = along;
    v[5] = across;
    for (const double s : r.places) {
      const auto y = by_trigonometry<double>(v, s);
      for (int c = 0; c < 2; ++c) {
        most[c] = std::max(most[c], y[static_cast<std::size_t>(c)]);
        least[c] = std::min(least[c], y[static_cast<std::size_t>(c)]);
      }
    }
    return std::min(2.2 - (most[0] - least[0]), 2.5 - (most[1] - least[1]));
  };
  EXPECT_LT(std::abs(room(r.found[0], r.found[1])), 1e-10);
  double best[3]{0, 0, -INFINITY};  // along, across, what is to be most
  for (int i = 0; i <= 400; ++i)
    for (int k = 0; k <= 600; ++k) {
      const double along = 0.01 * i, across = -3 + 0.01 * k, value = along + 0.3 * across;
      if (value > best[2] && room(along, across) >= 0)
        best[0] = along, best[1] = across, best[2] = value;
    }
  EXPECT_GE(-r.after, best[2] - 1e-10) << best[0] << ", " << best[1];
  EXPECT_LT(-r.after, best[2] + 0.05);
}

// Wanted poses with a condition that holds: what Ceres finds with the bound that it amounts to.
TEST(Least, ConditionsOfWantedPosesAsByBounds) {
  const std::vector<std::string> names{"crank", "coupler", "rocker"};
  const ParametricMechanism family(traced_four_bar(), "four-bar", {}, names);
  std::vector<double> known(all_names.size());
  const ParametricMechanism all(traced_four_bar(), "four-bar", {}, all_names);
  for (std::size_t i = 0; i < known.size(); ++i) known[i] = all.own()[static_cast<Index>(i)];
  known[1] = 2.8;
  for (const bool given : {true, false}) {
    WantedPoses wanted;
    wanted.quantities = {{"P.x", "m", -1, 0, 0}, {"P.y", "m", -1, 0, 1}};
    wanted.values.resize(12, 2);
    for (int i = 0; i < 12; ++i) {
      const double s = -1.5 + 0.3 * i;
      const auto y = by_trigonometry<double>(known, s);
      wanted.values.row(i) << y[0], y[1];
      if (given) wanted.swept.push_back(s);
    }
    FitRequest request;
    request.sweep = "O";
    for (const std::string& name : names) request.parameters.push_back({name, std::nullopt});
    request.keep = {"coupler <= 2.7"};
    const FitResult kept = fit(family, wanted, request);
    EXPECT_TRUE(kept.starts.front().converged) << kept.starts.front().why;
    EXPECT_LT(std::abs(kept.found[1] - 2.7), 1e-10);
    EXPECT_GT(kept.keep[0].multiplier, 0);
    request.keep.clear();
    request.parameters[1] = ranged("coupler", 2, 2.7);
    const FitResult bounded = fit(family, wanted, request);
    EXPECT_NEAR(kept.after.cost, bounded.after.cost, 1e-9 * bounded.after.cost);
    EXPECT_LT((kept.found - bounded.found).cwiseAbs().maxCoeff(), 1e-5);
  }
}

std::string pendulum() {
  return R"toml(
name = "pendulum"
[parameters]
length = 1
stiffness = 2
[[body]]
name = "rod"
mass = 1
shape = { kind = "rod", length = "length", axis = "x" }
[[joint]]
name = "O"
kind = "revolute"
parent = "ground"
child = "rod"
axis = [0, 0, 1]
position = 0.4
stiffness = "stiffness"
[[marker]]
name = "P"
body = "rod"
point = ["length", 0, 0]
)toml";
}

LeastRequest of_a_run(const std::string& least, std::vector<FittedParameter> parameters) {
  LeastRequest request;
  request.least = least;
  request.parameters = std::move(parameters);
  request.scene = {pendulum(), "pendulum", {}, {}};
  request.settings.integrator = "rk4";
  request.settings.step = 0.01;
  request.settings.end_time = 0.9;
  request.settings.gauge = "none";
  return request;
}

// A run's functionals: their gradients against differences of sixth order of whole runs, and a
// search that finds the parameter with which a run was made.
TEST(Least, FunctionalsOfRuns) {
  const ParametricMechanism family(pendulum(), "pendulum", {}, {"length", "stiffness"});
  const LeastRequest request = of_a_run("", {});
  RunParts parts(family, family.own(), request.scene, request.settings);
  const MotionFunction f(
      MotionFormula::from_text("last(P.y) + length*integral(O.u^2) - mean(O.q)^2"), parts);
  const auto at = [&](const VectorXd& theta, VectorXd* by) {
    MotionValues values;
    EXPECT_TRUE(parts.at(theta, true, values)) << parts.why();
    return f.at(values, f.rows(values), VectorXd(), by, nullptr);
  };
  VectorXd by;
  at(family.own(), &by);
  for (Index j = 0; j < 2; ++j) {
    const auto near = [&](double d) {
      VectorXd theta = family.own();
      theta[j] += d;
      return at(theta, nullptr);
    };
    constexpr double h = 4e-3;
    const double slow = (45 * (near(h) - near(-h)) - 9 * (near(2 * h) - near(-2 * h)) +
                         (near(3 * h) - near(-3 * h))) /
                        (60 * h);
    EXPECT_NEAR(by[j], slow, 1e-9) << j;
  }
  MotionValues known;
  RunParts end(family, family.own(), request.scene, request.settings);
  end.add({MotionPart::Kind::last, "O.q"});
  end.add({MotionPart::Kind::integral, "O.q"});
  end.add({MotionPart::Kind::mean, "O.q"});
  ASSERT_TRUE(end.at(Eigen::Vector2d(1, 2.3), true, known)) << end.why();
  EXPECT_NEAR(known.parts[2][0], known.parts[1][0] / 0.9, 1e-14);
  char least_text[80];
  std::snprintf(least_text, sizeof least_text, "(last(O.q) - (%.17g))^2", known.parts[0][0]);
  const ParametricMechanism stiff(pendulum(), "pendulum", {}, {"stiffness"});
  const LeastResult r = least(stiff, of_a_run(least_text, {{"stiffness", std::nullopt}}));
  EXPECT_NEAR(r.found[0], 2.3, 1e-6);
  EXPECT_TRUE(r.starts.front().converged) << r.starts.front().why;
}

// Stopped after some starts and begun again, a search ends with the very same numbers.
TEST(Least, AStoppedSearchGoesOn) {
  const std::vector<FittedParameter> parameters{ranged("crank", 0.5, 1.4),
                                                ranged("coupler", 2, 4.0)};
  const ParametricMechanism family(traced_four_bar(), "four-bar", {}, names_of(parameters));
  LeastRequest request = of_crank("mean((P.y - 1)^2) + 0.1*mean((P.x - 0.5)^2)", parameters);
  request.keep = {"coupler <= 3 - 0.1*crank"};
  request.starts = 4;
  request.seed = 3;
  const LeastResult whole = least(family, request);
  ASSERT_EQ(whole.starts.size(), 4u);
  const auto file = std::filesystem::temp_directory_path() / "momenta_least_runs.jsonl";
  std::filesystem::remove(file);
  const Journal::Study study{"study", "build", "command"};
  {
    Journal journal(file, study);
    request.journal = &journal;
    request.progress = [](int start, double) { return start < 2; };
    const LeastResult stopped = least(family, request);
    EXPECT_TRUE(stopped.stopped);
    EXPECT_EQ(stopped.starts.size(), 3u);
    EXPECT_FALSE(stopped.starts.back().converged);
  }
  Journal journal(file, study);
  request.journal = &journal;
  int made = 0, last = -1;
  request.progress = [&](int start, double) {
    if (start != last) ++made;
    last = start;
    return true;
  };
  const LeastResult again = least(family, request);
  EXPECT_EQ(journal.runs_taken(), 2);
  EXPECT_EQ(made, 2);
  EXPECT_EQ(again.best, whole.best);
  EXPECT_EQ(again.found, whole.found);
  EXPECT_EQ(again.after, whole.after);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(again.starts[k].from, whole.starts[k].from);
    EXPECT_EQ(again.starts[k].to, whole.starts[k].to);
    EXPECT_EQ(again.starts[k].multipliers, whole.starts[k].multipliers);
  }
  // One that wants poses, likewise.
  WantedPoses wanted;
  wanted.quantities = {{"P.y", "m", -1, 0, 1}};
  wanted.swept = {0.1, 0.6, 1.1};
  wanted.values = Eigen::Vector3d(0.9, 1.1, 1.2);
  FitRequest fitting;
  fitting.sweep = "O";
  fitting.parameters = parameters;
  fitting.starts = 3;
  const FitResult whole_fit = fit(family, wanted, fitting);
  const auto other = std::filesystem::temp_directory_path() / "momenta_fit_runs.jsonl";
  std::filesystem::remove(other);
  {
    Journal kept(other, study);
    fitting.journal = &kept;
    fitting.progress = [](int start, double) { return start < 1; };
    fit(family, wanted, fitting);
  }
  Journal kept(other, study);
  fitting.journal = &kept;
  fitting.progress = nullptr;
  const FitResult again_fit = fit(family, wanted, fitting);
  EXPECT_EQ(kept.runs_taken(), 1);
  EXPECT_EQ(again_fit.found, whole_fit.found);
  EXPECT_EQ(again_fit.after.cost, whole_fit.after.cost);
  std::filesystem::remove(file);
  std::filesystem::remove(other);
}

// A mechanism that does not close is no candidate: the search for a long crank ends where the crank
// still comes round, by Grashof's rule, and says why; with that rule as a condition it is met.
TEST(Least, MechanismsThatDoNotCloseAreNoCandidates) {
  const ParametricMechanism family(traced_four_bar(), "four-bar", {}, {"crank"});
  LeastRequest request = of_crank("-crank", {{"crank", std::nullopt}});
  request.way = SweptWay{"O", std::nullopt, 73, 1};
  request.keep = {"crank + 2*max(ground, max(coupler, rocker)) <= ground + coupler + rocker - 0.1"};
  const LeastResult kept = least(family, request);
  EXPECT_TRUE(kept.starts.front().converged) << kept.starts.front().why;
  EXPECT_NEAR(kept.found[0], 1.9, 1e-10);
  EXPECT_NEAR(kept.keep[0].multiplier, 1, 1e-6);
  request.keep.clear();
  request.least = "1e-6*mean(P.x) - crank";
  const LeastResult r = least(family, request);
  EXPECT_LE(r.found[0], 2.0);
  EXPECT_GT(r.found[0], 1.5);
  EXPECT_FALSE(r.starts.front().converged);
  EXPECT_NE(r.starts.front().why.find("steps became too short"), std::string::npos)
      << r.starts.front().why;
}

// What formulas and conditions are, and what they are not, in one sentence.
TEST(Least, FormulasOfMotions) {
  const MotionFormula f = MotionFormula::from_text("max(P.y, 0) + 2*max (P.x^2) - 'a-max'.q");
  EXPECT_EQ(f.outer, "max(P.y, 0) + 2*motion.part0 - 'a-max'.q");
  ASSERT_EQ(f.parts.size(), 1u);
  EXPECT_EQ(f.parts[0].formula, "P.x^2");
  EXPECT_EQ(
      equations::thrown([] { MotionFormula::from_text("max(mean(P.x))"); }),
      "'max(mean(P.x))': max(…) of a motion holds another; expected a formula of single poses "
      "in it");
  EXPECT_EQ(equations::thrown([] { MotionFormula::from_text("max(P.x"); }),
            "'max(P.x': a bracket is not closed, expected ')'");
  const auto condition = [](const std::string& text) {
    return equations::thrown([&] { MotionCondition::from_text(text, {"a", "b"}); });
  };
  constexpr const char* one =
      ": expected one comparison, as in 'a + d <= b + c', and a condition of its own for each";
  EXPECT_EQ(condition("a + b"), std::string("'a + b'") + one);
  EXPECT_EQ(condition("a < b < 2"), std::string("'a < b < 2'") + one);
  EXPECT_EQ(condition("a != b"), std::string("'a != b'") + one);
  EXPECT_EQ(condition("a = b"), "'a = b': found '=', expected '==', '<=' or '>='");
  EXPECT_TRUE(
      condition("P.x == a").starts_with("'P.x == a': an equation cannot hold at every pose"))
      << condition("P.x == a");
  EXPECT_EQ(MotionCondition::from_text("P.x >= a", {"a"}).gap.parts[0].formula, "(a) - (P.x)");
  const ParametricMechanism family(traced_four_bar(), "four-bar", {}, {"crank"});
  const std::vector<FittedParameter> crank{{"crank", std::nullopt}};
  EXPECT_EQ(equations::thrown([&] { least(family, of_crank("max(Q.x)", crank)); }).substr(0, 25),
            "'Q.x': unknown name 'Q.x'");
  EXPECT_TRUE(equations::thrown([&] {
                least(family, of_crank("P.x + max(P.y)", crank));
              }).starts_with("'P.x + max(P.y)': found a name that is no parameter outside of"));
  const ParametricMechanism swinging(pendulum(), "pendulum", {}, {"length"});
  EXPECT_TRUE(equations::thrown([&] {
                least(swinging, of_a_run("max(O.q)", {{"length", std::nullopt}}));
              }).starts_with("'O.q': of a run no largest, smallest or first value is taken"));
}

}  // namespace
}  // namespace momenta::dae_least
