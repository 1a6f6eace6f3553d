// (q, p) → (q̇, ṗ) by the two sweeps against the Lagrangian of positions alone.
//
// Both sides start from the same doubles q, u, t; the kernel gets p = M u + ... rounded to double.
// That rounding alone moves u by up to |M⁻¹| |p| ε, whatever the algorithm: errors of u and of ṗ,
// which hangs on u, are counted in units of growth = max(1, ‖|M⁻¹| |p|‖ / ‖u‖).

#include "equations/decompositions.h"
#include "equations/dense_lagrangian.h"
#include "equations/random_tree.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/open_chain/open_chain.h>

namespace momenta::core_momentum_recursion {
namespace {

using namespace equations;

struct Worst {
  double rates = 0, momentum_rates = 0, momenta = 0, velocities = 0, energies = 0, masses = 0,
         growth = 1;
};

double rounding_growth(const RealMatrix& m, const RealVector& p, const Eigen::VectorXd& u) {
  if (u.size() == 0) return 1;
  const RealVector moved = spread_by_inverse(m, p);
  return std::max(1.0, static_cast<double>(moved.maxCoeff()) / u.cwiseAbs().maxCoeff());
}

/// Every product of the momentum route at one random state.
void compare(const Scene& scene, RandomTree& random, Worst& worst) {
  OpenChain chain(scene, Algebra::spatial);
  const DenseLagrangian twin(scene, chain.tree());
  const TreeState s = random.state(chain.tree());
  const RealVector p_exact = twin.momenta_at(s.t, s.q, s.u);
  const Eigen::VectorXd p = p_exact.cast<double>();

  Eigen::VectorXd qdot(chain.nq()), pdot(chain.nv()), u(chain.nv()), momenta(chain.nv());
  ASSERT_TRUE(chain.rates(s.t, s.q, p, qdot, pdot));
  ASSERT_TRUE(chain.velocities(s.t, s.q, p, u));
  chain.momenta(s.t, s.q, s.u, momenta);
  const Energies e = chain.energies(s.t, s.q, s.u);

  const auto note = [](double& most, double error) { most = equations::larger(most, error); };
  const RealVector qdot_twin = twin.coordinate_rates_at(s.q, s.u);
  const RealVector pdot_twin = twin.momentum_rates(s.t, s.q, s.u);
  const RealMatrix m = twin.mass_matrix(s.t, s.q);
  const double growth = rounding_growth(m, p_exact, s.u);
  note(worst.growth, growth);
  note(worst.rates, over_growth(relative_error(qdot, qdot_twin.cast<double>()), growth));
  note(worst.momentum_rates, over_growth(relative_error(pdot, pdot_twin.cast<double>()), growth));
  note(worst.momenta, relative_error(momenta, p));
  note(worst.velocities, over_growth(relative_error(u, s.u), growth));
  note(worst.masses, relative_error(chain.mass_matrix(s.t, s.q), m.cast<double>()));

  const std::vector<Real> q_list(s.q.data(), s.q.data() + s.q.size());
  const std::vector<Real> u_list(s.u.data(), s.u.data() + s.u.size());
  const Real kinetic = twin.kinetic_energy(Real(s.t), q_list, u_list);
  const Real potential = twin.potential_energy(Real(s.t), q_list);
  const Real hamiltonian = p_exact.dot(s.u.cast<Real>()) - kinetic + potential;
  const Eigen::Vector3d energies(e.kinetic, e.potential, e.hamiltonian);
  const Eigen::Vector3d expected(static_cast<double>(kinetic), static_cast<double>(potential),
                                 static_cast<double>(hamiltonian));
  note(worst.energies, relative_error(energies, expected));
}

void expect_all_below(const Worst& worst, double tolerance) {
  EXPECT_LT(worst.rates, tolerance);
  EXPECT_LT(worst.momentum_rates, tolerance);
  EXPECT_LT(worst.momenta, tolerance);
  EXPECT_LT(worst.velocities, tolerance);
  EXPECT_LT(worst.energies, tolerance);
  EXPECT_LT(worst.masses, tolerance);
  for (const auto& [name, value] :
       {std::pair{"rates", worst.rates}, std::pair{"momentum_rates", worst.momentum_rates},
        std::pair{"momenta", worst.momenta}, std::pair{"velocities", worst.velocities},
        std::pair{"energies", worst.energies}, std::pair{"masses", worst.masses},
        std::pair{"growth", worst.growth}})
    testing::Test::RecordProperty(name, std::to_string(value * 1e16) + "e-16");
}

void sweep(const TreeRecipe& recipe, int trees, unsigned seed) {
  Worst worst;
  for (int i = 0; i < trees; ++i) {
    RandomTree random(seed + static_cast<unsigned>(i));
    const Scene scene = random.scene(recipe);
    compare(scene, random, worst);
    if (testing::Test::HasFatalFailure()) return;
  }
  expect_all_below(worst, algebra_tol(2 * recipe.bodies));
}

// One kind of joint at a time, so that a failure names its culprit.

TEST(MomentumRecursion, Revolute) {
  sweep({.kinds = {JointKind::revolute}, .drives = false, .body_forces = false}, 40, 100);
}
TEST(MomentumRecursion, Prismatic) {
  sweep({.bodies = 3, .kinds = {JointKind::prismatic}, .drives = false, .body_forces = false}, 40,
        200);
}
TEST(MomentumRecursion, RevoluteAndPrismatic) {
  sweep(
      {.kinds = {JointKind::revolute, JointKind::prismatic}, .drives = false, .body_forces = false},
      40, 300);
}
TEST(MomentumRecursion, Spherical) {
  sweep({.kinds = {JointKind::spherical}, .drives = false, .body_forces = false}, 30, 400);
}
TEST(MomentumRecursion, Free) {
  sweep({.bodies = 4, .kinds = {JointKind::free}, .drives = false, .body_forces = false}, 20, 500);
}
TEST(MomentumRecursion, Helical) {
  sweep({.kinds = {JointKind::helical}, .drives = false, .body_forces = false}, 40, 510);
}
TEST(MomentumRecursion, Cylindrical) {
  sweep({.kinds = {JointKind::cylindrical}, .drives = false, .body_forces = false}, 30, 560);
}
TEST(MomentumRecursion, Universal) {
  sweep({.kinds = {JointKind::universal}, .drives = false, .body_forces = false}, 30, 5600);
}
TEST(MomentumRecursion, PlanarJoints) {
  sweep({.bodies = 4, .kinds = {JointKind::planar}, .drives = false, .body_forces = false}, 30,
        5650);
}
TEST(MomentumRecursion, Welds) {
  sweep({.kinds = {JointKind::revolute, JointKind::spherical, JointKind::weld},
         .drives = false,
         .body_forces = false},
        30, 600);
}
TEST(MomentumRecursion, Drives) {
  sweep({.kinds = {JointKind::revolute, JointKind::prismatic}, .body_forces = false}, 60, 700);
}
TEST(MomentumRecursion, DrivesOfSomeCoordinates) {
  sweep({.kinds = {JointKind::helical, JointKind::cylindrical, JointKind::universal,
                   JointKind::planar},
         .body_forces = false},
        60, 7000);
}
TEST(MomentumRecursion, DrivesOfSphericalAndFreeJoints) {
  sweep(
      {.kinds = {JointKind::revolute, JointKind::spherical, JointKind::free}, .body_forces = false},
      60, 7100);
}
TEST(MomentumRecursion, BodyForces) {
  sweep({.kinds = {JointKind::revolute, JointKind::prismatic}, .drives = false}, 40, 800);
}
TEST(MomentumRecursion, ForcesWithoutGravity) {
  sweep({.kinds = {JointKind::revolute, JointKind::spherical}, .gravity = false}, 30, 900);
}

// Everything at once.

TEST(MomentumRecursion, MixedTrees) {
  sweep({}, 120, 1000);
}
TEST(MomentumRecursion, MixedChains) {
  sweep({.branching = Branching::serial}, 60, 2000);
}
TEST(MomentumRecursion, MixedStars) {
  sweep({.bodies = 8, .branching = Branching::star}, 40, 3000);
}
TEST(MomentumRecursion, RightAngles) {
  sweep({.placing = Placing::right_angles}, 60, 4000);
}
TEST(MomentumRecursion, NearlyParallelAxes) {
  sweep({.placing = Placing::degenerate}, 100, 5000);
}
TEST(MomentumRecursion, NearlyParallelRevolutes) {
  sweep({.branching = Branching::serial,
         .placing = Placing::degenerate,
         .kinds = {JointKind::revolute, JointKind::prismatic}},
        100, 6000);
}
TEST(MomentumRecursion, OneBody) {
  sweep({.bodies = 1}, 100, 7200);
}

}  // namespace
}  // namespace momenta::core_momentum_recursion
