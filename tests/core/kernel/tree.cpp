// Trees of joints that are chains: parts, names, places in q, start values, drives; and what the
// coordinates mean, by hand.

#include "equations/parts.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/open_chain/open_chain.h>

namespace momenta::core_tree {
namespace {

using Eigen::Vector3d;
using equations::algebra_tol;

BodySpec body(const std::string& name) {
  return equations::make_body(name, 1, {1, 1, 1});
}

JointSpec joint(JointKind kind, const std::string& parent = "ground",
                const std::string& child = "body") {
  return equations::make_joint(kind, "to " + child, parent, child);
}

Scene one_body(JointSpec j) {
  Scene scene;
  scene.bodies.push_back(body("body"));
  scene.joints.push_back(std::move(j));
  return scene;
}

DriveSpec constant(int coordinate, double value, double rate = 0) {
  DriveSpec d = equations::polynomial("to body", {value, rate});
  d.coordinate = coordinate;
  return d;
}

Eigen::Isometry3d pose(const Scene& scene, const Eigen::VectorXd& q) {
  OpenChain chain(scene, Algebra::spatial);
  return chain.poses(0, q)[static_cast<std::size_t>(chain.tree().body("body"))];
}

Eigen::Matrix3d turn(double angle, const Vector3d& axis) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

void expect_pose(const Eigen::Isometry3d& found, const Eigen::Matrix3d& axes, const Vector3d& at) {
  EXPECT_LT((found.linear() - axes).norm(), algebra_tol(4)) << found.matrix();
  EXPECT_LT((found.translation() - at).norm(), algebra_tol(4)) << found.matrix();
}

TEST(Tree, PartsOfJoints) {
  Scene scene;
  for (const char* name : {"a", "b", "c"}) scene.bodies.push_back(body(name));
  scene.joints = {joint(JointKind::planar, "ground", "a"), joint(JointKind::revolute, "a", "b"),
                  joint(JointKind::universal, "a", "c")};
  scene.joints[0].position = {1, 2, 3};
  scene.joints[0].velocity = {4, 5, 6};
  scene.joints[2].position = {7, 8};
  DriveSpec drive = equations::polynomial("to a", {1});
  drive.coordinate = 1;
  scene.drives.push_back(drive);
  const Tree tree = build_tree(scene);

  ASSERT_EQ(tree.bodies.size(), 6U);
  EXPECT_EQ(tree.nq, 5);
  EXPECT_EQ(tree.nv, 5);
  EXPECT_EQ(tree.carried_by("to a"), 2);
  EXPECT_EQ(tree.body("a"), 2);
  EXPECT_EQ(tree.first_part(2), 0);
  EXPECT_EQ(tree.body("b"), 3);
  EXPECT_EQ(tree.first_part(3), 3);
  EXPECT_EQ(tree.body("c"), 5);
  EXPECT_EQ(tree.first_part(5), 4);
  EXPECT_EQ(tree.body(""), -1);
  EXPECT_EQ(tree.carried_by("none"), -1);
  for (int k : {0, 1, 4}) {
    const Tree::Body& b = tree.bodies[static_cast<std::size_t>(k)];
    EXPECT_FALSE(tree.carries_scene_body(k));
    EXPECT_EQ(b.name, "");
    EXPECT_EQ(b.mass, 0);
    EXPECT_TRUE(b.inertia.isZero(0));
  }
  EXPECT_EQ(tree.bodies[3].parent, 2);
  EXPECT_EQ(tree.bodies[4].parent, 2);
  EXPECT_EQ(tree.bodies[1].drive, 0);
  EXPECT_EQ(tree.bodies[1].nq, 0);
  EXPECT_EQ(tree.bodies[2].coordinate, 2);
  EXPECT_EQ(tree.joint_in_words(3), "joint 'to b'");
  EXPECT_EQ(tree.joint_in_words(2), "coordinate 2 of joint 'to a'");
  // coordinate 1 of the planar joint is driven: it has no place in q
  EXPECT_EQ(tree.q0, (Eigen::VectorXd(5) << 1, 3, 0, 7, 8).finished());
  EXPECT_EQ(tree.u0, (Eigen::VectorXd(5) << 4, 6, 0, 0, 0).finished());
}

TEST(Tree, HelicalByHand) {
  JointSpec j = joint(JointKind::helical);
  j.axis = Vector3d::UnitX();
  j.pitch = 0.5;
  expect_pose(pose(one_body(j), Eigen::VectorXd::Constant(1, 0.8)), turn(0.8, Vector3d::UnitX()),
              {0.4, 0, 0});
  // p = (J + m pitch²) u, T = ½ p u: the nut's mass moves along, com on the axis
  OpenChain chain(one_body(j));
  EXPECT_FALSE(chain.plan().planar);
  const Eigen::VectorXd q = Eigen::VectorXd::Constant(1, 0.8), u = Eigen::VectorXd::Constant(1, 2);
  Eigen::VectorXd p(1);
  chain.momenta(0, q, u, p);
  EXPECT_NEAR(p[0], 2 * (1 + 0.25), algebra_tol(1));
  j.pitch = 0;
  EXPECT_TRUE(OpenChain(one_body(j)).plan().planar);
}

TEST(Tree, CylindricalByHand) {
  JointSpec j = joint(JointKind::cylindrical);
  j.axis = Vector3d::UnitY();
  expect_pose(pose(one_body(j), Eigen::Vector2d(0.3, 0.8)), turn(0.8, Vector3d::UnitY()),
              {0, 0.3, 0});
}

TEST(Tree, UniversalByHand) {
  JointSpec j = joint(JointKind::universal);  // axis z, axis2 x
  const Eigen::Vector2d q(0.3, 0.8);
  expect_pose(pose(one_body(j), q), turn(0.3, Vector3d::UnitZ()) * turn(0.8, Vector3d::UnitX()),
              Vector3d::Zero());
  j.axis2 = Vector3d(0, 0.6, 0.8);
  expect_pose(pose(one_body(j), q), turn(0.3, Vector3d::UnitZ()) * turn(0.8, j.axis2),
              Vector3d::Zero());
}

TEST(Tree, PlanarByHand) {
  JointSpec j = joint(JointKind::planar);  // axis z: x and y of the joint frame
  const Vector3d q(0.3, 0.5, 0.8);
  expect_pose(pose(one_body(j), q), turn(0.8, Vector3d::UnitZ()), {0.3, 0.5, 0});
  EXPECT_TRUE(OpenChain(one_body(j)).plan().planar);
  j.axis = Vector3d::UnitX();  // y, then z
  expect_pose(pose(one_body(j), q), turn(0.8, Vector3d::UnitX()), {0, 0.3, 0.5});
  j.direction = Vector3d(0.6, 0, 0.8);  // z, then x × z = −y
  expect_pose(pose(one_body(j), q), turn(0.8, Vector3d::UnitX()), {0, -0.5, 0.3});
}

TEST(Tree, DrivenSphericalJointByHand) {
  Scene scene = one_body(joint(JointKind::spherical));
  for (int i = 0; i < 3; ++i) scene.drives.push_back(constant(i, 0.2 + 0.3 * i));
  expect_pose(
      pose(scene, Eigen::VectorXd(0)),
      turn(0.8, Vector3d::UnitZ()) * turn(0.5, Vector3d::UnitY()) * turn(0.2, Vector3d::UnitX()),
      Vector3d::Zero());
}

TEST(Tree, DrivenFreeJointByHand) {
  Scene scene = one_body(joint(JointKind::free));
  for (int i = 5; i >= 0; --i)  // in any order
    scene.drives.push_back(constant(i, 0.1 + 0.2 * i, 1));
  expect_pose(
      pose(scene, Eigen::VectorXd(0)),
      turn(1.1, Vector3d::UnitZ()) * turn(0.9, Vector3d::UnitY()) * turn(0.7, Vector3d::UnitX()),
      {0.1, 0.3, 0.5});
  OpenChain chain(scene);
  EXPECT_EQ(chain.nq(), 0);
  EXPECT_EQ(chain.nv(), 0);
  EXPECT_FALSE(chain.plan().quasi_velocities);
  const Eigen::VectorXd none(0);
  EXPECT_GT(chain.energies(0, none, none).kinetic,
            1.5 - algebra_tol(4));  // ½ m |v|², v = (1, 1, 1)
}

TEST(Tree, ForcesOnDrivenJointsAreRefused) {
  JointSpec j = joint(JointKind::helical);
  j.pitch = 0.1;
  j.stiffness = 1;
  Scene scene = one_body(j);
  scene.drives.push_back(constant(0, 1));
  EXPECT_THROW(build_tree(scene), SceneError);
}

}  // namespace
}  // namespace momenta::core_tree
