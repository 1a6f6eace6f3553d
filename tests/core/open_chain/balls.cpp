// Spherical joints at the ends of a tree: bodies that carry nothing, whose M* is constant, and
// joints on the ground, which pass nothing on; where there is nothing else, no sweep runs at all.
// Against the Lagrangian of positions alone, in the units of core/kernel/momentum_recursion.cpp.

#include "equations/decompositions.h"
#include "equations/dense_lagrangian.h"
#include "equations/random_tree.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/open_chain/open_chain.h>

namespace momenta::core_balls {
namespace {

using namespace equations;

TreeRecipe balls(int bodies, Branching branching) {
  return {.bodies = bodies,
          .branching = branching,
          .kinds = {JointKind::spherical},
          .drives = false,
          .body_forces = false,
          .rotors = false};
}
void put_all_on_the_ground(Scene& scene) {
  for (JointSpec& joint : scene.joints) joint.parent = "ground";
}

/// Both recursions, M⁻¹ and a batch at one state against the twin.
void compare(const Scene& scene, RandomTree& random) {
  OpenChain chain(scene);
  const DenseLagrangian twin(scene, chain.tree());
  const TreeState s = random.state(chain.tree());
  const RealVector p_exact = twin.momenta_at(s.t, s.q, s.u);
  const Eigen::VectorXd p = p_exact.cast<double>();
  const RealMatrix m = twin.mass_matrix(s.t, s.q);
  const double growth =
      std::max(1.0, static_cast<double>(spread_by_inverse(m, p_exact).maxCoeff()) /
                        s.u.cwiseAbs().maxCoeff());
  ASSERT_LE(growth, 1e4);
  const double tolerance = algebra_tol(2 * static_cast<int>(scene.bodies.size())) * growth;

  Eigen::VectorXd qdot(chain.nq()), pdot(chain.nv()), u(chain.nv()), udot(chain.nv());
  ASSERT_TRUE(chain.rates(s.t, s.q, p, qdot, pdot)) << chain.failure();
  const Eigen::VectorXd pdot_twin = twin.momentum_rates(s.t, s.q, s.u).cast<double>();
  EXPECT_LT(relative_error(qdot, twin.coordinate_rates_at(s.q, s.u).cast<double>()), tolerance);
  EXPECT_LT(relative_error(pdot, pdot_twin), tolerance);

  ASSERT_TRUE(chain.inverse_mass_times(p, u));
  EXPECT_LT(relative_error(u, s.u), tolerance);
  ASSERT_TRUE(chain.inverse_mass_times(s.t, s.q, p, u));
  EXPECT_LT(relative_error(u, s.u), tolerance);

  ASSERT_TRUE(chain.accelerations(s.t, s.q, s.u, udot));
  EXPECT_LT(over_growth(relative_error(udot, twin.accelerations(s.t, s.q, s.u).cast<double>()),
                        condition(chain.mass_matrix(s.t, s.q))),
            tolerance);

  // States side by side, and quaternions of any length: R(k q) = R(q).
  StateMatrix q(chain.nq(), 11), ps(chain.nv(), 11), qdots(chain.nq(), 11), pdots(chain.nv(), 11);
  Eigen::VectorXd longer = Eigen::VectorXd::Zero(chain.nq());
  for (const auto& b : chain.tree().bodies)
    if (b.nq == 4) longer.segment(b.q, 4).setConstant(0.1);
  for (int i = 0; i < 11; ++i) {
    q.col(i) = s.q + i * longer.cwiseProduct(s.q);
    ps.col(i) = p;
  }
  ASSERT_TRUE(chain.rates_of_states(s.t, q, ps, qdots, pdots));
  for (int i = 0; i < 11; ++i) {
    EXPECT_LT(relative_error(pdots.col(i), pdot_twin), tolerance);
    EXPECT_LT(relative_error(qdots.col(i), qdot + i * longer.cwiseProduct(qdot)), tolerance);
  }
}

TEST(Balls, OneBody) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    RandomTree random(seed);
    compare(random.scene(balls(1, Branching::serial)), random);
  }
}
TEST(Balls, SeveralOnTheGround) {
  for (unsigned seed = 100; seed < 120; ++seed) {
    RandomTree random(seed);
    Scene scene = random.scene(balls(4, Branching::serial));
    put_all_on_the_ground(scene);
    compare(scene, random);
  }
}
TEST(Balls, ChainsStarsAndTrees) {
  for (unsigned seed = 200; seed < 220; ++seed)
    for (const Branching branching : {Branching::serial, Branching::star, Branching::random}) {
      RandomTree random(seed);
      compare(random.scene(balls(2 + static_cast<int>(seed) % 5, branching)), random);
    }
}
TEST(Balls, AmongJointsOfOtherKinds) {
  for (unsigned seed = 300; seed < 330; ++seed) {
    RandomTree random(seed);
    TreeRecipe recipe = balls(6, Branching::random);
    recipe.kinds = {JointKind::spherical, JointKind::revolute, JointKind::prismatic};
    compare(random.scene(recipe), random);
  }
}
TEST(Balls, WithoutGravity) {
  for (unsigned seed = 400; seed < 410; ++seed) {
    RandomTree random(seed);
    TreeRecipe recipe = balls(1 + static_cast<int>(seed) % 3, Branching::serial);
    recipe.gravity = false;
    compare(random.scene(recipe), random);
  }
}

/// A rod without thickness has no inertia about itself: found once or at every evaluation, the
/// joint is named.
TEST(Balls, NameTheJointWithoutInertia) {
  for (const int thin : {0, 2}) {
    RandomTree random(7);
    Scene scene = random.scene(balls(3, Branching::serial));
    for (JointSpec& joint : scene.joints) joint.origin_child.setZero();
    const Eigen::Vector3d along = Eigen::Vector3d(0.3, -0.5, 0.7).normalized();
    const auto make_thin = [&](BodySpec& body) {
      body.com = 0.5 * along;
      body.inertia = Eigen::Matrix3d::Identity() - along * along.transpose();
    };
    make_thin(scene.bodies[static_cast<std::size_t>(thin)]);
    if (thin == 0) put_all_on_the_ground(scene);
    OpenChain chain(scene);
    const TreeState s = random.state(chain.tree());
    Eigen::VectorXd qdot(chain.nq()), pdot(chain.nv());
    EXPECT_FALSE(chain.rates(s.t, s.q, s.u, qdot, pdot));
    EXPECT_NE(chain.failure().find(scene.joints[static_cast<std::size_t>(thin)].name),
              std::string::npos)
        << chain.failure();
    EXPECT_FALSE(chain.accelerations(s.t, s.q, s.u, pdot));
    EXPECT_FALSE(chain.inverse_mass_times(s.t, s.q, s.u, pdot));
  }
}

}  // namespace
}  // namespace momenta::core_balls
