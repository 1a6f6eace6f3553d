// Parameters of scenes found for wanted poses: derivatives against quadruple precision and against
// poses assembled anew, results against closed formulas and against mechanisms that are known.

#include <gtest/gtest.h>
#include <momenta/dae/analysis/kinematics/move.h>
#include <momenta/dae/output/fit_picture.h>
#include <momenta/dae/study/fit/fit.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <numbers>
#include <random>

#include "equations/refusal.h"
#include "equations/tolerance.h"
#include "equations/traced_four_bar.h"

namespace momenta::dae_fit {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using std::numbers::pi;
using namespace equations;

WantedPoses wanted_by_trigonometry(const VectorXd& values, const std::vector<double>& places,
                                   bool given) {
  WantedPoses wanted;
  wanted.file = "wanted";
  wanted.quantities = {{"P.x", "m", -1, 0, 0}, {"P.y", "m", -1, 0, 1}};
  wanted.values.resize(static_cast<Eigen::Index>(places.size()), 2);
  const std::vector<double> v(values.begin(), values.end());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto y = by_trigonometry<double>(v, places[i]);
    wanted.values.row(static_cast<Eigen::Index>(i)) << y[0], y[1];
  }
  if (given) wanted.swept = places;
  return wanted;
}

FitRequest varied(const std::vector<std::string>& names) {
  FitRequest request;
  for (const std::string& name : names) request.parameters.push_back({name, std::nullopt});
  request.sweep = "O";
  return request;
}

// ∂y/∂θ of nine parameters and ∂y/∂s of a four-bar's coupler point and rocker, against its closed
// formulas in quadruple precision.
TEST(Fit, DerivativesOfAFourBarInQuadruplePrecision) {
  const ParametricMechanism family(traced_four_bar(), "four-bar", {}, all_names);
  const VectorXd own = family.own();
  const auto mechanism = family.at(own);
  SweptPoses poses(*mechanism, "O");
  std::vector<double> places;
  for (int k = 0; k < 24; ++k) places.push_back(-1.7 + 0.21 * k);
  std::vector<VectorXd> q;
  ASSERT_TRUE(poses.reach(places, q)) << poses.why();
  const int rocker = 2;
  ASSERT_EQ(mechanism->coordinate_columns()[rocker].name, "C.q");
  const PoseDerivatives derivatives(
      family, own.cwiseAbs(),
      {{"P.x", "m", -1, 0, 0}, {"P.y", "m", -1, 0, 1}, {"C.q", "rad", rocker, -1, 0}});
  std::vector<MatrixXd> by;
  std::size_t lost = 0;
  ASSERT_TRUE(derivatives.at(own, *mechanism, poses.rate(), q, by, lost));
  double worst = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    std::vector<Quad> x(own.begin(), own.end());
    x.push_back(places[i]);
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t j = 0; j < x.size(); ++j) {
        const double exact = slope(
            [&](const std::vector<Quad>& at) { return by_trigonometry<Quad>(at, at.back())[k]; }, x,
            j);
        worst = std::max(
            worst,
            std::abs(by[i](static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(j)) - exact));
      }
  }
  EXPECT_LT(worst, 1e-11);
}

/// y of the mechanism of θ with the swept coordinate at s, assembled anew there.
VectorXd assembled_at(const ParametricMechanism& family, const VectorXd& values,
                      const std::string& sweep, double s,
                      const std::vector<WantedPoses::Quantity>& quantities) {
  const auto mechanism = family.at(values);
  SweptPoses poses(*mechanism, sweep);
  std::vector<VectorXd> q;
  EXPECT_TRUE(poses.reach({s}, q)) << poses.why();
  const auto e = mechanism->evaluation<double>();
  return quantities_at(*e, q.front(), quantities,
                       static_cast<int>(mechanism->scene().markers.size()));
}

/// Two spatial mechanisms: a crank that pushes a slider by a rod with two balls, axes askew; a tree
/// with a helical joint and a planar one behind it.
std::string spatial_slider_crank() {
  return R"toml(
name = "spatial slider-crank"
[parameters]
crank = 0.4
rod = 1.7
lean = 0.35
offset = 0.2
[assembly]
hold = ["O"]
[[body]]
name = "crank"
mass = 1
inertia = [0.1, 0.1, 0.1]
[[body]]
name = "slider"
mass = 1
inertia = [0.1, 0.1, 0.1]
[[joint]]
name = "O"
kind = "revolute"
parent = "ground"
child = "crank"
axis = [0, "sin(lean)", "cos(lean)"]
position = 0.5
[[joint]]
name = "S"
kind = "prismatic"
parent = "ground"
child = "slider"
origin = { parent = [0, "offset", 0.1] }
axis = [1, 0, 0.2]
position = 2.0
[[loop]]
name = "rod"
kind = "distance"
parent = "crank"
child = "slider"
origin = { parent = ["crank", 0, 0.3] }
length = "rod"
[[marker]]
name = "P"
body = "slider"
point = [0.1, 0, 0]
[[marker]]
name = "K"
body = "crank"
point = ["crank", 0, "offset"]
)toml";
}

// The same in space, with a parameter that turns an axis, against poses that are assembled anew for
// other θ: differences of sixth order of whole solutions.
TEST(Fit, DerivativesInSpaceAgainstPosesAssembledAnew) {
  const std::vector<std::string> names{"crank", "rod", "lean", "offset"};
  const ParametricMechanism family(spatial_slider_crank(), "space", {}, names);
  const VectorXd own = family.own();
  const auto mechanism = family.at(own);
  SweptPoses poses(*mechanism, "O");
  const std::vector<double> places{-2.0, -0.9, 0.1, 1.0, 2.1};
  std::vector<VectorXd> q;
  ASSERT_TRUE(poses.reach(places, q)) << poses.why();
  std::vector<WantedPoses::Quantity> quantities{{"S.q", "m", 1, -1, 0}};
  for (int c = 0; c < 3; ++c) {
    quantities.push_back({"P", "m", -1, 0, c});
    quantities.push_back({"K", "m", -1, 1, c});
  }
  const PoseDerivatives derivatives(family, own.cwiseAbs(), quantities);
  std::vector<MatrixXd> by;
  std::size_t lost = 0;
  ASSERT_TRUE(derivatives.at(own, *mechanism, poses.rate(), q, by, lost));
  const auto difference = [](const std::function<VectorXd(double)>& f, double h) -> VectorXd {
    return (45 * (f(h) - f(-h)) - 9 * (f(2 * h) - f(-2 * h)) + (f(3 * h) - f(-3 * h))) / (60 * h);
  };
  constexpr double h = 2e-3;  // truncation and rounding, of Newton's method too, below 1e-10
  double worst = 0;
  for (std::size_t i = 0; i < places.size(); ++i)
    for (Eigen::Index j = 0; j <= own.size(); ++j) {
      const VectorXd slow = difference(
          [&](double d) {
            VectorXd values = own;
            if (j < own.size()) values[j] += d;
            return assembled_at(family, values, "O", places[i] + (j < own.size() ? 0 : d),
                                quantities);
          },
          h);
      worst = equations::larger(worst, (slow - by[i].col(j)).cwiseAbs().maxCoeff());
    }
  EXPECT_LT(worst, 1e-9);
}

// Freudenstein's equation, d/a cos φ − d/c cos θ + (a² − b² + c² + d²)/(2ac) = cos(θ − φ), is
// linear in three numbers: three pairs of angles give the links in closed form.
TEST(Fit, ThreePairsOfAnglesAsByFreudenstein) {
  const ParametricMechanism family(traced_four_bar(), "four-bar", {},
                                   {"crank", "coupler", "rocker"});
  const std::vector<double> own(family.own().begin(), family.own().end());
  const double ground = 2.4, crank[] = {0.3, 0.9, 1.6}, change[] = {0.02, -0.03, 0.04};
  WantedPoses wanted;
  wanted.quantities = {{"C.q", "rad", 2, -1, 0}};
  wanted.values.resize(3, 1);
  Eigen::Matrix3d rows;
  Eigen::Vector3d right;
  for (int i = 0; i < 3; ++i) {
    const std::vector<double> v{own[0], own[1], own[2], ground, 0, 0, 0, 0, 0};
    const double theta = crank[i], phi = by_trigonometry<double>(v, theta)[2] + change[i];
    wanted.swept.push_back(theta);
    wanted.values(i, 0) = phi;
    rows.row(i) << std::cos(phi), -std::cos(theta), 1;
    right[i] = std::cos(theta - phi);
  }
  const Eigen::Vector3d k = rows.fullPivLu().solve(right);
  const double a = ground / k[0], c = ground / k[1],
               b = std::sqrt(a * a + c * c + ground * ground - 2 * a * c * k[2]);
  const FitResult r = fit(family, wanted, varied({"crank", "coupler", "rocker"}));
  EXPECT_TRUE(r.starts.front().converged) << r.starts.front().why;
  EXPECT_LT((r.found - Eigen::Vector3d(a, b, c)).cwiseAbs().maxCoeff(), 1e-10)
      << r.found.transpose() << ", by formula " << a << " " << b << " " << c;
  EXPECT_GT(r.before.angle_most, 0.01);
  EXPECT_LT(r.after.angle_most, 1e-12);
}

// A path that a known four-bar traces, with the crank's angles and without: its nine numbers are
// found again from a start off by up to 8 %.
TEST(Fit, AFourBarIsFoundAgainFromItsPath) {
  const ParametricMechanism family(traced_four_bar(), "four-bar", {}, all_names);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> off(-0.08, 0.08);
  for (const bool given : {true, false}) {
    VectorXd known = family.own();
    for (double& x : known) x *= 1 + off(random);
    std::vector<double> places;
    for (int k = 0; k < 16; ++k) places.push_back(-1.9 + 0.27 * k);
    const FitResult r =
        fit(family, wanted_by_trigonometry(known, places, given), varied(all_names));
    EXPECT_TRUE(r.starts.front().converged) << r.starts.front().why;
    EXPECT_LT(r.after.length_most, 1e-11);
    EXPECT_LT((r.found - known).cwiseAbs().maxCoeff(), 1e-8)
        << given << ": " << r.found.transpose() << ", known " << known.transpose();
    EXPECT_TRUE(r.undetermined.empty()) << r.undetermined;
    for (std::size_t i = 0; i < places.size(); ++i) EXPECT_NEAR(r.places[i], places[i], 1e-8);
  }
}

// Hoecken's straight line: crank 1, ground 2, coupler and rocker ℓ, the point 2ℓ from the crank.
// The ℓ of least squares from a horizontal line at any height, over half a turn, by a search along
// the closed formulas.
TEST(Fit, HoeckensLengthAsByASearch) {
  std::vector<double> places;
  for (int k = 0; k <= 36; ++k) places.push_back(pi / 2 + pi * k / 36);
  const auto squares = [&](double length) {
    double sum = 0, mean = 0;
    std::vector<double> heights;
    for (const double s : places) {
      heights.push_back(hoecken_height(length, s));
      mean += heights.back() / static_cast<double>(places.size());
    }
    for (const double y : heights) sum += (y - mean) * (y - mean);
    return sum;
  };
  const double best = place_of_least(squares, 2.2, 3.2, 1e-9);
  const ParametricMechanism family(hoecken("length = 2.3\nheight = -4\n", "\"height\""), "hoecken",
                                   {}, {"length", "height"});
  WantedPoses wanted;
  wanted.quantities = {{"P.y", "m", -1, 0, 1}};
  wanted.values = MatrixXd::Zero(static_cast<Eigen::Index>(places.size()), 1);
  wanted.swept = places;
  const FitResult r = fit(family, wanted, varied({"length", "height"}));
  EXPECT_TRUE(r.starts.front().converged) << r.starts.front().why;
  EXPECT_NEAR(r.found[0], best, 1e-6);
  EXPECT_NEAR(2 * r.after.cost, squares(r.found[0]), 1e-12);
}

// Starts follow from the seed; the best of many is the best of them, between the bounds; a start
// that is refused is told and does not end the search.
TEST(Fit, StartsFollowFromTheSeed) {
  const std::vector<std::string> names{"crank", "coupler", "rocker"};
  const ParametricMechanism family(traced_four_bar(), "four-bar", {}, names);
  FitRequest request = varied(names);
  request.parameters[0].range = {0.5, 1.4};
  request.parameters[1].range = {0.8, 4.0};
  request.parameters[2].range = {0.8, 4.0};
  request.starts = 8;
  request.seed = 5;
  VectorXd known(9);
  known << 1.2, 3.1, 1.9, 2.4, 1.4, 0.7, 0.2, -0.3, 0.3;
  const WantedPoses wanted = wanted_by_trigonometry(known, {0.2, 0.7, 1.2, 1.6, 2.0}, true);
  const FitResult r = fit(family, wanted, request), again = fit(family, wanted, request);
  ASSERT_EQ(r.starts.size(), 8u);
  EXPECT_EQ(r.found, again.found);
  EXPECT_EQ(r.evaluations, again.evaluations);
  EXPECT_LT(r.after.length_most, 1e-10);
  for (const FitStart& s : r.starts) {
    for (int j = 0; j < 3; ++j) {
      const auto& range = *request.parameters[static_cast<std::size_t>(j)].range;
      EXPECT_GE(s.from[j], range[0]);
      EXPECT_LE(s.from[j], range[1]);
      if (s.to.size() > 0) {
        EXPECT_GE(s.to[j], range[0]);
        EXPECT_LE(s.to[j], range[1]);
      }
    }
    EXPECT_EQ(s.converged, s.why.empty()) << s.why;
    if (s.to.size() > 0) {
      EXPECT_GE(s.cost, r.after.cost);
    }
  }
  request.seed = 6;
  EXPECT_NE(fit(family, wanted, request).starts[1].from, r.starts[1].from);
}

// A bound that the free minimum lies beyond holds, and is a minimum there.
TEST(Fit, BoundsHold) {
  const ParametricMechanism family(traced_four_bar(), "four-bar", {}, {"coupler", "rocker"});
  VectorXd known(9);
  known << 1, 2.9, 2.0, 2.4, 1.4, 0.7, 0.2, -0.3, 0.3;
  FitRequest request = varied({"coupler", "rocker"});
  request.parameters[0].range = {2.0, 2.7};
  const FitResult r =
      fit(family, wanted_by_trigonometry(known, {0.2, 0.7, 1.2, 1.6, 2.0}, true), request);
  EXPECT_EQ(r.found[0], 2.7);
  EXPECT_TRUE(r.starts.front().converged) << r.starts.front().why;
  EXPECT_GT(r.after.length_most, 1e-4);
  // Along the bound no other rocker does better.
  for (const double d : {-1e-3, 1e-3}) {
    WantedError error(family, "O", r.wanted, Eigen::Vector2d(2.6, 2.2));
    VectorXd values;
    ASSERT_TRUE(error.evaluate(r.found + Eigen::Vector2d(0, d), values, nullptr)) << error.why();
    EXPECT_GT(0.5 * values.squaredNorm(), r.after.cost);
  }
}

// Only angles are wanted: no place of the mechanism matters, nor its size.
TEST(Fit, WhatIsNotDeterminedIsSaid) {
  const ParametricMechanism family(traced_four_bar("idle = 1\n"), "four-bar", {},
                                   {"crank", "coupler", "rocker", "ground"});
  WantedPoses wanted;
  wanted.quantities = {{"C.q", "rad", 2, -1, 0}};
  wanted.values.resize(6, 1);
  for (int i = 0; i < 6; ++i) {
    wanted.swept.push_back(0.3 * i);
    wanted.values(i, 0) = by_trigonometry<double>({1.1, 2.5, 2.3, 2.4, 0, 0, 0, 0, 0}, 0.3 * i)[2];
  }
  const FitResult r = fit(family, wanted, varied({"crank", "coupler", "rocker", "ground"}));
  EXPECT_EQ(r.undetermined,
            "Parameters 'crank', 'coupler', 'rocker', 'ground' can change together in 1 way "
            "without a change of what is wanted, to first order: others are as good.");
  const ParametricMechanism idle(traced_four_bar("idle = 1\n"), "four-bar", {}, {"crank", "idle"});
  EXPECT_EQ(fit(idle, wanted, varied({"crank", "idle"})).undetermined,
            "What is wanted does not depend on 'idle'.");
}

// The scene that is written has the numbers found and all else as it was.
TEST(Fit, TheSceneKeepsItsText) {
  const std::string text = traced_four_bar("ratio = \"2 * crank\"  # kept\n");
  const ParametricMechanism family(text, "four-bar", {}, {"tilt", "crank", "ratio"});
  const std::string written = family.text(Eigen::Vector3d(0.1, 1.25, -3e-9));
  std::string expected = text;
  for (const auto& [from, to] : {std::pair<std::string, std::string>{"tilt = 0.3", "tilt = 0.1"},
                                 {"\ncrank = 1\n", "\ncrank = 1.25\n"},
                                 {"\"2 * crank\"  #", "-3e-09  #"}})
    expected.replace(expected.find(from), from.size(), to);
  EXPECT_EQ(written, expected);
  // Numbers that are no parameters: the scene is written anew, and does the same.
  const ParametricMechanism heavy(text, "four-bar", {{"body.crank.mass", 7}}, {"crank"});
  const Scene scene = parse_scene(heavy.text(VectorXd::Constant(1, 1.5)), "written", {});
  EXPECT_EQ(scene.bodies[0].mass, 7);
  EXPECT_EQ(scene.joints[1].origin_parent[0], 1.5);
}

// Where the path alone counts, places begin at the nearest of those a degree apart; and a turn of
// the crank's zero changes no path of a point of the crank, once places follow.
TEST(Fit, FreePlacesFollow) {
  const ParametricMechanism family(traced_four_bar(), "four-bar", {}, all_names);
  const std::vector<double> places{-1.1, -0.2, 0.7, 1.9, 2.6};
  WantedError error(family, "O", wanted_by_trigonometry(family.own(), places, false),
                    family.own().cwiseAbs());
  VectorXd x;
  ASSERT_TRUE(error.start(family.own(), x)) << error.why();
  for (std::size_t i = 0; i < places.size(); ++i)
    EXPECT_NEAR(x[family.own().size() + static_cast<Eigen::Index>(i)], places[i], 0.51 * pi / 180);
  const ParametricMechanism turned(
      traced_four_bar() + "[[marker]]\nname = \"K\"\nbody = \"crank\"\npoint = [\"crank\", 0, 0]\n",
      "four-bar", {}, {"crank", "tilt"});
  WantedPoses wanted;
  wanted.quantities = {{"K.x", "m", -1, 1, 0}, {"K.y", "m", -1, 1, 1}};
  wanted.values.resize(4, 2);
  for (int i = 0; i < 4; ++i)
    wanted.values.row(i) << 0.2 + 1.1 * std::cos(0.4 * i), -0.3 + 1.1 * std::sin(0.4 * i);
  const FitResult r = fit(turned, wanted, varied({"crank", "tilt"}));
  EXPECT_NEAR(r.found[0], 1.1, 1e-10);
  EXPECT_EQ(r.undetermined, "What is wanted does not depend on 'tilt'.");
}

// Poses are reached up to where the swept coordinate turns back, and no further.
TEST(Fit, PosesAreReachedUpToDeadPoints) {
  const ParametricMechanism family(traced_four_bar(), "four-bar", {}, {"crank"});
  const auto mechanism = family.at(family.own());
  MoveRequest request;
  request.sweep = {{"C", 1}};
  const Assembly a = assemble(*mechanism, Assembled::rates);
  const Reach reach = move(*mechanism, 0, a.start.q, request).reach[2];
  SweptPoses poses(*mechanism, "C");
  std::vector<VectorXd> q;
  EXPECT_TRUE(poses.reach({reach.most - 1e-6, reach.least + 1e-6}, q)) << poses.why();
  EXPECT_FALSE(poses.reach({reach.most + 1e-6}, q));
  EXPECT_FALSE(poses.reach({reach.least - 1e-6}, q));
}

// The page's film: in every frame both mechanisms are closed, their cranks stand at one place, and
// a ball stands where the path is wanted.
TEST(Fit, ThePictureHasBothMechanismsClosed) {
  const ParametricMechanism family(traced_four_bar(), "four-bar", {}, all_names);
  VectorXd known = family.own();
  known *= 1.05;
  const FitResult r = fit(family, wanted_by_trigonometry(known, {0.2, 0.7, 1.2, 1.6, 2.0}, true),
                          varied(all_names));
  const FitPicture picture = fit_picture(family, r, 60);
  const Mechanism& both = *picture.mechanism;
  ASSERT_EQ(both.nq(), 6);
  ASSERT_GT(picture.film.frames.size(), 50u);
  const auto columns = both.coordinate_columns();
  const auto place = [&](const std::string& name) {
    for (std::size_t i = 0; i < columns.size(); ++i)
      if (columns[i].name == name) return i;
    ADD_FAILURE() << name;
    return std::size_t{0};
  };
  const auto e = both.evaluation<double>();
  VectorXd phi(both.m());
  for (std::size_t k = 0; k < picture.film.frames.size(); ++k) {
    const std::vector<double>& q = picture.film.frames[k];
    e->place(0, q.data());
    e->positions(phi.data());
    EXPECT_LT(phi.cwiseAbs().maxCoeff(), 1e-10);
    const double there = picture.first + static_cast<double>(k) * picture.film.every;
    EXPECT_NEAR(q[place("O.q")], there, 1e-9);
    EXPECT_NEAR(q[place("before: O.q")], there, 1e-9);
  }
  ASSERT_EQ(both.scene().visuals.size(), 5u);
  for (Eigen::Index i = 0; i < 5; ++i)
    for (Eigen::Index c = 0; c < 2; ++c)
      EXPECT_EQ(both.scene().visuals[static_cast<std::size_t>(i)].position[c],
                r.wanted.values(i, c));
}

// Files of wanted poses: what is read, and each thing that is wrong with one, by file and line.
TEST(Fit, FilesOfWantedPoses) {
  const ParametricMechanism family(traced_four_bar(), "four-bar", {}, {"crank"});
  const auto mechanism = family.at(family.own());
  const auto file = std::filesystem::temp_directory_path() / "momenta_fit_wanted.csv";
  const auto read = [&](const std::string& text) {
    std::ofstream(file) << text;
    return read_wanted(file, *mechanism, "O");
  };
  const WantedPoses w = read("P.y [m],O.q [rad],\"C.q\"\r\n0.5,0.1,\r\n\r\n,0.2,1.5\r\n");
  ASSERT_EQ(w.poses(), 2);
  EXPECT_EQ(w.swept, (std::vector<double>{0.1, 0.2}));
  ASSERT_EQ(w.quantities.size(), 2u);
  EXPECT_EQ(w.quantities[0].component, 1);
  EXPECT_EQ(w.quantities[1].coordinate, 2);
  EXPECT_EQ(w.values(0, 0), 0.5);
  EXPECT_TRUE(std::isnan(w.values(0, 1)) && std::isnan(w.values(1, 0)));
  EXPECT_EQ(w.values(1, 1), 1.5);
  const auto sentence = [&](const std::string& text) {
    const std::string all = equations::thrown([&] { read(text); });
    EXPECT_TRUE(all.starts_with(file.string() + ":")) << all;
    return all.substr(std::min(all.size(), file.string().size() + 1));
  };
  EXPECT_EQ(sentence("P.y [mm]\n1\n"),
            "1: column 'P.y [mm]' is in another unit; expected 'P.y [m]'");
  EXPECT_EQ(sentence("P.vx [m/s]\n1\n"),
            "1: column 'P.vx [m/s]' is no coordinate and no position of a marker; expected of "
            "'O.q', 'A.q', 'C.q', 'P.x', 'P.y', 'P.z'");
  EXPECT_EQ(sentence("P.y,P.y\n1,2\n"), "1: column 'P.y' stands twice, expected it once");
  EXPECT_EQ(sentence("O.q\n1\n"),
            "1: the swept coordinate is the only column; expected what it is to move");
  EXPECT_EQ(sentence("P.y\n1,2\n"), "2: found 2 cells; expected 1");
  EXPECT_EQ(sentence("P.y\n1\nnan\n"), "3: found 'nan'; expected a finite number");
  EXPECT_EQ(sentence("P.y,O.q\n1,\n"), "2: found ''; expected a finite number");
  EXPECT_EQ(sentence("P.y\n"), "1: there are no poses; expected a line for each");
  EXPECT_EQ(sentence("P.y,P.x\n,\n"),
            "2: all cells are empty; expected a number for what is asked");
  std::filesystem::remove(file);
}

// What cannot be done is said in one sentence.
TEST(Fit, WhatCannotBeDoneIsSaid) {
  EXPECT_EQ(
      equations::thrown([] { ParametricMechanism(traced_four_bar(), "four-bar", {}, {"crnk"}); }),
      "'crnk': the scene has no parameter of that name; did you mean 'crank'?");
  EXPECT_EQ(equations::thrown([] {
              ParametricMechanism(traced_four_bar(), "four-bar", {}, {"tilt", "tilt"});
            }),
            "'tilt' is varied twice, expected each name once");
  EXPECT_EQ(FittedParameter::from_text("parameters.crank=1:2").name, "crank");
  EXPECT_EQ(equations::thrown([] { FittedParameter::from_text("crank=1"); }),
            "--vary 'crank=1': expected NAME or NAME=FROM:TO, as in crank=0.1:2");
  EXPECT_EQ(equations::thrown([] { FittedParameter::from_text("crank=2:1"); }),
            "--vary 'crank=2:1': expected the smaller end first");
  EXPECT_EQ(equations::thrown([] { FittedParameter::from_text("crank=a:1"); }),
            "--vary 'crank=a:1': found 'a', expected a number");
  const ParametricMechanism family(traced_four_bar(), "four-bar", {}, {"crank"});
  const WantedPoses wanted = wanted_by_trigonometry(
      ParametricMechanism(traced_four_bar(), "four-bar", {}, all_names).own(), {0.3, 0.6}, true);
  FitRequest request = varied({"crank"});
  request.starts = 2;
  EXPECT_EQ(equations::thrown([&] { fit(family, wanted, request); }),
            "parameter 'crank' has no range to draw starts from; expected crank=FROM:TO");
  request.parameters[0].range = {1.1, 1.2};
  EXPECT_EQ(equations::thrown([&] { fit(family, wanted, request); }),
            "parameter 'crank' is 1 in the scene, expected a number in its range, from 1.1 to 1.2");
  request = varied({"crank"});
  request.sweep = "X";
  EXPECT_EQ(equations::thrown([&] { fit(family, wanted, request); }),
            "coordinate 'X' is not known; expected 'O.q', 'A.q', 'C.q'");
  // The rocker does not come round: the crank's coupler does.
  request.sweep = "C";
  WantedPoses beyond = wanted;
  beyond.swept = {1.5, 4.0};
  const std::string sentence = equations::thrown([&] { fit(family, beyond, request); });
  EXPECT_TRUE(
      sentence.starts_with("no start is possible; the first is not, as C.q = 4 is not "
                           "reached: from its start, "))
      << sentence;
}

}  // namespace
}  // namespace momenta::dae_fit
