// (q, u) → u̇ by the articulated recursion against d'Alembert's principle in its dense form,
// against Newton-Euler inward, and against the momentum recursion: ṗ = d/dt p(q(t), u(t), t).

#include "equations/decompositions.h"
#include "equations/dense_lagrangian.h"
#include "equations/random_tree.h"
#include "equations/recursions.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/kernel/accelerations.h>
#include <momenta/core/kernel/momentum_recursion.h>
#include <momenta/core/open_chain/open_chain.h>

namespace momenta::core_accelerations {
namespace {

using namespace equations;

template <class Space>
Model<Space> model_of(const Tree& tree, const Scene& scene) {
  if constexpr (Space::dimension == 6)
    return build_spatial_model(tree, scene);
  else
    return build_planar_model(tree, scene, *find_plane(tree, scene).basis);
}

struct Worst {
  double accelerations = 0, forces = 0, momentum_rates = 0;
};

/// u̇, the residual of Newton-Euler with that u̇, and ṗ twice, at one random state.
template <class Space>
void compare(const Scene& scene, RandomTree& random, Worst& worst) {
  const Tree tree = build_tree(scene);
  const DenseLagrangian twin(scene, tree);
  const TreeState s = random.state(tree);
  const Model<Space> model = model_of<Space>(tree, scene);
  Workspace<Space, double> w(model);
  const double *q = s.q.data(), *u = s.u.data();
  const auto note = [](double& most, double error) { most = equations::larger(most, error); };

  Eigen::VectorXd udot(tree.nv), tau(tree.nv);
  ASSERT_TRUE(equations::acceleration_recursion(w, s.t, q, u, udot.data()));
  const RealVector expected = twin.accelerations(s.t, s.q, s.u);
  // Forces of size |Q| and |M u̇| cancel in M u̇ = Q − bias: the rounding of either moves u̇ by up
  // to |M⁻¹| |M u̇| ε.
  const RealMatrix m = twin.mass_matrix(s.t, s.q);
  const RealVector forces = m.cwiseAbs() * expected.cwiseAbs();
  double growth = 1;
  if (tree.nv > 0) {
    const RealVector moved = spread_by_inverse(m, forces);
    const Real size = std::max(Real(1), expected.cwiseAbs().maxCoeff());
    growth = std::max(1.0, static_cast<double>(moved.maxCoeff() / size));
  }
  note(worst.accelerations, over_growth(relative_error(udot, expected.cast<double>()), growth));

  // τ = M u̇ + bias − applied − joint forces vanishes
  accelerations_outward(w, u, udot.data());
  apply_forces(w, model.has_body_forces());
  newton_euler_inward(w, q, u, tau.data());
  const double size = tree.nv > 0 ? static_cast<double>(forces.maxCoeff()) : 0.0;
  note(worst.forces, tree.nv > 0 ? tau.cwiseAbs().maxCoeff() / std::max(1.0, size) : 0.0);

  // d/dt p along (q̇, u̇, 1) by a dual number through p = M u, and ṗ of the two sweeps
  using D = Dual<double, 1>;
  std::vector<double> qdot(static_cast<std::size_t>(tree.nq));
  coordinate_rates(model, q, u, qdot.data());
  std::vector<D> q_along(qdot.size()), u_along(static_cast<std::size_t>(tree.nv)),
      p_along(static_cast<std::size_t>(tree.nv));
  for (std::size_t i = 0; i < q_along.size(); ++i) {
    q_along[i] = D::variable(q[i], 0);
    q_along[i].b[0] = qdot[i];
  }
  for (std::size_t i = 0; i < u_along.size(); ++i) {
    u_along[i] = D::variable(u[i], 0);
    u_along[i].b[0] = udot[static_cast<Eigen::Index>(i)];
  }
  Workspace<Space, D> dual(model);
  momenta_from_rates(dual, D::variable(s.t, 0), q_along.data(), u_along.data(), p_along.data());
  Eigen::VectorXd p(tree.nv), pdot_along(tree.nv), pdot(tree.nv), again(tree.nv);
  for (int i = 0; i < tree.nv; ++i) {
    p[i] = p_along[static_cast<std::size_t>(i)].a;
    pdot_along[i] = p_along[static_cast<std::size_t>(i)].b[0];
  }
  ASSERT_TRUE(equations::momentum_recursion(w, s.t, q, p.data(), again.data(), pdot.data()));
  note(worst.momentum_rates,
       over_growth(relative_error(pdot, pdot_along, std::max(1.0, size)), growth));
}

template <class Space>
void sweep(const TreeRecipe& recipe, int trees, unsigned seed) {
  Worst worst;
  for (int i = 0; i < trees; ++i) {
    RandomTree random(seed + static_cast<unsigned>(i));
    const Scene scene = Space::dimension == 3 ? random.planar_scene(recipe) : random.scene(recipe);
    compare<Space>(scene, random, worst);
    if (testing::Test::HasFatalFailure()) return;
  }
  const double tolerance = algebra_tol(2 * recipe.bodies);
  EXPECT_LT(worst.accelerations, tolerance);
  EXPECT_LT(worst.forces, tolerance);
  EXPECT_LT(worst.momentum_rates, tolerance);
  for (const auto& [name, value] :
       {std::pair{"accelerations", worst.accelerations}, std::pair{"forces", worst.forces},
        std::pair{"momentum_rates", worst.momentum_rates}})
    testing::Test::RecordProperty(name, std::to_string(value * 1e16) + "e-16");
}

TEST(Accelerations, Revolute) {
  sweep<Spatial>({.kinds = {JointKind::revolute}, .drives = false, .body_forces = false}, 30, 100);
}
TEST(Accelerations, RevoluteAndPrismatic) {
  sweep<Spatial>({.kinds = {JointKind::revolute, JointKind::prismatic}, .drives = false}, 40, 200);
}
TEST(Accelerations, Spherical) {
  sweep<Spatial>({.kinds = {JointKind::spherical}}, 20, 300);
}
TEST(Accelerations, Free) {
  sweep<Spatial>({.bodies = 4, .kinds = {JointKind::free}}, 20, 400);
}
TEST(Accelerations, Drives) {
  sweep<Spatial>({.kinds = {JointKind::revolute, JointKind::prismatic}}, 60, 500);
}
TEST(Accelerations, Helical) {
  sweep<Spatial>({.kinds = {JointKind::helical}}, 30, 520);
}
TEST(Accelerations, ChainsForJoints) {
  sweep<Spatial>({.kinds = {JointKind::cylindrical, JointKind::universal, JointKind::planar}}, 40,
                 560);
}
TEST(Accelerations, DrivenSphericalAndFreeJoints) {
  sweep<Spatial>({.kinds = {JointKind::revolute, JointKind::spherical, JointKind::free}}, 40, 5600);
}
TEST(Accelerations, MixedTrees) {
  sweep<Spatial>({}, 100, 600);
}
TEST(Accelerations, MixedChains) {
  sweep<Spatial>({.branching = Branching::serial}, 40, 800);
}
TEST(Accelerations, MixedStars) {
  sweep<Spatial>({.bodies = 8, .branching = Branching::star}, 20, 900);
}
TEST(Accelerations, NearlyParallelAxes) {
  sweep<Spatial>({.placing = Placing::degenerate}, 40, 1000);
}
TEST(Accelerations, PlanarTrees) {
  sweep<Planar>({}, 100, 1100);
}
TEST(Accelerations, PlanarChains) {
  sweep<Planar>({.branching = Branching::serial}, 60, 1300);
}

}  // namespace
}  // namespace momenta::core_accelerations
