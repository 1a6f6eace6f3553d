// Forces by formulas: those of springs, dampers, torques and wrenches written as formulas against
// the built-in ones, potentials against their energies, powers against energy rates, both
// recursions and algebras against each other, exact derivatives against differences, batches
// against single states.

#include "equations/four_bodies.h"
#include "equations/random_tree.h"

#include <gtest/gtest.h>
#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/core/kernel/body_forces.h>
#include <momenta/core/open_chain/open_chain.h>

#include <cmath>
#include <cstdio>
#include <string>

namespace momenta::core_formula_forces {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A tree of every kind of joint that formulas name.
const std::string tree = R"toml(
gravity = [0.3, -9, 1]
[parameters]
k = 4
c = 0.7
)toml" + equations::four_bodies +
                         R"toml(
[[joint]]
name = "A"
kind = "revolute"
child = "a"
axis = [1, 2, 2]
[[joint]]
name = "left-knee"
kind = "universal"
parent = "a"
child = "b"
origin = { parent = [0.5, 0.1, 0], child = [0, -0.2, 0.1] }
rotation = { rpy = [0.3, -0.5, 0.7] }
axis = "x"
axis2 = "y"
[[joint]]
name = "D"
kind = "prismatic"
parent = "b"
child = "d"
axis = [1, 0, 1]
[[joint]]
name = "E"
kind = "cylindrical"
parent = "a"
child = "e"
axis = "y"
rotation = { rpy = [0.1, 0.2, 0.3] }
[[marker]]
name = "M"
body = "d"
point = [0.1, -0.2, 0.3]
[[marker]]
name = "N"
body = "ground"
point = [0.4, 0.5, -0.6]
)toml";

const std::string built_in = R"toml(
[[force]]
kind = "spring-damper"
parent = "a"
child = "d"
origin = { parent = [0.1, 0.4, 0], child = [0.2, 0, 0.1] }
stiffness = 4
damping = 0.7
rest = 0.3
[[force]]
kind = "coordinate-spring"
joints = ["A", "left-knee", "E"]
coordinates = [0, 1, 0]
ratios = [1.5, -2, 0.7]
stiffness = 3
damping = 0.4
rest = -0.2
[[force]]
kind = "torque"
joint = "D"
value = 1.7
[[force]]
kind = "wrench"
body = "e"
point = [0.1, 0.2, 0.3]
force = [1, -2, 3]
torque = [0.4, 0, -0.6]
[[force]]
kind = "wrench"
body = "b"
force = [0.5, 2, -1]
torque = [0.4, 0.3, 0]
axes = "body"
)toml";

const std::string by_formula = R"toml(
[[force]]
kind = "spring-damper"
parent = "a"
child = "d"
origin = { parent = [0.1, 0.4, 0], child = [0.2, 0, 0.1] }
law = "k * (length - 0.3) + c * rate"
[[force]]
kind = "coordinate-spring"
joints = ["A", "left-knee", "E"]
coordinates = [0, 1, 0]
ratios = [1.5, -2, 0.7]
law = "(k - 1) * (l + 0.2) + 0.4 * rate"
[[force]]
kind = "torque"
joint = "D"
law = "1.7 + 0 * (q + u + t)"
[[force]]
kind = "wrench"
body = "e"
point = [0.1, 0.2, 0.3]
force = ["1 + 0 * t", -2, "3 + 0 * M.x"]
torque = [0.4, "0 * t", "-0.6 + 0 * t"]
[[force]]
kind = "wrench"
body = "b"
force = ["0.5 + 0 * t", "2 + 0 * t", "-1 + 0 * t"]
torque = ["0.4 + 0 * t", "0.3 + 0 * t", "0 * t"]
axes = "body"
)toml";

/// The built-in springs' energy, and functions of everything that has one.
const std::string potentials = R"toml(
[[force]]
name = "S"
kind = "spring-damper"
parent = "a"
child = "d"
origin = { parent = [0.1, 0.4, 0], child = [0.2, 0, 0.1] }
[[force]]
name = "C"
kind = "coordinate-spring"
joints = ["A", "left-knee", "E"]
coordinates = [0, 1, 0]
ratios = [1.5, -2, 0.7]
[[force]]
kind = "potential"
V = "2 * (S.length - 0.3)^2 + 1.5 * (C.l + 0.2)^2"
[[force]]
kind = "potential"
V = "-cos(A.q) * 'left-knee'.q0^2 + exp(0.3 * D.q) * E.q1 + 1 / (1 + (M.x - N.x)^2 + (M.y - N.y)^2 + M.z^2)"
)toml";

Scene scene_of(const std::string& forces) {
  return parse_scene(tree + forces, "formulas.toml");
}

struct State {
  double t;
  VectorXd q, u;
};
State random_state(equations::RandomTree& random, const OpenChain& chain) {
  State s{random.uniform(0, 2), VectorXd(chain.nq()), VectorXd(chain.nv())};
  for (double& x : s.q) x = random.uniform(-1, 1);
  for (double& x : s.u) x = random.uniform(-1, 1);
  return s;
}

void expect_same(const std::string& one, const std::string& other) {
  OpenChain a(scene_of(one)), b(scene_of(other));
  equations::RandomTree random(1);
  for (int i = 0; i < 20; ++i) {
    const State s = random_state(random, a);
    VectorXd udot(a.nv()), again(a.nv()), p(a.nv()), qdot(a.nq()), pdot(a.nv()), other_pdot(a.nv());
    ASSERT_TRUE(a.accelerations(s.t, s.q, s.u, udot));
    ASSERT_TRUE(b.accelerations(s.t, s.q, s.u, again));
    EXPECT_LE((udot - again).norm(), 1e-12 * (1 + udot.norm()));
    a.momenta(s.t, s.q, s.u, p);
    ASSERT_TRUE(a.rates(s.t, s.q, p, qdot, pdot));
    ASSERT_TRUE(b.rates(s.t, s.q, p, qdot, other_pdot));
    EXPECT_LE((pdot - other_pdot).norm(), 1e-12 * (1 + pdot.norm()));
  }
}

TEST(FormulaForces, AreTheBuiltInOnesWhereTheyAreWrittenSo) {
  expect_same(built_in, by_formula);
}

TEST(FormulaForces, PotentialsOfSpringsAreTheSprings) {
  const std::string springs = R"toml(
[[force]]
kind = "spring-damper"
parent = "a"
child = "d"
origin = { parent = [0.1, 0.4, 0], child = [0.2, 0, 0.1] }
stiffness = 4
rest = 0.3
[[force]]
kind = "coordinate-spring"
joints = ["A", "left-knee", "E"]
coordinates = [0, 1, 0]
ratios = [1.5, -2, 0.7]
stiffness = 3
rest = -0.2
)toml";
  const std::string same = potentials.substr(0, potentials.rfind("[[force]]"));
  expect_same(springs, same);
  OpenChain a(scene_of(springs)), b(scene_of(same));
  equations::RandomTree random(2);
  for (int i = 0; i < 20; ++i) {
    const State s = random_state(random, a);
    const double energy = a.energies(s.t, s.q, s.u).potential;
    EXPECT_NEAR(energy, b.energies(s.t, s.q, s.u).potential, 1e-13 * (1 + std::abs(energy)));
  }
}

/// Q = −∂V/∂q by differences; all joints of the tree have q̇ = u.
TEST(FormulaForces, PotentialsGiveTheirGradients) {
  OpenChain with(scene_of(potentials)), without(scene_of(""));
  equations::RandomTree random(3);
  constexpr double h = 1e-6;
  for (int i = 0; i < 20; ++i) {
    const State s = random_state(random, with);
    VectorXd a(with.nv()), b(with.nv());
    ASSERT_TRUE(with.accelerations(s.t, s.q, s.u, a));
    ASSERT_TRUE(without.accelerations(s.t, s.q, s.u, b));
    const VectorXd force = with.mass_matrix(s.t, s.q) * (a - b);
    VectorXd gradient(with.nv());
    const auto energy = [&](const VectorXd& q) {
      return with.energies(s.t, q, s.u).potential - without.energies(s.t, q, s.u).potential;
    };
    for (int k = 0; k < with.nv(); ++k) {
      const VectorXd step = h * VectorXd::Unit(with.nv(), k);
      gradient[k] = (energy(s.q + step) - energy(s.q - step)) / (2 * h);
    }
    EXPECT_LE((force + gradient).norm(), 1e-8 * (1 + gradient.norm()));
  }
}

/// What takes every signal, rates and the time among them.
const std::string everything = potentials + R"toml(
[[force]]
kind = "torque"
joint = "A"
law = "-c * u * abs(u) + sin(3 * t) * D.u - k * tanh(q) + M.vy * 'left-knee'.u1 / (1 + E.u0^2)"
[[force]]
kind = "spring-damper"
parent = "b"
child = "e"
origin = { parent = [0, 0.1, 0.5], child = [0.3, 0, 0] }
law = "if(length > 0.5, k * length^3, 1) + max(rate, 0.2) * cos(t) + S.rate * C.rate"
[[force]]
kind = "wrench"
body = "d"
point = [0.1, 0, 0]
force = ["-c * M.vx", "exp(-t) * M.z", 0]
torque = [0, 0, "0.2 * N.y + E.q0 * E.u1"]
axes = "body"
[[force]]
kind = "wrench"
body = "a"
point = [0.3, 0, 0.1]
force = [0, "-0.3 * A.u", "2 * t"]
)toml";

TEST(FormulaForces, MomentaAndAccelerationsAgree) {
  OpenChain chain(scene_of(everything));
  equations::RandomTree random(4);
  constexpr double h = 1e-5;
  for (int i = 0; i < 20; ++i) {
    const State s = random_state(random, chain);
    VectorXd udot(chain.nv()), p(chain.nv()), qdot(chain.nq()), pdot(chain.nv());
    ASSERT_TRUE(chain.accelerations(s.t, s.q, s.u, udot));
    chain.momenta(s.t, s.q, s.u, p);
    ASSERT_TRUE(chain.rates(s.t, s.q, p, qdot, pdot));
    VectorXd later(chain.nv()), sooner(chain.nv());
    chain.momenta(s.t, s.q + h * s.u, s.u + h * udot, later);
    chain.momenta(s.t, s.q - h * s.u, s.u - h * udot, sooner);
    EXPECT_LE((pdot - (later - sooner) / (2 * h)).norm(), 1e-7 * (1 + pdot.norm()));
  }
}

TEST(FormulaForces, ExactDerivatives) {
  OpenChain chain(scene_of(everything));
  equations::RandomTree random(5);
  constexpr double h = 1e-6;
  for (int i = 0; i < 10; ++i) {
    const State s = random_state(random, chain);
    VectorXd p(chain.nv());
    chain.momenta(s.t, s.q, s.u, p);
    const MatrixXd J = chain.jacobian(s.t, s.q, p);
    MatrixXd differences = J;
    for (int k = 0; k < chain.nq() + chain.nv(); ++k) {
      VectorXd f[2];
      for (const int side : {0, 1}) {
        VectorXd q = s.q, at = p, qdot(chain.nq()), pdot(chain.nv());
        (k < chain.nq() ? q[k] : at[k - chain.nq()]) += side ? h : -h;
        ASSERT_TRUE(chain.rates(s.t, q, at, qdot, pdot));
        f[side].resize(qdot.size() + pdot.size());
        f[side] << qdot, pdot;
      }
      differences.col(k) = (f[1] - f[0]) / (2 * h);
    }
    EXPECT_LE((J - differences).norm(), 1e-7 * J.norm());
  }
}

/// A torque at a time, and one of a driven joint's motion, are the numbers they are there.
TEST(FormulaForces, TakeTheTimeAndDrivenCoordinates) {
  const std::string drive = R"toml(
[[drive]]
joint = "E"
coordinate = 1
kind = "harmonic"
amplitude = 0.7
frequency = 3
)toml";
  const auto with = [&](const std::string& torque) {
    return scene_of(drive + "[[force]]\nkind = \"torque\"\njoint = \"A\"\n" + torque + "\n");
  };
  OpenChain chain(with("law = \"2 * sin(3 * t) + E.q1 * E.u1\""));
  equations::RandomTree random(9);
  for (int i = 0; i < 10; ++i) {
    const State s = random_state(random, chain);
    const double q = 0.7 * std::sin(3 * s.t), u = 2.1 * std::cos(3 * s.t);
    char value[40];
    std::snprintf(value, sizeof value, "value = %.17g", 2 * std::sin(3 * s.t) + q * u);
    OpenChain plain(with(value));
    VectorXd one(chain.nv()), two(chain.nv()), p(chain.nv()), qdot(chain.nq()), pdot(chain.nv());
    ASSERT_TRUE(chain.accelerations(s.t, s.q, s.u, one));
    ASSERT_TRUE(plain.accelerations(s.t, s.q, s.u, two));
    EXPECT_LE((one - two).norm(), 1e-12 * (1 + one.norm()));
    chain.momenta(s.t, s.q, s.u, p);
    VectorXd other(chain.nv());
    ASSERT_TRUE(chain.rates(s.t, s.q, p, qdot, pdot));
    ASSERT_TRUE(plain.rates(s.t, s.q, p, qdot, other));
    EXPECT_LE((pdot - other).norm(), 1e-12 * (1 + pdot.norm()));
  }
}

TEST(FormulaForces, BatchesAreStateByState) {
  OpenChain chain(scene_of(everything));
  equations::RandomTree random(6);
  constexpr int count = 13;
  StateMatrix q(chain.nq(), count), p(chain.nv(), count), qdot = q, pdot = p;
  for (int i = 0; i < count; ++i) {
    const State s = random_state(random, chain);
    q.col(i) = s.q;
    p.col(i) = s.u;
  }
  ASSERT_TRUE(chain.rates_of_states(0.4, q, p, qdot, pdot, 2));
  for (int i = 0; i < count; ++i) {
    VectorXd one(chain.nq()), two(chain.nv());
    ASSERT_TRUE(chain.rates(0.4, q.col(i), p.col(i), one, two));
    EXPECT_EQ(one, qdot.col(i));
    EXPECT_EQ(two, pdot.col(i));
  }
}

/// In a plane that is not one of the axes', against space.
TEST(FormulaForces, PlanarLikeSpatial) {
  const Scene scene = parse_scene(R"toml(
[[body]]
name = "a"
mass = 2
com = [0.3, 0, 0]
inertia = [0.1, 0.2, 0.25]
[[body]]
name = "b"
mass = 1
com = [0.2, 0, 0.1]
inertia = [0.1, 0.2, 0.15]
[[joint]]
name = "A"
kind = "revolute"
child = "a"
axis = "y"
origin = { parent = [0, 0.4, 0.1] }
[[joint]]
name = "B"
kind = "prismatic"
parent = "a"
child = "b"
axis = "x"
[[marker]]
name = "M"
body = "b"
point = [0.1, 0.7, 0.2]
[[marker]]
name = "N"
body = "ground"
point = [0.1, 0.2, 0.3]
[[force]]
name = "S"
kind = "spring-damper"
parent = "ground"
child = "b"
origin = { parent = [0.5, 0.5, 0.2], child = [0.1, 0, 0] }
law = "3 * length^2 - rate * t"
[[force]]
kind = "potential"
V = "M.x * M.z + 0.5 * M.y^2 + S.length^3 + sin(A.q) * B.q + N.x * M.x * t"
[[force]]
kind = "wrench"
body = "a"
point = [0.2, 0, 0]
force = ["M.vx", "A.u", "B.u * M.vz"]
torque = ["t", "A.q * S.rate", 0]
[[force]]
kind = "wrench"
body = "b"
force = ["M.vx", "A.u", "B.u * M.vz"]
torque = ["t", "A.q * S.rate", 0]
axes = "body"
)toml",
                                  "plane.toml");
  OpenChain planar(scene, Algebra::planar), spatial(scene, Algebra::spatial);
  equations::RandomTree random(7);
  for (int i = 0; i < 20; ++i) {
    const State s = random_state(random, planar);
    VectorXd one(2), two(2), p(2), qdot(2), pdot(2), other(2);
    ASSERT_TRUE(planar.accelerations(s.t, s.q, s.u, one));
    ASSERT_TRUE(spatial.accelerations(s.t, s.q, s.u, two));
    EXPECT_LE((one - two).norm(), 1e-12 * (1 + one.norm()));
    planar.momenta(s.t, s.q, s.u, p);
    ASSERT_TRUE(planar.rates(s.t, s.q, p, qdot, pdot));
    ASSERT_TRUE(spatial.rates(s.t, s.q, p, qdot, other));
    EXPECT_LE((pdot - other).norm(), 1e-12 * (1 + pdot.norm()));
    const double energy = planar.energies(s.t, s.q, s.u).potential;
    EXPECT_NEAR(energy, spatial.energies(s.t, s.q, s.u).potential, 1e-12 * (1 + std::abs(energy)));
    const MatrixXd J = planar.jacobian(s.t, s.q, p), K = spatial.jacobian(s.t, s.q, p);
    EXPECT_LE((J - K).norm(), 1e-11 * (1 + J.norm()));
  }
}

/// A signal's rate is its derivative along a motion, and what acts along it has its power.
template <class Space>
void check_signals(const Model<Space>& model, unsigned seed) {
  using D = Dual<double, 1>;
  Workspace<Space, D> w(model);
  Workspace<Space, double> plain(model);
  equations::RandomTree random(seed);
  std::vector<D> q(static_cast<std::size_t>(model.nq)), u(q.size());
  std::vector<double> q0(q.size()), u0(q.size());
  for (int trial = 0; trial < 10; ++trial) {
    for (std::size_t i = 0; i < q.size(); ++i) {
      q0[i] = random.uniform(-1, 1);
      u0[i] = random.uniform(-1, 1);
      q[i] = D(q0[i]);
      q[i].b[0] = u0[i];
      u[i] = D(u0[i]);
    }
    poses_outward(w, D(0.3), q.data(), true);
    for (std::size_t k = 0; k < model.signals.size(); ++k) {
      const auto& signal = model.signals[k];
      using Of = typename Model<Space>::Signal::Of;
      if (signal.of == Of::time) continue;
      poses_outward(plain, 0.3, q0.data(), true);
      velocities_outward(plain, u0.data());
      const double rate = signal_rate(plain, signal);
      const bool has_place = signal.of != Of::turn && !signal.in_body_axes;
      if (has_place) {
        EXPECT_NEAR(signal_place(w, signal).b[0], rate, 1e-13 * (1 + std::abs(rate)));
      }
      for (auto& body : plain.body) body.T = {};
      add_along_signal(plain, signal, 1.7);
      double power = 0;
      for (std::size_t b = 0; b < plain.body.size(); ++b)
        power += Space::power(plain.body[b].T, plain.body[b].V);
      EXPECT_NEAR(power, 1.7 * rate, 1e-13 * (1 + std::abs(rate)));
    }
  }
}

TEST(FormulaForces, WhatActsAlongASignalHasItsPower) {
  const Scene scene = scene_of(everything);
  const Tree built = build_tree(scene);
  check_signals(build_spatial_model(built, scene), 8);
}

}  // namespace
}  // namespace momenta::core_formula_forces
