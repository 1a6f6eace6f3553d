// Stops at the limits of joints: the law against its formula and a spring of its own, force as the
// derivative of what is stored, both recursions, lanes and branches against single states.

#include "equations/parts.h"
#include "equations/random_tree.h"

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/kernel/branches/branches.h>
#include <momenta/core/open_chain/open_chain.h>

namespace momenta::core_stops {
namespace {

using Eigen::VectorXd;

/// A hinge with nothing else on it: u̇ is the stop's force over the moment 0.5.
Scene hinge(const std::string& keys) {
  return parse_scene(R"(
[[body]]
name = "a"
mass = 1
inertia = 0.5
[[joint]]
name = "A"
kind = "revolute"
child = "a"
)" + keys,
                     "hinge.toml");
}
double force_on(OpenChain& chain, double q, double u) {
  VectorXd udot(1);
  EXPECT_TRUE(chain.accelerations(0, VectorXd::Constant(1, q), VectorXd::Constant(1, u), udot));
  return 0.5 * udot[0];
}

TEST(Stops, AreTheirFormula) {
  OpenChain chain(
      hinge("limits = [-0.4, 0.7]\nstop_stiffness = 200\nstop_damping = 3\nstop_width = 0.1\n"));
  const auto push = [](double x, double v) {  // as the reference of scenes has it
    if (x <= 0) return 0.0;
    const double s = x / 0.1;
    return x < 0.1 ? 200 * x * x / 0.2 + 3 * s * s * (3 - 2 * s) * v : 200 * (x - 0.05) + 3 * v;
  };
  int beyond = 0;
  for (double q = -1; q < 1.2; q += 0.0173)
    for (const double u : {-2.0, 0.0, 1.5}) {
      const double expected = push(-0.4 - q, -u) - push(q - 0.7, u);
      EXPECT_NEAR(force_on(chain, q, u), expected, 1e-12 * (1 + std::abs(expected))) << q;
      beyond += expected != 0;
    }
  EXPECT_GT(beyond, 100);
  EXPECT_EQ(force_on(chain, 0.7, 5), 0);
  EXPECT_EQ(force_on(chain, -0.4, 5), 0);
}

// A continuous derivative: nowhere do one-sided slopes differ by more than curvature times step.
TEST(Stops, HaveAContinuousDerivative) {
  OpenChain chain(
      hinge("limits = [-0.4, 0.7]\nstop_stiffness = 200\nstop_damping = 3\nstop_width = 0.1\n"));
  constexpr double h = 1e-6, curvature = 200 / 0.1 + 2 * 6 * 3 / 0.01;
  for (const double at : {-0.5, -0.4, 0.7, 0.8, 0.75}) {
    const double f = force_on(chain, at, 2);
    const double left = (f - force_on(chain, at - h, 2)) / h;
    const double right = (force_on(chain, at + h, 2) - f) / h;
    EXPECT_NEAR(left, right, 4 * curvature * h) << at;
  }
}

// Beyond the width a stop is the spring at rest half a width behind the limit, and the damper.
TEST(Stops, FarBeyondAreASpringAndADamper) {
  OpenChain stop(
      hinge("limits = [-3, -2]\nstop_stiffness = 200\nstop_damping = 3\nstop_width = 0.1\n"));
  OpenChain spring(hinge("stiffness = 200\nrest = -1.95\ndamping = 3\n"));
  for (const double q : {-1.9, -1.0, 0.5})
    for (const double u : {-1.0, 0.3})
      EXPECT_NEAR(force_on(stop, q, u), force_on(spring, q, u), 1e-10);
}

/// A random tree, its joints of one coordinate with stops about where its states are.
Scene stopped(equations::RandomTree& random, double damping) {
  Scene scene = random.scene({.bodies = 9});
  for (JointSpec& joint : scene.joints) {
    if (joint.kind != JointKind::revolute && joint.kind != JointKind::prismatic &&
        joint.kind != JointKind::helical)
      continue;
    joint.limits = {random.uniform(-0.8, -0.1), random.uniform(0.1, 0.8)};
    joint.stop_stiffness = random.uniform(10, 100);
    joint.stop_damping = damping * random.uniform(1, 3);
    joint.stop_width = random.uniform(0.05, 0.9);
  }
  scene.drives.clear();
  return scene;
}

int count_stops(const Scene& scene) {
  int count = 0;
  for (const JointSpec& joint : scene.joints) count += has_stops(joint);
  return count;
}

/// The state h later along u and u̇.
std::pair<VectorXd, VectorXd> moved(const OpenChain& chain, const VectorXd& q, const VectorXd& u,
                                    const VectorXd& udot, double h) {
  VectorXd qdot(chain.nq()), there = q;
  chain.coordinate_rates(q, u, qdot);
  there += h * qdot;
  chain.tree().normalise(there);
  return {there, u + h * udot};
}

// T + V changes by the power of dampers alone; without them it is kept, so that the force is minus
// the derivative of what the stops store.
TEST(Stops, KeepEnergyWithoutDampersAndAgreeInBothRecursions) {
  int stops = 0;
  for (unsigned seed = 0; seed < 30; ++seed) {
    equations::RandomTree random(seed);
    Scene scene = stopped(random, 0);
    for (JointSpec& joint : scene.joints) joint.damping = joint.friction = 0;
    scene.forces.clear();
    stops += count_stops(scene);
    OpenChain chain(scene);
    const auto s = random.state(chain.tree());
    VectorXd udot(chain.nv()), p(chain.nv()), qdot(chain.nq()), pdot(chain.nv());
    ASSERT_TRUE(chain.accelerations(0, s.q, s.u, udot));
    constexpr double h = 1e-5;
    const auto after = moved(chain, s.q, s.u, udot, h), before = moved(chain, s.q, s.u, udot, -h);
    const auto energy = [&](const auto& state) {
      const Energies e = chain.energies(0, state.first, state.second);
      return e.kinetic + e.potential;
    };
    const Energies now = chain.energies(0, s.q, s.u);
    EXPECT_NEAR((energy(after) - energy(before)) / (2 * h), 0,
                1e-6 * (1 + now.kinetic + std::abs(now.potential)));
    chain.momenta(0, s.q, s.u, p);
    ASSERT_TRUE(chain.rates(0, s.q, p, qdot, pdot));
    VectorXd later(chain.nv()), sooner(chain.nv());
    chain.momenta(0, after.first, after.second, later);
    chain.momenta(0, before.first, before.second, sooner);
    EXPECT_LE((pdot - (later - sooner) / (2 * h)).norm(), 1e-6 * (1 + pdot.norm()));
  }
  EXPECT_GT(stops, 60);
}

TEST(Stops, ActAlikeInLanes) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    equations::RandomTree random(seed);
    OpenChain chain(stopped(random, 1));
    constexpr int states = 11;
    using States = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    States q(chain.nq(), states), p(chain.nv(), states), qdot = q, pdot = p;
    for (int i = 0; i < states; ++i) {
      const auto s = random.state(chain.tree());
      q.col(i) = s.q;
      p.col(i) = s.u;
    }
    ASSERT_TRUE(chain.rates_of_states(0, q, p, qdot, pdot));
    for (int i = 0; i < states; ++i) {
      VectorXd one(chain.nq()), two(chain.nv());
      ASSERT_TRUE(chain.rates(0, q.col(i), p.col(i), one, two));
      EXPECT_LE((two - pdot.col(i)).norm(), 1e-11 * (1 + two.norm())) << seed;
    }
  }
}

// Six equal legs are branches that are swept side by side; with stops they are not, and move as six
// legs do.
TEST(Stops, ActInBranchesOfOneShape) {
  Scene legs;
  legs.gravity = {0, 0, -9.81};
  const auto body = [&](const std::string& name, const std::string& parent, JointKind kind,
                        double position) {
    legs.bodies.push_back(equations::make_body(name, 1, {0.1, 0.12, 0.05}, {0.1, 0.05, -0.3}));
    JointSpec j;
    j.name = "j" + name;
    j.kind = kind;
    j.parent = parent;
    j.child = name;
    j.axis = Eigen::Vector3d(1, 2, 0.5).normalized();
    j.origin_parent = {0.2, 0.1, -0.4};
    if (kind == JointKind::revolute) {
      j.position = {position};
      j.limits = {-0.2, 0.2};
      j.stop_stiffness = 80;
      j.stop_damping = 2;
    }
    legs.joints.push_back(j);
  };
  body("trunk", "ground", JointKind::free, 0);
  for (int leg = 0; leg < 6; ++leg)
    for (int k = 0; k < 3; ++k)
      body("b" + std::to_string(3 * leg + k),
           k == 0 ? "trunk" : "b" + std::to_string(3 * leg + k - 1), JointKind::revolute,
           0.15 * (leg + 1));
  const auto side_by_side = [](const Scene& scene) {
    const Tree tree = build_tree(scene);
    const Model<Spatial> model = build_spatial_model(tree, scene);
    return branches_in_words(build_links(model), 4);
  };
  EXPECT_EQ(side_by_side(legs), "");
  Scene bare_legs = legs;
  for (JointSpec& j : bare_legs.joints) j.stop_stiffness = j.stop_damping = 0;
  EXPECT_NE(side_by_side(bare_legs), "");
  OpenChain chain(legs);
  const VectorXd& q = chain.tree().q0;
  VectorXd udot(chain.nv()), bare(chain.nv());
  ASSERT_TRUE(chain.accelerations(0, q, VectorXd::Zero(chain.nv()), udot));
  VectorXd p = VectorXd::Zero(chain.nv()), qdot(chain.nq()), pdot(chain.nv());
  ASSERT_TRUE(chain.rates(0, q, p, qdot, pdot));  // at rest ṗ = M u̇
  EXPECT_LE((chain.mass_matrix(0, q) * udot - pdot).norm(), 1e-10 * pdot.norm());
  OpenChain free(bare_legs);
  VectorXd less(chain.nv());
  ASSERT_TRUE(free.rates(0, q, p, qdot, less));
  int pushed = 0;
  for (int k = 6; k < chain.nv(); ++k) {
    const double x = q[k + 1] - 0.2;
    const double push = x <= 0 ? 0 : x < 0.01 ? 80 * x * x / 0.02 : 80 * (x - 0.005);
    EXPECT_NEAR(pdot[k] - less[k], -push, 1e-10) << k;
    pushed += push != 0;
  }
  EXPECT_EQ(pushed, 15);
}

TEST(Stops, AreGivenToLimitsThatHaveNone) {
  Scene scene = hinge("limits = [-0.4, 0.7]\n");
  stop_at_limits(scene, {300, 2});
  EXPECT_EQ(scene.joints[0].stop_stiffness, 300);
  EXPECT_EQ(scene.joints[0].stop_damping, 2);
  Scene own = hinge("limits = [-0.4, 0.7]\nstop_stiffness = 5\n");
  stop_at_limits(own, {300, 2});
  EXPECT_EQ(own.joints[0].stop_stiffness, 5);
  EXPECT_EQ(own.joints[0].stop_damping, 0);
  EXPECT_THROW(stop_at_limits(scene = hinge("limits = [0, 1]\n"), {-1, 0}), SceneError);
  Scene driven = hinge(
      "limits = [-0.4, 0.7]\n[[drive]]\njoint = 'A'\nkind = 'polynomial'\n"
      "coefficients = [0, 1]\n");
  stop_at_limits(driven, {300, 2});
  EXPECT_FALSE(has_stops(driven.joints[0]));
  driven.joints[0].stop_damping = 1;  // which only the drive would feel
  EXPECT_THROW(OpenChain{driven}, SceneError);
}

}  // namespace
}  // namespace momenta::core_stops
