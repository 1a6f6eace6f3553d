// Runs against stops and beyond limits: the balance of energy, the time at which a limit is passed
// between the samples, and what is said of it.

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/run/passed_limits.h>
#include <momenta/dae/run/run_form.h>

#include <algorithm>
#include <cmath>

#include "equations/parts.h"
#include "equations/runs.h"

namespace momenta::dae_stops {
namespace {

/// A slide in free fall from rest: q = −g t²/2.
Scene slide(const std::string& keys) {
  return parse_scene(R"(
gravity = [0, 0, -10]
[[body]]
name = "a"
mass = 2
shape = { kind = "sphere", radius = 0.1 }
[[joint]]
name = "A"
kind = "prismatic"
child = "a"
)" + keys,
                     "slide.toml");
}

RunResult run(const Scene& scene, double end, int samples, const std::string& form = "momentum",
              const std::string& integrator = "dop853") {
  const Mechanism mechanism(scene);
  RunRequest request =
      equations::kept(equations::adaptive(form, integrator, "none", 1e-10, end, samples));
  if (form == "acceleration") request.settings.gauge.clear();
  return run_form(mechanism, assemble(mechanism).start, request);
}

// Out and back between two samples: q = 3 t − 5 t², farthest 0.45 at 0.3, within [−9, 0.4] up to
// t = 0.2 and from 0.4 on; samples at 0 and 0.6 alone see nothing.
TEST(PassedLimits, AreToldBetweenTheSamples) {
  const Scene scene = slide("velocity = 3\nlimits = [-9, 0.4]\n");
  for (const char* integrator : {"dop853", "dp5"}) {
    const RunResult result = run(scene, 0.6, 1, "momentum", integrator);
    ASSERT_EQ(result.status, "done");
    ASSERT_EQ(result.passed_limits.size(), 1U) << integrator;
    const PassedLimit& passed = result.passed_limits[0];
    EXPECT_EQ(passed.joint, "A");
    EXPECT_NEAR(passed.since, 0.2, 1e-8);
    EXPECT_NEAR(passed.farthest, 0.45, 1e-9);
    EXPECT_NEAR(passed.farthest_at, 0.3, 1e-6);
    EXPECT_EQ(in_words(result.passed_limits),
              std::vector<std::string>{"joint 'A' is beyond its limits [-9, 0.4] m from t = 0.2 s "
                                       "on, farthest at t = 0.3 s: 0.45 m"});
  }
  EXPECT_TRUE(run(slide("velocity = 3\nlimits = [-9, 0.46]\n"), 0.6, 1).passed_limits.empty());
}

// A body that glides along an open slot of 2 m, x = 0.5 + t, and on straight beyond its end.
TEST(PassedLimits, EndsOfOpenSlotsAreToldBetweenTheSamples) {
  const auto glide = [](double end) {
    return run(parse_scene(R"(
[[body]]
name = "a"
mass = 2
shape = { kind = "sphere", radius = 0.1 }
[[joint]]
name = "A"
kind = "planar"
child = "a"
position = [0.5, 0, 0]
velocity = [1, 0, 0]
[[loop]]
name = "L"
kind = "slot"
curve = "spline"
points = [[0, 0, 0], [1, 0, 0], [2, 0, 0]]
child = "a"
)",
                           "slot.toml"),
               end, 1);
  };
  EXPECT_TRUE(glide(1.4).passed_limits.empty());
  const RunResult beyond = glide(2);
  ASSERT_EQ(beyond.status, "done") << beyond.reason;
  ASSERT_EQ(beyond.passed_limits.size(), 1U);
  EXPECT_TRUE(beyond.passed_limits[0].of_slot);
  constexpr double grid = 2.0 / (1 << 24);  // places are told on it (higher_pair.h)
  EXPECT_NEAR(beyond.passed_limits[0].since, 1.5, grid);
  EXPECT_NEAR(beyond.passed_limits[0].farthest, 2.5, grid);
  EXPECT_EQ(in_words(beyond.passed_limits),
            std::vector<std::string>{"the point in slot 'L' is beyond its ends [0, 2] m from "
                                     "t = 1.5 s on, farthest at t = 2 s: 2.5 m"});
}

TEST(PassedLimits, CountFromTheStartWhereItIsBeyond) {
  const RunResult result = run(slide("position = 1\nlimits = [0, 0.5]\n"), 0.1, 4);
  ASSERT_EQ(result.passed_limits.size(), 1U);
  EXPECT_EQ(result.passed_limits[0].since, 0);
  EXPECT_EQ(result.passed_limits[0].farthest, 1);
}

// With a damper the energy balance counts what it takes; the body comes to rest where k (x − w/2)
// carries its weight.
TEST(Stops, BalanceTheEnergyOfARunAndCarryTheWeight) {
  const Scene scene = slide(
      "position = 0.5\nlimits = [-0.1, 9]\nstop_stiffness = 4000\nstop_damping = 60\n"
      "stop_width = 0.002\n");
  for (const char* form : {"momentum", "acceleration"}) {
    const RunResult result = run(scene, 4, 200, form);
    ASSERT_EQ(result.status, "done") << result.reason;
    EXPECT_LE(result.energy_error_max, 1e-6) << form;  // of 10 J that are lost
    ASSERT_EQ(result.passed_limits.size(), 1U);
    EXPECT_TRUE(result.passed_limits[0].stops);
    EXPECT_NEAR(result.passed_limits[0].since, std::sqrt(2 * 0.6 / 10), 1e-8);
    EXPECT_EQ(in_words(result.passed_limits)[0].substr(0, 41),
              "joint 'A' is at its stops beyond [-0.1, 9");
  }
  Scene rest = scene;
  rest.joints[0].position = {-0.1 - (20.0 / 4000 + 0.001)};
  const RunResult still = run(rest, 1, 10);
  EXPECT_LE(still.kinetic_energy_max, 1e-12);  // J, of the tolerance
}

// Without a damper it bounces for ever with the energy it has.
TEST(Stops, BounceWithoutLoss) {
  const RunResult result =
      run(slide("position = 0.5\nlimits = [-0.1, 9]\nstop_stiffness = 4000\nstop_width = 0.01\n"),
          5, 500);
  EXPECT_EQ(result.status, "done");
  EXPECT_LE(result.energy_error_max, 1e-6);
  EXPECT_GT(result.kinetic_energy_max, 10);
}

/// A body on a joint at the origin, and forces; without gravity.
Scene turning(const std::string& joint, const std::string& forces = "") {
  return parse_scene(
      "[[body]]\nname = \"a\"\nmass = 2\ninertia = [0.3, 0.3, 0.3]\n[[joint]]\n"
      "name = \"A\"\nchild = \"a\"\n" +
          joint + forces,
      "turning.toml");
}

// The angle of a ball that turns about one axis grows like the time.
TEST(PassedLimits, OfBallsAndLengths) {
  const auto sentences = [](const Scene& scene) {
    const RunResult result = run(scene, 1, 1);
    EXPECT_EQ(result.status, "done") << result.reason;
    return in_words(result.passed_limits);
  };
  EXPECT_EQ(
      sentences(turning("kind = \"spherical\"\nvelocity = [0.6, 0, -0.8]\nlimits = [0, 0.25]\n")),
      std::vector<std::string>{"joint 'A' is beyond its limits [0, 0.25] rad from t = 0.25 s "
                               "on, farthest at t = 1 s: 1 rad"});
  const std::string
      sum = "[[force]]\nkind = \"coordinate-spring\"\njoints = [\"A\"]\nratios = [-2]\n",
      length =
          "[[force]]\nname = \"A\"\nkind = \"spring-damper\"\nchild = \"a\"\n"
          "origin.child = [0, 0, 1]\norigin.parent = [0, 0, -1]\n",
      slide = "kind = \"prismatic\"\nvelocity = [1]\n";
  EXPECT_EQ(
      sentences(turning("kind = \"revolute\"\nvelocity = [1]\n", sum + "limits = [-1, 1]\n")),
      std::vector<std::string>{"the length of force 'coordinate-spring 1' is beyond its limits "
                               "[-1, 1] rad from t = 0.5 s on, farthest at t = 1 s: -2 rad"});
  // of a joint and a force with one name both are told
  EXPECT_EQ(
      sentences(turning(slide + "limits = [-1, 0.75]\n", length + "limits = [0, 2.5]\n")),
      (std::vector<std::string>{"joint 'A' is beyond its limits [-1, 0.75] m from t = 0.75 s "
                                "on, farthest at t = 1 s: 1 m",
                                "the length of force 'A' is beyond its limits [0, 2.5] m from "
                                "t = 0.5 s on, farthest at t = 1 s: 3 m"}));
}

// A stop is the same on a hinge, on a ball that turns about the hinge's axis, along a sum of
// coordinates and along a length: what comes back, when, and what the damper took.
TEST(Stops, OfBallsAndLengthsAreThoseOfHingesAndSlides) {
  const std::string stops = "stop_stiffness = 40\nstop_damping = 0.7\nstop_width = 0.05\n",
                    hinge = "kind = \"revolute\"\nvelocity = [1]\n",
                    slide = "kind = \"prismatic\"\nvelocity = [1]\n";
  const auto back = [](const Scene& scene, const std::string& column) {
    const RunResult result = run(scene, 1.5, 40);
    EXPECT_EQ(result.status, "done") << result.reason;
    EXPECT_LE(result.energy_error_max, 1e-7);
    const auto& columns = result.trajectory.columns;
    const auto at = std::find_if(columns.begin(), columns.end(),
                                 [&](const std::string& c) { return c.starts_with(column + " "); });
    EXPECT_NE(at, columns.end());
    std::vector<double> rates;
    for (const auto& row : result.trajectory.rows)
      rates.push_back(row[static_cast<std::size_t>(at - columns.begin())]);
    return rates;
  };
  const auto same = [](const std::vector<double>& a, const std::vector<double>& b) {
    ASSERT_EQ(a.size(), b.size());
    EXPECT_LT(a.back(), -0.3);  // it went back, slower
    EXPECT_GT(a.back(), -0.99);
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-7) << i;
  };
  const std::vector<double> on_hinge = back(turning(hinge + "limits = [-9, 0.4]\n" + stops), "A.u");
  same(on_hinge,
       back(turning("kind = \"spherical\"\nvelocity = [0, 0, 1]\nlimits = [0, 0.4]\n" + stops),
            "A.wz"));
  const std::string sum =
      "[[force]]\nkind = \"coordinate-spring\"\njoints = [\"A\"]\nratios = [1]\n";
  same(on_hinge, back(turning(hinge, sum + "rest = 0.2\nlimits = [-9, 0.4]\n" + stops), "A.u"));
  const std::vector<double> on_slide = back(turning(slide + "limits = [-9, 0.4]\n" + stops), "A.u");
  const std::string length =
      "[[force]]\nkind = \"spring-damper\"\nchild = \"a\"\n"
      "origin.parent = [0, 0, -1]\nrest = 0.3\n";
  same(on_slide, back(turning(slide, length + "limits = [0, 1.4]\n" + stops), "A.u"));
}

// Eight equal arms with a loop each hang on a body that flies: where sweeps take such branches side
// by side, they must not forget the stops that push each arm.
TEST(Stops, ActInBranchesWithLoops) {
  Scene scene;
  const auto body = [&](const std::string& name, double mass) {
    scene.bodies.push_back(equations::make_body(name, mass, {0.2, 0.3, 0.25}, {0.4, 0.1, 0.05}));
  };
  const auto hinge = [&](const std::string& name, const std::string& parent,
                         const std::string& child, const Eigen::Vector3d& at, double most) {
    JointSpec j =
        equations::make_joint(JointKind::revolute, name, parent, child, at, {0, 0.6, 0.8});
    j.limits = {-2, -most};
    j.stop_stiffness = 50;
    j.stop_damping = 3;
    scene.joints.push_back(j);
  };
  body("trunk", 3);
  JointSpec flies;
  flies.name = "flies";
  flies.kind = JointKind::free;
  flies.child = "trunk";
  scene.joints.push_back(flies);
  for (int i = 0; i < 8; ++i) {
    const std::string n = std::to_string(i);
    body("a" + n, 1);
    body("b" + n, 1);
    hinge("A" + n, "trunk", "a" + n, {0.1 * i, 0.3, 0}, 0.05 * (i + 1));
    hinge("B" + n, "a" + n, "b" + n, {1, 0, 0}, 0.02 * (i + 1));
    LoopSpec rod = equations::make_loop(LoopKind::distance, "L" + n, "trunk", "b" + n,
                                        {0.1 * i, 1.3, 0}, {1, 0, 0});
    rod.length = std::sqrt(5.0);
    scene.loops.push_back(rod);
  }
  const auto accelerations = [](const Scene& of, KktChoice kkt) {
    const Mechanism mechanism(of, {.kkt = kkt});
    const auto e = mechanism.evaluation<double>();
    const auto solver = make_loop_solver(mechanism, *e);
    Eigen::VectorXd u = Eigen::VectorXd::Zero(mechanism.nv()), udot = u, lambda(mechanism.m());
    EXPECT_TRUE(solver->acceleration(0, mechanism.tree().q0.data(), u.data(), nullptr, 0, 0,
                                     udot.data(), lambda.data()));
    return udot;
  };
  const Eigen::VectorXd sweeps = accelerations(scene, KktChoice::sweeps),
                        dense = accelerations(scene, KktChoice::dense);
  EXPECT_GT(dense.norm(), 1);
  EXPECT_LE((sweeps - dense).norm(), 1e-9 * dense.norm());
}

}  // namespace
}  // namespace momenta::dae_stops
