// ClosedChain: its calls describe one motion, whatever solves (7), with and without forces of
// joints; many states are as one; what is wrong is said.

#include "equations/ensemble.h"
#include "equations/examples.h"
#include "equations/linkages.h"
#include "equations/random_loops.h"
#include "equations/refusal.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/dae/analysis/chain/closed_chain.h>

#include <cmath>

namespace momenta::dae_closed_chain {
namespace {

using namespace equations;
using Eigen::VectorXd;
using equations::example;

VectorXd any(RandomTree& random, int size) {
  VectorXd x(size);
  for (double& v : x) v = random.uniform(-1, 1);
  return x;
}

/// Scenes in the plane and in space, driven, sprung, with quaternions.
std::vector<Scene> scenes() {
  std::vector<Scene> all = {example("four_bar"),
                            example("andrews"),
                            example("driven"),
                            example("spatial_slider_crank"),
                            bricard(),
                            platform(6),
                            row_of_four_bars(4, 1.1, 1)};
  all.push_back(flying_rod());
  return all;
}

constexpr KktChoice solvers[] = {KktChoice::sweeps, KktChoice::sparse, KktChoice::dense};

struct State {
  double t;
  VectorXd q, u;
};

/// The scene's start, moving within its loops.
State moving(ClosedChain& chain, RandomTree& random) {
  const Start start = start_of(chain.mechanism());
  State s{start.t, start.q, start.u + any(random, chain.nv())};
  EXPECT_TRUE(chain.correct(s.t, s.q, s.u)) << chain.failure();
  return s;
}

/// ṗ − Φ_qᵀ λ of σ = 0 is d/dt (M u + what drives prescribe) along (q̇, u̇): (8) beside (3).
TEST(ClosedChain, RatesOfMomentaAndAccelerationsAreOneMotion) {
  RandomTree random(5);
  for (const Scene& scene : scenes())
    for (const KktChoice kkt : solvers)
      for (const bool pushed : {false, true}) {
        ClosedChain chain(scene, {.kkt = kkt});
        const State s = moving(chain, random);
        const int nv = chain.nv(), nq = chain.nq(), m = chain.m();
        const VectorXd tau = pushed ? any(random, nv) : VectorXd::Zero(nv);
        VectorXd p(nv), u(nv), sigma(m), qdot(nq), pdot(nv), udot(nv), lambda(m);
        chain.momenta(s.t, s.q, s.u, p);
        ASSERT_TRUE(chain.velocities(s.t, s.q, p, u, sigma)) << chain.failure();
        const std::string where = scene.name + ", " + name_of(kkt);
        const double speed = 1 + s.u.cwiseAbs().maxCoeff();
        EXPECT_LT((u - s.u).cwiseAbs().maxCoeff(), 1e-9 * speed) << where;
        ASSERT_TRUE(chain.rates(s.t, s.q, p, tau, qdot, pdot)) << chain.failure();
        ASSERT_TRUE(chain.accelerations(s.t, s.q, s.u, tau, udot, lambda)) << chain.failure();

        const double h = 1e-5;
        const auto at = [&](double step) {
          VectorXd moved(nv), q = s.q + step * qdot;
          chain.mechanism().tree().normalise(q);
          chain.momenta(s.t + step, q, s.u + step * udot, moved);
          return moved;
        };
        const VectorXd slope = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
        const VectorXd expected = pdot - chain.jacobian(s.t, s.q).transpose() * lambda;
        const double size = 1 + slope.cwiseAbs().maxCoeff() + pdot.cwiseAbs().maxCoeff();
        EXPECT_LT((slope - expected).cwiseAbs().maxCoeff(), 1e-7 * size) << where;

        VectorXd found(nv);
        chain.joint_forces(s.t, s.q, s.u, udot, lambda, found);
        EXPECT_LT((found - tau).cwiseAbs().maxCoeff(), 1e-9 * size) << where;
        // The loops stay closed: Φ̇ one step on is of second order.
        VectorXd phi(m), phidot(m), q = s.q + h * qdot;
        chain.mechanism().tree().normalise(q);
        chain.constraints(s.t + h, q, s.u + h * udot, phi, phidot);
        EXPECT_LT(phidot.cwiseAbs().maxCoeff(), 1e-5 * speed * speed * size) << where;
      }
}

TEST(ClosedChain, SolvesTheEquationsAsTheyStand) {
  RandomTree random(6);
  for (const Scene& scene : scenes()) {
    ClosedChain chain(scene);
    const State s = moving(chain, random);
    const Eigen::MatrixXd M = chain.mass_matrix(s.t, s.q), J = chain.jacobian(s.t, s.q);
    VectorXd still(chain.nv()), p = any(random, chain.nv()), u(chain.nv()), sigma(chain.m()),
                                phi(chain.m()), phidot(chain.m());
    chain.momenta(s.t, s.q, VectorXd::Zero(chain.nv()), still);
    ASSERT_TRUE(chain.velocities(s.t, s.q, p, u, sigma));
    const double size = 1 + u.cwiseAbs().maxCoeff() * M.cwiseAbs().maxCoeff();
    EXPECT_LT((M * u + still + J.transpose() * sigma - p).cwiseAbs().maxCoeff(), 1e-9 * size)
        << scene.name;
    chain.constraints(s.t, s.q, u, phi, phidot);
    EXPECT_LT(phidot.cwiseAbs().maxCoeff(), 1e-9 * size) << scene.name;
    const Energies e = chain.energies(s.t, s.q, s.u);
    chain.momenta(s.t, s.q, s.u, p);
    EXPECT_NEAR(e.hamiltonian, p.dot(s.u) - e.kinetic + e.potential, 1e-9 * (1 + e.kinetic));
    EXPECT_EQ(chain.reactions(s.t, s.q, s.u).loops.size(), scene.loops.size());
  }
}

/// Without constraints the mass matrix is factorised: what it gives meets the equations as they
/// stand, with what L has linear in the rates, and many states are as one.
TEST(ClosedChain, SolvesALagrangianWithoutConstraints) {
  const Scene scene = parse_scene(R"toml(
[lagrangian]
coordinates = ["a", "b"]
lagrangian = """(2 + cos(b))*a.dot^2 + (1 + cos(b))*a.dot*b.dot + b.dot^2/2
  + 0.7*sin(3*t)*a.dot + b*a.dot + 4*cos(a) + cos(a + b)"""
force = { a = "-0.3*a.dot" }
)toml",
                                  "typed.toml");
  RandomTree random(9);
  ClosedChain chain(scene);
  const double t = 0.4;
  constexpr int count = 5;
  StateMatrix q(2, count), u(2, count), p = u, tau = u, qdot = q, pdot = u, udot = u;
  StateMatrix lambda(0, count);
  for (int i = 0; i < count; ++i) {
    const VectorXd one_q = any(random, 2), one_u = any(random, 2), force = any(random, 2);
    VectorXd one_p(2), rates(2), slopes(2), pushed(2), found(2), none(0), found_u(2);
    const Eigen::MatrixXd M = chain.mass_matrix(t, one_q);
    chain.momenta(t, one_q, one_u, one_p);
    ASSERT_TRUE(chain.rates(t, one_q, one_p, rates, slopes)) << chain.failure();
    ASSERT_TRUE(chain.velocities(t, one_q, one_p, found_u, none)) << chain.failure();
    EXPECT_LT((rates - one_u).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_EQ(rates, found_u);
    ASSERT_TRUE(chain.accelerations(t, one_q, one_u, rates, none)) << chain.failure();
    ASSERT_TRUE(chain.accelerations(t, one_q, one_u, force, pushed, none)) << chain.failure();
    EXPECT_LT((M * (pushed - rates) - force).cwiseAbs().maxCoeff(), 1e-13);
    chain.joint_forces(t, one_q, one_u, pushed, none, found);
    EXPECT_LT((found - force).cwiseAbs().maxCoeff(), 1e-13);
    q.col(i) = one_q, u.col(i) = one_u, p.col(i) = one_p, tau.col(i) = force;
  }
  ASSERT_TRUE(chain.rates_of_states(t, q, p, tau, qdot, pdot)) << chain.failure();
  ASSERT_TRUE(chain.accelerations_of_states(t, q, u, tau, udot, lambda, 2)) << chain.failure();
  for (int i = 0; i < count; ++i) {
    VectorXd one_qdot(2), one_pdot(2), one_udot(2), none(0);
    ASSERT_TRUE(chain.rates(t, q.col(i), p.col(i), tau.col(i), one_qdot, one_pdot));
    ASSERT_TRUE(chain.accelerations(t, q.col(i), u.col(i), tau.col(i), one_udot, none));
    EXPECT_EQ(qdot.col(i), one_qdot);
    EXPECT_EQ(pdot.col(i), one_pdot);
    EXPECT_EQ(udot.col(i), one_udot);
  }
  VectorXd one_q = q.col(0), one_u = u.col(0);
  EXPECT_TRUE(chain.correct(t, one_q, one_u));
  EXPECT_EQ(one_q, q.col(0));
}

TEST(ClosedChain, ManyStatesAreAsOne) {
  RandomTree random(7);
  for (const Scene& scene : scenes()) {
    ClosedChain chain(scene);
    constexpr int count = 21;
    const int nq = chain.nq(), nv = chain.nv(), m = chain.m();
    StateMatrix q(nq, count), u(nv, count), p = u, tau = u, qdot = q, pdot = u, pushed = u,
                                            udot = u, lambda(m, count);
    for (int i = 0; i < count; ++i) {
      const State s = moving(chain, random);
      VectorXd one(nv);
      chain.momenta(s.t, s.q, s.u, one);
      // With impulses of the loops: of σ = 0 nothing leaks.
      q.col(i) = s.q;
      u.col(i) = s.u;
      p.col(i) = one + chain.jacobian(s.t, s.q).transpose() * any(random, m);
      tau.col(i) = any(random, nv);
    }
    ASSERT_TRUE(chain.rates_of_states(0, q, p, qdot, pdot, 2)) << chain.failure();
    StateMatrix qdot_pushed = q;
    ASSERT_TRUE(chain.rates_of_states(0, q, p, tau, qdot_pushed, pushed, 2)) << chain.failure();
    EXPECT_EQ(qdot_pushed, qdot) << scene.name;
    EXPECT_EQ(pushed, pdot + tau) << scene.name;
    const auto expect_accelerations = [&](bool with_tau) {
      for (int i = 0; i < count; ++i) {
        VectorXd one_udot(nv), one_lambda(m);
        ASSERT_TRUE(
            with_tau ? chain.accelerations(0, q.col(i), u.col(i), tau.col(i), one_udot, one_lambda)
                     : chain.accelerations(0, q.col(i), u.col(i), one_udot, one_lambda));
        EXPECT_LT(relative_error(udot.col(i), one_udot), 1e-9) << scene.name;
        // λ of redundant rows is not unique: what it does to the joints is.
        const Eigen::MatrixXd J = chain.jacobian(0, q.col(i));
        EXPECT_LT(relative_error(J.transpose() * lambda.col(i), J.transpose() * one_lambda), 1e-8)
            << scene.name;
      }
    };
    ASSERT_TRUE(chain.accelerations_of_states(0, q, u, udot, lambda)) << chain.failure();
    expect_accelerations(false);
    ASSERT_TRUE(chain.accelerations_of_states(0, q, u, tau, udot, lambda)) << chain.failure();
    expect_accelerations(true);
    for (int i = 0; i < count; ++i) {
      VectorXd one_qdot(nq), one_pdot(nv);
      ASSERT_TRUE(chain.rates(0, q.col(i), p.col(i), one_qdot, one_pdot, 2));
      EXPECT_LT(relative_error(qdot.col(i), one_qdot), 1e-9) << scene.name;
      EXPECT_LT(relative_error(pdot.col(i), one_pdot), 1e-9) << scene.name;
    }
    StateMatrix qdot_shared = q, pdot_shared = p, udot_shared = u, lambda_shared = lambda;
    ASSERT_TRUE(chain.rates_of_states(0, q, p, qdot_shared, pdot_shared, 2, 3));
    EXPECT_EQ(qdot, qdot_shared) << scene.name;
    EXPECT_EQ(pdot, pdot_shared) << scene.name;
    ASSERT_TRUE(chain.accelerations_of_states(0, q, u, tau, udot_shared, lambda_shared, 3));
    EXPECT_EQ(udot, udot_shared) << scene.name;
    EXPECT_EQ(lambda, lambda_shared) << scene.name;

    p(0, 4) = NAN;
    EXPECT_FALSE(chain.rates_of_states(0, q, p, qdot_shared, pdot_shared, 2, 2));
    EXPECT_NE(chain.failure().find("state 4"), std::string::npos) << chain.failure();
    EXPECT_TRUE(std::isnan(qdot_shared(0, 4)) && std::isnan(pdot_shared(0, 4)));
    EXPECT_LT(relative_error(pdot_shared.col(5), pdot.col(5)), 1e-9) << scene.name;
    tau(0, 3) = HUGE_VAL;
    const std::string of_tau = "state 3: tau[0] is infinite, expected a finite number";
    EXPECT_FALSE(chain.rates_of_states(0, q, p, tau, qdot_shared, pdot_shared));
    EXPECT_EQ(chain.failure(), of_tau);
    EXPECT_TRUE(std::isnan(pdot_shared(0, 3)) && std::isnan(pdot_shared(0, 4)));
    EXPECT_FALSE(chain.accelerations_of_states(0, q, u, tau, udot_shared, lambda_shared));
    EXPECT_EQ(chain.failure(), of_tau);
    EXPECT_TRUE(std::isnan(udot_shared(0, 3)));
    EXPECT_LT(relative_error(udot_shared.col(4), udot.col(4)), 1e-9) << scene.name;
  }
}

TEST(ClosedChain, WithoutLoopsIsAnOpenChain) {
  RandomTree random(8);
  const Scene scene = random.scene({.bodies = 7});
  ClosedChain chain(scene);
  OpenChain open(scene);
  const TreeState s = random.state(open.tree());
  const VectorXd tau = any(random, open.nv());
  VectorXd p(open.nv()), qdot(open.nq()), pdot(open.nv()), udot(open.nv()), none(0),
      qdot_open = qdot, pdot_open = pdot, udot_open = udot;
  chain.momenta(s.t, s.q, s.u, p);
  ASSERT_TRUE(chain.rates(s.t, s.q, p, tau, qdot, pdot));
  ASSERT_TRUE(open.rates(s.t, s.q, p, tau, qdot_open, pdot_open));
  EXPECT_EQ(qdot, qdot_open);
  EXPECT_EQ(pdot, pdot_open);
  ASSERT_TRUE(chain.accelerations(s.t, s.q, s.u, tau, udot, none));
  ASSERT_TRUE(open.accelerations(s.t, s.q, s.u, tau, udot_open));
  EXPECT_EQ(udot, udot_open);
  // M u̇ = … + τ
  VectorXd udot_free(open.nv());
  ASSERT_TRUE(open.accelerations(s.t, s.q, s.u, udot_free));
  const VectorXd added = open.mass_matrix(s.t, s.q) * (udot - udot_free);
  EXPECT_LT(relative_error(added, tau), 1e-7);
}

TEST(ClosedChain, ClosesWhatIsSlightlyOpen) {
  RandomTree random(9);
  for (const Scene& scene : scenes()) {
    ClosedChain chain(scene);
    const Start start = start_of(chain.mechanism());
    VectorXd q = start.q + 1e-3 * any(random, chain.nq()), u = start.u + any(random, chain.nv());
    chain.mechanism().tree().normalise(q);
    ASSERT_TRUE(chain.correct(start.t, q, u)) << scene.name << chain.failure();
    VectorXd phi(chain.m()), phidot(chain.m());
    chain.constraints(start.t, q, u, phi, phidot);
    EXPECT_LT(phi.cwiseAbs().maxCoeff(), 1e-12) << scene.name;
    EXPECT_LT(phidot.cwiseAbs().maxCoeff(), 1e-11 * (1 + u.cwiseAbs().maxCoeff())) << scene.name;
    EXPECT_LT((q - start.q).cwiseAbs().maxCoeff(), 0.1) << scene.name;
  }
  ClosedChain torn(example("four_bar"));
  VectorXd q(3), u = VectorXd::Zero(3);
  q << NAN, 0, 0;
  EXPECT_FALSE(torn.correct(0, q, u));
  EXPECT_EQ(torn.failure(), "q[0] is not a number, expected a finite number");
}

TEST(ClosedChain, SaysWhatIsWrong) {
  ClosedChain chain(example("four_bar"));
  const Assembly a = chain.assemble();
  VectorXd p(3), qdot(3), pdot(3), two(2), lambda(2);
  chain.momenta(0, a.start.q, a.start.u, p);
  EXPECT_EQ(
      equations::thrown<std::invalid_argument>([&] { chain.rates(0, a.start.q, two, qdot, pdot); }),
      "rates: p has 2 numbers, expected 3");
  EXPECT_EQ(equations::thrown<std::invalid_argument>(
                [&] { chain.rates(0, a.start.q, p, two, qdot, pdot); }),
            "rates: tau has 2 numbers, expected 3");
  EXPECT_EQ(equations::thrown<std::invalid_argument>(
                [&] { chain.accelerations(0, a.start.q, p, two, qdot, lambda); }),
            "accelerations: tau has 2 numbers, expected 3");
  EXPECT_EQ(equations::thrown<std::invalid_argument>([&] { chain.jacobian(0, two); }),
            "jacobian: q has 2 numbers, expected 3");
  EXPECT_FALSE(chain.rates(NAN, a.start.q, p, qdot, pdot));
  EXPECT_EQ(chain.failure(), "t is not finite, expected a time in seconds");
  p[1] = HUGE_VAL;
  EXPECT_FALSE(chain.rates(0, a.start.q, p, qdot, pdot));
  EXPECT_EQ(chain.failure(), "p[1] is infinite, expected a finite number");

  p[1] = 0;
  two.resize(3);
  two << 0, NAN, 0;
  EXPECT_FALSE(chain.rates(0, a.start.q, p, two, qdot, pdot));
  EXPECT_EQ(chain.failure(), "tau[1] is not a number, expected a finite number");
  EXPECT_EQ(equations::thrown<std::invalid_argument>(
                [&] { chain.joint_forces(0, a.start.q, p, two, lambda, pdot); }),
            "joint_forces: udot[1] is not a number, expected a finite number");
  lambda << 0, -HUGE_VAL;
  EXPECT_EQ(equations::thrown<std::invalid_argument>(
                [&] { chain.joint_forces(0, a.start.q, p, p, lambda, pdot); }),
            "joint_forces: lambda[1] is minus infinite, expected a finite number");
  p.setConstant(1e200);
  EXPECT_EQ(equations::thrown<std::invalid_argument>([&] { chain.energies(0, a.start.q, p); }),
            "energies: the result is not finite, expected smaller numbers to find it from");
  const StateMatrix many = a.start.q, of_p = StateMatrix::Zero(3, 1);
  StateMatrix many_qdot(3, 1), many_pdot(3, 1);
  EXPECT_EQ(equations::thrown<std::invalid_argument>(
                [&] { chain.rates(0, a.start.q, p, qdot, pdot, -1); }),
            "rates: leak is -1, expected a rate in 1/s, not negative");
  EXPECT_EQ(equations::thrown<std::invalid_argument>(
                [&] { chain.rates_of_states(0, many, of_p, many_qdot, many_pdot, NAN); }),
            "rates_of_states: leak is nan, expected a rate in 1/s, not negative");
  chain.momenta(0, a.start.q, a.start.u, p);

  // Moved, it works on: nothing inside points at the object.
  p[1] = 0;
  ASSERT_TRUE(chain.rates(0, a.start.q, p, qdot, pdot));
  ClosedChain other(example("andrews"));
  other = std::move(chain);
  VectorXd again(3);
  ASSERT_TRUE(other.rates(0, a.start.q, p, again, pdot));
  EXPECT_EQ(again, qdot);
}

}  // namespace
}  // namespace momenta::dae_closed_chain
