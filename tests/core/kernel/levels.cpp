// The recursions compiled for every x86-64 level agree with each other and with the plain double
// kernel, single states and batches of any size; the code of a level stays its own.
#include <gtest/gtest.h>
#include <momenta/core/kernel/levels/open_sweeps.h>
#include <momenta/core/kernel/momentum_recursion.h>
#include <momenta/core/open_chain/open_chain.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "equations/level_symbols.h"
#include "equations/levels.h"
#include "equations/parts.h"
#include "equations/random_tree.h"
#include "equations/tolerance.h"

namespace momenta::core_levels {
namespace {

using namespace equations;

struct Batch {
  StateMatrix q, u, p, tau, qdot, pdot, udot, udot_pushed;
  Batch(OpenChain& chain, RandomTree& random, Eigen::Index count)
      : q(chain.nq(), count),
        u(chain.nv(), count),
        p(chain.nv(), count),
        tau(chain.nv(), count),
        qdot(chain.nq(), count),
        pdot(chain.nv(), count),
        udot(chain.nv(), count),
        udot_pushed(chain.nv(), count) {
    for (Eigen::Index i = 0; i < count; ++i) {
      const TreeState s = random.state(chain.tree());
      Eigen::VectorXd momenta(chain.nv());
      chain.momenta(0.3, s.q, s.u, momenta);
      q.col(i) = s.q;
      u.col(i) = s.u;
      p.col(i) = momenta;
      for (int k = 0; k < chain.nv(); ++k) tau(k, i) = random.uniform(-1, 1);
    }
  }
};

double growth_of(OpenChain& chain, const Eigen::VectorXd& q) {
  if (chain.nv() == 0) return 1;
  const Eigen::VectorXd s = chain.mass_matrix(0.3, q).jacobiSvd().singularValues();
  return s[0] / s[s.size() - 1];
}

/// Every state of a batch against the same state alone at the least level there is.
void compare(const Scene& scene, unsigned seed, Algebra algebra) {
  RandomTree random(seed);
  const int least = equations::levels().front();
  OpenChain plain(scene, algebra, least);
  ASSERT_EQ(plain.level(), least);
  const Eigen::Index count = 1 + static_cast<Eigen::Index>(seed % 19);
  Batch b(plain, random, count);
  Eigen::VectorXd qdot(plain.nq()), pdot(plain.nv()), udot(plain.nv()), udot_pushed(plain.nv());
  StateMatrix qdot_pushed = b.qdot, pdot_pushed = b.pdot;
  for (const int level : equations::levels()) {
    OpenChain chain(scene, algebra, level);
    EXPECT_EQ(chain.level(), level);
    ASSERT_TRUE(chain.rates_of_states(0.3, b.q, b.p, b.qdot, b.pdot)) << chain.failure();
    ASSERT_TRUE(chain.accelerations_of_states(0.3, b.q, b.u, b.udot)) << chain.failure();
    ASSERT_TRUE(chain.accelerations_of_states(0.3, b.q, b.u, b.tau, b.udot_pushed));
    ASSERT_TRUE(chain.rates_of_states(0.3, b.q, b.p, b.tau, qdot_pushed, pdot_pushed));
    EXPECT_EQ(qdot_pushed, b.qdot);
    EXPECT_EQ(pdot_pushed, b.pdot + b.tau);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::VectorXd q = b.q.col(i), p = b.p.col(i), u = b.u.col(i);
      ASSERT_TRUE(plain.rates(0.3, q, p, qdot, pdot));
      ASSERT_TRUE(plain.accelerations(0.3, q, u, udot));
      ASSERT_TRUE(plain.accelerations(0.3, q, u, b.tau.col(i), udot_pushed));
      const double tolerance = algebra_tol(12) * growth_of(plain, q);
      EXPECT_LT(relative_error(Eigen::VectorXd(b.qdot.col(i)), qdot), tolerance)
          << "level " << level;
      EXPECT_LT(relative_error(Eigen::VectorXd(b.pdot.col(i)), pdot), tolerance)
          << "level " << level;
      EXPECT_LT(relative_error(Eigen::VectorXd(b.udot.col(i)), udot), tolerance)
          << "level " << level;
      EXPECT_LT(relative_error(Eigen::VectorXd(b.udot_pushed.col(i)), udot_pushed), tolerance)
          << "level " << level;
      Eigen::VectorXd one_qdot(plain.nq()), one_pdot(plain.nv());
      ASSERT_TRUE(chain.rates(0.3, q, p, one_qdot, one_pdot));
      EXPECT_LT(relative_error(one_qdot, qdot), tolerance) << "level " << level;
      EXPECT_LT(relative_error(one_pdot, pdot), tolerance) << "level " << level;
    }
  }
}

TEST(Levels, AgreeOnTreesOfEveryJoint) {
  for (unsigned seed = 0; seed < 60; ++seed)
    compare(RandomTree(seed).scene({.body_forces = seed % 4 == 0}), seed, Algebra::spatial);
}
TEST(Levels, AgreeOnTreesWithoutForces) {
  for (unsigned seed = 100; seed < 140; ++seed)
    compare(RandomTree(seed).scene({.joint_forces = false, .body_forces = false}), seed,
            Algebra::spatial);
}

Scene pendulums(int n) {
  Scene s;
  s.gravity = {0, -9.81, 0};
  for (int i = 0; i < n; ++i) {
    BodySpec b;
    b.name = "b" + std::to_string(i);
    b.mass = 1;
    b.com = {0.5, 0.1, 0};
    b.inertia = Eigen::Vector3d(0.1, 0.1, 0.1).asDiagonal();
    s.bodies.push_back(b);
    JointSpec j = equations::make_joint(
        i % 3 == 2 ? JointKind::prismatic : JointKind::revolute, "J" + std::to_string(i),
        i == 0 ? "ground" : "b" + std::to_string((i - 1) / 2), b.name);
    if (i % 3 == 2) j.axis = {1, 0, 0};
    j.origin_parent = {0.7, 0.2, 0};
    s.joints.push_back(j);
  }
  return s;
}
TEST(Levels, AgreeInThePlane) {
  for (unsigned seed = 1; seed < 12; ++seed)
    compare(pendulums(static_cast<int>(seed)), seed, Algebra::planar);
}

TEST(Levels, OneBadStateSpoilsNoOther) {
  Scene s = pendulums(2);  // a body without inertia at the leaf: no state has rates
  s.bodies[1].mass = 0;
  s.bodies[1].inertia.setZero();
  OpenChain chain(s, Algebra::spatial);
  StateMatrix q = StateMatrix::Zero(2, 5), p = q, qdot = q, pdot = q;
  EXPECT_FALSE(chain.rates_of_states(0, q, p, qdot, pdot));
  EXPECT_NE(chain.failure().find("state 0: joint 'J1'"), std::string::npos) << chain.failure();
  EXPECT_TRUE(qdot.array().isNaN().all());

  Scene good = pendulums(2);
  OpenChain other(good, Algebra::spatial);
  q(1, 3) = std::numeric_limits<double>::quiet_NaN();  // an inertia of NaN is not positive
  EXPECT_FALSE(other.rates_of_states(0, q, p, qdot, pdot));
  EXPECT_NE(other.failure().find("state 3"), std::string::npos) << other.failure();
  const std::string of_q = other.failure();
  StateMatrix tau = StateMatrix::Zero(2, 5);
  EXPECT_FALSE(other.rates_of_states(0, q, p, tau, qdot, pdot));
  EXPECT_EQ(other.failure(), of_q);
  tau(0, 1) = std::numeric_limits<double>::infinity();
  for (const bool of_momenta : {true, false}) {
    EXPECT_FALSE(of_momenta ? other.rates_of_states(0, q, p, tau, qdot, pdot)
                            : other.accelerations_of_states(0, q, p, tau, pdot));
    EXPECT_EQ(other.failure(), "state 1: tau[0] is infinite, expected a finite number");
    for (Eigen::Index i = 0; i < 5; ++i)
      EXPECT_EQ(pdot.col(i).array().isNaN().any(), i == 1 || i == 3) << "state " << i;
  }
  ASSERT_FALSE(other.rates_of_states(0, q, p, qdot, pdot));
  for (Eigen::Index i = 0; i < 5; ++i)
    EXPECT_EQ(qdot.col(i).array().isNaN().any(), i == 3) << "state " << i;
}

/// However many share the states: the same bits, and the same culprit.
TEST(Threads, OfABatchChangeNothing) {
  for (unsigned seed = 200; seed < 212; ++seed) {
    RandomTree random(seed);
    OpenChain chain(RandomTree(seed).scene({.body_forces = seed % 4 == 0}));
    constexpr Eigen::Index counts[] = {1, 7, 30, 3000};
    const Eigen::Index count = counts[seed / 2 % 4];
    Batch b(chain, random, count);
    if (count > 20) {
      b.q.col(count - 9).setConstant(std::numeric_limits<double>::quiet_NaN());
      b.q.col(count - 2).setConstant(std::numeric_limits<double>::quiet_NaN());
    }
    const bool rates = chain.rates_of_states(0.3, b.q, b.p, b.qdot, b.pdot);
    const std::string culprit = chain.failure();
    EXPECT_EQ(rates, count <= 20 || chain.nv() < 2) << seed;
    const bool accelerations = chain.accelerations_of_states(0.3, b.q, b.u, b.udot);
    const auto same = [](const StateMatrix& x, const StateMatrix& y) {
      return x.size() == y.size() &&
             std::memcmp(x.data(), y.data(), sizeof(double) * static_cast<std::size_t>(x.size())) ==
                 0;
    };
    for (const int threads : {2, 3, 16}) {
      StateMatrix qdot = StateMatrix::Ones(b.qdot.rows(), count), pdot(b.pdot), udot(b.udot);
      pdot.setOnes();
      udot.setOnes();
      EXPECT_EQ(chain.rates_of_states(0.3, b.q, b.p, qdot, pdot, threads), rates);
      EXPECT_EQ(chain.failure(), culprit) << threads;
      EXPECT_EQ(chain.accelerations_of_states(0.3, b.q, b.u, udot, threads), accelerations);
      EXPECT_TRUE(same(qdot, b.qdot)) << seed << ", " << threads;
      EXPECT_TRUE(same(pdot, b.pdot)) << seed << ", " << threads;
      EXPECT_TRUE(same(udot, b.udot)) << seed << ", " << threads;
    }
    EXPECT_THROW(chain.rates_of_states(0.3, b.q, b.p, b.qdot, b.pdot, 0), std::invalid_argument);
  }
}

/// A batch whose rows lie far apart is computed in copies of blocks: the same bits as of small
/// batches of its columns, and a bad state spoils itself alone.
TEST(Levels, LargeBatchesAreTheirPartsSideBySide) {
  OpenChain chain(pendulums(40));
  RandomTree random(5);
  constexpr Eigen::Index count = 1403, part = 67;
  Batch b(chain, random, count);
  b.q(3, 1000) = std::numeric_limits<double>::quiet_NaN();
  ASSERT_FALSE(chain.rates_of_states(0.3, b.q, b.p, b.qdot, b.pdot));
  ASSERT_FALSE(chain.accelerations_of_states(0.3, b.q, b.u, b.tau, b.udot));
  for (Eigen::Index first = 0; first < count; first += part) {
    const Eigen::Index some = std::min(part, count - first);
    const auto columns = [&](const StateMatrix& x) {
      return StateMatrix(x.middleCols(first, some));
    };
    StateMatrix qdot = columns(b.q), pdot = columns(b.p), udot = columns(b.u);
    const bool bad = first <= 1000 && 1000 < first + some;
    EXPECT_NE(chain.rates_of_states(0.3, columns(b.q), columns(b.p), qdot, pdot), bad);
    EXPECT_NE(chain.accelerations_of_states(0.3, columns(b.q), columns(b.u), columns(b.tau), udot),
              bad);
    for (Eigen::Index i = 0; i < some; ++i) {
      const bool none = first + i == 1000;
      EXPECT_TRUE(none ? b.pdot.col(first + i).array().isNaN().all()
                       : pdot.col(i) == b.pdot.col(first + i) &&
                             qdot.col(i) == b.qdot.col(first + i) &&
                             udot.col(i) == b.udot.col(first + i))
          << "state " << first + i;
    }
  }
}

TEST(Levels, SinesOfLargeAnglesAndNone) {
  Scene s = pendulums(1);
  OpenChain chain(s, Algebra::spatial);
  StateMatrix q(1, 11), p = StateMatrix::Ones(1, 11), qdot(1, 11), pdot(1, 11);
  q << 0, 1e-300, -0.75, 1.5707963267948966, 3e3, -59999, 9.9e5, -1.1e6, 1e15, 1e300, 42;
  ASSERT_TRUE(chain.rates_of_states(0, q, p, qdot, pdot));
  for (Eigen::Index i = 0; i < 11; ++i) {
    // Torque of the weight about the revolute joint. The frame's constant angle is added to q
    // first: that sum is as exact as q is.
    const double angle = q(0, i);
    const double torque = -9.81 * (0.5 * std::cos(angle) - 0.1 * std::sin(angle));
    if (std::abs(angle) < 1e7)
      EXPECT_NEAR(pdot(0, i), torque, 4e-15 * std::max(1.0, std::abs(angle))) << angle;
    else
      EXPECT_LE(std::abs(pdot(0, i)), 9.81 * std::hypot(0.5, 0.1) * (1 + 1e-15)) << angle;
  }
}

TEST(Levels, CodeOfALevelIsItsOwn) {
  expect_own_symbols(MOMENTA_BINARY_DIR "/core", "*_kernels.cpp.o",
                     {"Pack<", "OpenSweepsAt<", "BatchSweepsAt<", "sweeps_at<"});
}

}  // namespace
}  // namespace momenta::core_levels
