// Nothing of a robot's file is dropped without a remark: what the tables of elements list, what
// readers tell, and the table of the documents.

#include "equations/scene_folder.h"

#include <momenta/core/format/xml/known_elements.h>
#include <momenta/core/open_chain/open_chain.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <sstream>

namespace momenta::core_known_elements {
namespace {

using reading::KnownElement;
using reading::mjcf_actuator_elements;
using reading::mjcf_elements;
using reading::sdf_elements;
using reading::urdf_elements;
using Remarks = std::vector<std::string>;

class KnownElements : public equations::SceneFolder {
 protected:
  Remarks mjcf(const std::string& body, const std::string& before = "",
               const std::string& after = "", const ReadOptions& o = {}) const {
    return read("m.xml",
                "<mujoco>" + before +
                    "<worldbody><body name='a'><inertial pos='0 0 0' mass='1' "
                    "diaginertia='1 1 1'/>" +
                    body + "</body></worldbody>" + after + "</mujoco>",
                o)
        .remarks;
  }
  Remarks urdf(const std::string& link, const std::string& joint = "",
               const std::string& after = "") const {
    return read("r.urdf",
                "<robot name='r'><link name='base'/><link name='a'><inertial><mass value='1'/>"
                "<inertia ixx='1' iyy='1' izz='1'/></inertial>" +
                    link +
                    "</link><joint name='j' "
                    "type='revolute'><parent link='base'/><child link='a'/>" +
                    joint + "</joint>" + after + "</robot>")
        .remarks;
  }
  Remarks sdf(const std::string& link, const std::string& joint = "",
              const std::string& more = "") const {
    return read("s.sdf", "<sdf version='1.9'><model name='m'>" + more +
                             "<link name='a'><inertial><mass>1"
                             "</mass></inertial>" +
                             link +
                             "</link><joint name='j' type='revolute'><parent>"
                             "world</parent><child>a</child><axis><xyz>0 0 1</xyz>" +
                             joint + "</axis></joint></model></sdf>")
        .remarks;
  }
};

TEST_F(KnownElements, OfMjcf) {
  const std::string hinge = "<joint name='h'/>";
  EXPECT_EQ(mjcf(hinge), Remarks{});
  // Without effect on motion: nothing is said.
  EXPECT_EQ(mjcf("<joint name='h' group='3' margin='1' user='1 2' solreflimit='1 1'/>"
                 "<site name='s' size='1' type='box' user='1'/>",
                 "<compiler fitaabb='true' texturedir='x'/><option timestep='.1' cone='elliptic'>"
                 "<flag contact='disable' warmstart='disable'/></option>"
                 "<asset><texture name='t' builtin='flat'/><material name='m' shininess='1'/>"
                 "</asset>"),
            Remarks{});
  // With one, left out: told, counted by attribute and element.
  EXPECT_EQ(
      mjcf("<joint name='h' actuatorgravcomp='true'/><joint actuatorgravcomp='true'/>"
           "<joint actuatorgravcomp='false'/><plugin plugin='p'/>"),
      (Remarks{"left out: actuatorgravcomp of <joint> (2)", "left out: <plugin> of <body> (1)"}));
  EXPECT_EQ(mjcf(hinge, "<compiler alignfree='true'/>",
                 "<equality><joint joint1='h' solref='1 1'"
                 "/></equality>"),
            (Remarks{"left out: alignfree of <compiler> (1)", "left out: solref of <joint> (1)"}));
  // No part of the format: told with its name.
  EXPECT_EQ(mjcf("<joint name='h' dampng='1'/>"),
            Remarks{"not known, left out: attribute 'dampng' of <joint> (1)"});
  EXPECT_EQ(mjcf(hinge, "<default><joint frictionlos='1'/></default><unheard/>"),
            (Remarks{"not known, left out: attribute 'frictionlos' of <joint> (1)",
                     "left out: <unheard> of <mujoco> (1)"}));
}

TEST_F(KnownElements, OfActuatorsUnderControl) {
  const std::string acts =
      "<actuator><motor joint='h' damping='2' group='1' nsense='1'/></actuator>";
  ReadOptions o;
  o.controls = {"1"};
  EXPECT_EQ(mjcf("<joint name='h'/>", "", acts, o),
            (Remarks{"left out: damping of <motor> (1)",
                     "not known, left out: attribute 'nsense' of <motor> (1)"}));
  EXPECT_EQ(mjcf("<joint name='h'/>", "", acts),
            Remarks{"left out: actuators, which --control lets act (1)"});
}

TEST_F(KnownElements, OfUrdf) {
  const std::string range = "<limit lower='-1' upper='1' effort='3' velocity='2'/>";
  EXPECT_EQ(urdf("", range, "<material name='m'/>"), Remarks{});
  EXPECT_EQ(
      urdf("<contact/>", range + "<safety_controller k_velocity='1'/><calibration rising='0'/>",
           "<gazebo/>"),
      (Remarks{"left out: <contact> of <link> (1)", "left out: <safety_controller> of <joint> (1)",
               "left out: <gazebo> of <robot> (1)"}));
  EXPECT_EQ(urdf("", "<limit lower='-1' uper='1'/><dynamics damping='1' stiffness='2'/>"),
            (Remarks{"not known, left out: attribute 'uper' of <limit> (1)",
                     "not known, left out: attribute 'stiffness' of <dynamics> (1)"}));
}

TEST_F(KnownElements, OfSdf) {
  EXPECT_EQ(sdf("<self_collide>true</self_collide>",
                "<limit><lower>-1</lower><upper>1</upper><effort>3</effort></limit>",
                "<allow_auto_disable>false</allow_auto_disable>"),
            Remarks{});
  EXPECT_EQ(
      sdf("<velocity_decay><linear>1</linear></velocity_decay>",
          "<limit><lower>-1</lower><unheard>1</unheard><stiffness>1e4</stiffness></limit>",
          "<gripper name='g'/>"),
      (Remarks{"left out: <gripper> of <model> (1)", "left out: <velocity_decay> of <link> (1)",
               "left out: <unheard> of <limit> (1)", "left out: <stiffness> of <limit> (1)"}));
}

// --- what readers take that was told or dropped before ---

TEST_F(KnownElements, FlagsAndAutolimits) {
  const auto joint = [&](const std::string& keys, const std::string& before) {
    return read("m.xml", "<mujoco>" + before + "<worldbody><body><joint name='h' " + keys +
                             "/><geom size='1'/></body></worldbody></mujoco>")
        .joints[0];
  };
  const std::string keys = "range='-10 10' frictionloss='.5'";
  EXPECT_TRUE(joint(keys, "").limits);
  EXPECT_EQ(joint(keys, "").friction, .5);
  EXPECT_FALSE(joint(keys, "<compiler autolimits='false'/>").limits);
  EXPECT_TRUE(joint(keys + " limited='true'", "<compiler autolimits='false'/>").limits);
  EXPECT_FALSE(joint(keys, "<option><flag limit='disable'/></option>").limits);
  EXPECT_EQ(joint(keys, "<option><flag frictionloss='disable'/></option>").friction, 0);
  // What all constraints are is left out by one flag.
  const JointSpec free = joint(keys, "<option><flag constraint='disable'/></option>");
  EXPECT_FALSE(free.limits);
  EXPECT_EQ(free.friction, 0);
}

// What a flag turns off does not act: loops, springs, dampers, and what takes weights back.
TEST_F(KnownElements, FlagsTurnOffWhatTheySay) {
  const auto model = [&](const std::string& flags) {
    return read("f.xml", "<mujoco><option><flag " + flags +
                             "/></option><worldbody><body name='a'><joint name='h' stiffness='2' "
                             "damping='3'/><joint type='slide' axis='1 0 0' springdamper='.1 1'/>"
                             "<geom size='1'/></body><body gravcomp='1'><joint type='ball' "
                             "damping='1'/><geom size='1'/></body></worldbody><tendon><fixed "
                             "stiffness='1' damping='4'><joint joint='h' coef='1'/></fixed>"
                             "</tendon><equality><connect body1='a' anchor='1 0 0'/></equality>"
                             "</mujoco>");
  };
  const Scene whole = model("");
  EXPECT_EQ(whole.loops.size(), 1U);
  EXPECT_EQ(whole.forces.size(), 3U);
  EXPECT_EQ(model("equality='disable'").loops.size(), 0U);
  EXPECT_EQ(model("constraint='disable'").loops.size(), 0U);
  EXPECT_EQ(model("constraint='disable'").forces.size(), 3U);
  const Scene no_springs = model("spring='disable'"), no_dampers = model("damper='disable'");
  EXPECT_EQ(no_springs.joints[0].stiffness, 0);
  EXPECT_EQ(no_springs.joints[0].damping, 3);
  EXPECT_EQ(no_springs.joints[1].stiffness, 0);
  EXPECT_GT(no_springs.joints[1].damping, 0);
  EXPECT_EQ(no_dampers.joints[0].stiffness, 2);
  EXPECT_EQ(no_dampers.joints[0].damping, 0);
  EXPECT_EQ(no_dampers.forces.size(), 2U);
  EXPECT_TRUE(model("passive='disable'").forces.empty());
}

// What a format has elsewhere, or others put into its files, is no misspelling.
TEST_F(KnownElements, WhatIsNearToNothingGoesThrough) {
  EXPECT_EQ(urdf("<sensor name='s'/>", "", "<ros2_control name='c'/><limb/><drake:lnik/>").size(),
            4U);
  EXPECT_EQ(urdf("<visual><geometri/><meterial/></visual>").size(), 3U);
  EXPECT_NE(refused("s.sdf", "<sdf version='1.9'><model name='m'><lnik name='a'/></model></sdf>")
                .find("did you mean 'link'?"),
            std::string::npos);
}

// The controls of a key act where --control gives none by name; its time is told.
TEST_F(KnownElements, KeysHaveTimeAndControls) {
  const std::string text =
      "<mujoco><worldbody><body><joint name='h'/><geom size='1'/></body></worldbody><actuator>"
      "<motor name='p' joint='h'/><motor name='q' joint='h' ctrlrange='-1 1'/></actuator><keyframe>"
      "<key name='k' time='3' ctrl='2 0.5'/></keyframe></mujoco>";
  const auto torque = [&](const std::vector<std::string>& controls, const std::string& key) {
    double sum = 0;
    ReadOptions o;
    o.controls = controls;
    o.key = key;
    for (const ForceSpec& f : read("k.xml", text, o).forces) sum += f.value;
    return sum;
  };
  EXPECT_EQ(torque({"p=7"}, "k"), 7 + 0.5);  // q at that of the key
  EXPECT_EQ(torque({"p=7"}, ""), 7);         // q at 0
  EXPECT_EQ(torque({"4"}, "k"), 4 + 1);      // both at 4, q clamped
  ReadOptions o;
  o.key = "k";
  EXPECT_EQ(read("k.xml", text, o).remarks,
            (Remarks{"left out: geoms as shapes to touch (1)",
                     "left out: actuators, which --control lets act (2)",
                     "left out: time of the key: runs begin at 0, and nothing depends on time (1)",
                     "left out: ctrl of the key, which --control lets act (1)"}));
  // One that no run starts from is as wrong.
  std::string of_another_model = text;
  of_another_model.replace(text.find("</keyframe>"), 0, "<key name='short' ctrl='2'/>");
  EXPECT_NE(refused("k.xml", of_another_model, o)
                .find("key 'short': <key> ctrl has 1 numbers, expected 2 for the actuators"),
            std::string::npos);
}

TEST_F(KnownElements, WhatDoesNotComeWithAnAttachedModelIsTold) {
  write("part.xml",
        "<mujoco><option timestep='1'/><worldbody><body name='b'><joint name='j'/><geom size='1'/>"
        "</body></worldbody><keyframe><key qpos='1'/><key qpos='2'/></keyframe><sensor>"
        "<jointpos joint='j'/></sensor></mujoco>");
  const Scene scene = read("whole.xml",
                           "<mujoco><asset><model name='p' file='part.xml'/></asset><worldbody>"
                           "<attach model='p' body='b' prefix='x'/></worldbody></mujoco>");
  EXPECT_EQ(scene.remarks, (Remarks{"left out: <option> of attached models (1)",
                                    "left out: keys of models of which a part is attached (2)",
                                    "left out: <sensor> of attached models (1)",
                                    "left out: geoms as shapes to touch (1)"}));
}

// A key of a model that is attached as a whole is of its joints, wherever they stand among others.
TEST_F(KnownElements, KeysOfAttachedModels) {
  write("part.xml",
        "<mujoco><worldbody><body name='b'><joint name='j' ref='90'/><joint name='k' type='ball'/>"
        "<geom size='1'/></body></worldbody><keyframe><key name='up' qpos='1 0 3 0 4' qvel='5 6 7 "
        "8'/></keyframe></mujoco>");
  const std::string whole =
      "<mujoco><asset><model name='p' file='part.xml'/></asset><worldbody><body name='o'>"
      "<joint name='own'/><geom size='1'/></body><attach model='p' prefix='x'/></worldbody>"
      "<keyframe><key name='here' qpos='7 1 1 0 0 0'/></keyframe></mujoco>";
  ReadOptions options;
  options.key = "xup";
  const Scene scene = read("whole.xml", whole, options);
  const auto joint = [&](const std::string& name) -> const JointSpec& {
    return *std::find_if(scene.joints.begin(), scene.joints.end(),
                         [&](const JointSpec& j) { return j.name == name; });
  };
  EXPECT_TRUE(joint("own").position.empty());
  EXPECT_NEAR(joint("xj").position.at(0), 1 - std::acos(0), 1e-15);
  EXPECT_EQ(joint("xk").position, (std::vector<double>{0, 0.6, 0, 0.8}));
  EXPECT_EQ(joint("xj").velocity, std::vector<double>{5});
  EXPECT_EQ(joint("xk").velocity, (std::vector<double>{6, 7, 8}));
  options.key = "here";
  EXPECT_EQ(read("whole.xml", whole, options).joints[0].position, std::vector<double>{7});
  write("part.xml",
        "<mujoco><worldbody><body name='b'><joint name='j'/><joint name='k' type='ball'/>"
        "<geom size='1'/></body></worldbody><keyframe><key qpos='2'/></keyframe></mujoco>");
  EXPECT_NE(refused("whole.xml", whole, options)
                .find("part.xml:1: key: <key> qpos has 1 numbers, expected 5 for the joints"),
            std::string::npos);
}

// ½ a |ω|² and ½ a |v|²: a on the diagonal of M, and no weight of a.
TEST_F(KnownElements, ArmatureOfBallsAndFreeJointsOnTheGround) {
  for (const char* type : {"ball", "free"}) {
    const auto model = [&](const std::string& armature) {
      return read("b.xml",
                  std::string("<mujoco><compiler angle='radian'/><worldbody><body pos='.1 .2 .3' "
                              "euler='.3 .2 .1'><joint type='") +
                      type + "' " + armature +
                      "/><inertial pos='.1 .2 .05' mass='2' fullinertia='.3 .4 .5 .01 .02 .03'/>"
                      "</body></worldbody></mujoco>");
    };
    OpenChain with(model("armature='0.7'")), without(model(""));
    Eigen::VectorXd q = with.tree().q0, u(with.nv()), a(with.nv()), b(with.nv());
    q.tail<4>() = Eigen::Vector4d(0.5, 0.1, -0.7, 0.3).normalized();
    for (Eigen::Index i = 0; i < u.size(); ++i) u[i] = 0.3 * static_cast<double>(i) - 0.5;
    const Eigen::MatrixXd M = without.mass_matrix(0, q),
                          A = 0.7 * Eigen::MatrixXd::Identity(u.size(), u.size());
    EXPECT_LE((with.mass_matrix(0, q) - M - A).norm(), 1e-13) << type;
    // With T_a = ½ a |u|² of rates in the body's axes Hamel's equations add a (u̇ + ω × v) to the
    // three of a free joint's velocity, a ω̇ to the others, and no force.
    ASSERT_TRUE(with.accelerations(0, q, u, a));
    ASSERT_TRUE(without.accelerations(0, q, u, b));
    Eigen::VectorXd gyroscopic = Eigen::VectorXd::Zero(u.size());
    if (u.size() == 6) {
      const Eigen::Vector3d v = u.head<3>(), w = u.tail<3>();
      gyroscopic.head<3>() = 0.7 * w.cross(v);
    }
    EXPECT_LE(((M + A) * a + gyroscopic - M * b).norm(), 1e-12 * (M * b).norm()) << type;
  }
}

// Between bodies that move, and with other joints of its body, M has a on the three rates of the
// ball and nowhere else, and ½ a |u|² brings no force: Hamel's a u × u vanishes.
TEST_F(KnownElements, ArmatureOfBallsBetweenMovingBodies) {
  const auto model = [&](const std::string& armature) {
    const std::string inertial =
        "<inertial pos='.1 .2 .05' mass='2' fullinertia='.3 .4 .5 .01 .02 .03'/>";
    return read("b.xml",
                "<mujoco><compiler angle='radian'/><worldbody><body><joint axis='1 2 3'/>" +
                    inertial + "<body pos='.1 .2 .3' euler='.3 .2 .1'><joint type='ball' " +
                    armature + "/>" + inertial + "<body pos='1 0 0'><joint/>" + inertial +
                    "</body></body></body><body pos='0 0 9'><joint type='slide' axis='1 0 0'/>"
                    "<joint type='ball' pos='.2 0 0' " +
                    armature + "/>" + inertial + "</body></worldbody></mujoco>");
  };
  OpenChain with(model("armature='0.7'")), without(model(""));
  Eigen::VectorXd q = with.tree().q0, u(with.nv()), p(with.nv()), a(with.nv()), b(with.nv());
  ASSERT_EQ(u.size(), 9);
  Eigen::VectorXd on(9);
  on << 0, 1, 1, 1, 0, 0, 1, 1, 1;
  q.segment<4>(1) = Eigen::Vector4d(0.5, 0.1, -0.7, 0.3).normalized();
  q.tail<4>() = Eigen::Vector4d(-0.2, 0.1, 0.6, 0.3).normalized();
  for (Eigen::Index i = 0; i < u.size(); ++i) u[i] = 0.3 * static_cast<double>(i) - 0.5;
  const Eigen::MatrixXd M = without.mass_matrix(0, q), A = 0.7 * Eigen::MatrixXd(on.asDiagonal());
  EXPECT_LE((with.mass_matrix(0, q) - M - A).norm(), 1e-13);
  ASSERT_TRUE(with.accelerations(0, q, u, a));
  ASSERT_TRUE(without.accelerations(0, q, u, b));
  EXPECT_LE(((M + A) * a - M * b).norm(), 1e-12 * (M * b).norm());
  with.momenta(0, q, u, p);
  EXPECT_LE((p - (M + A) * u).norm(), 1e-13 * p.norm());
  Eigen::VectorXd qdot(with.nq()), pdot(with.nv()), own(with.nv());
  ASSERT_TRUE(with.rates(0, q, p, qdot, pdot));
  own = (M + A).ldlt().solve(p);
  EXPECT_NEAR(qdot[0], own[0], 1e-13);
  EXPECT_NEAR(with.energies(0, q, u).kinetic, 0.5 * u.dot(p), 1e-13 * u.dot(p));
}

// --- the table of docs/reference/formats.md ---

std::string table(const char* name, std::span<const KnownElement> elements) {
  const auto words = [](std::string_view all) {
    std::istringstream in{std::string(all)};
    std::string text;
    for (std::string word; in >> word;) text += (text.empty() ? "`" : ", `") + word + "`";
    return text;
  };
  std::string text = std::string("<!-- elements of ") + name + " -->\n\n" +
                     "| element | read | without effect on motion | left out and told |\n"
                     "|---|---|---|---|\n";
  for (const KnownElement& e : elements)
    text += "| `" + std::string(e.name) + "` | " + words(e.taken) + " | " + words(e.silent) +
            " | " + words(e.told) + " |\n";
  return text;
}

TEST(KnownElementTables, StandInTheDocuments) {
  const std::string file = std::string(MOMENTA_SOURCE_DIR) + "/docs/reference/formats.md";
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  for (const auto& [name, elements] :
       {std::pair{"MJCF", mjcf_elements()}, std::pair{"MJCF actuators", mjcf_actuator_elements()},
        std::pair{"URDF", urdf_elements()}, std::pair{"SDF", sdf_elements()}}) {
    const std::string expected = table(name, elements);
    EXPECT_NE(text.str().find(expected), std::string::npos)
        << file << " has another table than this one:\n\n"
        << expected;
  }
}

TEST(KnownElementTables, ListEachWordOnce) {
  for (const auto& elements :
       {mjcf_elements(), mjcf_actuator_elements(), urdf_elements(), sdf_elements()}) {
    std::set<std::string_view> names;
    for (const KnownElement& e : elements) {
      EXPECT_TRUE(names.insert(e.name).second) << e.name;
      std::set<std::string> words;
      for (const std::string_view list : {e.taken, e.silent, e.told}) {
        std::istringstream in{std::string(list)};
        for (std::string word; in >> word;)
          EXPECT_TRUE(words.insert(word).second) << e.name << " has " << word << " twice";
      }
    }
  }
}

}  // namespace
}  // namespace momenta::core_known_elements
