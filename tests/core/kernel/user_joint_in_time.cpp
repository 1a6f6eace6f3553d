// User joints whose pose moves with time: momenta, energy, reactions, derivatives.
#include <gtest/gtest.h>
#include <momenta/core/kernel/inverse_dynamics_sweeps.h>
#include <momenta/core/kernel/jacobian_pass.h>
#include <momenta/core/open_chain/open_chain.h>

#include "equations/recursions.h"
#include "equations/tolerance.h"
#include "equations/user_chain.h"

namespace momenta::core_user_joint_in_time {
namespace {

using namespace equations;

/// (T, V, p) as dual numbers along a direction of (t, q, u).
struct Energy {
  using D = Dual<double, 1>;
  Workspace<Spatial, D> w;
  std::vector<D> q, u, p;
  D t, kinetic, potential;
  Energy(const Model<Spatial>& model, const State& s)
      : w(model), q(s.q.begin(), s.q.end()), u(s.u.begin(), s.u.end()), p(u.size()), t(s.t) {}
  void evaluate() {
    momenta_from_rates(w, t, q.data(), u.data(), p.data());
    poses_outward(w, t, q.data(), true);
    kinetic = kinetic_energy(w);
    potential = potential_energy(w, q.data());
  }
};

TEST(UserJoint, MovesWithTime) {
  const Scene scene = rheonomic();
  OpenChain chain(scene);
  const Model<Spatial> model = build_spatial_model(chain.tree(), scene);
  const auto n = static_cast<std::size_t>(chain.nv());
  for (unsigned seed = 0; seed < 5; ++seed) {
    const State s(chain.nv(), 200 + seed);
    const Answer x(chain, s);
    EXPECT_LE(relative_error(x.qdot, s.u), 1e-13);

    Energy motion(model, s);  // along (u, u̇, 1): ṗ = d/dt p, dH/dt
    motion.t.b[0] = 1;
    for (std::size_t i = 0; i < n; ++i) {
      motion.q[i].b[0] = s.u[static_cast<Eigen::Index>(i)];
      motion.u[i].b[0] = x.udot[static_cast<Eigen::Index>(i)];
    }
    motion.evaluate();
    Eigen::VectorXd rate(chain.nv());
    double hamiltonian = -motion.kinetic.b[0] + motion.potential.b[0];
    for (std::size_t i = 0; i < n; ++i) {
      rate[static_cast<Eigen::Index>(i)] = motion.p[i].b[0];
      hamiltonian += (motion.p[i] * motion.u[i]).b[0];
    }
    EXPECT_LE(relative_error(x.pdot, rate), 1e-13);

    Energy time(model, s);  // dH/dt = −∂L/∂t
    time.t.b[0] = 1;
    time.evaluate();
    const double power = time.potential.b[0] - time.kinetic.b[0];
    EXPECT_NEAR(hamiltonian, power, 1e-12 * (1 + std::abs(power)));

    for (std::size_t i = 0; i < n; ++i) {  // p = ∂T/∂u, ṗ = ∂L/∂q
      Energy dq(model, s), du(model, s);
      dq.q[i].b[0] = du.u[i].b[0] = 1;
      dq.evaluate();
      du.evaluate();
      const auto at = static_cast<Eigen::Index>(i);
      EXPECT_NEAR(du.kinetic.b[0], x.p[at], 1e-13 * (1 + x.p.cwiseAbs().maxCoeff()));
      EXPECT_NEAR(dq.kinetic.b[0] - dq.potential.b[0], x.pdot[at],
                  1e-13 * (1 + x.pdot.cwiseAbs().maxCoeff()));
    }
  }
}

TEST(UserJoint, ReactionsAreThoseOfNewtonAndEuler) {
  const Scene scene = rheonomic();
  OpenChain chain(scene);
  const Model<Spatial> model = build_spatial_model(chain.tree(), scene);
  const State s(chain.nv(), 7);
  Answer x(chain, s);
  Workspace<Spatial, double> w(model);
  Eigen::VectorXd udot(chain.nv()), tau(chain.nv());
  ASSERT_TRUE(equations::acceleration_recursion(w, s.t, s.q.data(), s.u.data(), udot.data()));
  accelerations_outward(w, s.u.data(), udot.data());
  apply_forces(w, true);
  newton_euler_inward(w, s.q.data(), s.u.data(), tau.data());
  EXPECT_LE(tau.cwiseAbs().maxCoeff(), 1e-12);
  for (std::size_t k = 0; k < model.bodies.size(); ++k) {
    const auto& b = chain.tree().bodies[k];
    double size = 0, expected = 0;
    const Reaction& r = x.reactions.at(b.joint);
    for (int i = 0; i < 3; ++i) expected += w.body[k].P.f[i] * w.body[k].P.f[i];
    size = r.force.squaredNorm();
    EXPECT_NEAR(size, expected, 1e-12 * (1 + expected));
  }
}

TEST(UserJoint, InverseDynamics) {
  Scene scene = rheonomic();
  scene.forces.clear();
  scene.joints.back().stiffness = 0;
  OpenChain chain(scene);
  const Model<Spatial> model = build_spatial_model(chain.tree(), scene);
  const auto links = build_links(model);
  const State s(chain.nv(), 8);
  const Answer x(chain, s);
  Eigen::VectorXd tau(chain.nv());
  InverseDynamicsSweeps<Spatial, double> inverse(links);
  inverse(s.t, s.q.data(), s.u.data(), static_cast<const double*>(x.udot.data()), tau.data());
  EXPECT_LE(tau.cwiseAbs().maxCoeff(), 1e-12);
}

TEST(UserJoint, JacobianAgainstDifferences) {
  const Scene scene = rheonomic();
  OpenChain chain(scene);
  const int n = chain.nv();
  const State s(n, 9);
  const Answer x(chain, s);
  const double h = 1e-5;
  Eigen::MatrixXd differences(2 * n, 2 * n);
  Eigen::VectorXd state(2 * n), plus(2 * n), minus(2 * n);
  state << s.q, x.p;
  const auto rates = [&](const Eigen::VectorXd& at, Eigen::VectorXd& out) {
    ASSERT_TRUE(chain.rates(s.t, at.head(n), at.tail(n), out.head(n), out.tail(n)));
  };
  for (int j = 0; j < 2 * n; ++j) {
    rates(state + h * Eigen::VectorXd::Unit(2 * n, j), plus);
    rates(state - h * Eigen::VectorXd::Unit(2 * n, j), minus);
    differences.col(j) = (plus - minus) / (2 * h);
  }
  EXPECT_LE(relative_error(x.jacobian, differences), 1e-7);
  Eigen::VectorXd qdot(n), pdot(n), both(2 * n);
  const Eigen::VectorXd d = Eigen::VectorXd::LinSpaced(2 * n, -1, 1);
  ASSERT_TRUE(chain.jacobian_times(s.t, s.q, x.p, d.head(n), d.tail(n), qdot, pdot));
  both << qdot, pdot;
  EXPECT_LE(relative_error(both, Eigen::VectorXd(x.jacobian * d)), 1e-12);
  EXPECT_LE(relative_error(x.solved, Eigen::VectorXd(x.mass.ldlt().solve(s.u))), 1e-12);

  // three directions at once, one by one inside: not a number of directions compiled beforehand
  const Model<Spatial> model = build_spatial_model(chain.tree(), scene);
  const auto links = build_links(model);
  DirectionalPass<Spatial, 3> pass(links);
  pass.set(s.q.data(), x.p.data());
  for (std::size_t j = 0; j < 3; ++j) pass.q[j].b[j] = 1;
  ASSERT_TRUE(pass(s.t));
  for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i)
    for (std::size_t j = 0; j < 3; ++j)
      EXPECT_NEAR(pass.pdot[i].b[j], x.jacobian(n + static_cast<int>(i), static_cast<int>(j)),
                  1e-12 * (1 + x.jacobian.cwiseAbs().maxCoeff()));
}

}  // namespace
}  // namespace momenta::core_user_joint_in_time
