// Axes that a loop holds in one are so in every pose that assembly finds, from starts anywhere: not
// half a turn or a third of a turn off, where the rows O_ij = a_i · b_j are zero as well. With C
// the child's axes in the loop frame and f what drives prescribe,
//
//   weld, prismatic, all coordinates driven     C = C(f)
//   revolute, cylindrical, planar               C a = a
//   revolute, cylindrical, planar, driven       C = R(a, f)
//   universal, outer angle driven               R(a, −f) C a₂ = a₂
//   universal, inner angle driven               C R(a₂, −f) a = a
//
// Here the child is one free body, whose C is read off its quaternion, or the last one of a chain
// of hinges, whose C is the product of their rotations.

#include "equations/examples.h"
#include "equations/parts.h"
#include "equations/random_tree.h"
#include "equations/refusal.h"
#include "equations/runs.h"

#include <gtest/gtest.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/topology/assembly/assembly.h>
#include <momenta/dae/topology/assembly/displacement_of_mass.h>
#include <momenta/dae/topology/assembly/turned_loops.h>

#include <functional>
#include <numbers>

namespace momenta::dae_turned_loops {
namespace {

using namespace equations;
using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double pi = std::numbers::pi;

BodySpec brick(const std::string& name) {
  return equations::make_body(name, 1, {0.02, 0.03, 0.04}, {0.1, -0.05, 0.2});
}

DriveSpec drive(int coordinate, double value) {
  DriveSpec d;
  d.loop = "L";
  d.coordinate = coordinate;
  d.kind = "polynomial";
  d.coefficients = {value};
  return d;
}

Matrix3d about(const Vector3d& axis, double angle) {
  return AngleAxisd(angle, axis).toRotationMatrix();
}

/// A kind of loop with what is driven of it, and how far C is from what it asks for [rad].
struct Case {
  std::string name;
  LoopKind kind;
  std::vector<DriveSpec> drives;
  std::function<double(const Matrix3d& c, const LoopSpec& loop)> off;
};

double angle_of(const Matrix3d& c) {
  return AngleAxisd(c).angle();
}
double angle_between(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

std::vector<Case> cases() {
  const double f = 2.1, g = -1.3, h = 0.4;
  const auto all = [](const Matrix3d& c, const LoopSpec&) { return angle_of(c); };
  const auto hinge = [](const Matrix3d& c, const LoopSpec& l) {
    return angle_between(c * l.axis, l.axis);
  };
  const auto angle = [=](const Matrix3d& c, const LoopSpec& l) {
    return angle_of(about(l.axis, f).transpose() * c);
  };
  return {
      {"weld", LoopKind::weld, {}, all},
      {"prismatic", LoopKind::prismatic, {}, all},
      {"prismatic driven", LoopKind::prismatic, {drive(0, 0.3)}, all},
      {"revolute", LoopKind::revolute, {}, hinge},
      {"cylindrical", LoopKind::cylindrical, {}, hinge},
      {"planar", LoopKind::planar, {}, hinge},
      {"revolute driven", LoopKind::revolute, {drive(0, f)}, angle},
      {"cylindrical driven", LoopKind::cylindrical, {drive(1, f)}, angle},
      {"planar driven", LoopKind::planar, {drive(2, f)}, angle},
      {"spherical driven",
       LoopKind::spherical,
       {drive(0, f), drive(1, g), drive(2, h)},
       [=](const Matrix3d& c, const LoopSpec&) {
         const Matrix3d given = about(Vector3d::UnitZ(), h) * about(Vector3d::UnitY(), g) *
                                about(Vector3d::UnitX(), f);
         return angle_of(given.transpose() * c);
       }},
      {"universal driven",
       LoopKind::universal,
       {drive(0, f), drive(1, g)},
       [=](const Matrix3d& c, const LoopSpec& l) {
         return angle_of((about(l.axis, f) * about(l.axis2, g)).transpose() * c);
       }},
      {"universal, outer driven",
       LoopKind::universal,
       {drive(0, f)},
       [=](const Matrix3d& c, const LoopSpec& l) {
         return angle_between(about(l.axis, -f) * c * l.axis2, l.axis2);
       }},
      {"universal, inner driven",
       LoopKind::universal,
       {drive(1, g)},
       [=](const Matrix3d& c, const LoopSpec& l) {
         return angle_between(c * about(l.axis2, -g) * l.axis, l.axis);
       }},
  };
}

LoopSpec loop_of(const Case& c, RandomTree& random, const std::string& child) {
  LoopSpec loop;
  loop.name = "L";
  loop.kind = c.kind;
  loop.child = child;
  loop.origin_parent = random.vector(1);
  loop.origin_child = random.vector(0.3);
  loop.rotation = random.turn();
  loop.axis = random.vector(1).normalized();
  if (c.kind == LoopKind::universal) loop.axis2 = loop.axis.cross(random.vector(1)).normalized();
  return loop;
}

TEST(TurnedLoops, AxesOfOneFreeBodyAreInOneFromAnyStart) {
  int starts = 0, closed = 0, turned_back = 0;
  for (const Case& c : cases())
    for (unsigned seed = 0; seed < 40; ++seed) {
      SCOPED_TRACE(c.name + ", seed " + std::to_string(seed));
      RandomTree random(seed);
      Scene scene;
      scene.bodies = {brick("a")};
      JointSpec joint = equations::make_joint(JointKind::free, "J", "ground", "a");
      const Quaterniond q = random.turn();
      const Vector3d x = random.vector(2);
      joint.position = {x[0], x[1], x[2], q.w(), q.x(), q.y(), q.z()};
      scene.joints = {joint};
      scene.loops = {loop_of(c, random, "a")};
      scene.drives = c.drives;
      const Mechanism mechanism(scene);
      ++starts;
      Assembly a;
      try {
        a = assemble(mechanism, Assembled::rates);
      } catch (const SceneError& e) {  // told, never another mechanism
        EXPECT_NE(std::string(e.what()).find("axes turned by"), std::string::npos) << e.what();
        continue;
      }
      const VectorXd& found = a.start.q;
      const Matrix3d axes = Quaterniond(found[3], found[4], found[5], found[6]).toRotationMatrix();
      const LoopSpec& loop = mechanism.scene().loops[0];
      EXPECT_LT(c.off(loop.rotation.toRotationMatrix().transpose() * axes, loop), 1e-7);
      EXPECT_LT(a.position_residual, 1e-12);
      ++closed;
      turned_back += a.branch.find("led back") != std::string::npos;
    }
  EXPECT_EQ(starts, 13 * 40);
  EXPECT_GE(closed, starts - 2);
  EXPECT_GT(turned_back, 0);
}

/// A chain of hinges with its last body's frame in the ground at q, by the product of the screws.
Scene hinges(RandomTree& random, int count) {
  Scene scene;
  for (int k = 0; k < count; ++k) {
    scene.bodies.push_back(brick("b" + std::to_string(k)));
    JointSpec joint;
    joint.name = "J" + std::to_string(k);
    joint.parent = k == 0 ? "ground" : "b" + std::to_string(k - 1);
    joint.child = "b" + std::to_string(k);
    joint.origin_parent = random.vector(0.5);
    joint.rotation = random.turn();
    scene.joints.push_back(joint);
  }
  return scene;
}
Eigen::Isometry3d last_frame(const Scene& scene, const VectorXd& q) {
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  for (Eigen::Index k = 0; k < q.size(); ++k) {
    const JointSpec& j = scene.joints[static_cast<std::size_t>(k)];
    frame = frame * Eigen::Translation3d(j.origin_parent) * j.rotation *
            AngleAxisd(q[k], Vector3d::UnitZ());
  }
  return frame;
}

TEST(TurnedLoops, AxesOfChainsOfHingesAreInOneFromAnyStart) {
  int starts = 0, closed = 0;
  for (const Case& c : cases())
    for (unsigned seed = 0; c.drives.empty() && seed < 30; ++seed) {
      SCOPED_TRACE(c.name + ", seed " + std::to_string(seed));
      RandomTree random(seed);
      Scene scene = hinges(random, 8);
      LoopSpec loop = loop_of(c, random, "b7");
      VectorXd somewhere(8);
      for (double& x : somewhere) x = random.uniform(-pi, pi);
      const Eigen::Isometry3d there = last_frame(scene, somewhere);
      loop.rotation = Quaterniond(there.linear());
      loop.origin_parent = there * loop.origin_child;
      scene.loops = {loop};
      for (JointSpec& joint : scene.joints) joint.position = {random.uniform(-pi, pi)};
      ++starts;
      const Mechanism mechanism(scene);
      try {
        const Assembly a = assemble(mechanism, Assembled::rates);
        const Matrix3d axes = last_frame(scene, a.start.q).linear();
        EXPECT_LT(c.off(loop.rotation.toRotationMatrix().transpose() * axes, loop), 1e-7);
        ++closed;
      } catch (const SceneError& e) {
        EXPECT_NE(std::string(e.what()).find("axes turned by"), std::string::npos) << e.what();
      }
    }
  EXPECT_EQ(starts, 5 * 30);
  EXPECT_GE(closed, starts - 1);
}

/// The delta robot of the models is drawn so that all three of its welds close half a turn off. Its
/// run by momentum-index2 then did not come past t = 0.02 s.
TEST(TurnedLoops, TheDeltaRobotIsLedBackAndRuns) {
  const Mechanism mechanism(equations::example("models/epr_robot_delta/robot.urdf"));
  const Assembly a = assemble(mechanism);
  EXPECT_TRUE(turned_loops(mechanism, 0, a.start.q).empty());
  EXPECT_NE(a.branch.find("turned by 180°, and it was led back"), std::string::npos) << a.branch;
  RunRequest request = equations::adaptive("momentum-index2", "ida", "none", 1e-8, 0.5);
  request.max_cpu_seconds = 60;
  const RunResult run = run_form(mechanism, a.start, request);
  EXPECT_EQ(run.status, "done") << run.reason;
}

/// A body of six points of mass, displaced: Σ m |x − x'|².
TEST(TurnedLoops, DisplacementOfMassIsThatOfItsPoints) {
  RandomTree random(4);
  const Quaterniond axes = random.turn();
  BodySpec body = brick("a");
  body.mass = 0;
  body.inertia = Matrix3d::Zero();
  std::vector<std::pair<double, Vector3d>> points;
  for (int k = 0; k < 3; ++k)
    for (const double side : {0.1, -0.1}) {
      const Vector3d arm = side * (k + 1) * (axes * Vector3d::Unit(k));
      points.push_back({k + 0.5, body.com + arm});
      body.mass += k + 0.5;
      body.inertia +=
          (k + 0.5) * (arm.squaredNorm() * Matrix3d::Identity() - arm * arm.transpose());
    }
  Scene scene;
  scene.bodies = {body};
  scene.joints = {equations::make_joint(JointKind::free, "J", "ground", "a")};
  const Mechanism mechanism(scene);
  VectorXd q[2];
  Eigen::Isometry3d poses[2];
  for (int i = 0; i < 2; ++i) {
    const Vector3d at = random.vector(1);
    const Quaterniond turn = random.turn();
    q[i].resize(7);
    q[i] << at, turn.w(), turn.vec();
    poses[i] = Eigen::Translation3d(at) * turn;
  }
  double sum = 0;
  for (const auto& [mass, x] : points) sum += mass * (poses[0] * x - poses[1] * x).squaredNorm();
  EXPECT_NEAR(displacement_of_mass(mechanism, 0, q[0], q[1]), sum, 1e-13 * sum);
}

/// Of the ways back from half a turn none is shorter: computed in a plane or in space, with a
/// loop's bodies exchanged, its frame turned, the whole turned in the ground, the delta robot comes
/// out the same, every point of its mass.
TEST(TurnedLoops, TheDeltaRobotIsTheSameHoweverWritten) {
  const Scene scene = equations::example("models/epr_robot_delta/robot.urdf");
  const Mechanism own(scene);
  const VectorXd q = assemble(own, Assembled::rates).start.q;
  const double size = displacement_of_mass(own, 0, q, own.tree().q0);
  EXPECT_GT(size, 1e-6);
  const auto off = [&](const Scene& other, Algebra algebra, double sense = 1) {
    MechanismOptions options;
    options.algebra = algebra;
    const Mechanism mechanism(other, options);
    const VectorXd found = sense * assemble(mechanism, Assembled::rates).start.q;
    return displacement_of_mass(own, 0, q, found) / size;
  };
  EXPECT_LT(off(scene, Algebra::spatial), 1e-12);
  Scene reversed = scene;
  for (JointSpec& joint : reversed.joints)
    if (joint.kind == JointKind::revolute) {
      joint.axis = -joint.axis;
      for (double& x : joint.position) x = -x;
    }
  EXPECT_LT(off(reversed, Algebra::automatic, -1), 1e-12);
  EXPECT_LT(off(reversed, Algebra::spatial, -1), 1e-12);
  Scene exchanged = scene;
  for (LoopSpec& loop : exchanged.loops) {
    ASSERT_TRUE(loop.rotation.isApprox(Quaterniond::Identity()));
    std::swap(loop.parent, loop.child);
    std::swap(loop.origin_parent, loop.origin_child);
    EXPECT_LT(off(exchanged, Algebra::automatic), 1e-12);
  }
  EXPECT_LT(off(exchanged, Algebra::spatial), 1e-12);
  Scene turned = scene;  // about any axis
  const Quaterniond by(AngleAxisd(2.2, Vector3d(0.3, -0.5, 0.7).normalized()));
  for (JointSpec& joint : turned.joints)
    if (joint.parent == "ground") {
      joint.origin_parent = by * joint.origin_parent;
      joint.rotation = by * joint.rotation;
    }
  EXPECT_LT(off(turned, Algebra::automatic), 1e-12);
  EXPECT_LT(off(turned, Algebra::spatial), 1e-12);
}

/// A free start is not taken where it is half a turn off; what is held there is told.
TEST(TurnedLoops, WhatClosesTurnedAloneIsRefused) {
  Scene scene;
  scene.bodies = {brick("a")};
  scene.joints = {
      equations::make_joint(JointKind::revolute, "J", "ground", "a", {0, 0, 0}, {0, 0, 1}, {pi})};
  LoopSpec loop = equations::make_loop(LoopKind::weld, "L", "ground", "a");
  scene.loops = {loop};
  scene.held = {"J"};
  const Mechanism mechanism(scene);
  EXPECT_TRUE(
      equations::says(equations::thrown<SceneError>([&] { assemble(mechanism, Assembled::rates); }),
                      "loop 'L' closes with its axes turned by 180° alone"));
}

}  // namespace
}  // namespace momenta::dae_turned_loops
