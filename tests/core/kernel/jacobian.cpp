// Jacobians of (q̇, ṗ) against dual numbers through the recursion in all directions, with and
// without the structure of Hamilton's equations, at every level; Jacobian-vector products; M⁻¹ x.
#include <gtest/gtest.h>
#include <momenta/core/kernel/jacobian_pass.h>
#include <momenta/core/kernel/levels/open_sweeps.h>
#include <momenta/core/open_chain/open_chain.h>

#include "equations/random_tree.h"
#include "equations/tolerance.h"

namespace momenta::core_jacobian {
namespace {

using namespace equations;

struct Sample {
  OpenChain chain;
  TreeState s;
  Eigen::VectorXd p;
  Sample(const Scene& scene, RandomTree& random)
      : chain(scene, Algebra::spatial), s(random.state(chain.tree())), p(chain.nv()) {
    chain.momenta(s.t, s.q, s.u, p);
  }
};

double condition_of(const Eigen::MatrixXd& m) {
  if (m.size() == 0) return 1;
  const Eigen::VectorXd s = m.jacobiSvd().singularValues();
  return s[0] / s[s.size() - 1];
}

/// One direction after another, dual in q and p alike.
template <class Space>
Eigen::MatrixXd twin(const Model<Space>& model, const TreeState& s, const Eigen::VectorXd& p) {
  const int nq = model.nq, nv = model.nv;
  const auto links = build_links(model);
  Eigen::MatrixXd expected(nq + nv, nq + nv);
  DirectionalPass<Space, 1> pass(links);
  for (int j = 0; j < nq + nv; ++j) {
    pass.set(s.q.data(), p.data());
    (j < nq ? pass.q[static_cast<std::size_t>(j)] : pass.p[static_cast<std::size_t>(j - nq)]).b[0] =
        1;
    EXPECT_TRUE(pass(s.t));
    for (int i = 0; i < nq; ++i) expected(i, j) = pass.qdot[static_cast<std::size_t>(i)].b[0];
    for (int i = 0; i < nv; ++i) expected(nq + i, j) = pass.pdot[static_cast<std::size_t>(i)].b[0];
  }
  return expected;
}

void compare(const Scene& scene, RandomTree& random, bool& structured, double& worst) {
  Sample x(scene, random);
  OpenChain& chain = x.chain;
  const int nq = chain.nq(), nv = chain.nv();
  const Model<Spatial> model = build_spatial_model(chain.tree(), scene);
  structured = is_hamiltonian(model);
  const Eigen::MatrixXd J = chain.jacobian(x.s.t, x.s.q, x.p);
  ASSERT_EQ(J.rows(), nq + nv);
  const Eigen::MatrixXd expected = twin(model, x.s, x.p);
  const double growth = condition_of(chain.mass_matrix(x.s.t, x.s.q));
  const double scale = std::max(1.0, expected.cwiseAbs().maxCoeff());
  worst =
      equations::larger(worst, over_growth((J - expected).cwiseAbs().maxCoeff() / scale, growth));

  const Eigen::VectorXd dq = Eigen::VectorXd::Random(nq), dp = Eigen::VectorXd::Random(nv);
  Eigen::VectorXd dqdot(nq), dpdot(nv), d(nq + nv), along(nq + nv);
  ASSERT_TRUE(chain.jacobian_times(x.s.t, x.s.q, x.p, dq, dp, dqdot, dpdot));
  d << dq, dp;
  along << dqdot, dpdot;
  worst =
      std::max(worst, over_growth((expected * d - along).cwiseAbs().maxCoeff() / scale, growth));
}

TEST(Jacobian, WithHamiltonsStructure) {
  double worst = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    RandomTree random(seed);
    bool structured = false;
    compare(
        random.scene({.kinds = {JointKind::revolute, JointKind::prismatic, JointKind::universal},
                      .body_forces = false}),
        random, structured, worst);
    EXPECT_TRUE(structured);
  }
  EXPECT_LT(worst, algebra_tol(12));
}
TEST(Jacobian, OfQuasiVelocitiesAndDampersBetweenBodies) {
  double worst = 0;
  int without = 0;
  for (unsigned seed = 100; seed < 150; ++seed) {
    RandomTree random(seed);
    bool structured = false;
    compare(random.scene({}), random, structured, worst);
    without += structured ? 0 : 1;
  }
  EXPECT_GT(without, 20);
  EXPECT_LT(worst, algebra_tol(12));
}

/// Trees of revolute joints with dampers on them, whose M⁻¹ comes from solves side by side, and of
/// every joint.
TEST(Jacobian, OfEveryLevelInSpaceAndInThePlane) {
  double worst = 0;
  int on_revolutes = 0;
  for (unsigned seed = 200; seed < 260; ++seed) {
    RandomTree random(seed);
    TreeRecipe recipe{.bodies = 1 + static_cast<int>(seed % 12)};
    if (seed % 3 != 0) {
      recipe.kinds = {JointKind::revolute};
      recipe.drives = recipe.body_forces = false;
    }
    const bool flat = seed % 2 == 0;
    const Scene scene = flat ? random.planar_scene(recipe) : random.scene(recipe);
    for (const int level : {1, 3, 4}) {
      if (level_at_most(level) != level) continue;
      OpenChain chain(scene, flat ? Algebra::planar : Algebra::spatial, level);
      const TreeState s = random.state(chain.tree());
      Eigen::VectorXd p(chain.nv());
      chain.momenta(s.t, s.q, s.u, p);
      Eigen::MatrixXd expected;
      if (flat) {
        const auto model = build_planar_model(chain.tree(), scene, chain.plan().basis);
        expected = twin(model, s, p);
        on_revolutes += is_hamiltonian_on_revolutes(build_links(model));
      } else {
        const auto model = build_spatial_model(chain.tree(), scene);
        expected = twin(model, s, p);
        on_revolutes += is_hamiltonian_on_revolutes(build_links(model));
      }
      Eigen::MatrixXd into = Eigen::MatrixXd::Zero(expected.rows() + 2, expected.cols());
      ASSERT_TRUE(chain.jacobian(s.t, s.q, p, into.topRows(expected.rows())));
      const double growth = condition_of(chain.mass_matrix(s.t, s.q));
      const double scale = std::max(1.0, expected.cwiseAbs().maxCoeff()) * growth;
      worst =
          std::max(worst, (into.topRows(expected.rows()) - expected).cwiseAbs().maxCoeff() / scale);
      EXPECT_TRUE(into.bottomRows(2).isZero(0));

      const Eigen::VectorXd d = Eigen::VectorXd::Random(expected.cols());
      Eigen::VectorXd dqdot(chain.nq()), dpdot(chain.nv()), along(d.size());
      ASSERT_TRUE(
          chain.jacobian_times(s.t, s.q, p, d.head(chain.nq()), d.tail(chain.nv()), dqdot, dpdot));
      along << dqdot, dpdot;
      worst = equations::larger(worst, (expected * d - along).cwiseAbs().maxCoeff() / scale);
    }
  }
  EXPECT_GT(on_revolutes, 40);
  EXPECT_LT(worst, algebra_tol(12));
}

TEST(InverseMass, TimesMassMatrixIsOne) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    RandomTree random(seed);
    Sample x(random.scene({}), random);
    const Eigen::MatrixXd m = x.chain.mass_matrix(x.s.t, x.s.q);
    const Eigen::VectorXd v = Eigen::VectorXd::Random(x.chain.nv());
    Eigen::VectorXd result(x.chain.nv());
    ASSERT_TRUE(x.chain.inverse_mass_times(x.s.t, x.s.q, m * v, result));
    EXPECT_LT(relative_error(result, v), algebra_tol(12) * condition_of(m));
  }
}

}  // namespace
}  // namespace momenta::core_jacobian
