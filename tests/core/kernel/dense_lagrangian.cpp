// The slow twin against a slider-pendulum by hand.

#include "equations/dense_lagrangian.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>

namespace momenta::equations::core_dense_lagrangian {
namespace {

/// A cart of mass M on x and a point of mass m on a massless bar of length l, angle θ from below:
///   T = ½ (M + m) ẋ² + m l ẋ θ̇ cos θ + ½ m l² θ̇²,  V = −m g l cos θ
///   p = ((M + m) ẋ + m l θ̇ cos θ, m l ẋ cos θ + m l² θ̇),  ṗ = (0, −m l ẋ θ̇ sin θ − m g l sin θ)
TEST(DenseLagrangian, SliderPendulumByHand) {
  const double M = 3, m = 2, l = 0.7, g = 9.81;
  Scene scene;
  scene.gravity = {0, -g, 0};
  scene.bodies.resize(2);
  scene.bodies[0].name = "cart";
  scene.bodies[0].mass = M;
  scene.bodies[0].inertia.setIdentity();
  scene.bodies[1].name = "point";
  scene.bodies[1].mass = m;
  scene.bodies[1].com = {0, -l, 0};
  scene.joints.resize(2);
  scene.joints[0].name = "slide";
  scene.joints[0].kind = JointKind::prismatic;
  scene.joints[0].child = "cart";
  scene.joints[0].axis = {1, 0, 0};
  scene.joints[1].name = "revolute joint";
  scene.joints[1].parent = "cart";
  scene.joints[1].child = "point";

  const DenseLagrangian twin(scene, build_tree(scene));
  const Eigen::Vector2d q(0.3, 0.8), u(1.1, -1.7);
  const double c = std::cos(q[1]), s = std::sin(q[1]);
  const Eigen::Vector2d p((M + m) * u[0] + m * l * c * u[1], m * l * c * u[0] + m * l * l * u[1]);
  const Eigen::Vector2d pdot(0, -m * l * u[0] * u[1] * s - m * g * l * s);
  Eigen::Matrix2d mass;
  mass << M + m, m * l * c, m * l * c, m * l * l;
  EXPECT_LT(relative_error(twin.momenta_at(0, q, u).cast<double>(), p), algebra_tol(1));
  EXPECT_LT(relative_error(twin.mass_matrix(0, q).cast<double>(), mass), algebra_tol(1));
  EXPECT_LT(relative_error(twin.momentum_rates(0, q, u).cast<double>(), pdot), algebra_tol(1));
  EXPECT_LT(relative_error(twin.lagrange_rates(0, q, u).cast<double>(), pdot), algebra_tol(1));
}

}  // namespace
}  // namespace momenta::equations::core_dense_lagrangian
