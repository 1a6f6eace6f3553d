// Joints of several coordinates in closed loops: columns, assembly, and two mechanisms with
// formulas of their own.

#include "equations/parts.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <numbers>

namespace momenta::dae_joint_kinds {
namespace {

using Eigen::Vector3d;
using equations::algebra_tol;

BodySpec body(const std::string& name, double mass, const Vector3d& moments) {
  BodySpec b;
  b.name = name;
  b.mass = mass;
  b.inertia = moments.asDiagonal();
  return b;
}

JointSpec joint(const std::string& name, JointKind kind, const std::string& parent,
                const std::string& child) {
  return equations::make_joint(kind, name, parent, child);
}

TEST(JointKinds, ColumnsOfSeveralCoordinates) {
  Scene scene;
  const std::pair<const char*, JointKind> joints[] = {
      {"H", JointKind::helical}, {"C", JointKind::cylindrical}, {"U", JointKind::universal},
      {"P", JointKind::planar},  {"S", JointKind::spherical},   {"F", JointKind::free}};
  for (const auto& [name, kind] : joints) {
    scene.bodies.push_back(body(std::string(name) + "b", 1, {1, 1, 1}));
    scene.joints.push_back(joint(name, kind, "ground", std::string(name) + "b"));
  }
  scene.joints[0].pitch = 0.1;
  DriveSpec drive = equations::polynomial("P", {0.5});
  drive.coordinate = 1;
  scene.drives.push_back(drive);
  const Mechanism mechanism(scene);
  const auto labels = [](const std::vector<Column>& columns, std::size_t count) {
    std::string all;
    for (std::size_t i = 0; i < std::min(count, columns.size()); ++i)
      all += (i > 0 ? ", " : "") + columns[i].label();
    return all;
  };
  EXPECT_EQ(labels(mechanism.coordinate_columns(), 8),
            "H.q [rad], C.q0 [m], C.q1 [rad], U.q0 [rad], U.q1 [rad], P.q0 [m], P.q2 [rad], "
            "S.qw [1]");
  EXPECT_EQ(labels(mechanism.rate_columns(), 8),
            "H.u [rad/s], C.u0 [m/s], C.u1 [rad/s], U.u0 [rad/s], U.u1 [rad/s], P.u0 [m/s], "
            "P.u2 [rad/s], S.wx [rad/s]");
  EXPECT_EQ(mechanism.coordinate_columns().size(), static_cast<std::size_t>(mechanism.nq()));
  EXPECT_EQ(mechanism.rate_columns().size(), static_cast<std::size_t>(mechanism.nv()));
}

/// A screw turns in its bearing by θ; the nut on it may only slide along the axis, so it turns back
/// by θ on the thread and rises by −h θ:  (J + m h²) θ̈ = τ + m g h.
TEST(JointKinds, ScrewJack) {
  const double h = 0.3, m = 2, screw = 0.5, torque = 1.5, g = 9.81;
  Scene scene;
  scene.gravity = {0, 0, -g};
  scene.bodies = {body("screw", 5, {1, 1, screw}), body("nut", m, {0.3, 0.3, 0.4})};
  scene.joints = {joint("bearing", JointKind::revolute, "ground", "screw"),
                  joint("thread", JointKind::helical, "screw", "nut")};
  scene.joints[0].position = {0.7};
  scene.joints[0].velocity = {1.3};
  scene.joints[1].pitch = h;
  scene.forces.push_back(equations::torque_on("bearing", torque));
  LoopSpec guide;
  guide.name = "guide";
  guide.kind = LoopKind::prismatic;
  guide.child = "nut";
  scene.loops.push_back(guide);
  scene.held = {"bearing"};
  const Mechanism mechanism(scene);
  const Assembly a = assemble(mechanism);
  EXPECT_EQ(a.mobility, 1);
  EXPECT_NEAR(a.start.q[1], -0.7, algebra_tol(4));
  EXPECT_NEAR(a.start.u[1], -1.3, algebra_tol(4));
  const double expected = (torque + m * g * h) / (screw + m * h * h);
  EXPECT_NEAR(a.start.udot[0], expected, 10 * algebra_tol(4) * expected);
  EXPECT_NEAR(a.start.udot[1], -expected, 10 * algebra_tol(4) * expected);
}

/// Hooke's joint between shafts z and n, inclined by β: with a the axis on the first shaft, turned
/// by θ, the second turns at ω₂ = ω₁ cos β / (1 − (a·n)²), a·n = sin β cos θ.
Scene shafts(double beta) {
  Scene scene;
  scene.bodies = {body("first", 1, {1, 1, 1}), body("second", 1, {1, 1, 1})};
  scene.joints = {joint("in", JointKind::revolute, "ground", "first"),
                  joint("cross", JointKind::universal, "first", "second")};
  scene.joints[1].axis = Vector3d::UnitX();
  scene.joints[1].axis2 = Vector3d::UnitY();
  LoopSpec out;
  out.name = "out";
  out.kind = LoopKind::revolute;
  out.child = "second";
  out.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(beta, Vector3d::UnitY()));
  scene.loops.push_back(out);
  return scene;
}

TEST(JointKinds, HookesJoint) {
  const double beta = 0.5, theta = 0.4, speed = 1.7;
  Scene scene = shafts(beta);
  scene.joints[0].position = {theta};
  scene.joints[0].velocity = {speed};
  scene.held = {"in"};
  const Mechanism mechanism(scene);
  const Assembly a = assemble(mechanism);
  EXPECT_EQ(a.mobility, 1);
  const Eigen::VectorXd &q = a.start.q, &u = a.start.u;
  ASSERT_EQ(q.size(), 3);
  EXPECT_EQ(q[0], theta);
  const Eigen::Matrix3d first = Eigen::AngleAxisd(q[0], Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Matrix3d cross =
      first * Eigen::AngleAxisd(q[1], Vector3d::UnitX()).toRotationMatrix();
  const Vector3d n(std::sin(beta), 0, std::cos(beta));
  const Vector3d turning = u[0] * Vector3d::UnitZ() + u[1] * first.col(0) + u[2] * cross.col(1);
  const double along = std::sin(beta) * std::cos(theta);
  const double expected = speed * std::cos(beta) / (1 - along * along);
  EXPECT_LT((turning - expected * n).norm(), 1e-13);
}

/// Holding a joint holds all its coordinates: the first shaft has to turn to where the loop closes.
TEST(JointKinds, HeldWithAllItsCoordinates) {
  const double beta = 0.5;
  Scene scene = shafts(beta);
  scene.joints[0].position = {1.2};
  scene.joints[1].position = {beta, 0};
  scene.held = {"cross"};
  const Assembly a = assemble(Mechanism(scene));
  EXPECT_EQ(a.start.q[1], beta);
  EXPECT_EQ(a.start.q[2], 0);
  EXPECT_NEAR(a.start.q[0], std::numbers::pi / 2, 1e-12);
}

/// A joint without inertia is named with the coordinate, and the body it carries.
TEST(JointKinds, CoordinateWithoutInertiaIsNamed) {
  Scene scene;
  scene.bodies = {body("point", 1, {0, 0, 0})};
  scene.joints = {joint("C", JointKind::cylindrical, "ground", "point")};
  try {
    assemble(Mechanism(scene, {.algebra = Algebra::spatial}));
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_NE(
        std::string(error.what()).find("coordinate 1 of joint 'C' has no inertia: body 'point'"),
        std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace momenta::dae_joint_kinds
