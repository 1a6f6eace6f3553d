// What SDF means: each kind of joint, each way to say a pose and an axis, against the same scene in
// TOML; and files that are wrong.

#include "equations/same_open_chain.h"
#include "equations/scene_folder.h"

#include <gtest/gtest.h>
#include <momenta/core/format/toml/write_scene.h>

namespace momenta::core_sdf {
namespace {

using namespace equations;
using Eigen::Vector3d;

constexpr double rounding = 1e-12;

std::string inertial(double mass) {
  return "<inertial><pose>0.1 0.2 0.3 0 0 0</pose><mass>" + std::to_string(mass) +
         "</mass><inertia><ixx>0.1</ixx><iyy>0.2</iyy><izz>0.25</izz><ixy>0.01</ixy></inertia>"
         "</inertial>";
}
std::string link(const std::string& name, const std::string& pose) {
  return "<link name='" + name + "'>" + pose + inertial(2) + "</link>\n";
}
std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& more) {
  return "<joint name='" + name + "' type='" + type + "'><parent>" + parent + "</parent><child>" +
         child + "</child>" + more + "</joint>\n";
}
std::string axis(const std::string& xyz, const std::string& more = "",
                 const std::string& name = "axis") {
  return "<" + name + "><xyz>" + xyz + "</xyz>" + more + "</" + name + ">";
}
std::string model(const std::string& inside, const std::string& version = "1.9") {
  return "<sdf version='" + version + "'><model name='m'>\n" + inside + "</model></sdf>";
}

constexpr const char* body_a = "<pose>0.1 0.2 0.3 0.3 -0.2 0.4</pose>";
constexpr const char* body_b = "<pose relative_to='a'>0.5 0.1 -0.3 0.2 0.6 -0.1</pose>";

class Sdf : public SceneFolder {
 protected:
  Scene sdf(const std::string& inside, const std::string& version = "1.9") const {
    return read("m.sdf", model(inside, version));
  }
  /// a on the ground by a hinge about its y axis, b on a by `joint`; links as body_a, body_b.
  Scene chain(const std::string& j) const {
    return sdf(link("a", body_a) + link("b", body_b) +
               joint("i", "revolute", "world", "a", axis("0 1 0")) + j);
  }
  Scene toml(const std::string& j) const {
    const std::string body =
        "mass = 2\ncom = [0.1, 0.2, 0.3]\ninertia = [0.1, 0.2, 0.25, 0.01, 0, 0]\n";
    return read("m.toml", "gravity = [0, 0, -9.8]\n[[body]]\nname = 'a'\n" + body +
                              "[[body]]\nname = 'b'\n" + body +
                              "[[joint]]\nname = 'i'\nkind = 'revolute'\nchild = 'a'\naxis = 'y'\n"
                              "origin.parent = [0.1, 0.2, 0.3]\nrotation.rpy = [0.3, -0.2, 0.4]\n" +
                              j);
  }
  /// The joint of b on a, both frames in b's origin.
  Scene twin(const std::string& keys) const {
    return toml(
        "[[joint]]\nname = 'j'\nparent = 'a'\nchild = 'b'\norigin.parent = [0.5, 0.1, "
        "-0.3]\nrotation.rpy = [0.2, 0.6, -0.1]\n" +
        keys);
  }
};

// A link without gravity has a force at its centre of mass that takes its weight back.
TEST_F(Sdf, LinksWithoutGravity) {
  const std::string j = joint("j", "revolute", "a", "b", axis("1 2 2"));
  const auto hung = [&](const std::string& a, const std::string& b) {
    return sdf(link("a", std::string(body_a) + a) + link("b", std::string(body_b) + b) +
               joint("i", "revolute", "world", "a", axis("0 1 0")) + j);
  };
  const std::string off = "<gravity>false</gravity>";
  Scene floating = hung("", "");
  floating.gravity.setZero();
  EXPECT_LE(differs(hung(off, off), floating), rounding);
  EXPECT_GE(differs(hung(off, ""), floating), 1e-3);
  EXPECT_EQ(differs(hung("<gravity>1</gravity>", ""), hung("", "")), 0);
}

// A revolute or sliding joint between 0 and 0 is a fixed one; about two axes, or as a mimic, it is
// not.
TEST_F(Sdf, JointsLockedByTheirLimitsAreFixed) {
  const std::string lock = "<limit><lower>0</lower><upper>0</upper></limit>",
                    sprung = "<dynamics><damping>3</damping></dynamics>";
  const Scene welded = chain(joint("j", "fixed", "a", "b", ""));
  for (const char* type : {"revolute", "prismatic"}) {
    const Scene locked = chain(joint("j", type, "a", "b", axis("1 2 2", lock + sprung)));
    EXPECT_EQ(differs(locked, welded), 0);
    EXPECT_EQ(locked.remarks,
              (std::vector<std::string>{"welded: joints whose limits are both 0 (1)"}));
  }
  EXPECT_EQ(OpenChain(chain(joint("j", "continuous", "a", "b", axis("1 2 2", lock)))).nv(), 2);
  const Scene two =
      chain(joint("j", "universal", "a", "b", axis("1 0 0", lock) + axis("0 1 0", lock, "axis2")));
  EXPECT_EQ(OpenChain(two).nv(), 3);
  EXPECT_EQ(two.remarks, (std::vector<std::string>{"left out: joint limits without a range (2)"}));
  EXPECT_EQ(chain(joint("j", "continuous", "a", "b",
                        axis("1 2 2", "<limit><lower>-1</lower><upper>1</upper></limit>")))
                .remarks,
            (std::vector<std::string>{
                "left out: limits of continuous joints, which SDF does not limit (1)"}));
  EXPECT_EQ(chain(joint("j", "ball", "a", "b",
                        axis("1 0 0", "<dynamics><damping>1</damping></dynamics>")))
                .remarks,
            (std::vector<std::string>{
                "left out: springs and dampers of joints of several degrees of freedom (1)"}));
}

// The joints of a gear are known by axes that files round: 1.5708 is π/2 to 4e-6.
TEST_F(Sdf, GearsKnowTheirJointsByRoundedAxes) {
  const auto geared = [&](const std::string& pitch) {
    const std::string out = "<pose>1 0 0 0 " + pitch + " 0</pose>";
    return model(link("base", "") + link("in", "") + link("out", out) +
                 joint("h", "fixed", "world", "base", "") +
                 joint("i", "revolute", "base", "in", axis("1 0 0")) +
                 joint("o", "revolute", "base", "out", axis("0 0 1")) +
                 joint("g", "gearbox", "in", "out",
                       axis("0 0 1") + axis("0 0 1", "", "axis2") +
                           "<gearbox_ratio>5</gearbox_ratio><gearbox_reference_body>base"
                           "</gearbox_reference_body>"));
  };
  const Scene scene = read("m.sdf", geared("1.5708"));
  ASSERT_EQ(scene.loops.size(), 1U);
  EXPECT_EQ(scene.loops[0].joints, (std::vector<std::string>{"i", "o"}));
  EXPECT_EQ(scene.loops[0].ratios, (std::vector<double>{5, 1}));
  EXPECT_NE(refused("m.sdf", geared("1.56")).find("has no revolute joint about the same axis"),
            std::string::npos);
}

// A link called world without inertia is the ground, which holds the model where it stands;
// versions from 1.7 on keep the name.
TEST_F(Sdf, ALinkCalledWorldIsTheGround) {
  const std::string held = joint("i", "revolute", "world", "a", axis("0 1 0"));
  const auto sdf = [&](const std::string& inside) { return this->sdf(inside, "1.6"); };
  const Scene own =
      sdf("<link name='world'><pose>0 0 0.2 0 0 0</pose></link>" + link("a", body_a) + held);
  EXPECT_EQ(differs(own, sdf(link("a", body_a) + held)), 0);
  EXPECT_EQ(own.bodies.size(), 1U);
  EXPECT_EQ(
      own.remarks,
      (std::vector<std::string>{"taken as the ground: links called world without <inertial> (1)"}));
  for (const std::string& other : {model(link("world", "") + link("a", body_a) + held, "1.6"),
                                   model("<link name='world'/>" + link("a", body_a) + held)})
    EXPECT_NE(refused("m.sdf", other).find("is called 'world', which is the ground's name"),
              std::string::npos);
}

TEST_F(Sdf, JointsOfEveryType) {
  const auto same = [&](const std::string& type, const std::string& more, const std::string& keys) {
    SCOPED_TRACE(type);
    EXPECT_LE(differs(chain(joint("j", type, "a", "b", more)), twin(keys)), rounding);
  };
  const std::string dynamics =
      "<dynamics><damping>0.7</damping><spring_stiffness>3</spring_stiffness>"
      "<spring_reference>0.2</spring_reference></dynamics>";
  const std::string sprung = "stiffness = 3\nrest = 0.2\ndamping = 0.7\n";
  same("revolute", axis("1 2 2", dynamics), "kind = 'revolute'\naxis = [1, 2, 2]\n" + sprung);
  same("continuous", axis("0 0 -3"), "kind = 'revolute'\naxis = '-z'\n");
  same("prismatic", axis("0 1 1", dynamics), "kind = 'prismatic'\naxis = [0, 1, 1]\n" + sprung);
  same("fixed", "", "kind = 'weld'\n");
  same("ball", "", "kind = 'spherical'\n");
  const std::string universal = "kind = 'universal'\naxis = [1, 2, 2]\naxis2 = [0, 1, 1]\n";
  same("universal", axis("1 2 2") + axis("0 1 1", "", "axis2"), universal);
  same("revolute2", axis("1 2 2") + axis("0 1 1", "", "axis2"), universal);
  // 0.5 m a turn; the older word has rad a metre, and the other hand
  same("screw", axis("0 0 1") + "<screw_thread_pitch>0.5</screw_thread_pitch>",
       "kind = 'helical'\naxis = 'z'\npitch = 0.079577471545947668\n");
  same("screw", axis("0 0 1") + "<thread_pitch>-4</thread_pitch>",
       "kind = 'helical'\naxis = 'z'\npitch = 0.25\n");
  same("revolute",
       axis("0 0 1") +
           "<drake:rotor_inertia>0.5</drake:rotor_inertia>"
           "<drake:gear_ratio>4</drake:gear_ratio>",
       "kind = 'revolute'\nrotor_inertia = 8\n");
}

// The joint's frame away from its child, and from all links.
TEST_F(Sdf, JointsWhereTheirPoseIs) {
  const Scene twin = toml(
      "[[joint]]\nname = 'j'\nkind = 'prismatic'\nparent = 'a'\nchild = 'b'\naxis = [1, 2, 2]\n"
      "origin.parent = [0.5, 0.1, -0.3]\nrotation.rpy = [0.2, 0.6, -0.1]\n");
  const Vector3d o(0.2, -0.1, 0.4);
  const Scene scene =
      chain(joint("j", "revolute", "a", "b", "<pose>0.2 -0.1 0.4 0 0 0.5</pose>" + axis("1 0 0")));
  const JointSpec& j = joint_of(scene, "j");
  EXPECT_LE((j.origin_child - o).norm(), 1e-15);
  EXPECT_LE((j.axis - Vector3d(std::cos(0.5), std::sin(0.5), 0)).norm(), 1e-15);
  const JointSpec& base = joint_of(twin, "j");
  EXPECT_LE((j.origin_parent - (base.origin_parent + base.rotation * o)).norm(), 1e-15);
  // the same point, said in the frame of a
  const Vector3d p = j.origin_parent;
  const Scene other =
      chain(joint("j", "revolute", "a", "b",
                  "<pose relative_to='a'>" + std::to_string(p[0]) + " " + std::to_string(p[1]) +
                      " " + std::to_string(p[2]) + " 0 0 0</pose>" +
                      "<axis><xyz expressed_in='b'>1 2 2</xyz></axis>"));
  EXPECT_LE((joint_of(other, "j").origin_child - o).norm(), 2e-6);  // six digits were written
  EXPECT_LE((joint_of(other, "j").axis - Vector3d(1, 2, 2) / 3).norm(), 1e-15);
}

TEST_F(Sdf, AxesInTheModelsFrame) {
  const auto along = [&](const std::string& how, const std::string& version) {
    const std::string a =
        link("a", "<pose>1 2 3 0.4 0.5 0.6</pose>") + joint("i", "revolute", "world", "a", how);
    const Scene scene =
        read("m.sdf", "<sdf version='" + version + "'><model name='m'><pose>0 0 0 0.3 0 0</pose>" +
                          a + "</model></sdf>");
    return Vector3d(joint_of(scene, "i").rotation * joint_of(scene, "i").axis);  // in the world
  };
  const Vector3d expected(0, -std::sin(0.3), std::cos(0.3));
  for (const Vector3d& z :
       {along("<axis><xyz>0 0 1</xyz></axis>", "1.4"),
        along("<axis><use_parent_model_frame>1</use_parent_model_frame><xyz>0 0 1</xyz></axis>",
              "1.6"),
        along("<axis><xyz expressed_in='__model__'>0 0 1</xyz></axis>", "1.7")})
    EXPECT_LE((z - expected).norm(), 1e-15);
  EXPECT_LE(
      (along("<axis><xyz expressed_in='world'>0 0 1</xyz></axis>", "1.10") - Vector3d::UnitZ())
          .norm(),
      1e-15);
  EXPECT_GE((along("<axis><xyz>0 0 1</xyz></axis>", "1.5") - expected).norm(), 0.1);
}

// One place of one link, by every way to say it.
TEST_F(Sdf, PosesInManyWords) {
  const std::string there = "0.1 0.2 0.3 0.4 0.5 0.6";
  const auto at = [&](const std::string& inside, const std::string& attributes = "") {
    const Scene scene =
        read("m.sdf", "<sdf version='1.11'><model name='m'" + attributes + ">" + inside +
                          "<link name='other'><pose>1 1 1 0 0 0</pose></link></model></sdf>");
    for (const JointSpec& joint : scene.joints)
      if (joint.child == "a" || joint.child == "inner::a") return joint.position;
    throw std::out_of_range("a");
  };
  const std::vector<double> expected = at(link("a", "<pose>" + there + "</pose>"));
  ASSERT_EQ(expected.size(), 7U);
  EXPECT_EQ(expected[1], 0.2);
  const auto number = [&](std::size_t i) {
    std::string digits(32, ' ');
    digits.resize(static_cast<std::size_t>(std::snprintf(digits.data(), 32, "%.17g", expected[i])));
    return digits + " ";
  };
  const std::string wxyz = number(4) + number(5) + number(6) + number(3);
  const std::vector<double> ways[] = {
      at(link("a",
              "<pose degrees='true'>0.1 0.2 0.3 22.918311805232932 28.647889756541161 "
              "34.377467707849391</pose>")),
      at(link("a", "<pose rotation_format='quat_xyzw'>0.1 0.2 0.3 " + wxyz + "</pose>")),
      at(link("a", "<pose relative_to='f'/>") + "<frame name='f'><pose>" + there +
         "</pose></frame>"),
      at(link("a", "<pose relative_to='f'>-1 -1 -1 0 0 0</pose>") +
         "<frame name='f' attached_to='other'><pose>" + "0.1 0.2 0.3 0 0 0" + "</pose></frame>"),
      at("<model name='inner'><pose>" + there + "</pose>" + link("a", "") + "</model>"),
      at(link("a", ""), " placement_frame='a'"),
      at(link("a",
              "<pose degrees='1'>0.1 0.2 0.3 22.918311805232932 28.647889756541161 "
              "34.377467707849391</pose>")),
      at(link("a", "<pose degrees='0'>" + there + "</pose>")),
  };
  for (int i : {0, 1, 2, 4, 6, 7})
    for (std::size_t k = 0; k < 7; ++k) EXPECT_NEAR(ways[i][k], expected[k], 1e-14) << i;
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(ways[3][k], expected[k], 1e-15);
  EXPECT_EQ(ways[5], (std::vector<double>{0, 0, 0, 1, 0, 0, 0}));
  // the model's pose places that frame of it
  const Scene placed =
      read("p.sdf", "<sdf version='1.8'><model name='m' placement_frame='a'><pose>" + there +
                        "</pose>" + link("a", "<pose>3 1 2 1 2 3</pose>") + "</model></sdf>");
  for (std::size_t k = 0; k < 7; ++k)
    EXPECT_NEAR(joint_of(placed, "root").position[k], expected[k], 1e-14);
}

// The tree goes from the ground outwards, whatever is called parent.
TEST_F(Sdf, JointsWrittenFromTheFarSide) {
  const auto same = [&](const std::string& type, const std::string& more, const std::string& keys) {
    SCOPED_TRACE(type);
    const Scene back = chain(joint("j", type, "b", "a", "<pose relative_to='b'/>" + more));
    EXPECT_EQ(joint_of(back, "j").parent, "a");
    EXPECT_LE(differs(back, twin(keys)), rounding);
  };
  // the axes in the frame of b, which the scene's joint has
  same("revolute", axis("1 2 2", "<dynamics><spring_stiffness>2</spring_stiffness></dynamics>"),
       "kind = 'revolute'\naxis = [-1, -2, -2]\nstiffness = 2\n");
  same("prismatic", axis("0 1 1"), "kind = 'prismatic'\naxis = [0, -1, -1]\n");
  same("screw", axis("0 0 1") + "<screw_thread_pitch>1</screw_thread_pitch>",
       "kind = 'helical'\naxis = '-z'\npitch = 0.15915494309189534\n");
  same("universal", axis("1 2 2") + axis("0 1 1", "", "axis2"),
       "kind = 'universal'\naxis = [0, -1, -1]\naxis2 = [-1, -2, -2]\n");
}

// Springs on the two axes of a universal joint: two hinges with a body without mass between.
TEST_F(Sdf, SpringsOfUniversalJoints) {
  const auto dynamics = [](const std::string& k, const std::string& c, const std::string& rest,
                           const std::string& friction) {
    return "<dynamics><spring_stiffness>" + k + "</spring_stiffness><damping>" + c +
           "</damping><spring_reference>" + rest + "</spring_reference><friction>" + friction +
           "</friction></dynamics>";
  };
  const Scene scene = chain(joint("j", "universal", "a", "b",
                                  axis("1 2 2", dynamics("3", "0.1", "0.4", "0.5")) +
                                      axis("0 1 1", dynamics("2", "0.4", "-0.3", "0.7"), "axis2")));
  const Scene two = toml(
      "[[body]]\nname = 'x'\nmass = 0\n[[joint]]\nname = 'j'\nparent = 'a'\nchild = 'x'\n"
      "kind = 'revolute'\norigin.parent = [0.5, 0.1, -0.3]\nrotation.rpy = [0.2, 0.6, -0.1]\n"
      "axis = [1, 2, 2]\nstiffness = 3\ndamping = 0.1\nrest = 0.4\nfriction = 0.5\n"
      "[[joint]]\nname = 'k'\nparent = 'x'\nchild = 'b'\nkind = 'revolute'\naxis = [0, 1, 1]\n"
      "damping = 0.4\nstiffness = 2\nrest = -0.3\nfriction = 0.7\n");
  EXPECT_LE(differs(scene, two), rounding);
}

TEST_F(Sdf, ModelsFloatUnlessTheyAreHeld) {
  const std::string two =
      link("a", body_a) + link("b", body_b) + joint("j", "revolute", "a", "b", axis("0 0 1"));
  const Scene free = sdf(two);
  EXPECT_EQ(joint_of(free, "root").kind, JointKind::free);
  EXPECT_EQ(joint_of(free, "root").child, "a");
  EXPECT_EQ(joint_of(free, "root").position[2], 0.3);
  EXPECT_EQ(free.gravity, Vector3d(0, 0, -9.8));
  const Scene canonical = read(
      "c.sdf", "<sdf version='1.7'><model name='m' canonical_link='b'>" + two + "</model></sdf>");
  EXPECT_EQ(joint_of(canonical, "root").child, "b");
  const Scene still = sdf("<static>true</static>" + two);
  EXPECT_EQ(OpenChain(still).nv(), 0);
  EXPECT_EQ(still.remarks,
            std::vector<std::string>{"left out: joints between links that do not move (1)"});
  const Scene world =
      read("w.world",
           "<sdf version='1.6'><world name='w'><gravity>0 0 -1.6</gravity>"
           "<model name='p'>" +
               two + "</model><model name='q'><static>1</static>" + two + "</model></world></sdf>");
  EXPECT_EQ(world.gravity, Vector3d(0, 0, -1.6));
  EXPECT_EQ(OpenChain(world).nv(), 7);
  EXPECT_EQ(world.bodies.at(0).name, "p::a");
  EXPECT_EQ(world.bodies.at(3).name, "q::b");
}

TEST_F(Sdf, WhatItTakesForGrantedAndLeavesOutIsTold) {
  const Scene scene = sdf(
      "<plugin name='x'/><link name='a'><visual name='v'/><sensor name='s' type='imu'/></link>" +
      joint("i", "revolute", "world", "a",
            axis("0 0 1",
                 "<limit><lower>0</lower></limit>"
                 "<dynamics><friction>1</friction></dynamics>")));
  EXPECT_EQ(scene.bodies.at(0).mass, 1);
  EXPECT_EQ(scene.bodies.at(0).inertia, Eigen::Matrix3d::Identity());
  EXPECT_EQ(scene.remarks,
            (std::vector<std::string>{
                "left out: sensors (1)", "left out: visual shapes without a geometry (1)",
                "taken as SDF has it: 1 kg and 1 kg m² of links without <inertial> (1)",
                "taken as smooth friction: friction of joints (1)",
                "left out: <plugin> of <model> (1)"}));
}

TEST_F(Sdf, WrongFiles) {
  const auto expect = [&](const std::string& text, const std::string& words) {
    const std::string sentence = refused("w.sdf", text);
    EXPECT_NE(sentence.find(words), std::string::npos) << sentence;
  };
  const auto wrong = [&](const std::string& inside, const std::string& words) {
    expect(model(link("a", "") + inside), words);
  };
  expect("<sdf><model name='m'/></sdf>", ":1: <sdf> has no version, expected one");
  expect("<sdf version='2.0'/>", "version is '2.0', expected 1.4 to 1.12");
  expect("<sdf version='1.7'/>", "<sdf> has 0 <world> and 0 <model>, expected one of them");
  expect("<sdf version='1.7'><model name='m'/></sdf>",
         ":1: model 'm': <model> has no <link>, expected at least one");
  wrong("<include><uri>x</uri></include>", ":3: <uri> is 'x', which does not exist, expected a");
  wrong(link("b", "<pose>1 2 3</pose>"), ":3: link 'b': <pose> has 3 numbers, expected 6");
  wrong(link("b", "<pose>1 2 3 nan 0 0</pose>"), "<pose> has 'nan', expected finite numbers");
  wrong(link("b", "<pose rotation_format='quat_xyzw'>0 0 0 0 0 0 2</pose>"),
        "has a quaternion of norm 2, expected 1 within 1e-6");
  wrong(link("b", "<pose degrees='yes'>0 0 0 0 0 0</pose>"),
        "<pose> degrees is 'yes', expected one of: false, true, 0, 1");
  wrong(link("b", "<pose relative_to='c'/>"), "link 'b': <link> names 'c', expected a link, joint");
  wrong(link("b", "<pose relative_to='c'/>") + link("c", "<pose relative_to='b'/>"),
        "is relative to frames that are relative to each other in a cycle");
  wrong(link("a", ""), "is the second called 'a'");
  wrong("<frame name='f' attached_to='g'/><frame name='g' attached_to='f'/>" +
            joint("j", "fixed", "world", "f", ""),
        "in a cycle");
  wrong(joint("j", "hinge", "world", "a", ""),
        "joint 'j': <joint> type is 'hinge', expected one of: revolute, continuous, prismatic, "
        "fixed, ball, universal, revolute2, screw, gearbox");
  wrong(joint("j", "revolute", "world", "a", ""), "joint 'j': <joint> has no <axis>, expected one");
  wrong(joint("j", "revolute", "world", "a", axis("0 0 0")), "<xyz> is the zero vector");
  wrong(joint("j", "revolute", "b", "a", axis("0 0 1")), "<parent> names 'b', expected a link");
  wrong(joint("j", "revolute", "a", "a", axis("0 0 1")), "joins link 'a' to itself");
  wrong(joint("j", "screw", "world", "a", axis("0 0 1")), "has no <screw_thread_pitch>");
  wrong(joint("j", "universal", "world", "a", axis("0 0 1") + axis("0 0 2", "", "axis2")),
        "has axes that are parallel");
  wrong("<link name='b'><inertial auto='true'/></link>",
        "<inertial> auto is true, expected a mass");
  EXPECT_EQ(
      read("g.sdf", "<sdf version='1.9'><model name='m'>" + link("ground", "") + "</model></sdf>")
          .bodies.at(0)
          .name,
      "ground 2");
  const std::string spring = "<dynamics><spring_stiffness>1</spring_stiffness></dynamics>";
  wrong(joint("j", "revolute", "world", "a", axis("0 0 1", spring)) +
            joint("k", "revolute", "world", "a", axis("0 0 1", spring)),
        "joint 'k': <joint> closes a loop of joints that all have springs");
  wrong(joint("j", "gearbox", "world", "a",
              axis("0 0 1") + axis("0 0 1", "", "axis2") +
                  "<gearbox_ratio>2</gearbox_ratio><gearbox_reference_body>a"
                  "</gearbox_reference_body>"),
        "has no revolute joint about the same axis with the reference body 'a'");
  wrong(joint("j", "revolute", "world", "a", axis("0 0 1", "<mimic joint='a'/>")),
        "<mimic> names 'm::a', expected a joint");
}

}  // namespace
}  // namespace momenta::core_sdf
