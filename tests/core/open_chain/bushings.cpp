// Bushings, springs along sums of coordinates and between points, with dead bands and stops, stops
// of a ball with a rotor, and friction of joints: energies against forces, both
// recursions against each other, exact derivatives against differences, and single bodies against
// their equations.

#include "equations/four_bodies.h"
#include "equations/random_tree.h"

#include <gtest/gtest.h>
#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/core/open_chain/open_chain.h>

#include <numbers>

namespace momenta::core_bushings {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// A tree with every kind of force; `c` scales what takes energy.
Scene mixed(double c) {
  const auto number = [](double x) { return std::to_string(x); };
  return parse_scene(equations::four_bodies + R"(
[[joint]]
name = "A"
kind = "revolute"
child = "a"
axis = [1, 2, 2]
friction = )" + number(0.8 * c) +
                         R"(
friction_rate = 0.5
[[joint]]
name = "B"
kind = "spherical"
parent = "a"
child = "b"
origin = { parent = [0.5, 0.1, 0], child = [0, -0.2, 0.1] }
rotation = { rpy = [0.3, -0.5, 0.7] }
rotor_inertia = 0.3
limits = [0, 0.6]
stop_stiffness = 6
stop_width = 0.4
[[joint]]
name = "D"
kind = "prismatic"
parent = "b"
child = "d"
axis = [1, 0, 1]
friction = )" + number(0.5 * c) +
                         R"(
[[joint]]
name = "E"
kind = "cylindrical"
parent = "a"
child = "e"
axis = "y"
rotation = { rpy = [0.1, 0.2, 0.3] }
[[force]]
kind = "bushing"
parent = "a"
child = "b"
origin = { parent = [0.4, 0.1, 0], child = [0.1, -0.2, 0.1] }
rotation = { rpy = [-0.4, 0.6, 0.2] }
stiffness = 7
rotational_stiffness = 3
damping = )" + number(0.9 * c) +
                         "\nrotational_damping = " + number(0.6 * c) + R"(
[[force]]
kind = "bushing"
child = "d"
origin = { parent = [0.4, 0.3, 0.2], child = [0.1, 0, 0] }
rotational_stiffness = 5
damping = )" + number(0.4 * c) +
                         R"(
[[force]]
kind = "coordinate-spring"
joints = ["A", "D", "E"]
coordinates = [0, 0, 1]
ratios = [1.5, -2, 0.7]
stiffness = 4
rest = 0.3
dead_band = 0.8
limits = [-0.5, 1.5]
stop_stiffness = 5
stop_width = 0.3
damping = )" + number(0.5 * c) +
                         R"(
[[force]]
kind = "spring-damper"
parent = "e"
child = "d"
origin = { parent = [0, 0.1, 0.3], child = [0.1, 0, -0.2] }
stiffness = 8
rest = 0.5
dead_band = 0.6
limits = [0.4, 1.2]
stop_stiffness = 5
stop_width = 0.2
)",
                     "mixed.toml");
}

struct State {
  VectorXd q, u;
};
State random_state(equations::RandomTree& random, const OpenChain& chain) {
  State s{VectorXd(chain.nq()), VectorXd(chain.nv())};
  for (double& x : s.q) x = random.uniform(-1, 1);
  for (double& x : s.u) x = random.uniform(-1, 1);
  chain.tree().normalise(s.q);
  return s;
}
/// The state h later, q to first order.
State moved(const OpenChain& chain, const State& s, const VectorXd& udot, double h) {
  VectorXd qdot(chain.nq());
  chain.coordinate_rates(s.q, s.u, qdot);
  State m{s.q + h * qdot, s.u + h * udot};
  chain.tree().normalise(m.q);
  return m;
}
double energy(OpenChain& chain, const State& s) {
  const Energies e = chain.energies(0, s.q, s.u);
  return e.kinetic + e.potential;
}

TEST(Bushings, EnergyIsKeptWithoutDampers) {
  OpenChain chain(mixed(0));
  equations::RandomTree random(1);
  constexpr double h = 1e-5;
  for (int i = 0; i < 40; ++i) {
    const State s = random_state(random, chain);
    VectorXd udot(chain.nv());
    ASSERT_TRUE(chain.accelerations(0, s.q, s.u, udot));
    const double power =
        (energy(chain, moved(chain, s, udot, h)) - energy(chain, moved(chain, s, udot, -h))) /
        (2 * h);
    EXPECT_NEAR(power, 0, 1e-7 * (1 + energy(chain, s)));
  }
}

TEST(Bushings, DampersAndFrictionTakeEnergy) {
  OpenChain chain(mixed(1)), kept(mixed(0));
  equations::RandomTree random(2);
  for (int i = 0; i < 40; ++i) {
    const State s = random_state(random, chain);
    VectorXd with(chain.nv()), without(chain.nv());
    ASSERT_TRUE(chain.accelerations(0, s.q, s.u, with));
    ASSERT_TRUE(kept.accelerations(0, s.q, s.u, without));
    const double power = s.u.dot(chain.mass_matrix(0, s.q) * (with - without));
    // The same from places and rates of bodies, by differences of poses.
    constexpr double h = 1e-5;
    const VectorXd still = VectorXd::Zero(chain.nv());
    const auto before = chain.poses(0, moved(chain, s, still, -h).q);
    const auto now = chain.poses(0, s.q);
    const auto after = chain.poses(0, moved(chain, s, still, h).q);
    const auto at = [&](const char* body) {
      return static_cast<std::size_t>(chain.tree().body(body));
    };
    const auto scene_pose = [&](const auto& poses, const char* body) {
      return Eigen::Isometry3d(poses[at(body)]);
    };
    const auto velocity = [&](const char* body, const Vector3d& ground_point) {
      const Vector3d own = scene_pose(now, body).inverse() * ground_point;
      return Vector3d((scene_pose(after, body) * own - scene_pose(before, body) * own) / (2 * h));
    };
    const auto spin = [&](const char* body) {
      const Eigen::AngleAxisd turn(scene_pose(after, body).linear() *
                                   scene_pose(before, body).linear().transpose());
      return Vector3d(turn.angle() * turn.axis() / (2 * h));
    };
    const Vector3d x = scene_pose(now, "b") * Vector3d(0.1, -0.2, 0.1);
    const Vector3d y = scene_pose(now, "d") * Vector3d(0.1, 0, 0);
    const double on_b = (velocity("b", x) - velocity("a", x)).squaredNorm();
    const double turn = (spin("b") - spin("a")).squaredNorm();
    const double on_d = velocity("d", y).squaredNorm();
    const double a = s.u[0], d = s.u[4], e = s.u[6];
    const double sum = 1.5 * a - 2 * d + 0.7 * e;
    const double expected = -0.9 * on_b - 0.6 * turn - 0.4 * on_d - 0.5 * sum * sum -
                            0.8 * a * a / std::hypot(a, 0.5) - 0.5 * d * d / std::hypot(d, 0.1);
    EXPECT_NEAR(power, expected, 1e-7 * (1 + std::abs(expected)));
  }
}

TEST(Bushings, MomentaAndAccelerationsAgree) {
  OpenChain chain(mixed(1));
  equations::RandomTree random(3);
  constexpr double h = 1e-5;
  for (int i = 0; i < 20; ++i) {
    const State s = random_state(random, chain);
    VectorXd udot(chain.nv()), p(chain.nv()), qdot(chain.nq()), pdot(chain.nv());
    ASSERT_TRUE(chain.accelerations(0, s.q, s.u, udot));
    chain.momenta(0, s.q, s.u, p);
    ASSERT_TRUE(chain.rates(0, s.q, p, qdot, pdot));
    VectorXd later(chain.nv()), sooner(chain.nv());
    const State after = moved(chain, s, udot, h), before = moved(chain, s, udot, -h);
    chain.momenta(0, after.q, after.u, later);
    chain.momenta(0, before.q, before.u, sooner);
    EXPECT_LE((pdot - (later - sooner) / (2 * h)).norm(), 1e-7 * (1 + pdot.norm()));
  }
}

TEST(Bushings, ExactDerivatives) {
  OpenChain chain(mixed(1));
  equations::RandomTree random(4);
  constexpr double h = 1e-6;
  for (int i = 0; i < 10; ++i) {
    const State s = random_state(random, chain);
    VectorXd p(chain.nv());
    chain.momenta(0, s.q, s.u, p);
    const MatrixXd J = chain.jacobian(0, s.q, p);
    MatrixXd differences = J;
    for (int k = 0; k < chain.nq() + chain.nv(); ++k) {
      VectorXd f[2];
      for (const int side : {0, 1}) {
        VectorXd q = s.q, at = p, qdot(chain.nq()), pdot(chain.nv());
        (k < chain.nq() ? q[k] : at[k - chain.nq()]) += side ? h : -h;
        ASSERT_TRUE(chain.rates(0, q, at, qdot, pdot));
        f[side].resize(qdot.size() + pdot.size());
        f[side] << qdot, pdot;
      }
      differences.col(k) = (f[1] - f[0]) / (2 * h);
    }
    EXPECT_LE((J - differences).norm(), 1e-7 * J.norm());
  }
}

/// One body on a ball: M u̇ + ω × M ω = −k θ − c ω, θ from the reference to the child's axes.
TEST(Bushings, BallAgainstItsEquation) {
  Scene scene = parse_scene(R"(
[[body]]
name = "a"
mass = 1
inertia = [0.3, 0.4, 0.5]
[[joint]]
name = "A"
kind = "spherical"
child = "a"
rotation = { rpy = [0.3, -0.5, 0.7] }
[[force]]
kind = "bushing"
child = "a"
rotation = { rpy = [0.3, -0.5, 0.7] }
rotational_stiffness = 3
rotational_damping = 0.6
)",
                            "ball.toml");
  OpenChain chain(scene);
  equations::RandomTree random(5);
  const Vector3d inertia(0.3, 0.4, 0.5);
  for (const double angle :
       {0.0, 1e-9, 1e-4, 0.5, 1.5, 2.0, 3.0, std::numbers::pi - 1e-7, std::numbers::pi}) {
    const Vector3d axis = random.vector(1).normalized();
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, axis));
    VectorXd q(4);
    q << turn.w(), turn.vec();
    const Vector3d w = random.vector(2);
    VectorXd udot(3);
    ASSERT_TRUE(chain.accelerations(0, q, VectorXd(w), udot));
    const Vector3d couple =
        inertia.cwiseProduct(Vector3d(udot)) + w.cross(Vector3d(inertia.cwiseProduct(w))) + 0.6 * w;
    if (angle == std::numbers::pi)  // either way round
      EXPECT_NEAR(couple.cwiseAbs().sum(), (3 * angle * axis).cwiseAbs().sum(), 1e-12);
    else
      EXPECT_LE((couple + 3 * angle * axis).norm(), 1e-13 * (1 + 3 * angle));
    EXPECT_NEAR(chain.energies(0, q, VectorXd(w)).potential, 1.5 * angle * angle, 1e-13 * 15);
  }
}

/// In a plane and in space the same.
TEST(Bushings, PlanarLikeSpatial) {
  const Scene scene = parse_scene(R"(
[[body]]
name = "a"
mass = 2
com = [0.3, 0, 0]
inertia = 0.1
[[body]]
name = "b"
mass = 1
com = [0.2, 0.1, 0]
inertia = 0.1
[[joint]]
name = "A"
kind = "revolute"
child = "a"
axis = "-z"
friction = 0.4
[[joint]]
name = "B"
kind = "prismatic"
parent = "a"
child = "b"
axis = "x"
[[force]]
kind = "bushing"
parent = "ground"
child = "b"
origin = { parent = [0.5, 0.5, 0.2], child = [0.1, 0, 0] }
stiffness = 3
damping = 0.5
rotational_damping = 0.2
[[force]]
kind = "coordinate-spring"
joints = ["A", "B"]
ratios = [1.5, -2]
stiffness = 4
damping = 0.3
)",
                                  "plane.toml");
  OpenChain planar(scene, Algebra::planar), spatial(scene, Algebra::spatial);
  equations::RandomTree random(6);
  for (int i = 0; i < 20; ++i) {
    const State s = random_state(random, planar);
    VectorXd one(2), two(2), p(2), qdot(2), pdot(2), other(2);
    ASSERT_TRUE(planar.accelerations(0, s.q, s.u, one));
    ASSERT_TRUE(spatial.accelerations(0, s.q, s.u, two));
    EXPECT_LE((one - two).norm(), 1e-12 * (1 + one.norm()));
    planar.momenta(0, s.q, s.u, p);
    ASSERT_TRUE(planar.rates(0, s.q, p, qdot, pdot));
    ASSERT_TRUE(spatial.rates(0, s.q, p, qdot, other));
    EXPECT_LE((pdot - other).norm(), 1e-12 * (1 + pdot.norm()));
    EXPECT_NEAR(energy(planar, s), energy(spatial, s), 1e-12 * (1 + energy(planar, s)));
  }
  Scene stiff = scene;
  stiff.forces[0].rotational_stiffness = 1;
  EXPECT_EQ(OpenChain(stiff).plan().planar_reason,
            "bushing from 'ground' to 'b' has a rotational stiffness, which only space has");
}

}  // namespace
}  // namespace momenta::core_bushings
