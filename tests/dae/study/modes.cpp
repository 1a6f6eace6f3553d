// Equilibria and modes of mechanisms solved by hand.

#include "equations/ensemble.h"
#include "equations/refusal.h"

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/dae/analysis/linear/linearisation.h>
#include <momenta/dae/study/modes_study.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <sstream>

namespace momenta::dae_modes {
namespace {

using std::numbers::pi;
constexpr double g = 9.81;

ModesResult modes_of(const std::string& text, ModesRequest request = {}, bool running = false) {
  Scene scene = parse_scene(text, "test");
  const Mechanism mechanism(running ? scene : held_at_start(scene));
  return find_modes(mechanism, equations::start_of(mechanism), request);
}
std::vector<double> frequencies(const ModesResult& r) {
  std::vector<double> all;
  for (const Mode& mode : r.spectrum.modes) all.push_back(mode.angular_frequency());
  return all;
}
void expect_frequencies(const ModesResult& r, std::vector<double> expected, double relative) {
  std::sort(expected.begin(), expected.end());
  const std::vector<double> found = frequencies(r);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_NEAR(found[i], expected[i], relative * expected[i]) << "mode " << i + 1;
}

/// Point masses of 1 kg in a chain of n hinges `length` apart.
std::string point_chain(int n, double length, double angle, const std::string& hinge = "") {
  std::ostringstream s;
  s << "name = \"chain\"\ngravity = [0, -9.81, 0]\n";
  for (int i = 1; i <= n; ++i)
    s << "[[body]]\nname = \"b" << i << "\"\nmass = 1\ncom = [" << length
      << ", 0, 0]\ninertia = [0, 0, 0]\n[[joint]]\nname = \"j" << i
      << "\"\nkind = \"revolute\"\nchild = \"b" << i << "\"\n"
      << (i == 1 ? "position = " + std::to_string(angle)
                 : "parent = \"b" + std::to_string(i - 1) + "\"\norigin = { parent = [" +
                       std::to_string(length) + ", 0, 0] }")
      << "\n"
      << hinge;
  return s.str();
}

TEST(Modes, OfAPendulum) {
  const ModesResult r = modes_of(point_chain(1, 0.5, 0.3));
  EXPECT_STREQ(r.nature(), "stable");
  EXPECT_NEAR(std::remainder(r.equilibrium.q[0] + pi / 2, 2 * pi), 0, 1e-12);
  EXPECT_NEAR(r.equilibrium.moved, 0.3 + pi / 2, 1e-12);
  EXPECT_NEAR(r.equilibrium.potential, -g * 0.5, 1e-12);
  expect_frequencies(r, {std::sqrt(g / 0.5)}, 1e-13);
  EXPECT_TRUE(r.spectrum.conservative);
  // M = m l²
  EXPECT_NEAR(std::abs(r.spectrum.modes[0].shape[0]), 1 / 0.5, 1e-13);
}

TEST(Modes, OfADoublePendulum) {
  expect_frequencies(
      modes_of(point_chain(2, 0.7, -1.0)),
      {std::sqrt(g / 0.7 * (2 - std::sqrt(2.0))), std::sqrt(g / 0.7 * (2 + std::sqrt(2.0)))},
      1e-12);
}

const std::string rod = R"(
gravity = [0, -9.81, 0]
[[body]]
name = "rod"
mass = 2.0
shape = { kind = "rod", length = 0.5, axis = "x" }
[[joint]]
name = "O"
kind = "revolute"
child = "rod"
)";

TEST(Modes, OfACompoundPendulumDampedAtItsHinge) {
  const double inertia = 2 * 0.25 / 3, stiffness = 2 * g * 0.25, c = 0.05;
  const ModesResult r = modes_of(rod + "position = -1\ndamping = 0.05\n");
  ASSERT_EQ(r.spectrum.modes.size(), 1u);
  const Mode& mode = r.spectrum.modes[0];
  const double omega0 = std::sqrt(stiffness / inertia),
               zeta = c / (2 * std::sqrt(stiffness * inertia));
  EXPECT_NEAR(mode.damping_ratio(), zeta, 1e-13);
  EXPECT_NEAR(mode.s.real(), -zeta * omega0, 1e-12);
  EXPECT_NEAR(mode.angular_frequency(), omega0 * std::sqrt(1 - zeta * zeta), 1e-12);
  EXPECT_NEAR(mode.frequency(), mode.angular_frequency() / (2 * pi), 1e-15);
  EXPECT_FALSE(r.spectrum.conservative);

  // Overdamped: two decays, their product ω₀².
  const ModesResult slow = modes_of(rod + "position = -1\ndamping = 5\n");
  ASSERT_EQ(slow.spectrum.modes.size(), 2u);
  for (const Mode& m : slow.spectrum.modes) EXPECT_EQ(m.kind(), Mode::Kind::decay);
  EXPECT_NEAR(slow.spectrum.modes[0].s.real() * slow.spectrum.modes[1].s.real(), omega0 * omega0,
              1e-9);
  EXPECT_NEAR(slow.spectrum.modes[0].s.real() + slow.spectrum.modes[1].s.real(), -5 / inertia,
              1e-9);
}

TEST(Modes, UprightIsASaddleThatNewtonFindsAndSettlingLeaves) {
  const double gamma = std::sqrt(3 * g / (2 * 0.5));
  const std::string leaning = rod + "position = 1.5\n";
  const ModesResult nearest = modes_of(leaning, {.search = Search::nearest});
  EXPECT_STREQ(nearest.nature(), "unstable");
  EXPECT_NEAR(nearest.equilibrium.q[0], pi / 2, 1e-12);
  ASSERT_EQ(nearest.spectrum.modes.size(), 1u);
  EXPECT_EQ(nearest.spectrum.modes[0].kind(), Mode::Kind::growth);
  EXPECT_NEAR(nearest.spectrum.modes[0].s.real(), gamma, 1e-12);
  EXPECT_STREQ(modes_of(leaning).nature(), "stable");

  std::ostringstream exact;
  exact.precision(17);
  exact << rod << "position = " << pi / 2 << "\n";
  for (const Search search : {Search::start, Search::settle}) {
    const ModesResult r = modes_of(exact.str(), {.search = search});
    EXPECT_EQ(r.equilibrium.steps, 0);
    EXPECT_EQ(r.growing(), 1);
  }
  try {
    modes_of(leaning, {.search = Search::start});
    ADD_FAILURE() << "a leaning rod was taken as it is";
  } catch (const SceneError& e) {
    // m g l/2 sin(π/2 − 1.5)
    EXPECT_NE(std::string(e.what()).find("joint 'O' is left with 0.347 N m"), std::string::npos)
        << e.what();
  }
}

// What a formula adds has no potential that is known: the way is downhill all the same.
TEST(Modes, SettlingGoesDownhillWithForcesOfAnyLaw) {
  for (const std::string law : {"0*t", "-0.3*u", "0.1*sin(3*t)"}) {
    const ModesResult r = modes_of(rod + R"(position = 1
[[force]]
kind = "torque"
joint = "O"
law = ")" + law + "\"\n");
    EXPECT_STREQ(r.nature(), "stable") << law;
    EXPECT_NEAR(std::remainder(r.equilibrium.q[0] + pi / 2, 2 * pi), 0, 1e-10) << law;
  }
  // A torque that holds it aside: 2 g/4 cos q = 3.
  const ModesResult aside = modes_of(rod + R"(position = 1.4
[[force]]
kind = "torque"
joint = "O"
law = "3 - 0.1*u"
)");
  EXPECT_STREQ(aside.nature(), "stable");
  EXPECT_NEAR(std::remainder(aside.equilibrium.q[0] + std::acos(6 / g), 2 * pi), 0, 1e-10);
}

// A crank on a spring, a piston, and between them a rod that has no mass or next to none: with
// x = 0.3 cos θ + √(0.64 − 0.09 sin²θ), V = ½ 20 (θ − 1.3)² + g 0.15 sin θ and
// M = 0.03 + ½ (dx/dθ)², of which the least V is at 2.4057 Hz.
TEST(Modes, OfALinkageWithAMasslessRod) {
  for (const std::string mass : {"0", "1e-9", "1e-6"}) {
    const ModesResult r = modes_of(R"(
gravity = [0, -9.81, 0]
[[body]]
name = "crank"
mass = 1
shape = { kind = "rod", length = 0.3 }
[[body]]
name = "rod"
mass = )" + mass + (mass == "0" ? "" : "\nshape = { kind = \"rod\", length = 0.8 }") +
                                   R"(
[[body]]
name = "piston"
mass = 0.5
shape = { kind = "point" }
[[joint]]
name = "O"
kind = "revolute"
child = "crank"
position = 1
stiffness = 20
rest = 1.3
[[joint]]
name = "A"
kind = "revolute"
parent = "crank"
child = "rod"
origin = { parent = [0.3, 0, 0] }
position = -1.3
[[joint]]
name = "P"
kind = "prismatic"
child = "piston"
axis = "x"
position = 0.9
[[loop]]
name = "B"
kind = "revolute"
parent = "rod"
child = "piston"
origin = { parent = [0.8, 0, 0] }
)");
    const double theta = r.equilibrium.q[0], sine = std::sin(theta), cosine = std::cos(theta),
                 slope = -0.3 * sine - 0.09 * sine * cosine / std::sqrt(0.64 - 0.09 * sine * sine);
    EXPECT_NEAR(20 * (theta - 1.3) + g * 0.15 * cosine, 0, 1e-5) << mass;
    const double omega = std::sqrt((20 - g * 0.15 * sine) / (0.03 + 0.5 * slope * slope));
    expect_frequencies(r, {omega}, 1e-5);
    EXPECT_NEAR(r.spectrum.modes[0].frequency(), 2.4057, 1e-4);
  }
}

TEST(Modes, OfAChainOfMassesAndSprings) {
  constexpr int n = 7;
  constexpr double m = 0.3, k = 50;
  std::ostringstream s;
  for (int i = 1; i <= n; ++i)
    s << "[[body]]\nname = \"b" << i << "\"\nmass = " << m
      << "\ninertia = [1, 1, 1]\n[[joint]]\nname = \"j" << i << "\"\nkind = \"prismatic\"\naxis = "
      << "\"x\"\nchild = \"b" << i << "\"\nstiffness = " << k << "\nrest = 1\nposition = 1\n"
      << (i > 1 ? "parent = \"b" + std::to_string(i - 1) + "\"\n" : "");
  std::vector<double> open, closed;
  for (int i = 1; i <= n; ++i) {
    open.push_back(2 * std::sqrt(k / m) * std::sin((2 * i - 1) * pi / (2 * (2 * n + 1))));
    closed.push_back(2 * std::sqrt(k / m) * std::sin(i * pi / (2 * (n + 1))));
  }
  expect_frequencies(modes_of(s.str()), open, 1e-12);
  s << "[[force]]\nkind = \"spring-damper\"\nparent = \"ground\"\nchild = \"b" << n
    << "\"\norigin = { parent = [" << n + 1 << ", 0, 0] }\nstiffness = " << k << "\nrest = 1\n";
  expect_frequencies(modes_of(s.str()), closed, 1e-12);
}

/// A parallelogram a × b on cranks held by a spring: one degree of freedom.
std::string parallelogram(const std::string& axis_y, double k, double gravity) {
  std::ostringstream s;
  s.precision(17);
  s << "gravity = [0, " << -gravity << ", 0]\n";
  for (const char* crank : {"left", "right"})
    s << "[[body]]\nname = \"" << crank
      << "\"\nmass = 1.5\nshape = { kind = \"rod\", length = 0.4, axis = \"x\" }\n";
  s << "[[body]]\nname = \"coupler\"\nmass = 2.5\nshape = { kind = \"rod\", length = 0.8, axis = "
       "\"x\" }\n"
    << "[[joint]]\nname = \"O\"\nkind = \"revolute\"\nchild = \"left\"\nposition = " << pi / 2
    << "\nstiffness = " << k << "\nrest = " << pi / 2 << "\n"
    << "[[joint]]\nname = \"A\"\nkind = \"revolute\"\nparent = \"left\"\nchild = "
       "\"coupler\"\norigin = { parent = [0.4, 0, 0] }\nposition = "
    << -pi / 2 << "\n"
    << "[[joint]]\nname = \"C\"\nkind = \"revolute\"\nchild = \"right\"\norigin = { parent = [0.8, "
       "0, 0] }\nposition = "
    << pi / 2 << "\n"
    << "[[loop]]\nname = \"B\"\nkind = \"revolute\"\nparent = \"coupler\"\nchild = "
       "\"right\"\norigin = { parent = [0.8, 0, 0], child = [0.4, 0, 0] }\n"
    << axis_y;
  return s.str();
}

TEST(Modes, OfAParallelogramHeldByASpring) {
  const double inertia = 2 * 1.5 * 0.16 / 3 + 2.5 * 0.16, weight = (1.5 + 2.5) * 0.4;
  for (const double gravity : {0.0, g})
    for (const Algebra algebra : {Algebra::planar, Algebra::spatial})
      for (const Route route : {Route::dense, Route::sparse}) {
        const Mechanism mechanism(parse_scene(parallelogram("", 80, gravity), "test"),
                                  {.algebra = algebra});
        const ModesResult r =
            find_modes(mechanism, equations::start_of(mechanism), {.route = route});
        EXPECT_EQ(r.spectrum.mobility, 1);
        EXPECT_EQ(mechanism.m() - r.spectrum.rank, algebra == Algebra::spatial ? 3 : 0);
        EXPECT_FALSE(r.singular_here());
        expect_frequencies(r, {std::sqrt((80 - gravity * weight) / inertia)}, 1e-10);
      }
  // A spring too weak for the weight: it falls over from what was a saddle, the start.
  const ModesResult weak = modes_of(parallelogram("", 10, g));
  EXPECT_EQ(weak.growing(), 1);
  EXPECT_NEAR(weak.spectrum.modes[0].s.real(), std::sqrt((g * weight - 10) / inertia), 1e-10);
}

/// One body of 2 kg on a joint from the ground: further lines are the joint's.
std::string body_on(const std::string& kind) {
  return R"(
[[body]]
name = "b"
mass = 2
inertia = [1, 2, 2.5]
[[joint]]
name = "F"
child = "b"
kind = ")" +
         kind + "\"\n";
}

TEST(Modes, OfAMechanismThatNothingHolds) {
  const ModesResult bar = modes_of(parallelogram("", 0, 0));
  EXPECT_STREQ(bar.nature(), "neutral");
  EXPECT_EQ(bar.rigid(), 1);
  const ModesResult body = modes_of(body_on("free"));
  EXPECT_EQ(body.rigid(), 6);
  EXPECT_EQ(body.spectrum.modes.size(), 6u);
  // One hinge damped, nothing held: a mode that stays and one that stops.
  const ModesResult damped = modes_of(body_on("revolute") + "damping = 0.5\n");
  ASSERT_EQ(damped.spectrum.modes.size(), 2u);
  EXPECT_EQ(damped.spectrum.modes[0].kind(), Mode::Kind::rigid);
  EXPECT_NEAR(damped.spectrum.modes[1].s.real(), -0.5 / 2.5, 1e-14);
}

TEST(Modes, OfABodyOnSpringsAtAnyTurn) {
  // Three springs along each axis at the mass centre: 2 k/m in each direction; turns are free.
  std::string text = body_on("free") + "position = [0.1, -0.05, 0.07, 0.5, 0.5, -0.5, 0.5]\n";
  for (const char* end :
       {"[3, 0, 0]", "[-3, 0, 0]", "[0, 3, 0]", "[0, -3, 0]", "[0, 0, 3]", "[0, 0, -3]"})
    text +=
        std::string("[[force]]\nkind = \"spring-damper\"\nchild = \"b\"\norigin = { parent = ") +
        end + " }\nstiffness = 40\nrest = 3\n";
  const ModesResult r = modes_of(text);
  EXPECT_EQ(r.rigid(), 3);
  ASSERT_EQ(r.spectrum.modes.size(), 6u);
  for (std::size_t i = 3; i < 6; ++i)
    EXPECT_NEAR(r.spectrum.modes[i].angular_frequency(), std::sqrt(2 * 40 / 2.0), 1e-11);
  EXPECT_LT(r.equilibrium.q.head<3>().norm(), 1e-12);
}

/// A bob of 2 kg half a metre below, on a joint O of a shaft that turns about z: further lines are
/// the drive's.
std::string bob_on_shaft(const std::string& joint) {
  return R"(
gravity = [0, 0, -9.81]
[[body]]
name = "shaft"
mass = 1
inertia = [1, 1, 1]
[[body]]
name = "bob"
mass = 2
com = [0, 0, -0.5]
inertia = [0, 0, 0]
[[joint]]
name = "S"
kind = "revolute"
child = "shaft"
axis = "z"
[[joint]]
name = "O"
parent = "shaft"
child = "bob"
)" + joint +
         R"(
[[drive]]
joint = "S"
kind = "polynomial"
)";
}

TEST(Modes, OfABobOnATurningHoop) {
  const std::string hoop = bob_on_shaft("kind = \"revolute\"\naxis = \"y\"\nposition = 0.1");
  const double fast = 6, slow = 3, ratio = g / (0.5 * fast * fast);
  const ModesResult out = modes_of(hoop + "coefficients = [0, 6]\n", {}, true);
  EXPECT_NEAR(std::cos(out.equilibrium.q[0]), ratio, 1e-12);
  expect_frequencies(out, {fast * std::sqrt(1 - ratio * ratio)}, 1e-11);
  const ModesResult below = modes_of(hoop + "coefficients = [0, 3]\n", {}, true);
  EXPECT_NEAR(below.equilibrium.q[0], 0, 1e-12);
  expect_frequencies(below, {std::sqrt(g / 0.5 - slow * slow)}, 1e-12);
  expect_frequencies(modes_of(hoop + "coefficients = [0, 6]\n"), {std::sqrt(g / 0.5)}, 1e-12);
  // A hoop that speeds up has no small motions with constant coefficients.
  EXPECT_THROW(modes_of(hoop + "coefficients = [0, 3, 2]\n", {}, true), SceneError);
}

TEST(Modes, OfFoucaultsPendulum) {
  const std::string text =
      bob_on_shaft("kind = \"universal\"\naxis = \"x\"\naxis2 = \"y\"") + "coefficients = [0, 2]\n";
  const ModesResult r = modes_of(text, {}, true);
  EXPECT_FALSE(r.spectrum.conservative);
  expect_frequencies(r, {std::sqrt(g / 0.5) - 2, std::sqrt(g / 0.5) + 2}, 1e-12);
  for (const Mode& mode : r.spectrum.modes) EXPECT_NEAR(mode.s.real(), 0, 1e-12);
}

/// A sleeping top, ξ = α + iβ its lean in ground axes: I ξ" − i C n ξ' − m g l ξ = 0, and in its
/// own axes s − i n. Of mechanisms without loops, and of what nothing can move in.
TEST(Modes, OfASleepingTopAboutItsSteadyMotion) {
  const double I = 0.02 + 0.09, C = 0.01, n = 40, weight = 0.3 * g;
  const ModesResult r = modes_of(
      "gravity = [0, 0, -9.81]\n[[body]]\nname = \"t\"\nmass = 1\ncom = [0, 0, 0.3]\ninertia = "
      "[0.02, 0.02, 0.01]\n[[joint]]\nname = \"S\"\nkind = \"spherical\"\nchild = "
      "\"t\"\nvelocity = [0, 0, 40]\n",
      {.search = Search::steady}, true);
  const std::complex<double> i(0, 1),
      root = std::sqrt(std::complex<double>(4 * I * weight - C * C * n * n));
  for (const double sign : {-1.0, 1.0}) {
    const std::complex<double> s = std::conj((i * C * n + sign * root) / (2 * I) - i * n);
    double nearest = HUGE_VAL;
    for (const Mode& mode : r.spectrum.modes) nearest = std::min(nearest, std::abs(mode.s - s));
    EXPECT_LT(nearest, 1e-9) << s;
  }
  // Two discs that turn as one, with a spring between: ω² = k (1/I₁ + 1/I₂).
  const ModesResult discs = modes_of(
      "[[body]]\nname = \"a\"\nmass = 1\ninertia = 0.2\n[[body]]\nname = \"b\"\nmass = "
      "1\ninertia = 0.1\n[[joint]]\nname = \"A\"\nkind = \"revolute\"\nchild = \"a\"\nvelocity = "
      "3\n[[joint]]\nname = \"B\"\nkind = \"revolute\"\nparent = \"a\"\nchild = "
      "\"b\"\nstiffness = 5\n",
      {.search = Search::steady}, true);
  EXPECT_TRUE(
      std::any_of(discs.spectrum.modes.begin(), discs.spectrum.modes.end(), [](const Mode& mode) {
        return std::abs(mode.s - std::complex<double>(0, std::sqrt(75))) < 1e-9;
      }));
  EXPECT_TRUE(
      modes_of("[[body]]\nname = \"a\"\nmass = 1\ninertia = 0.2\n[[body]]\nname = "
               "\"b\"\nmass = 1\ninertia = 0.1\n[[joint]]\nname = \"A\"\nkind = "
               "\"revolute\"\nchild = \"a\"\nposition = 1.0471975511965976\n[[joint]]\nname "
               "= \"B\"\nkind = \"revolute\"\nchild = \"b\"\norigin = { parent = [1, 0, 0] "
               "}\nposition = 2.0943951023931953\n[[loop]]\nname = \"L\"\nkind = "
               "\"point\"\nparent = \"a\"\nchild = \"b\"\norigin = { parent = [1, 0, 0], "
               "child = [1, 0, 0] }\n",
               {.search = Search::steady}, true)
          .spectrum.modes.empty());
}

TEST(Modes, ZieglersColumnFluttersAtItsKnownLoad) {
  // Masses 2 m and m at the ends of two bars of length l, springs c, a load P along the second bar:
  // Ziegler (1952): P l/c = 7/2 − √2 is where two frequencies meet.
  const auto growing = [](double load) {
    std::ostringstream s;
    s.precision(17);
    s << R"(
[[body]]
name = "one"
mass = 2
com = [1, 0, 0]
inertia = [0, 0, 0]
[[body]]
name = "two"
mass = 1
com = [1, 0, 0]
inertia = [0, 0, 0]
[[joint]]
name = "O"
kind = "revolute"
child = "one"
stiffness = 3
[[joint]]
name = "A"
kind = "revolute"
parent = "one"
child = "two"
origin = { parent = [1, 0, 0] }
stiffness = 3
[[force]]
kind = "wrench"
body = "two"
point = [1, 0, 0]
axes = "body"
force = [)"
      << -load * 3 << ", 0, 0]\n";
    const ModesResult r = modes_of(s.str());
    EXPECT_FALSE(r.spectrum.conservative);
    // So near a double root rounding is a thousand times its own size; growth beyond it is 1e-3.
    return std::count_if(r.spectrum.modes.begin(), r.spectrum.modes.end(),
                         [](const Mode& mode) { return mode.s.real() > 1e-9 * std::abs(mode.s); });
  };
  const double critical = 3.5 - std::sqrt(2.0);
  EXPECT_EQ(growing(critical * (1 - 1e-6)), 0);
  EXPECT_EQ(growing(critical * (1 + 1e-6)), 1);
}

/// Zeros of J₀.
constexpr double bessel_zeros[] = {2.404825557695773, 5.520078110286311, 8.653727912911013};

TEST(Modes, OfALongHangingChainComeNearThoseOfARope) {
  // Daniel Bernoulli: ω_k = j_{0,k}/2 √(g/L). Rods of a uniform chain are off by a part like 1/n².
  const auto error = [](int n, std::size_t k) {
    std::ostringstream s;
    s.precision(17);
    s << "gravity = [0, -9.81, 0]\n";
    const double l = 1.0 / n;
    for (int i = 1; i <= n; ++i)
      s << "[[body]]\nname = \"b" << i << "\"\nmass = " << l
        << "\nshape = { kind = \"rod\", length = " << l << ", axis = \"x\" }\n[[joint]]\nname = \"j"
        << i << "\"\nkind = \"revolute\"\nchild = \"b" << i << "\"\n";
    std::string text;
    std::istringstream lines(s.str());
    int joint = 0;
    for (std::string line; std::getline(lines, line);) {
      text += line + "\n";
      if (line.rfind("child", 0) != 0) continue;
      ++joint;
      std::ostringstream more;
      more.precision(17);
      if (joint == 1)
        more << "position = " << -pi / 2 + 0.2 << "\n";
      else
        more << "parent = \"b" << joint - 1 << "\"\norigin = { parent = [" << l << ", 0, 0] }\n";
      text += more.str();
    }
    const ModesResult r = modes_of(text);
    const double rope = 0.5 * bessel_zeros[k] * std::sqrt(g);
    return r.spectrum.modes.at(k).angular_frequency() / rope - 1;
  };
  for (std::size_t k = 0; k < 3; ++k) {
    const double coarse = error(20, k), fine = error(40, k);
    EXPECT_LT(std::abs(fine), 4e-3 * static_cast<double>((k + 1) * (k + 1))) << k;
    EXPECT_NEAR(coarse / fine, 4, 0.3) << k;
  }
}

TEST(Modes, NothingMovesWhereLoopsLeaveNoMotion) {
  // The right crank shifted: a triangle of three rods on two points.
  const std::string text = R"(
gravity = [0, -9.81, 0]
[[body]]
name = "a"
mass = 1
shape = { kind = "rod", length = 1, axis = "x" }
[[body]]
name = "b"
mass = 1
shape = { kind = "rod", length = 1, axis = "x" }
[[joint]]
name = "O"
kind = "revolute"
child = "a"
position = 1.0471975511965976
[[joint]]
name = "A"
kind = "revolute"
parent = "a"
child = "b"
origin = { parent = [1, 0, 0] }
position = -2.0943951023931953
[[loop]]
name = "C"
kind = "revolute"
child = "b"
origin = { parent = [1, 0, 0], child = [1, 0, 0] }
)";
  const ModesResult r = modes_of(text);
  EXPECT_STREQ(r.nature(), "fixed");
  EXPECT_TRUE(r.spectrum.modes.empty());
}

TEST(Modes, WhatFallsAndWhatHasNoLengthIsRefusedInASentence) {
  const auto refused = [](const std::string& text, const std::string& with) {
    EXPECT_TRUE(equations::says(equations::thrown<SceneError>([&] { modes_of(text); }), with));
  };
  refused("gravity = [0, 0, -9.81]" + body_on("free"), "joint 'F'");
  refused(body_on("planar") + R"([[force]]
name = "pull"
kind = "spring-damper"
child = "b"
stiffness = 4
)",
          "spring 'pull' from 'ground' to 'b' has no length");
  refused(body_on("planar") + R"([[force]]
kind = "spring-damper"
child = "b"
stiffness = 4
)",
          ": spring from 'ground' to 'b' has no length");
}

// Where no drive runs, the sentence names the formula that moves.
TEST(Modes, AboutFormulasThatMoveAreRefusedInASentence) {
  const std::string two = R"(
gravity = [0, -9.81, 0]
[[body]]
name = "a"
mass = 1
shape = { kind = "rod", length = 1 }
[[body]]
name = "b"
mass = 1
shape = { kind = "rod", length = 1 }
[[joint]]
name = "A"
kind = "revolute"
child = "a"
position = -1.5707963267948966
[[joint]]
name = "B"
kind = "revolute"
child = "b"
position = -1.5707963267948966
[[drive]]
joint = "B"
kind = "polynomial"
coefficients = [-1.5707963267948966]
)";
  const std::string free = two.substr(0, two.find("[[drive]]"));
  const auto refused = [](const std::string& text, const std::string& with, bool running = false) {
    const std::string said = equations::thrown<SceneError>([&] { modes_of(text, {}, running); });
    EXPECT_TRUE(equations::says(said, with)) << said;
  };
  const std::string loop = "[[loop]]\nname = \"L\"\nkind = \"equation\"\nequation = ";
  for (const std::string& scene : {free, two})
    refused(scene + loop + "\"A.q - B.q + 0.1*t\"\n",
            "equation 'L' moves with t: no pose is at rest; expected an equation without t");
  refused(free +
              "[[loop]]\nname = \"L\"\nkind = \"velocity-equation\"\n"
              "equation = \"A.u - B.u + 0.1\"\n",
          "velocity equation 'L' is not zero at rest: no pose is at rest; expected terms that have "
          "rates in them");
  std::string turning = two;
  turning.replace(turning.rfind("966]"), 4, "966, 1]");
  refused(turning + loop + "\"A.q - B.q\"\n", "the drives move loop 'L'", true);
  refused(R"toml(
[lagrangian]
coordinates = ["x", "y"]
position = [0.0, 1.0]
kinetic = "(x.dot^2 + y.dot^2)/2"
potential = "x^2"
constraints = [{ name = "wheel", equation = "y - 1 - 0.1*sin(t)" }]
)toml",
          "constraint 'wheel' moves with t: no pose is at rest; expected constraints without t");
}

// At and beyond a rigid stop motions, however small, have impacts.
TEST(Modes, AtRigidStopsAreRefused) {
  const auto pendulum = [](const std::string& limits, double velocity) {
    return "gravity = [0, -9.81, 0]\n[[body]]\nname = \"a\"\nmass = 1\nshape = { kind = \"rod\", "
           "length = 1 }\n[[joint]]\nname = \"A\"\nkind = \"revolute\"\nchild = \"a\"\nposition = "
           "-0.9\nvelocity = " +
           std::to_string(velocity) + "\nlimits = " + limits + "\nrestitution = 0\n";
  };
  const std::string sentence =
      equations::thrown<SceneError>([&] { modes_of(pendulum("[-1, 1]", 0)); });
  EXPECT_TRUE(equations::says(sentence, "joint 'A' is at -1.5708, at or beyond its rigid stop"));
  EXPECT_NEAR(frequencies(modes_of(pendulum("[-2, 1]", 0))).at(0), std::sqrt(1.5 * g), 1e-8);
}

// A descent that ends by rounding near a saddle, with more force left than an equilibrium may have:
// it goes on along what curves downwards there. Frequencies: those about the pose that a gradient
// flow finds.
TEST(Modes, OfALinkageWhoseDescentStallsNearASaddle) {
  const ModesResult r = modes_of(R"(gravity=[0,-9.81,0]
[[body]]
name="b0"
mass=2.6536119030626812
com=[0.2856,0.0273,0]
inertia=0.0181
[[body]]
name="b1"
mass=2.780174299989154
com=[0.3262,0.0098,0]
inertia=0.1076
[[body]]
name="b2"
mass=2.9140538164185115
com=[0.4918,0.0084,0]
inertia=0.0247
[[body]]
name="b3"
mass=2.9101758132467603
com=[0.3507,-0.0963,0]
inertia=0.1881
[[body]]
name="b4"
mass=2.8664536665967506
com=[0.2588,-0.0252,0]
inertia=0.0418
[[joint]]
name="J0"
kind="revolute"
parent="ground"
child="b0"
origin={parent=[0.514,-0.03,0],child=[0,0,0]}
position=0.228
rotation={axis="z",angle=0.7}
[[joint]]
name="J1"
kind="revolute"
parent="ground"
child="b1"
origin={parent=[0.72,-0.057,0],child=[0,0,0]}
position=0.528
rotor_inertia=0.21
[[joint]]
name="J2"
kind="revolute"
parent="b0"
child="b2"
origin={parent=[0.903,-0.021,0],child=[0,0,0]}
position=-0.173
damping=0.99
[[joint]]
name="J3"
kind="prismatic"
parent="b2"
child="b3"
origin={parent=[0.703,0.179,0],child=[0,0,0]}
position=-1.222
axis=[1.0,0.0,0]
stiffness=42.65
rest=0.38
[[joint]]
name="J4"
kind="revolute"
parent="b3"
child="b4"
origin={parent=[0.513,-0.002,0],child=[0,0,0]}
position=0.544
rotor_inertia=0.24
[[loop]]
name="L0"
kind="point"
parent="ground"
child="b4"
origin={parent=[1.135162847222961,1.4821788600504378,0],child=[0.703,0.0,0]}
[[force]]
name="S0"
kind="spring-damper"
parent="ground"
child="b4"
origin={parent=[1.65,0.29,0],child=[0.19,0.05,0]}
stiffness=51.9
rest=0.74
[[force]]
name="S1"
kind="spring-damper"
parent="ground"
child="b2"
origin={parent=[0.36,-1.87,0],child=[0.36,0.05,0]}
stiffness=17.3
rest=0.27
)");
  EXPECT_STREQ(r.nature(), "stable");
  EXPECT_NEAR(r.spectrum.modes.front().frequency(), 0.6061, 1e-4);
  EXPECT_NEAR(std::remainder(r.equilibrium.q[0] + 2.32819, 2 * pi), 0, 1e-5);
}

}  // namespace
}  // namespace momenta::dae_modes
