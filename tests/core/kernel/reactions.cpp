// Joint reactions, eq. (28), three ways: OpenChain::reactions (Newton-Euler inward), the balance of
// the carried subtree in ground axes from positions alone, and one dual-number pass of the momentum
// kernel, T_r = d/dt P* + Ω × P* − T* in the direction (q̇, ṗ, 1).

#include "equations/decompositions.h"
#include "equations/dense_lagrangian.h"
#include "equations/random_tree.h"
#include "equations/recursions.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/kernel/accelerations.h>
#include <momenta/core/kernel/reactions.h>
#include <momenta/core/open_chain/open_chain.h>

namespace momenta::core_reactions {
namespace {

using namespace equations;

/// Errors of accelerations enter reactions: see core/kernel/accelerations.cpp for the growth of
/// rounding.
double growth_of(const DenseLagrangian& twin, const TreeState& s) {
  if (twin.nv() == 0) return 1;
  const RealMatrix m = twin.mass_matrix(s.t, s.q);
  const RealVector udot = twin.accelerations(s.t, s.q, s.u);
  const RealVector moved = spread_by_inverse(m, m.cwiseAbs() * udot.cwiseAbs());
  const Real size = std::max(Real(1), udot.cwiseAbs().maxCoeff());
  return std::max(1.0, static_cast<double>(moved.maxCoeff() / size));
}

/// A joint of several parts acts on the scene's body through the last one.
std::vector<Reaction> last_of_each_joint(const std::vector<Reaction>& all) {
  std::vector<Reaction> last;
  for (const Reaction& r : all)
    if (!last.empty() && last.back().joint == r.joint)
      last.back() = r;
    else
      last.push_back(r);
  return last;
}

/// Worst error of all reactions of a random tree against the twin, relative to the greatest.
double error_against_balance(const Scene& scene, RandomTree& random) {
  OpenChain chain(scene, Algebra::spatial);
  const DenseLagrangian twin(scene, chain.tree());
  const TreeState s = random.state(chain.tree());
  const auto expected = twin.reactions(s.t, s.q, s.u);
  const auto found = last_of_each_joint(chain.reactions(s.t, s.q, s.u));
  Eigen::VectorXd all(6 * static_cast<Eigen::Index>(scene.joints.size())), twins(all.size());
  for (const Reaction& r : found)
    for (std::size_t k = 0; k < scene.joints.size(); ++k)
      if (scene.joints[k].name == r.joint) {
        const auto at = 6 * static_cast<Eigen::Index>(k);
        all.segment<3>(at) = r.force;
        all.segment<3>(at + 3) = r.torque;
        twins.segment<6>(at) = expected[k];
      }
  EXPECT_EQ(found.size(), scene.joints.size());
  return over_growth(relative_error(all, twins), growth_of(twin, s));
}

void sweep(const TreeRecipe& recipe, int trees, unsigned seed) {
  double worst = 0;
  for (int i = 0; i < trees; ++i) {
    RandomTree random(seed + static_cast<unsigned>(i));
    const Scene scene = random.scene(recipe);
    worst = equations::larger(worst, error_against_balance(scene, random));
  }
  EXPECT_LT(worst, algebra_tol(2 * recipe.bodies));
  testing::Test::RecordProperty("worst", std::to_string(worst * 1e16) + "e-16");
}

TEST(Reactions, BalanceRevoluteAndPrismatic) {
  sweep({.kinds = {JointKind::revolute, JointKind::prismatic}, .drives = false}, 40, 100);
}
TEST(Reactions, BalanceWithDrives) {
  sweep({.kinds = {JointKind::revolute, JointKind::prismatic}}, 60, 200);
}
TEST(Reactions, BalanceOfChainsForJoints) {
  sweep({.kinds = {JointKind::cylindrical, JointKind::universal, JointKind::planar}}, 40, 250);
}
TEST(Reactions, BalanceMixedTrees) {
  sweep({}, 80, 300);
}
TEST(Reactions, BalanceNearlyParallelAxes) {
  sweep({.placing = Placing::degenerate}, 40, 500);
}

/// F_K of Newton-Euler and T_r of the dual pass, in the kernel's own frames.
TEST(Reactions, RateOfArticulatedMomentum) {
  double worst = 0;
  for (unsigned seed = 700; seed < 800; ++seed) {
    RandomTree random(seed);
    const Scene scene = random.scene({});
    const Tree tree = build_tree(scene);
    const Model<Spatial> model = build_spatial_model(tree, scene);
    const DenseLagrangian twin(scene, tree);
    const TreeState s = random.state(tree);

    Workspace<Spatial, double> w(model);
    Eigen::VectorXd p(tree.nv), u(tree.nv), pdot(tree.nv), udot(tree.nv), tau(tree.nv);
    Eigen::VectorXd qdot(tree.nq);
    momenta_from_rates(w, s.t, s.q.data(), s.u.data(), p.data());
    ASSERT_TRUE(equations::momentum_recursion(w, s.t, s.q.data(), p.data(), u.data(), pdot.data()));
    coordinate_rates(model, s.q.data(), s.u.data(), qdot.data());
    ASSERT_TRUE(equations::acceleration_recursion(w, s.t, s.q.data(), s.u.data(), udot.data()));
    accelerations_outward(w, s.u.data(), udot.data());
    apply_forces(w, model.has_body_forces());
    newton_euler_inward(w, s.q.data(), s.u.data(), tau.data());  // body[k].P is F_K now

    const auto links = build_links(model);
    ReactionPass<Spatial> pass(links);
    ASSERT_TRUE(pass(s.t, s.q.data(), qdot.data(), p.data(), pdot.data()));

    const double growth = growth_of(twin, s);
    ASSERT_LE(growth, 1e4);
    double size = 1, error = 0;
    for (std::size_t k = 0; k < tree.bodies.size(); ++k) {
      const auto reaction = pass.reaction(k);
      for (int i = 0; i < 6; ++i) {
        size = std::max(size, std::abs(w.body[k].P[i]));
        error = equations::larger(error, std::abs(reaction[i] - w.body[k].P[i]));
      }
      // udot comes out of the same pass
      const auto& body = tree.bodies[k];
      for (int i = 0; i < body.nv; ++i)
        EXPECT_NEAR(pass.acceleration(static_cast<std::size_t>(body.u + i)), udot[body.u + i],
                    algebra_tol(12) * growth * std::max(1.0, udot.cwiseAbs().maxCoeff()));
    }
    worst = equations::larger(worst, over_growth(error / size, growth));
  }
  EXPECT_LT(worst, algebra_tol(12));
  RecordProperty("worst", std::to_string(worst * 1e16) + "e-16");
}

/// Eᵀ T_r: what acts along a joint is its own spring, damper and torque; nothing acts along a
/// spherical or free joint, nor along the last part of one of several. A driven joint transmits
/// what its drive takes (BalanceWithDrives).
TEST(Reactions, AlongTheJoint) {
  for (unsigned seed = 900; seed < 960; ++seed) {
    RandomTree random(seed);
    const Scene scene = random.scene({});
    OpenChain chain(scene, Algebra::spatial);
    const DenseLagrangian twin(scene, chain.tree());
    const TreeState s = random.state(chain.tree());
    const auto reactions = last_of_each_joint(chain.reactions(s.t, s.q, s.u));
    Eigen::VectorXd udot(chain.nv());
    ASSERT_TRUE(chain.accelerations(s.t, s.q, s.u, udot));
    double size = 1;
    for (const Reaction& r : reactions)
      size = std::max({size, r.force.cwiseAbs().maxCoeff(), r.torque.cwiseAbs().maxCoeff()});
    const double tolerance = algebra_tol(12) * size * growth_of(twin, s);
    for (const Reaction& r : reactions) {
      const int k = chain.tree().carried_by(r.joint);
      const Tree::Body& b = chain.tree().bodies[static_cast<std::size_t>(k)];
      if (b.drive >= 0) continue;
      if (b.nv == 1) {
        const Eigen::Vector3d axis = b.scene_axes.linear().transpose().col(2);
        const double force = b.torque - b.stiffness * (s.q[b.q] - b.rest) - b.damping * s.u[b.u];
        const double along = b.kind == JointKind::prismatic
                                 ? axis.dot(r.force)
                                 : axis.dot(r.torque + b.pitch * r.force);
        EXPECT_NEAR(along, force - b.rotor * udot[b.u], tolerance);
      }
      if (b.nv >= 3) {  // a rotor on the ball takes I_r u̇
        const Eigen::Vector3d turning =
            b.nv == 3 ? Eigen::Vector3d(b.rotor * udot.segment<3>(b.u)) : Eigen::Vector3d::Zero();
        EXPECT_LT((r.torque + turning).norm(), tolerance);
      }
      if (b.nv == 6) {
        EXPECT_LT(r.force.norm(), tolerance);
      }
    }
  }
}

}  // namespace
}  // namespace momenta::core_reactions
