// Rows of loops that hold nothing but rounding, and joints that hold next to no inertia: aligned
// and tilted scenes move the same, by every solver.

#include "equations/examples.h"
#include "equations/linkages.h"

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/study/extremes.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <algorithm>
#include <cmath>

namespace momenta::dae_dust {
namespace {

/// A body that slides along the axis of a cylindrical joint, kept from turning by a slide along the
/// same axis, with an arm swinging on it. Of the slide's five equations four say nothing.
constexpr const char* slide = R"(
name = "slide on a cylindrical joint"
gravity = [1.0, -2.0, -9.81]
[[body]]
name = "a"
mass = 1.0
com = [0.2, 0.1, 0.3]
inertia = [0.1, 0.2, 0.15]
[[body]]
name = "b"
mass = 0.5
com = [0.3, 0.0, 0.0]
inertia = [0.01, 0.02, 0.02]
[[joint]]
name = "C"
kind = "cylindrical"
parent = "ground"
child = "a"
axis = [0, 0, 1]
position = [0.1, 0.0]
velocity = [0.3, 0.0]
[[joint]]
name = "H"
kind = "revolute"
parent = "a"
child = "b"
axis = [0, 1, 0]
position = 0.4
[[loop]]
name = "S"
kind = "prismatic"
parent = "ground"
child = "a"
axis = [0, 0, 1]
)";

RunResult two_seconds(const Mechanism& mechanism, const std::string& form) {
  const Assembly a = assemble(mechanism);
  RunRequest request;
  RunSettings& s = request.settings;
  s.form = form;
  s.integrator = is_dae_form(form) ? "ida" : "dop853";
  s.gauge = is_dae_form(form) ? "leak:3" : "reset";
  s.project = form == "momentum";
  s.rtol = s.atol = 1e-9;
  s.end_time = 2;
  s.samples = 10;
  request.keep_trajectory = true;
  return run_form(mechanism, a.start, request);
}

TEST(Dust, PrismaticAlongACylindricalJointMovesTheSameTilted) {
  const Scene scene = parse_scene(slide, "slide");
  const RunResult reference =
      two_seconds(Mechanism(scene, {Algebra::spatial, KktChoice::dense}), "momentum");
  ASSERT_EQ(reference.status, "done") << reference.reason;
  const auto& exact = reference.trajectory.rows.back();
  EXPECT_GT(std::abs(exact[1]), 1);
  for (int tilt = 0; tilt < 8; ++tilt) {
    const Eigen::Vector3d axis = Eigen::Vector3d(1, 2 * tilt - 3, 3).normalized();
    const Scene tilted = turned(scene, Eigen::Quaterniond(Eigen::AngleAxisd(0.37 * tilt, axis)));
    const Assembly a = assemble(Mechanism(tilted, {.algebra = Algebra::spatial}));
    EXPECT_LT(a.moved, 1e-14) << tilt;
    EXPECT_EQ(a.rank, 1);
    for (const KktChoice kkt : {KktChoice::sweeps, KktChoice::sparse, KktChoice::dense})
      for (const char* form : {"momentum", "projected", "momentum-index2", "stabilised-index2"}) {
        const RunResult r = two_seconds(Mechanism(tilted, {Algebra::spatial, kkt}), form);
        ASSERT_EQ(r.status, "done") << form << ", " << name_of(kkt) << ": " << r.reason;
        for (std::size_t i = 1; i <= 3; ++i)
          EXPECT_NEAR(r.trajectory.rows.back()[i], exact[i], 1e-5)
              << form << ", " << name_of(kkt) << ", tilt " << tilt;
      }
  }
}

/// A pendulum of two rods in one piece, with a loop between them that ties nothing, alone and
/// beside one that does: by every form that is a DAE, as without that loop.
TEST(Dust, LoopsBetweenWeldedBodiesHarmNoForm) {
  const std::string rods = R"(
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
[[joint]]
name = "B"
kind = "weld"
parent = "a"
child = "b"
origin = { parent = [1, 0, 0] }
)",
                    idle = R"(
[[loop]]
name = "W"
kind = "revolute"
parent = "a"
child = "b"
origin = { parent = [1.5, 0.3, 0], child = [0.5, 0.3, 0] }
)",
                    bar = R"(
[[body]]
name = "c"
mass = 0.5
shape = { kind = "rod", length = 2 }
[[joint]]
name = "C"
kind = "revolute"
child = "c"
origin = { parent = [2, 0, 0] }
position = 2.0
[[loop]]
name = "L"
kind = "distance"
parent = "b"
child = "c"
origin = { parent = [1, 0, 0], child = [2, 0, 0] }
length = 2.5
)";
  for (const std::string& more : {std::string(), bar}) {
    const RunResult without = two_seconds(Mechanism(parse_scene(rods + more, "rods")), "momentum");
    ASSERT_EQ(without.status, "done") << without.reason;
    const Mechanism mechanism(parse_scene(rods + more + idle, "rods"), {.cut = CutChoice::scene});
    for (const std::string& form : form_names()) {
      if (form != "momentum" && !is_dae_form(form)) continue;
      const RunResult r = two_seconds(mechanism, form);
      ASSERT_EQ(r.status, "done") << form << ": " << r.reason;
      EXPECT_NEAR(r.trajectory.rows.back()[1], without.trajectory.rows.back()[1], 1e-4) << form;
    }
  }
}

/// The four-bar with a coupler `factor` times as heavy.
Scene with_coupler(double factor) {
  Scene s = equations::example("four_bar");
  for (BodySpec& b : s.bodies)
    if (b.name == "coupler") {
      b.mass *= factor;
      b.inertia *= factor;
    }
  return s;
}

// Beside a joint that turns next to nothing the sweeps lose the digits of the others. Motions have
// limits for couplers without mass and for all the mass in the coupler. At 10⁹ ω is near what it
// may be, and either way of solving is right.
TEST(Dust, LoopsOfLightAndHeavyLinksAreLeftToKlu) {
  for (const double sign : {-1.0, 1.0}) {
    const Mechanism limit(with_coupler(std::pow(10, sign * 5)));
    EXPECT_TRUE(limit.solver().leaves_first());
    EXPECT_EQ(limit.solver().kkt(), KktChoice::sweeps);
    const double angle = two_seconds(limit, "momentum").trajectory.rows.back()[1];
    for (const int power : {9, 10, 12}) {
      const Scene scene = with_coupler(std::pow(10, sign * power));
      const Mechanism mechanism(scene);
      for (const char* form : {"momentum", "projected", "baumgarte", "stabilised-index2"}) {
        const RunResult r = two_seconds(mechanism, form);
        ASSERT_EQ(r.status, "done") << form << ": " << r.reason;
        EXPECT_NEAR(r.trajectory.rows.back()[1], angle, 1e-4) << form << ", 10^" << sign * power;
        EXPECT_TRUE(r.undetermined.empty()) << form;
      }
      if (power == 9) continue;
      EXPECT_FALSE(mechanism.solver().leaves_first());
      EXPECT_EQ(mechanism.solver().kkt(), KktChoice::sparse);
      const auto lines = plan_lines(mechanism);
      EXPECT_TRUE(std::any_of(lines.begin(), lines.end(), [](const auto& line) {
        return line.second.find("before their loops miss (7) by") != std::string::npos &&
               line.second.find("times lighter than") != std::string::npos;
      }));
      // M and pivots of W would take what the light bodies let move for all there is.
      EXPECT_THROW(Mechanism(scene, {.kkt = KktChoice::dense}).solver(), SceneError);
    }
  }
}

// Redundant rows stand beside rows of heavy links: what keeps the matrices regular must be small
// beside both.
TEST(Dust, RedundantLoopWithMassesFarApart) {
  for (const double factor : {1e-6, 1e6, 1e9}) {
    Scene scene = equations::bricard();
    for (std::size_t i = 1; i < scene.bodies.size(); i += 2) {
      scene.bodies[i].mass *= factor;
      scene.bodies[i].inertia *= factor;
    }
    const Mechanism mechanism(scene);
    for (const char* form : {"momentum", "projected", "stabilised-index2"}) {
      const RunResult r = two_seconds(mechanism, form);
      ASSERT_EQ(r.status, "done") << form << ": " << r.reason;
      EXPECT_LT(r.energy_error_max, 2e-5 * r.energy_scale) << form << ", " << factor;
      EXPECT_FALSE(r.undetermined.empty()) << form;
    }
  }
}

}  // namespace
}  // namespace momenta::dae_dust
