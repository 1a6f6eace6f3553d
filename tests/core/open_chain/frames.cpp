// Poses: canonical frames composed back give the scene's frames, for any placement of joints; and
// the words of core/scene/scene.h by hand.

#include "equations/dense_lagrangian.h"
#include "equations/random_tree.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/open_chain/open_chain.h>

#include <numbers>

namespace momenta::core_frames {
namespace {

using namespace equations;
using Eigen::Vector3d;

/// Poses of a random scene against the twin, relative to the reach of its bodies.
double error_of_poses(const Scene& scene, RandomTree& random, Algebra algebra) {
  OpenChain chain(scene, algebra);
  const DenseLagrangian twin(scene, chain.tree());
  const TreeState s = random.state(chain.tree());
  const auto found = chain.poses(s.t, s.q);
  const auto expected = twin.poses(s.t, s.q);
  double reach = 1, error = 0;
  for (const auto& pose : expected)
    reach = std::max(reach, pose.translation().cwiseAbs().maxCoeff());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const int at = chain.tree().body(scene.bodies[k].name);
    const auto& pose = found[static_cast<std::size_t>(at)];
    error = equations::larger(error, relative_error(pose.linear(), expected[k].linear()));
    error = equations::larger(error,
                              relative_error(pose.translation(), expected[k].translation(), reach));
  }
  return error;
}

void sweep(const TreeRecipe& recipe, int trees, unsigned seed) {
  double worst = 0;
  for (int i = 0; i < trees; ++i) {
    RandomTree random(seed + static_cast<unsigned>(i));
    worst =
        equations::larger(worst, error_of_poses(random.scene(recipe), random, Algebra::spatial));
    worst = equations::larger(worst,
                              error_of_poses(random.planar_scene(recipe), random, Algebra::planar));
  }
  EXPECT_LT(worst, algebra_tol(recipe.bodies));
  testing::Test::RecordProperty("worst", std::to_string(worst * 1e16) + "e-16");
}

TEST(Frames, General) {
  sweep({.bodies = 4, .branching = Branching::serial}, 1500, 10000);
}
TEST(Frames, RightAngles) {
  sweep({.bodies = 4, .placing = Placing::right_angles}, 1500, 20000);
}
TEST(Frames, Degenerate) {
  TreeRecipe recipe{.bodies = 4, .branching = Branching::serial, .placing = Placing::degenerate};
  double worst = 0;
  for (unsigned seed = 30000; seed < 33000; ++seed) {
    RandomTree random(seed);
    worst =
        equations::larger(worst, error_of_poses(random.scene(recipe), random, Algebra::spatial));
  }
  EXPECT_LT(worst, algebra_tol(recipe.bodies));
  RecordProperty("worst", std::to_string(worst * 1e16) + "e-16");
}

/// Axes at every small and large inclination to that of the parent, on both sides of the border
/// between the two forms of an edge, and all around.
TEST(Frames, EveryInclination) {
  double worst = 0;
  for (const double exponent : {-17., -15., -12., -9., -7., -5., -3., -2., -1., -0.6, -0.5, -0.4})
    for (const bool opposite : {false, true})
      for (int turn = 0; turn < 8; ++turn) {
        RandomTree random(static_cast<unsigned>(turn));
        Scene scene = random.scene({.bodies = 3,
                                    .branching = Branching::serial,
                                    .kinds = {JointKind::revolute},
                                    .drives = false,
                                    .body_forces = false});
        const double tilt = std::pow(10.0, exponent), around = turn * std::numbers::pi / 4;
        for (JointSpec& joint : scene.joints) {
          joint.rotation = Eigen::Quaterniond::Identity();
          joint.axis = {std::sin(tilt) * std::cos(around), std::sin(tilt) * std::sin(around),
                        (opposite ? -1 : 1) * std::cos(tilt)};
        }
        scene.joints[1].axis = {0, 0, 1};
        worst = equations::larger(worst, error_of_poses(scene, random, Algebra::spatial));
      }
  EXPECT_LT(worst, algebra_tol(3));
  RecordProperty("worst", std::to_string(worst * 1e16) + "e-16");
}

Scene one_body(JointKind kind) {
  Scene scene;
  BodySpec body;
  body.name = "body";
  body.mass = 1;
  body.inertia = Eigen::Matrix3d::Identity();
  scene.bodies.push_back(body);
  JointSpec joint;
  joint.name = "joint";
  joint.kind = kind;
  joint.child = "body";
  scene.joints.push_back(joint);
  return scene;
}

const double root = std::sqrt(0.5);

/// A quarter turn about z takes the child's x axis to the joint's y axis.
TEST(Frames, QuaternionTakesChildToJoint) {
  OpenChain chain(one_body(JointKind::spherical));
  const auto pose = chain.poses(0, Eigen::Vector4d(root, 0, 0, root)).front();
  EXPECT_LT((pose.linear().col(0) - Vector3d::UnitY()).norm(), algebra_tol(1));
  EXPECT_LT((pose.linear().col(1) + Vector3d::UnitX()).norm(), algebra_tol(1));
}

/// A quaternion that has drifted off unit length is still a rotation, the same one.
TEST(Frames, QuaternionOfAnyLength) {
  OpenChain chain(one_body(JointKind::spherical));
  const Eigen::Vector4d q(0.5, -0.5, 0.5, 0.5);
  const auto unit = chain.poses(0, q).front(), longer = chain.poses(0, 1.3 * q).front();
  EXPECT_LT((unit.matrix() - longer.matrix()).norm(), algebra_tol(1));
}

/// Rates are in child axes: turned a quarter about z, a turn about the child's x turns about the
/// joint's y, and a velocity along the child's x moves along y.
TEST(Frames, RatesAreInChildAxes) {
  OpenChain chain(one_body(JointKind::free));
  Eigen::VectorXd q(7), u(6), qdot(7);
  q << 1, 2, 3, root, 0, 0, root;
  u << 1, 0, 0, 1, 0, 0;
  chain.coordinate_rates(q, u, qdot);
  EXPECT_LT((qdot.head<3>() - Vector3d::UnitY()).norm(), algebra_tol(1));
  const double h = 1e-6;  // forward difference: error of order h
  const auto before = chain.poses(0, q).front(), after = chain.poses(0, q + h * qdot).front();
  const Eigen::Matrix3d spin = (after.linear() - before.linear()) / h * before.linear().transpose();
  EXPECT_LT((Vector3d(spin(2, 1), spin(0, 2), spin(1, 0)) - Vector3d::UnitY()).norm(), 2 * h);
}

/// origin_parent, rotation, axis and origin_child of a prismatic joint: the child's point moves
/// along the axis in the joint frame.
TEST(Frames, PrismaticByHand) {
  Scene scene = one_body(JointKind::prismatic);
  JointSpec& joint = scene.joints.front();
  joint.origin_parent = {1, 2, 3};
  joint.rotation = Eigen::Quaterniond(root, 0, 0, root);  // joint x is ground y
  joint.axis = {1, 0, 0};
  joint.origin_child = {0, 0, 5};
  OpenChain chain(scene);
  const auto pose = chain.poses(0, Eigen::VectorXd::Constant(1, 0.25)).front();
  EXPECT_LT((pose * Vector3d(0, 0, 5) - Vector3d(1, 2.25, 3)).norm(), algebra_tol(4));
  EXPECT_LT((pose.linear().col(0) - Vector3d::UnitY()).norm(), algebra_tol(1));
}

/// validate() lets a rotation pass that is unit within 1e-6; its frame must be orthogonal all the
/// same.
TEST(Frames, RotationNotQuiteUnit) {
  Scene scene = one_body(JointKind::revolute);
  JointSpec& joint = scene.joints.front();
  joint.rotation.coeffs() = (1 + 5e-7) * Eigen::Vector4d(0.5, -0.5, 0.5, 0.5);
  joint.axis = (1 - 5e-7) * Vector3d(0.6, 0, -0.8);
  OpenChain chain(scene, Algebra::spatial);
  const Eigen::Matrix3d r = chain.poses(0, Eigen::VectorXd::Constant(1, 0.3)).front().linear();
  EXPECT_LT((r * r.transpose() - Eigen::Matrix3d::Identity()).norm(), algebra_tol(1));
}

}  // namespace
}  // namespace momenta::core_frames
