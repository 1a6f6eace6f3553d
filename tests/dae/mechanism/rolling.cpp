// Motions of rolling wheels and spheres that textbooks know: circles, what is steady and whether it
// is stable, energy, and one disc on two trees.

#include "equations/rolling.h"
#include "equations/refusal.h"

#include <momenta/core/open_chain/poses.h>
#include <momenta/dae/study/modes_study.h>

#include <cmath>
#include <complex>
#include <numbers>

namespace momenta::dae_rolling {
namespace {

using equations::column;
using equations::number;
using equations::run_of;
using equations::wheel;

/// A homogeneous sphere on a table that turns at Ω moves on a circle, at 2/7 of Ω, whatever its
/// start (Earnshaw 1844; Milne, Vectorial Mechanics, 1948).
TEST(Rolling, SphereOnATurningTable) {
  constexpr double turn = 2;
  const Mechanism mechanism(parse_scene(R"(
gravity = [0, 0, -9.81]
[[body]]
name = "table"
mass = 1
inertia = [1, 1, 1]
[[body]]
name = "ball"
mass = 2
inertia = [0.008, 0.008, 0.008]
[[joint]]
name = "T"
kind = "revolute"
child = "table"
[[joint]]
name = "F"
kind = "free"
child = "ball"
position = [0.5, 0, 0.1, 1, 0, 0, 0]
velocity = [0.2, 0.3, 0, 1, 2, 0.5]
[[loop]]
name = "contact"
kind = "rolling"
parent = "table"
child = "ball"
radius = 0.1
crown_radius = 0.1
[[drive]]
joint = "T"
kind = "polynomial"
coefficients = [0, 2]
[[marker]]
name = "C"
body = "ball"
)",
                                        "table.toml"));
  const Start start = assemble(mechanism).start;
  const double omega = 2 * turn / 7, period = 2 * std::numbers::pi / omega;
  // The centre's velocity in body axes, which start as those of the ground.
  const double x = start.q[0], y = start.q[1], vx = start.u[0], vy = start.u[1];
  for (const std::string form : {"momentum", "acceleration", "projected", "stabilised-index2"})
    for (const double part : {0.3, 1.0}) {
      SCOPED_TRACE(form);
      const double angle = omega * part * period;
      const RunResult run = run_of(mechanism, form, part * period);
      ASSERT_EQ(run.status, "done") << run.reason;
      // v turns at ω.
      const double bound = is_dae_form(form) ? 1e-5 : 1e-9;
      EXPECT_NEAR(column(run, "C.x"),
                  x + (vx * std::sin(angle) - vy * (1 - std::cos(angle))) / omega, bound);
      EXPECT_NEAR(column(run, "C.y"),
                  y + (vx * (1 - std::cos(angle)) + vy * std::sin(angle)) / omega, bound);
    }
}

/// λ does no work where nothing moves by itself.
TEST(Rolling, EnergyIsKept) {
  const Mechanism mechanism(
      parse_scene(wheel("[0, 0, -9.81]", 0.3, 0.05,
                        "position = [0, 0, 0.29, 0.98, 0.1989974874213240, 0, 0]\n"
                        "velocity = [1.5, 0.2, 0, 0.1, 0, 0.7]",
                        "velocity = [6]"),
                  "wheel.toml"));
  for (const std::string form : {"momentum", "projected", "acceleration"}) {
    const RunResult run = run_of(mechanism, form, 0.8);
    ASSERT_EQ(run.status, "done") << run.reason;
    EXPECT_LE(run.energy_error_max, 1e-9 * run.energy_scale) << form;
    EXPECT_LE(run.velocity_drift_max, 1e-9) << form;
    EXPECT_LE(run.position_drift_max, 1e-9) << form;
  }
}

/// A wheel in a circle. θ: of the axle from the vertical, Ω about it, n: spin in all along the
/// axle; m, A, C of wheel and carrier, which has mass too:
///   (C + m r²) n Ω sin θ − A Ω² sin θ cos θ + m g r cos θ = 0     (Routh, 1884, art. 244)
/// with C of the wheel alone where the carrier turns with Ω only: L of that is along Ω.
Scene circling(double theta, double precession, double error = 0) {
  constexpr double mass = 2.5, r = 0.3, A = 0.05, C = 0.09, g = 9.81;
  const double si = std::sin(theta), co = std::cos(theta);
  const double n = (A * precession * precession * si * co - mass * g * r * co) /
                       ((C + mass * r * r) * precession * si) +
                   error;
  const double gamma = std::numbers::pi / 2 - theta;
  // Carrier axes: x along −v for n > 0 …: ω = Ω (sin θ e₂ + cos θ e₃) with e₃ = y, e₂ = z.
  return parse_scene(
      wheel("[0, 0, -9.81]", r, 0,
            "position = [0, 0, " + number(r * si) + ", " + number(std::cos(gamma / 2)) + ", " +
                number(std::sin(gamma / 2)) + ", 0, 0]\nvelocity = [" + number(r * n) +
                ", 0, 0, 0, " + number(precession * co) + ", " + number(precession * si) + "]",
            "velocity = [" + number(n - precession * co) + "]"),
      "circle.toml");
}

TEST(Rolling, WheelInACircleIsSteady) {
  for (const double theta : {1.2, 1.9})
    for (const double precession : {1.5, -2.0}) {
      SCOPED_TRACE(theta);
      const Mechanism mechanism(circling(theta, precession));
      const Assembly a = assemble(mechanism);
      EXPECT_LE((a.start.u - mechanism.tree().u0).norm(), 1e-12);
      EXPECT_LE(a.start.udot.norm(), 1e-11);
      EXPECT_GT(assemble(Mechanism(circling(theta, precession, 0.1))).start.udot.norm(), 1e-2);
    }
}

/// Upright and straight: (A + m r²) θ̈ + (C (C + m r²)/A Ω² − m g r) θ = 0, A with the carrier's;
/// for a thin disc alone stable where v² > g r/3.
TEST(Rolling, UprightWheelIsStableAboveItsSpeed) {
  constexpr double mass = 2.5, r = 0.3, A = 0.07, C = 0.09, g = 9.81;
  const double critical = r * std::sqrt(mass * g * r * A / (C * (C + mass * r * r)));
  for (const double part : {0.5, 0.99, 1.01, 2.0}) {
    const double v = part * critical, spin = v / r;
    const Mechanism mechanism(parse_scene(
        wheel("[0, 0, -9.81]", r, 0,
              "position = [0, 0, 0.3, 1, 0, 0, 0]\nvelocity = [" + number(v) + ", 0, 0, 0, 0, 0]",
              "velocity = [" + number(spin) + "]"),
        "upright.toml"));
    ModesRequest request;
    request.search = Search::steady;
    const ModesResult result = find_modes(mechanism, assemble(mechanism).start, request);
    const double square =
        (mass * g * r - C * (C + mass * r * r) / A * spin * spin) / (A + mass * r * r);
    double nearest = HUGE_VAL;
    for (const Mode& mode : result.spectrum.modes)
      nearest = std::min(nearest, std::abs(mode.s * mode.s - square));
    EXPECT_LE(nearest, 1e-10) << part;
    EXPECT_EQ(result.growing() > 0, part < 1) << part;
  }
}

/// A sphere whose mass centre lies e below its middle rocks at ω² = m g e/(I + m (R − e)²), in two
/// directions, by both routes.
TEST(Rolling, WeightedSphereRocks) {
  constexpr double mass = 2, R = 0.1, e = 0.03, inertia = 0.008, g = 9.81;
  Scene scene = parse_scene(R"(
gravity = [0, 0, -9.81]
[[body]]
name = "ball"
mass = 2
inertia = [0.008, 0.008, 0.008]
com = [0, 0, -0.03]
[[joint]]
name = "F"
kind = "free"
child = "ball"
position = [0, 0, 0.1, 0.98, 0.1989974874213240, 0, 0]
[[loop]]
name = "contact"
kind = "rolling"
child = "ball"
radius = 0.1
crown_radius = 0.1
)",
                            "ball.toml");
  const double omega = std::sqrt(mass * g * e / (inertia + mass * (R - e) * (R - e)));
  const Mechanism mechanism(scene);
  for (const Route route : {Route::dense, Route::sparse}) {
    ModesRequest request;
    request.route = route;
    const ModesResult result = find_modes(mechanism, assemble(mechanism).start, request);
    ASSERT_EQ(result.spectrum.mobility, 3);
    int rocking = 0;
    for (const Mode& mode : result.spectrum.modes)
      rocking += std::abs(mode.s - std::complex<double>(0, omega)) < 1e-6;
    EXPECT_EQ(rocking, 2);
    EXPECT_EQ(result.rigid(), 1);
  }
}

TEST(Rolling, MotionsThatAreNotSteadyAreRefused) {
  const Mechanism mechanism(circling(1.2, 1.5, 0.1));
  ModesRequest request;
  request.search = Search::steady;
  const Start start = assemble(mechanism).start;
  EXPECT_NE(equations::sentence_of([&] {
              find_modes(mechanism, start, request);
            }).find("the start is no steady motion: "),
            std::string::npos);
}

/// One disc as a chain of a planar joint and two hinges, and as a free body.
TEST(Rolling, SameMotionWhateverTheTree) {
  const std::string bodies = R"(
[[body]]
name = "wheel"
mass = 2
inertia = [0.05, 0.09, 0.05]
com = [0.02, 0.01, 0]
[[marker]]
name = "C"
body = "wheel"
point = [0.1, 0, 0.1]
[[loop]]
name = "contact"
kind = "rolling"
child = "wheel"
axis = [0, 1, 0]
radius = 0.3
crown_radius = 0.04
)";
  const std::string massless = R"(
[[body]]
name = "yawing"
mass = 0
[[body]]
name = "rising"
mass = 0
[[body]]
name = "leaning"
mass = 0
[[joint]]
name = "P"
kind = "planar"
child = "yawing"
direction = [1, 0, 0]
velocity = [1.2, 0, 0.4]
[[joint]]
name = "Z"
kind = "prismatic"
parent = "yawing"
child = "rising"
axis = [0, 0, 1]
position = 0.3
[[joint]]
name = "L"
kind = "revolute"
parent = "rising"
child = "leaning"
axis = [1, 0, 0]
position = 0.1
velocity = 0.3
[[joint]]
name = "W"
kind = "revolute"
parent = "leaning"
child = "wheel"
axis = [0, 1, 0]
velocity = 5
)";
  const std::string gravity = "gravity = [0.5, 0, -9.81]\n";
  const Mechanism chain(parse_scene(gravity + massless + bodies, "chain.toml"));
  const Start one = assemble(chain).start;
  // The same pose and twist of the free wheel.
  const int k = chain.tree().body("wheel");
  const auto at = Poses(chain.tree(), chain.scene())(0, one.q.data())[static_cast<std::size_t>(k)];
  const Eigen::Quaterniond turn(at.linear());
  const Eigen::Vector3d lean(one.u[4], 0, 0), spin(0, one.u[5], 0), yaw(0, 0, one.u[2]);
  const Eigen::AngleAxisd leaning(one.q[4], Eigen::Vector3d::UnitX());
  const Eigen::Vector3d omega =
      at.linear().transpose() *
      (yaw + Eigen::AngleAxisd(one.q[2], Eigen::Vector3d::UnitZ()) * (lean + leaning * spin));
  const Eigen::Vector3d v = at.linear().transpose() * Eigen::Vector3d(one.u[0], one.u[1], one.u[3]);
  std::string position = "position = [", velocity = "velocity = [";
  for (const double x : {at.translation()[0], at.translation()[1], at.translation()[2], turn.w(),
                         turn.x(), turn.y()})
    position += number(x) + ", ";
  position += number(turn.z()) + "]\n";
  for (const double x : {v[0], v[1], v[2], omega[0], omega[1]}) velocity += number(x) + ", ";
  velocity += number(omega[2]) + "]\n";
  const Mechanism alone(
      parse_scene(gravity + "[[joint]]\nname = \"F\"\nkind = \"free\"\nchild = \"wheel\"\n" +
                      position + velocity + bodies,
                  "free.toml"));
  for (const std::string form : {"momentum", "projected"}) {
    const RunResult a = run_of(chain, form, 0.7), b = run_of(alone, form, 0.7);
    ASSERT_EQ(a.status, "done") << a.reason;
    ASSERT_EQ(b.status, "done") << b.reason;
    for (const char* name : {"C.x", "C.y", "C.z", "C.vx", "C.vy", "C.vz"})
      EXPECT_NEAR(column(a, name), column(b, name), 1e-8) << form << name;
  }
}

}  // namespace
}  // namespace momenta::dae_rolling
