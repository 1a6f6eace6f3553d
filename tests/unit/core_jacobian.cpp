// Jacobians of (q̇, ṗ) against dual numbers through the recursion in all directions, with and
// without the structure of Hamilton's equations; Jacobian-vector products; M⁻¹ x.
#include <gtest/gtest.h>
#include <momenta/core/kernel/jacobian_pass.h>
#include <momenta/core/open_chain.h>

#include "equations/random_tree.h"
#include "equations/tolerance.h"

namespace momenta {
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

void compare(const Scene& scene, RandomTree& random, bool& structured, double& worst) {
  Sample x(scene, random);
  OpenChain& chain = x.chain;
  const int nq = chain.nq(), nv = chain.nv();
  const Model<Spatial> model = build_spatial_model(chain.tree(), scene);
  const auto links = build_links(model);
  structured = is_hamiltonian(model);
  const Eigen::MatrixXd J = chain.jacobian(x.s.t, x.s.q, x.p);
  ASSERT_EQ(J.rows(), nq + nv);
  // One direction after another, dual in q and p alike.
  Eigen::MatrixXd expected(nq + nv, nq + nv);
  DirectionalPass<Spatial, 1> pass(links);
  for (int j = 0; j < nq + nv; ++j) {
    pass.set(x.s.q.data(), x.p.data());
    (j < nq ? pass.q[static_cast<std::size_t>(j)] : pass.p[static_cast<std::size_t>(j - nq)]).b[0] =
        1;
    ASSERT_TRUE(pass(x.s.t));
    for (int i = 0; i < nq; ++i) expected(i, j) = pass.qdot[static_cast<std::size_t>(i)].b[0];
    for (int i = 0; i < nv; ++i) expected(nq + i, j) = pass.pdot[static_cast<std::size_t>(i)].b[0];
  }
  const double growth = condition_of(chain.mass_matrix(x.s.t, x.s.q));
  const double scale = std::max(1.0, expected.cwiseAbs().maxCoeff());
  worst = std::max(worst, (J - expected).cwiseAbs().maxCoeff() / scale / growth);

  const Eigen::VectorXd dq = Eigen::VectorXd::Random(nq), dp = Eigen::VectorXd::Random(nv);
  Eigen::VectorXd dqdot(nq), dpdot(nv), d(nq + nv), along(nq + nv);
  ASSERT_TRUE(chain.jacobian_times(x.s.t, x.s.q, x.p, dq, dp, dqdot, dpdot));
  d << dq, dp;
  along << dqdot, dpdot;
  worst = std::max(worst, (expected * d - along).cwiseAbs().maxCoeff() / scale / growth);
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
}  // namespace momenta
