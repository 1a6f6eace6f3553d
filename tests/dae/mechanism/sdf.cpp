// SDF with loops: a four-bar of joints alone has M and accelerations of the same in TOML, wherever
// its joints let the tree be cut; gears and mimics tie angles as couplers do.

#include "equations/examples.h"
#include "equations/scene_folder.h"

#include <gtest/gtest.h>
#include <momenta/dae/run/state_values.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <cmath>
#include <map>

namespace momenta::dae_sdf {
namespace {

using namespace equations;
using Eigen::Vector3d;
using Eigen::VectorXd;

std::string digits(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g ", x);
  return text;
}

StateValues values_at(const Mechanism& mechanism, const VectorXd& q, const VectorXd& u) {
  GivenState given;
  given.q = q;
  given.v = u;
  given.p = given.tau = VectorXd::Zero(mechanism.nv());
  return evaluate_state(mechanism, given);
}

/// The place of a joint's rate.
Eigen::Index place(const Mechanism& mechanism, const std::string& joint) {
  for (const Tree::Body& body : mechanism.tree().bodies)
    if (body.joint == joint) return body.u;
  throw std::out_of_range(joint);
}
VectorXd in_order(const Mechanism& mechanism, const std::map<std::string, double>& rates) {
  VectorXd u(mechanism.nv());
  for (const auto& [joint, rate] : rates)
    for (const JointSpec& in_tree : mechanism.scene().joints)
      if (in_tree.name == joint) u[place(mechanism, joint)] = rate;
  return u;
}

/// Uniform rods, as of examples/four_bar, at an angle to the ground's x axis.
struct Rod {
  const char* name;
  double mass, length, x, y, angle;
};
std::string link(const Rod& rod) {
  const std::string moment = digits(rod.mass * rod.length * rod.length / 12);
  return std::string("<link name='") + rod.name + "'><pose>" + digits(rod.x) + digits(rod.y) +
         "0 0 0 " + digits(rod.angle) + "</pose><inertial><pose>" + digits(rod.length / 2) +
         "0 0 0 0 0</pose><mass>" + digits(rod.mass) + "</mass><inertia><ixx>0</ixx><iyy>" +
         moment + "</iyy><izz>" + moment + "</izz></inertia></inertial></link>\n";
}
std::string hinge(const std::string& name, const std::string& parent, const std::string& child,
                  const std::string& more = "", const std::string& pose = "") {
  return "<joint name='" + name + "' type='revolute'>" + pose + "<parent>" + parent +
         "</parent><child>" + child + "</child><axis><xyz>0 0 1</xyz>" + more + "</axis></joint>\n";
}

class SdfLoops : public SceneFolder {
 protected:
  Scene world(const std::string& inside) const {
    return read("w.sdf",
                "<sdf version='1.9'><world name='w'><gravity>0 -9.81 0</gravity><model "
                "name='m'>" +
                    inside + "</model></world></sdf>");
  }
};

TEST_F(SdfLoops, FourBarAsInToml) {
  const Mechanism toml(equations::example("four_bar"));
  const Assembly closed = assemble(toml);
  const VectorXd q = closed.start.q;  // of O, A, C
  // the one motion that the loop allows, at 2 rad/s of the crank
  Eigen::Matrix2d s;
  const double a = q[0], b = q[0] + q[1], c = q[2];
  s << -2 * std::sin(b), 1.5 * std::sin(c), 2 * std::cos(b), -1.5 * std::cos(c);
  const Eigen::Vector2d turning =
      s.partialPivLu().solve(Eigen::Vector2d(std::sin(a), -std::cos(a)));  // of the rods B, C
  const VectorXd u = VectorXd(Vector3d(2, turning[0] - 2, turning[1]));
  const StateValues expected = values_at(toml, q, u);
  ASSERT_LE(expected.phidot.norm(), 1e-12);

  const std::string links = link({"crank", 1, 0.5, 0, 0, a}) +
                            link({"coupler", 2, 2, 0.5 * std::cos(a), 0.5 * std::sin(a), b}) +
                            link({"rocker", 1.5, 1.5, 2, 0, c});
  const std::string b_pose = "<pose relative_to='coupler'>2 0 0 0 0 0</pose>";
  const Scene scene =
      world(links + hinge("O", "world", "crank") + hinge("C", "world", "rocker") +
            hinge("A", "crank", "coupler") + hinge("B", "coupler", "rocker", "", b_pose));
  ASSERT_EQ(scene.loops.size(), 1U);
  EXPECT_EQ(scene.loops[0].name, "B");
  const Mechanism sdf(scene);
  const std::map<std::string, double> rates{
      {"O", u[0]}, {"A", u[1]}, {"C", u[2]}, {"B", turning[1] - turning[0]}};
  const StateValues found = values_at(sdf, VectorXd::Zero(3), in_order(sdf, rates));
  EXPECT_LE(found.phi.norm(), 1e-14);
  EXPECT_LE(found.phidot.norm(), 1e-12);
  for (const char* i : {"O", "A", "C"})
    for (const char* k : {"O", "A", "C"})
      EXPECT_NEAR(found.mass(place(sdf, i), place(sdf, k)),
                  expected.mass(place(toml, i), place(toml, k)), 1e-13 * expected.mass.norm());
  for (const char* i : {"O", "A", "C"})
    EXPECT_NEAR(found.constrained[place(sdf, i)], expected.constrained[place(toml, i)],
                1e-12 * expected.constrained.norm());

  // a damper at B has B in the tree, from its far side: the same mechanism, cut at A instead
  const std::string damper = "<dynamics><damping>1e-300</damping></dynamics>";
  const Scene other =
      world(links + hinge("O", "world", "crank") + hinge("C", "world", "rocker") +
            hinge("A", "crank", "coupler") + hinge("B", "coupler", "rocker", damper, b_pose));
  ASSERT_EQ(other.loops.size(), 1U);
  EXPECT_EQ(other.loops[0].name, "A");
  EXPECT_EQ(joint_of(other, "B").child, "coupler");
  EXPECT_EQ(joint_of(other, "B").axis[2], -1);  // its angle counts as the file has it
  const Mechanism cut(other);
  const StateValues again = values_at(cut, VectorXd::Zero(3), in_order(cut, rates));
  EXPECT_LE(again.phidot.norm(), 1e-12);
  const double tolerance = 1e-12 * expected.constrained.norm();
  const VectorXd& e = expected.constrained;
  EXPECT_NEAR(again.constrained[place(cut, "O")], e[place(toml, "O")], tolerance);
  EXPECT_NEAR(again.constrained[place(cut, "C")], e[place(toml, "C")], tolerance);
  EXPECT_NEAR(again.constrained[place(cut, "B")],
              e[place(toml, "C")] - e[place(toml, "O")] - e[place(toml, "A")], tolerance);
}

// θ2 = −ratio θ1 of a wheel's and an arm's angle about their axes, seen from the ground.
TEST_F(SdfLoops, GearsTieAngles) {
  const auto wheels = [&](const std::string& second_joint, const std::string& axis2,
                          const std::string& axis = "0 0 1") {
    return world(link({"one", 1, 1, 0, 0, 0.3}) + link({"two", 3, 0.5, 2, 0, -0.4}) +
                 hinge("j", "world", "one") + second_joint +
                 "<joint name='g' type='gearbox'><parent>one</parent><child>two</child>"
                 "<gearbox_ratio>3</gearbox_ratio><gearbox_reference_body>world"
                 "</gearbox_reference_body><axis><xyz>" +
                 axis + "</xyz></axis><axis2><xyz>" + axis2 + "</xyz></axis2></joint>");
  };
  const auto speed = [&](const Scene& scene) {  // of the second joint, for 1 rad/s of the first
    const Mechanism mechanism(scene);
    EXPECT_EQ(mechanism.m(), 1);
    const VectorXd q = VectorXd::Zero(2);
    double found = 0;
    for (const double rate : {-1. / 3, 1. / 3, -3., 3.}) {
      const StateValues values = values_at(mechanism, q, VectorXd(Eigen::Vector2d(1, rate)));
      if (values.phidot.norm() < 1e-14) found = rate;
    }
    return found;
  };
  const std::string ahead = hinge("k", "world", "two");
  EXPECT_EQ(speed(wheels(ahead, "0 0 1")), -3);
  EXPECT_EQ(speed(wheels(ahead, "0 0 -1")), 3);
  EXPECT_EQ(speed(wheels(ahead, "0 0 1", "0 0 -1")), 3);
  EXPECT_EQ(speed(wheels(ahead, "0 0 -1", "0 0 -1")), -3);
  // The angles are those since the pose of the file.
  const Mechanism turned(wheels(ahead, "0 0 1"));
  EXPECT_LE(values_at(turned, VectorXd(Eigen::Vector2d(0.4, -1.2)), VectorXd::Zero(2)).phi.norm(),
            1e-15);
  // An axis that is not given is that of the joint. A joint from the wheel to the reference body
  // counts the reference's angle seen from the wheel: the other sign.
  const auto on_a_base = [&](const std::string& second_joint, const std::string& first_joint) {
    return world(link({"one", 1, 1, 0, 0, 0.3}) + link({"two", 3, 0.5, 2, 0, -0.4}) +
                 link({"base", 1, 1, 0, 0, 0}) +
                 "<joint name='f' type='fixed'><parent>world"
                 "</parent><child>base</child></joint>" +
                 first_joint + second_joint +
                 "<joint name='g' type='gearbox'><parent>one</parent><child>two</child>"
                 "<gearbox_ratio>3</gearbox_ratio><gearbox_reference_body>base"
                 "</gearbox_reference_body></joint>");
  };
  const std::string first = hinge("j", "base", "one"), first_back = hinge("j", "one", "base");
  EXPECT_EQ(speed(on_a_base(hinge("k", "base", "two"), first)), -3);
  EXPECT_EQ(speed(on_a_base(hinge("k", "two", "base"), first)), 3);
  EXPECT_EQ(speed(on_a_base(hinge("k", "base", "two"), first_back)), 3);
  EXPECT_EQ(speed(on_a_base(hinge("k", "two", "base"), first_back)), -3);
}

// q = multiplier (q_leader − reference) + offset, on axes of universal joints too.
TEST_F(SdfLoops, MimicsAreCouplers) {
  const std::string links = link({"one", 1, 1, 0, 0, 0.3}) + link({"two", 3, 0.5, 2, 0, -0.4});
  const std::string universal =
      "<joint name='j' type='universal'><parent>world</parent><child>one</child><axis><xyz>1 0 0"
      "</xyz></axis><axis2><xyz>0 1 0</xyz></axis2></joint>";
  const Scene scene = world(links + universal +
                            hinge("k", "world", "two",
                                  "<mimic joint='j' axis='axis2'><multiplier>-2</multiplier>"
                                  "<offset>0.5</offset><reference>0.1</reference></mimic>"));
  ASSERT_EQ(scene.loops.size(), 1U);
  const Mechanism mechanism(scene);
  VectorXd q(3);
  ASSERT_EQ(scene.joints[0].name, "j");
  q << 0, 0.7, -2 * (0.7 - 0.1) + 0.5;
  EXPECT_LE(values_at(mechanism, q, VectorXd::Zero(3)).phi.norm(), 1e-15);
}

}  // namespace
}  // namespace momenta::dae_sdf
