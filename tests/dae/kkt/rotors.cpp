// What a rotor's inertia on a joint stands for: a wheel on the ground, without mass, that a gear
// turns with the joint. The same accelerations and kinetic energy, with the wheel as a number and
// as a body behind a coupler; and joints that have no other inertia.

#include "equations/descriptions.h"
#include "equations/examples.h"
#include "equations/linkages.h"
#include "equations/random_tree.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/dae/kkt/factor/faded_pivot.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/run/state_values.h>

namespace momenta::dae_rotors {
namespace {

using namespace equations;
using Eigen::VectorXd;

StateValues at_start(const Mechanism& mechanism) {
  GivenState given;
  given.q = mechanism.tree().q0;
  given.v = mechanism.tree().u0;
  given.p = given.tau = VectorXd::Zero(mechanism.nv());
  return evaluate_state(mechanism, given);
}

/// A random tree, in the plane or in space, that starts anywhere.
Scene anywhere(unsigned seed, bool flat) {
  RandomTree random(seed);
  const TreeRecipe recipe{.bodies = 5, .drives = false};
  Scene scene = flat ? random.planar_scene(recipe) : random.scene(recipe);
  for (JointSpec& j : scene.joints) {
    if (scalar_coordinates_of(j.kind) == 0) continue;
    j.position.assign(scalar_coordinates_of(j.kind), random.uniform(-1, 1));
    j.velocity.assign(scalar_coordinates_of(j.kind), random.uniform(-1, 1));
  }
  return scene;
}

TEST(Rotors, MoveAsWheelsOnTheGround) {
  int rotors = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    const Scene scene = anywhere(seed, seed % 2);
    Scene geared = scene;
    RandomTree random(seed);
    turn_rotors_into_wheels(random, geared);
    const int wheels = static_cast<int>(geared.loops.size());
    if (wheels == 0) continue;
    rotors += wheels;
    const Mechanism as_number(scene), as_bodies(geared);
    const StateValues number = at_start(as_number), bodies = at_start(as_bodies);
    const double size = 1 + bodies.constrained.cwiseAbs().maxCoeff();
    EXPECT_LT((number.free - bodies.constrained.head(as_number.nv())).cwiseAbs().maxCoeff(),
              1e-9 * size)
        << seed;
    EXPECT_NEAR(number.kinetic, bodies.kinetic, algebra_tol(10) * (1 + bodies.kinetic)) << seed;
  }
  EXPECT_GT(rotors, 60);
}

/// Torque or force over rotor inertia, where neither the body nor what it carries has any.
TEST(Rotors, AreAllTheInertiaThereIs) {
  for (const JointKind kind : {JointKind::revolute, JointKind::prismatic, JointKind::helical})
    for (const Algebra algebra : {Algebra::spatial, Algebra::planar}) {
      if (kind == JointKind::helical && algebra == Algebra::planar) continue;
      Scene scene;
      scene.gravity = {0, -9.81, 0};
      for (const char* name : {"first", "second"}) {
        BodySpec body;
        body.name = name;
        JointSpec joint;
        joint.name = std::string(name) + " joint";
        joint.kind = kind;
        joint.child = name;
        joint.parent = scene.bodies.empty() ? "ground" : "first";
        joint.rotor_inertia = {scene.bodies.empty() ? 2.0 : 0.5};
        if (kind == JointKind::prismatic) joint.axis = {1, 0, 0};
        if (kind == JointKind::helical) joint.pitch = 0.1;
        if (!scene.bodies.empty()) joint.origin_parent = {0.3, 0.1, 0};
        ForceSpec torque;
        torque.kind = "torque";
        torque.joint = joint.name;
        torque.value = 3;
        scene.bodies.push_back(body);
        scene.joints.push_back(joint);
        scene.forces.push_back(torque);
      }
      const StateValues s = at_start(Mechanism(scene, {.algebra = algebra}));
      EXPECT_TRUE(s.not_there.empty()) << s.not_there;
      ASSERT_EQ(s.free.size(), 2);
      EXPECT_NEAR(s.free[0], 1.5, 1e-14);
      EXPECT_NEAR(s.free[1], 6, 1e-13);
    }
}

/// A leg linkage on a moving base has rows that depend on others at every pose: the sweeps fade
/// them, and it is they that carry its loops.
TEST(Rotors, AndDependentRowsLeaveCassieToTheSweeps) {
  const Scene scene = equations::example("models/agility_cassie/cassie.xml");
  EXPECT_EQ(scene.bodies.size(), 25U);  // no body stands for a rotor
  const Mechanism mechanism(scene);
  EXPECT_EQ(mechanism.solver().kkt(), KktChoice::sweeps);
  const Mechanism sparse(scene, {.kkt = KktChoice::sparse});
  const VectorXd p = VectorXd::LinSpaced(mechanism.nv(), -1, 1);
  const auto rates = [&](const Mechanism& m) {
    const auto e = m.evaluation<double>();
    VectorXd u(m.nv()), pdot(m.nv()), sigma(m.m());
    EXPECT_TRUE(make_loop_solver(m, *e)->momentum(0, m.tree().q0.data(), p.data(), nullptr,
                                                  fade_evaluation, 0, u.data(), sigma.data(),
                                                  pdot.data()));
    return u;
  };
  const VectorXd swept = rates(mechanism), assembled = rates(sparse);
  EXPECT_LT((swept - assembled).norm(), 1e-9 * (1 + assembled.norm()));
}

}  // namespace
}  // namespace momenta::dae_rotors
