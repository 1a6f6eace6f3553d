// Everything at one state against the open chain, against the equations it must satisfy, and
// against balances of the whole mechanism.

#include "equations/examples.h"
#include "equations/linkages.h"
#include "equations/random_loops.h"
#include "equations/random_tree.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/open_chain/open_chain.h>
#include <momenta/dae/mechanism/joint_places.h>
#include <momenta/dae/run/state_values.h>
#include <momenta/dae/topology/assembly/assembly.h>

namespace momenta::dae_state_values {
namespace {

using namespace equations;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using equations::example;

VectorXd any(RandomTree& random, int size, double reach) {
  VectorXd x(size);
  for (int i = 0; i < size; ++i) x[i] = random.uniform(-reach, reach);
  return x;
}

GivenState rates(double t, const VectorXd& q, const VectorXd& v) {
  GivenState given;
  given.t = t;
  given.q = q;
  given.v = v;
  given.p = given.tau = VectorXd::Zero(v.size());
  return given;
}

GivenState by_momenta(GivenState given, const VectorXd& p) {
  given.of_momenta = true;
  given.p = p;
  given.p_given.assign(static_cast<std::size_t>(p.size()), true);
  given.v.setZero();
  return given;
}

/// Reactions of the open chain, child axes, against ours, ground axes. A joint of several parts
/// acts on the scene's body through the last one.
void expect_same_reactions(const std::vector<Reaction>& chain, const Tree& tree,
                           const std::vector<Eigen::Isometry3d>& poses, const Reactions& ours,
                           double tolerance) {
  double greatest = 1;
  for (const auto& r : chain) greatest = std::max({greatest, r.force.norm(), r.torque.norm()});
  std::size_t next = 0;
  for (std::size_t k = 0; k < chain.size(); ++k) {
    if (k + 1 < chain.size() && chain[k + 1].joint == chain[k].joint) continue;
    ASSERT_LT(next, ours.joints.size());
    const auto& joint = ours.joints[next++];
    EXPECT_EQ(chain[k].joint, joint.name);
    const auto body = static_cast<std::size_t>(tree.carried_by(joint.name));
    const Eigen::Matrix3d axes = poses[body].linear();
    EXPECT_LT((axes * chain[k].force - joint.force).norm(), tolerance * greatest);
    EXPECT_LT((axes * chain[k].torque - joint.torque).norm(), tolerance * greatest);
  }
  EXPECT_EQ(next, ours.joints.size());
}

void expect_agrees_with_chain(const Scene& scene, RandomTree& random) {
  const Mechanism mechanism(scene);
  OpenChain chain(scene);
  const TreeState at = random.state(chain.tree());
  const int nv = chain.nv();
  const StateValues s = evaluate_state(mechanism, rates(at.t, at.q, at.u));
  VectorXd p(nv), qdot(chain.nq()), pdot(nv), udot(nv);
  chain.momenta(at.t, at.q, at.u, p);
  ASSERT_TRUE(chain.rates(at.t, at.q, p, qdot, pdot)) << chain.failure();
  ASSERT_TRUE(chain.accelerations(at.t, at.q, at.u, udot));
  const MatrixXd mass = chain.mass_matrix(at.t, at.q);
  // v is recovered from p by way of M, so its rounding and all that follows carry M's condition.
  const double tolerance = 1e3 * algebra_tol(nv);
  EXPECT_LT(relative_error(s.p, p), algebra_tol(nv));
  EXPECT_LT(relative_error(s.qdot, qdot), tolerance);
  EXPECT_LT(relative_error(s.pdot, pdot), tolerance);
  EXPECT_LT(relative_error(s.free, udot), tolerance);
  EXPECT_TRUE(s.dense);
  EXPECT_LT(relative_error(s.mass, mass), algebra_tol(nv));
  EXPECT_LT(relative_error(VectorXd(mass * s.free), VectorXd(-s.bias)), tolerance);
  const Energies energies = chain.energies(at.t, at.q, at.u);
  EXPECT_NEAR(s.kinetic, energies.kinetic, 1e-12 * (1 + energies.kinetic));
  EXPECT_NEAR(s.potential, energies.potential, 1e-12 * (1 + std::abs(energies.potential)));
  EXPECT_NEAR(s.hamiltonian, energies.hamiltonian, 1e-12 * (1 + std::abs(energies.hamiltonian)));
  expect_same_reactions(chain.reactions(at.t, at.q, at.u), chain.tree(), chain.poses(at.t, at.q),
                        s.reactions, tolerance);

  const StateValues back = evaluate_state(mechanism, by_momenta(rates(at.t, at.q, at.u), p));
  EXPECT_LT(relative_error(back.v, at.u), tolerance);
  EXPECT_LT(relative_error(back.pdot, pdot), tolerance);

  GivenState pushed = rates(at.t, at.q, at.u);
  pushed.tau = any(random, nv, 5);
  const StateValues with = evaluate_state(mechanism, pushed);
  EXPECT_LT(relative_error(VectorXd(with.pdot - s.pdot), pushed.tau), 1e-12 * (1 + pdot.norm()));
  EXPECT_LT(relative_error(VectorXd(mass * (with.free - s.free)), pushed.tau),
            tolerance * (1 + udot.norm()));
  EXPECT_LT(relative_error(VectorXd(with.bias - s.bias), VectorXd(-pushed.tau)),
            1e-12 * (1 + s.bias.norm()));
}

TEST(StateValues, OpenTreesAgreeWithTheOpenChain) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    RandomTree random(900 + seed);
    SCOPED_TRACE(seed);
    TreeRecipe recipe;
    recipe.bodies = 5;
    expect_agrees_with_chain(seed % 2 == 0 ? random.scene(recipe) : random.planar_scene(recipe),
                             random);
  }
}

TEST(StateValues, CentroidalMomentaOfAFloatingTreeAreThoseOfItsFreeJoint) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    RandomTree random(40 + seed);
    TreeRecipe recipe;
    recipe.bodies = 6;
    recipe.branching = Branching::serial;  // all of it hangs on the first joint
    recipe.joint_forces = recipe.body_forces = false;
    Scene scene = random.scene(recipe);
    JointSpec root;
    root.name = scene.joints[0].name;
    root.kind = JointKind::free;
    root.child = scene.joints[0].child;
    root.origin_parent = random.vector(1);
    root.origin_child = random.vector(1);
    root.rotation = random.turn();
    scene.joints[0] = root;
    std::erase_if(scene.drives, [&](const DriveSpec& d) { return d.joint == root.name; });
    OpenChain chain(scene);
    TreeState at = random.state(chain.tree());
    VectorXd p(chain.nv());
    chain.momenta(at.t, at.q, at.u, p);
    const Centroidal all = centroidal(chain.tree(), scene, at.t, at.q, at.u);
    const Eigen::Isometry3d pose = chain.poses(at.t, at.q)[0];
    const Vector3d point = pose * root.origin_child;
    const Vector3d linear = pose.linear() * p.head<3>();
    const Vector3d angular = pose.linear() * p.segment<3>(3) + point.cross(linear);
    const double size = 1 + linear.norm() + angular.norm();
    EXPECT_LT((all.linear_momentum - linear).norm(), 1e-13 * size);
    EXPECT_LT((all.angular_momentum - angular).norm(), 1e-13 * size);
    // The weight's potential is −m g·c.
    const double potential = chain.energies(at.t, at.q, at.u).potential;
    EXPECT_NEAR(potential, -all.mass * scene.gravity.dot(all.centre), 1e-12 * (1 + size));
  }
}

/// d/dt of the whole's momenta along the motion, by differences, against what acts from outside:
/// the weight, and what joints and loops on the ground transmit.
void expect_balance(const Mechanism& mechanism, const GivenState& given) {
  const Scene& scene = mechanism.scene();
  const StateValues s = evaluate_state(mechanism, given);
  const VectorXd& udot = mechanism.m() > 0 ? s.constrained : s.free;
  const double h = 1e-5;
  const auto e = mechanism.evaluation<double>();
  const auto moved = [&](double dt) {
    // q to second order; u to first is enough for a central difference of second order.
    VectorXd q = given.q, qdot(mechanism.nq());
    const VectorXd mean = s.v + 0.5 * dt * udot;
    e->place(given.t, q.data());
    e->coordinate_rates(q.data(), mean.data(), qdot.data());
    q += dt * qdot;
    return centroidal(mechanism.tree(), scene, given.t + dt, q, s.v + dt * udot);
  };
  const Centroidal before = moved(-h), after = moved(h);
  Vector3d force = s.centroidal.mass * scene.gravity;
  Vector3d torque = s.centroidal.centre.cross(force);
  const auto add = [&](const Transmitted& r) {
    force += r.force;
    torque += r.torque + r.at.cross(r.force);
  };
  for (const Transmitted& r : s.reactions.joints)
    for (const auto& joint : scene.joints)
      if (joint.name == r.name && joint.parent == "ground") add(r);
  for (std::size_t i = 0; i < scene.loops.size(); ++i)
    if (scene.loops[i].parent == "ground") add(s.reactions.loops[i]);
  Vector3d linear = (after.linear_momentum - before.linear_momentum) / (2 * h) - force;
  Vector3d angular = (after.angular_momentum - before.angular_momentum) / (2 * h) - torque;
  if (mechanism.plan().planar) {  // across the plane nothing is known
    const Vector3d n = mechanism.plan().basis.col(2);
    linear -= n.dot(linear) * n;
    angular = n * n.dot(angular);
  }
  const double size = 1 + force.norm() + torque.norm() + s.v.squaredNorm();
  EXPECT_LT(linear.norm(), 1e-7 * size);
  EXPECT_LT(angular.norm(), 1e-7 * size);
}

/// (7), (8), (3) as they stand in the head of state_values.h, with M and Φ_q from elsewhere.
void expect_loop_equations(const Scene& scene, double speed, unsigned seed) {
  const Mechanism mechanism(scene);
  const Assembly a = assemble(mechanism);
  const int nv = mechanism.nv(), m = mechanism.m();
  RandomTree random(seed);
  MatrixXd jacobian(m, nv);
  const auto e = mechanism.evaluation<double>();
  e->place(0, a.start.q.data());
  for (int i = 0; i < m; ++i) {
    const VectorXd unit = VectorXd::Unit(m, i);
    VectorXd row(nv);
    e->constraint_forces(unit.data(), row.data());
    jacobian.row(i) = row;
  }
  // Rates the loops allow: any, less what tears.
  VectorXd v = a.start.u + any(random, nv, speed);
  e->move(v.data());
  VectorXd tears(m);
  e->velocities(tears.data());
  v -= jacobian.completeOrthogonalDecomposition().solve(tears);

  GivenState given = rates(0, a.start.q, v);
  given.tau = any(random, nv, 2);
  const StateValues s = evaluate_state(mechanism, given);
  const double size = 1 + s.bias.norm() + s.lambda.norm(), tolerance = 1e-9;
  EXPECT_LT(s.phi.norm(), 1e-12 * size);
  EXPECT_LT(s.phidot.norm(), 1e-12 * (1 + v.norm()));
  EXPECT_EQ(s.sigma.norm(), 0);
  EXPECT_LT((s.mass * s.constrained + jacobian.transpose() * s.lambda + s.bias).norm(),
            tolerance * size);
  EXPECT_LT((s.mass * s.free + s.bias).norm(), tolerance * size);
  EXPECT_EQ(s.loops.rank, a.rank);
  const LoopUnits units(mechanism);
  const MatrixXd scaled =
      units.equations.cwiseInverse().asDiagonal() * jacobian * units.rates.asDiagonal();
  const VectorXd singular = scaled.jacobiSvd().singularValues();
  EXPECT_LT((s.loops.singular_values - singular).norm(), 1e-12 * singular[0]);
  // Φ̈ = 0
  VectorXd unused(nv), phiddot(m);
  e->move(v.data());
  e->joint_forces(given.q.data(), v.data(), s.constrained.data(), s.lambda.data(), unused.data());
  EXPECT_LT((unused - given.tau).norm(), tolerance * size);
  e->accelerations(phiddot.data());
  EXPECT_LT(phiddot.norm(), tolerance * size);

  // p with impulses in it gives back the rates; σ and (8) where σ is unique.
  const VectorXd sigma = any(random, m, 3);
  const VectorXd p = s.p + jacobian.transpose() * sigma;
  const StateValues from_p = evaluate_state(mechanism, by_momenta(given, p));
  EXPECT_LT((from_p.v - v).norm(), tolerance * (1 + v.norm() + p.norm()));
  EXPECT_LT((from_p.constrained - s.constrained).norm(), tolerance * (1 + s.constrained.norm()));
  EXPECT_NEAR(from_p.hamiltonian, from_p.kinetic + from_p.potential, 1e-9 * (1 + p.norm()));
  EXPECT_LT((jacobian.transpose() * (from_p.sigma - sigma)).norm(), 1e-7 * (1 + p.norm()));
  // (8) at σ from the same evaluation
  VectorXd pdot(nv), again(nv);
  e->move(v.data());
  e->momenta(sigma.data(), again.data());
  e->momentum_rates(given.q.data(), v.data(), sigma.data(), 0, pdot.data());
  if (s.loops.rank == m) {
    EXPECT_LT((from_p.sigma - sigma).norm(), 1e-9 * (1 + p.norm()));
    EXPECT_LT((from_p.pdot - pdot - given.tau).norm(), 1e-8 * (1 + pdot.norm()));
  }
}

TEST(StateValues, LoopsSatisfyTheirEquations) {
  expect_loop_equations(example("four_bar"), 2, 1);
  expect_loop_equations(example("andrews"), 2, 2);
  expect_loop_equations(bricard(), 1, 3);
  expect_loop_equations(row_of_four_bars(3, 1.2), 1, 4);
  expect_loop_equations(example("slider_crank"), 1, 5);
}

TEST(StateValues, ReactionsBalanceTheWhole) {
  for (const Scene& scene : {example("four_bar"), bricard(), row_of_four_bars(3, 1.2, -1),
                             example("pendulum"), example("chain"), example("slider_crank")}) {
    const Mechanism mechanism(scene);
    const Assembly a = assemble(mechanism);
    SCOPED_TRACE(scene.name);
    expect_balance(mechanism, rates(0, a.start.q, a.start.u));
  }
  for (unsigned seed = 0; seed < 20; ++seed) {
    RandomTree random(300 + seed);
    TreeRecipe recipe;
    recipe.bodies = 5;
    recipe.body_forces = false;  // springs to the ground and wrenches act from outside, too
    const Scene scene = seed % 2 == 0 ? random.scene(recipe) : random.planar_scene(recipe);
    const Mechanism mechanism(scene);
    const TreeState at = random.state(mechanism.tree());
    SCOPED_TRACE(seed);
    expect_balance(mechanism, rates(at.t, at.q, at.u));
  }
}

TEST(StateValues, PendulumCutOpenPullsAsMuch) {
  const Mechanism hinged(example("pendulum"));
  const Mechanism cartesian(example("pendulum/cartesian.toml"));
  const double angle = 0.4, rate = 1.7;
  const StateValues a =
      evaluate_state(hinged, rates(0, VectorXd::Constant(1, angle), VectorXd::Constant(1, rate)));
  const StateValues b =
      evaluate_state(cartesian, rates(0, Eigen::Vector2d(std::cos(angle), std::sin(angle)),
                                      rate * Eigen::Vector2d(-std::sin(angle), std::cos(angle))));
  // By hand: the bar pulls the bob inward with m (l θ̇² − g·e).
  const double pull = rate * rate - 9.81 * std::sin(angle);
  const Vector3d inward = -pull * Vector3d(std::cos(angle), std::sin(angle), 0);
  EXPECT_LT((a.reactions.joints[0].force - inward).norm(), 1e-13);
  EXPECT_LT((b.reactions.loops[0].force - inward).norm(), 1e-13);
  EXPECT_NEAR(b.lambda[0], pull, 1e-13);
  EXPECT_NEAR(a.free[0], -9.81 * std::cos(angle), 1e-13);
  EXPECT_LT((a.centroidal.angular_momentum - Vector3d(0, 0, rate)).norm(), 1e-14);
  EXPECT_LT((b.centroidal.angular_momentum - Vector3d(0, 0, rate)).norm(), 1e-14);
}

TEST(StateValues, LargeMechanismsLeaveDensePartsOut) {
  const Mechanism mechanism(row_of_four_bars(80, 1.2));
  const Assembly a = assemble(mechanism);
  const StateValues s = evaluate_state(mechanism, rates(0, a.start.q, a.start.u));
  EXPECT_FALSE(s.dense);
  EXPECT_EQ(s.mass.size(), 0);
  EXPECT_LT(s.phi.norm(), 1e-12);
  EXPECT_TRUE(s.constrained.allFinite());
}

TEST(StateValues, JointWithoutInertiaIsNamed) {
  Scene scene = example("pendulum");
  scene.bodies[0].mass = 0;
  const Mechanism mechanism(scene);
  const VectorXd one = VectorXd::Constant(1, 1.0);
  const StateValues s = evaluate_state(mechanism, rates(0, one, one));
  EXPECT_NE(s.not_there.find("joint 'O' has no inertia"), std::string::npos) << s.not_there;
  EXPECT_TRUE(std::isnan(s.free[0]));
  EXPECT_EQ(s.mass(0, 0), 0);
}

}  // namespace
}  // namespace momenta::dae_state_values
