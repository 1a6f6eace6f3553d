// <gazebo> in a URDF: a <joint> of SDF closes a loop as the file draws it, with frames composed
// here by matrices; springs of joints and weights that are taken back, each against the same said
// otherwise; and what is refused.

#include "equations/same_open_chain.h"
#include "equations/scene_folder.h"

#include <gtest/gtest.h>

namespace momenta::core_urdf_gazebo {
namespace {

using namespace equations;
using Eigen::Affine3d;
using Eigen::Vector3d;

constexpr double rounding = 1e-14;

struct Place {
  std::array<double, 6> n;  ///< x y z, roll pitch yaw
  std::string xyz() const { return text(0); }
  std::string rpy() const { return text(3); }
  Affine3d frame() const {
    return Eigen::Translation3d(n[0], n[1], n[2]) * Eigen::AngleAxisd(n[5], Vector3d::UnitZ()) *
           Eigen::AngleAxisd(n[4], Vector3d::UnitY()) * Eigen::AngleAxisd(n[3], Vector3d::UnitX());
  }

 private:
  std::string text(std::size_t from) const {
    std::string all;
    for (std::size_t i = from; i < from + 3; ++i) all += std::to_string(n[i]) + " ";
    return all;
  }
};

// b hangs on a, c on the base: the loop is from b to c.
constexpr Place at_a{{0.3, -0.2, 0.5, 0.7, -0.4, 1.1}}, at_b{{0.1, 0.4, -0.3, -0.2, 0.9, 0.3}},
    at_c{{-0.6, 0.2, 0.1, 0.5, 0.1, -0.8}}, own{{0.2, 0.3, -0.1, 0.4, -0.6, 0.2}};
const Affine3d B = at_a.frame() * at_b.frame(), C = at_c.frame(), J = own.frame();

std::string link(const std::string& name) {
  return "<link name='" + name + "'><inertial><origin xyz='0.1 0.2 0.3'/><mass value='2'/>" +
         "<inertia ixx='0.1' iyy='0.2' izz='0.25' ixy='0.01'/></inertial></link>\n";
}
std::string joint(const std::string& name, const std::string& parent, const std::string& child,
                  const Place& at) {
  return "<joint name='" + name + "' type='revolute'><parent link='" + parent + "'/><child link='" +
         child + "'/><origin xyz='" + at.xyz() + "' rpy='" + at.rpy() +
         "'/><axis xyz='1 2 2'/></joint>\n";
}
std::string pose(const Place& at) {
  return "<pose>" + at.xyz() + at.rpy() + "</pose>";
}
std::string axis(const std::string& xyz, const std::string& more = "",
                 const std::string& name = "axis") {
  return "<" + name + "><xyz>" + xyz + "</xyz>" + more + "</" + name + ">";
}
std::string ends(const std::string& parent, const std::string& child) {
  return "<parent>" + parent + "</parent><child>" + child + "</child>";
}
constexpr const char* of_model = "<use_parent_model_frame>1</use_parent_model_frame>";
constexpr const char* of_joint = "<use_parent_model_frame>0</use_parent_model_frame>";

class UrdfGazebo : public SceneFolder {
 protected:
  static std::string robot(const std::string& inside) {
    return "<robot name='r'><link name='base'/>" + link("a") + link("b") + link("c") +
           joint("i", "base", "a", at_a) + joint("j", "a", "b", at_b) +
           joint("k", "base", "c", at_c) + inside + "</robot>";
  }
  Scene urdf(const std::string& inside) const { return read("r.urdf", robot(inside)); }
  static std::string tag(const std::string& type, const std::string& inside) {
    return "<gazebo><joint name='l' type='" + type + "'>" + inside + "</joint></gazebo>";
  }
  LoopSpec loop(const std::string& type, const std::string& inside) const {
    const Scene scene = urdf(tag(type, inside));
    EXPECT_EQ(scene.remarks, std::vector<std::string>{});
    return scene.loops.size() == 1 ? scene.loops[0] : LoopSpec{};
  }
};

/// It has one point in both links, and one frame, as they stand at q = 0.
void expect_closed(const LoopSpec& loop, const Affine3d& parent, const Affine3d& child,
                   const Vector3d& point) {
  EXPECT_LE((parent * loop.origin_parent - point).norm(), rounding);
  EXPECT_LE((child * loop.origin_child - point).norm(), rounding);
  EXPECT_LE((parent.linear() * loop.rotation.toRotationMatrix() - child.linear()).norm(), rounding);
}

TEST_F(UrdfGazebo, AJointClosesALoopAsItIsDrawn) {
  const std::string between = pose(own) + ends("b", "c");
  const LoopSpec weld = loop("fixed", between);
  EXPECT_EQ(weld.kind, LoopKind::weld);
  EXPECT_EQ(weld.name, "l");
  EXPECT_EQ(weld.parent, "b");
  EXPECT_EQ(weld.child, "c");
  expect_closed(weld, B, C, C * J.translation());
  const LoopSpec ball = loop("ball", between);
  EXPECT_EQ(ball.kind, LoopKind::spherical);
  expect_closed(ball, B, C, C * J.translation());
  const Vector3d given(0.6, 0, 0.8);
  const LoopSpec in_joint = loop("revolute", between + axis("0.6 0 0.8", of_joint));
  EXPECT_EQ(in_joint.kind, LoopKind::revolute);
  expect_closed(in_joint, B, C, C * J.translation());
  EXPECT_LE((C.linear() * in_joint.axis - C.linear() * J.linear() * given).norm(), rounding);
  const LoopSpec in_model = loop("prismatic", between + axis("0.6 0 0.8", of_model));
  EXPECT_EQ(in_model.kind, LoopKind::prismatic);
  EXPECT_LE((C.linear() * in_model.axis - given).norm(), rounding);
  const LoopSpec newer =
      loop("continuous", between + "<axis><xyz expressed_in='__model__'>0.6 0 0.8</xyz></axis>");
  EXPECT_EQ(newer.kind, LoopKind::revolute);
  EXPECT_LE((newer.axis - in_model.axis).norm(), rounding);
  const LoopSpec two =
      loop("universal", between + axis("1 0 0", of_model) + axis("0 1 0", of_model, "axis2"));
  EXPECT_EQ(two.kind, LoopKind::universal);
  EXPECT_LE((C.linear() * two.axis - Vector3d::UnitX()).norm(), rounding);
  EXPECT_LE((C.linear() * two.axis2 - Vector3d::UnitY()).norm(), rounding);
}

TEST_F(UrdfGazebo, WhatDoesNotMoveIsTheParent) {
  const LoopSpec loop =
      this->loop("universal", pose(own) + ends("c", "world") + axis("1 0 0", of_model) +
                                  axis("0 1 0", of_model, "axis2"));
  EXPECT_EQ(loop.parent, "ground");
  EXPECT_EQ(loop.child, "c");
  expect_closed(loop, Affine3d::Identity(), C, J.translation());
  EXPECT_LE((C.linear() * loop.axis - Vector3d::UnitY()).norm(), rounding);
  EXPECT_LE((C.linear() * loop.axis2 - Vector3d::UnitX()).norm(), rounding);
}

TEST_F(UrdfGazebo, AnAxisOfTwoMeaningsIsRefused) {
  const auto sentence = refused(
      "r.urdf", robot("\n" + tag("revolute", pose(own) + ends("b", "c") + "\n" + axis("1 0 0"))));
  EXPECT_NE(sentence.find("joint 'l': <xyz> is another direction in the model than in the joint's "
                          "frame"),
            std::string::npos)
      << sentence;
  // One meaning: along the axis that the joint's frame is turned about against the model.
  const std::string straight = "<robot><link name='base'/>" + link("a") + link("b") +
                               joint("i", "base", "a", {{1, 0, 0, 0, 0, 0.3}}) +
                               joint("j", "base", "b", {{0, 1, 0, 0, 0, -0.4}}) +
                               tag("revolute", ends("a", "b") + axis("0 0 2")) + "</robot>";
  EXPECT_EQ(read("r.urdf", straight).loops.at(0).axis, Vector3d::UnitZ());
}

TEST_F(UrdfGazebo, SpringsOfJoints) {
  const Scene sprung = urdf(
      "<gazebo reference='j'><springStiffness>3</springStiffness><springReference>0.4"
      "</springReference></gazebo>");
  EXPECT_EQ(joint_of(sprung, "j").stiffness, 3);
  EXPECT_EQ(joint_of(sprung, "j").rest, 0.4);
  EXPECT_EQ(joint_of(sprung, "i").stiffness, 0);
  EXPECT_EQ(sprung.remarks, std::vector<std::string>{});
}

TEST_F(UrdfGazebo, LinksWithoutGravity) {
  const auto light = [&](const std::string& link, const std::string& how) {
    return "<gazebo reference='" + link + "'>" + how + "</gazebo>";
  };
  const std::string off = "<turnGravityOff>true</turnGravityOff>";
  Scene floating = urdf("");
  floating.gravity.setZero();
  EXPECT_LE(differs(urdf(light("a", off) + light("b", "<gravity>0</gravity>") + light("c", off)),
                    floating),
            1e-12);
  EXPECT_GE(differs(urdf(light("a", off) + light("b", "<gravity>0</gravity>")), floating), 1e-3);
  EXPECT_EQ(
      differs(urdf(light("a", "<turnGravityOff>0</turnGravityOff><gravity>1</gravity>")), urdf("")),
      0);
}

TEST_F(UrdfGazebo, TheRestIsToldAndWhatAddsBodiesIsRefused) {
  const auto remarks = [&](const std::string& inside) { return urdf(inside).remarks; };
  EXPECT_EQ(remarks("<gazebo reference='a'><material>Gazebo/Red</material></gazebo><gazebo/>"),
            (std::vector<std::string>{"left out: <gazebo> of <robot> (2)"}));
  EXPECT_EQ(remarks(tag("revolute",
                        ends("base", "b") +
                            axis("0 0 1", std::string(of_joint) +
                                              "<limit><lower>-1</lower></limit><dynamics><damping>2"
                                              "</damping></dynamics>"))),
            (std::vector<std::string>{
                "left out: limits of joints that close loops (1)",
                "left out: dampers, springs and friction of joints that close loops (1)"}));
  const auto wrong = [&](const std::string& inside, const std::string& expected) {
    const std::string sentence = refused("r.urdf", robot(inside));
    EXPECT_NE(sentence.find(expected), std::string::npos) << sentence;
  };
  wrong("<gazebo><link name='d'/></gazebo>", "<link> adds bodies to a URDF and is not read");
  wrong(tag("gearbox", ends("b", "c")), "joint 'l': <joint> type is 'gearbox', expected one of");
  wrong(tag("ball", ends("b", "cc")), "<child> is 'cc', expected the name of a link");
  wrong(tag("ball", ends("b", "b")), "joins link 'b' to itself, expected two links");
  wrong(tag("revolute", ends("b", "c")), "has no <axis>");
  wrong(tag("ball", "<pose relative_to='b'>0 0 0 0 0 0</pose>" + ends("b", "c")),
        "<pose> is relative to 'b', expected the child link");
}

}  // namespace
}  // namespace momenta::core_urdf_gazebo
