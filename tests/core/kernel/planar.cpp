// The planar kernel against the spatial one, on scenes that move in any plane.

#include "equations/decompositions.h"
#include "equations/dense_lagrangian.h"
#include "equations/random_tree.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/open_chain/open_chain.h>

namespace momenta::core_planar {
namespace {

using namespace equations;

struct Worst {
  double momenta = 0, rates = 0, accelerations = 0, energies = 0, masses = 0, poses = 0,
         reactions = 0;
};

/// T, H − V, and V against another state: the plane's own height is no coordinate of the planar
/// kernel, so that V is known to it up to a constant.
Eigen::Vector3d energies_of(OpenChain& chain, const TreeState& a, const TreeState& b) {
  const Energies at_a = chain.energies(a.t, a.q, a.u), at_b = chain.energies(b.t, b.q, b.u);
  return {at_a.kinetic, at_a.hamiltonian - at_a.potential, at_a.potential - at_b.potential};
}

void compare(const Scene& scene, RandomTree& random, Worst& worst) {
  OpenChain planar(scene), spatial(scene, Algebra::spatial);
  ASSERT_TRUE(planar.plan().planar) << planar.plan().planar_reason;
  ASSERT_FALSE(spatial.plan().planar);
  const Tree& tree = planar.tree();
  const TreeState s = random.state(tree), other = random.state(tree);
  const auto note = [](double& most, double error) { most = equations::larger(most, error); };
  const auto n = tree.nv;

  const Eigen::MatrixXd m = spatial.mass_matrix(s.t, s.q);
  note(worst.masses, relative_error(planar.mass_matrix(s.t, s.q), m));
  Eigen::VectorXd p(n), p_spatial(n), qdot(n), qdot_spatial(n), pdot(n), pdot_spatial(n);
  planar.momenta(s.t, s.q, s.u, p);
  spatial.momenta(s.t, s.q, s.u, p_spatial);
  note(worst.momenta, relative_error(p, p_spatial));

  // The same p for both; its rounding moves u by |M⁻¹| |p| ε.
  double growth = 1;
  if (n > 0)
    growth += static_cast<double>(
        spread_by_inverse(m.cast<long double>(), p.cast<long double>()).maxCoeff());
  ASSERT_TRUE(planar.rates(s.t, s.q, p, qdot, pdot));
  ASSERT_TRUE(spatial.rates(s.t, s.q, p, qdot_spatial, pdot_spatial));
  note(worst.rates, over_growth(relative_error(qdot, qdot_spatial), growth));
  note(worst.rates, over_growth(relative_error(pdot, pdot_spatial), growth));

  ASSERT_TRUE(planar.accelerations(s.t, s.q, s.u, qdot));
  ASSERT_TRUE(spatial.accelerations(s.t, s.q, s.u, qdot_spatial));
  double acceleration_growth = 1;
  if (n > 0)
    acceleration_growth +=
        static_cast<double>(
            spread_by_inverse(m.cast<long double>(),
                              (m.cwiseAbs() * qdot_spatial.cwiseAbs()).cast<long double>())
                .maxCoeff()) /
        std::max(1.0, qdot_spatial.cwiseAbs().maxCoeff());
  note(worst.accelerations, over_growth(relative_error(qdot, qdot_spatial), acceleration_growth));

  const double size = std::abs(spatial.energies(s.t, s.q, s.u).hamiltonian) +
                      std::abs(spatial.energies(other.t, other.q, other.u).hamiltonian);
  note(worst.energies, relative_error(energies_of(planar, s, other), energies_of(spatial, s, other),
                                      std::max(1.0, size)));

  const auto poses = planar.poses(s.t, s.q), poses_spatial = spatial.poses(s.t, s.q);
  for (std::size_t k = 0; k < poses.size(); ++k)
    note(worst.poses, relative_error(poses[k].matrix(), poses_spatial[k].matrix()));

  // In the plane's axes: two components of each force, one of each torque. The normal torque about
  // the child's own origin needs no lever across the plane.
  const auto found = planar.reactions(s.t, s.q, s.u), expected = spatial.reactions(s.t, s.q, s.u);
  ASSERT_EQ(found.size(), expected.size());
  const Eigen::Matrix3d in_plane = planar.plan().basis.transpose();
  Eigen::VectorXd all(3 * found.size()), twins(3 * found.size());
  all.setZero();
  twins.setZero();
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (k + 1 < found.size() && found[k + 1].joint == found[k].joint) continue;  // not a scene body
    const auto body = static_cast<std::size_t>(tree.carried_by(found[k].joint));
    const Eigen::Matrix3d turned = in_plane * poses_spatial[body].linear();
    const Eigen::Vector3d f = turned * found[k].force, n_found = turned * found[k].torque;
    const Eigen::Vector3d g = turned * expected[k].force, n_twin = turned * expected[k].torque;
    const auto at = 3 * static_cast<Eigen::Index>(k);
    all.segment<3>(at) << f.x(), f.y(), n_found.z();
    twins.segment<3>(at) << g.x(), g.y(), n_twin.z();
    EXPECT_LT(std::abs(f.z()) + n_found.head<2>().norm(),
              algebra_tol(12) * std::max(1.0, all.cwiseAbs().maxCoeff()));
  }
  note(worst.reactions, over_growth(relative_error(all, twins), acceleration_growth));
}

void sweep(const TreeRecipe& recipe, int trees, unsigned seed) {
  Worst worst;
  for (int i = 0; i < trees; ++i) {
    RandomTree random(seed + static_cast<unsigned>(i));
    const Scene scene = random.planar_scene(recipe);
    compare(scene, random, worst);
    if (testing::Test::HasFatalFailure()) return;
  }
  const double tolerance = algebra_tol(2 * recipe.bodies);
  for (const auto& [name, value] :
       {std::pair{"momenta", worst.momenta}, std::pair{"rates", worst.rates},
        std::pair{"accelerations", worst.accelerations}, std::pair{"energies", worst.energies},
        std::pair{"masses", worst.masses}, std::pair{"poses", worst.poses},
        std::pair{"reactions", worst.reactions}}) {
    EXPECT_LT(value, tolerance) << name;
    testing::Test::RecordProperty(name, std::to_string(value * 1e16) + "e-16");
  }
}

TEST(Planar, Revolutes) {
  sweep({.kinds = {JointKind::revolute}, .drives = false, .body_forces = false}, 200, 100);
}
TEST(Planar, Slides) {
  sweep({.bodies = 3, .kinds = {JointKind::prismatic}, .drives = false, .body_forces = false}, 100,
        300);
}
TEST(Planar, RevolutesAndPrismatics) {
  sweep({.kinds = {JointKind::revolute, JointKind::prismatic}, .drives = false}, 300, 400);
}
TEST(Planar, PlanarJoints) {
  sweep({.bodies = 4, .kinds = {JointKind::planar}}, 200, 700);
}
TEST(Planar, MixedTrees) {
  sweep({}, 400, 800);
}
TEST(Planar, MixedChains) {
  sweep({.bodies = 8, .branching = Branching::serial}, 200, 1300);
}
TEST(Planar, MixedStars) {
  sweep({.bodies = 8, .branching = Branching::star}, 200, 1600);
}
TEST(Planar, RightAngles) {
  sweep({.placing = Placing::right_angles}, 200, 2000);
}
TEST(Planar, WithoutGravity) {
  sweep({.gravity = false, .body_forces = false}, 100, 2300);
}

/// What the plan must not take for planar.
TEST(Planar, SpatialScenesAreSeen) {
  int planar = 0;
  for (unsigned seed = 0; seed < 50; ++seed) {
    RandomTree random(seed);
    Scene scene = random.planar_scene({.kinds = {JointKind::revolute}});
    const OpenChain flat(scene);
    EXPECT_TRUE(flat.plan().planar);
    scene.joints.back().axis = (Eigen::AngleAxisd(1e-6, scene.joints.back().axis.unitOrthogonal()) *
                                scene.joints.back().axis)
                                   .normalized();
    planar += OpenChain(scene).plan().planar;
    EXPECT_THROW(OpenChain(scene, Algebra::planar), SceneError);
  }
  EXPECT_EQ(planar, 0);
}

}  // namespace
}  // namespace momenta::core_planar
