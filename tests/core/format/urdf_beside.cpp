// What stands beside the links and joints of a URDF: joints of other types in a YAML file, rotors
// of transmissions, and what is told of a root. Each against the same mechanism said otherwise.

#include "equations/same_open_chain.h"
#include "equations/scene_folder.h"

#include <gtest/gtest.h>

namespace momenta::core_urdf_beside {
namespace {

using namespace equations;

constexpr double rounding = 1e-12;

std::string link(const std::string& name) {
  return "<link name='" + name + "'><inertial><origin xyz='0.1 0.2 0.3' rpy='0.4 0.5 0.6'/>" +
         "<mass value='2'/><inertia ixx='0.1' iyy='0.2' izz='0.25' ixy='0.01'/></inertial></link>";
}
std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& more = "") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/>" + more + "</joint>";
}
const std::string turned = "<origin xyz='0.3 -0.2 0.5' rpy='0.7 -0.4 1.1'/>";

class UrdfBeside : public SceneFolder {
 protected:
  Scene urdf(const std::string& inside) const {
    return read("r.urdf", "<robot name='r'>" + inside + "</robot>");
  }
  /// Links a, b, c in a row, b on a by the joint j.
  static std::string arm(const std::string& j) {
    return "<link name='world'/>" + link("a") + link("b") + link("c") +
           joint("i", "revolute", "world", "a", "<axis xyz='0 1 0'/>") + j +
           joint("k", "revolute", "b", "c", turned + "<axis xyz='1 2 2'/>");
  }
  Scene retyped(const std::string& type) const {
    write("r.yaml", "joint_name: [j]\njoint_type: [" + type + "]\n");
    const Scene scene = urdf(arm(joint("j", "revolute", "a", "b", turned + "<axis xyz='0 0 1'/>")));
    std::filesystem::remove(write("r.yaml", ""));
    return scene;
  }
  /// j as two revolute joints with a link without mass between.
  Scene pair(const std::string& first, const std::string& second) const {
    return urdf(arm("<link name='cross'/>" +
                    joint("j1", "revolute", "a", "cross", turned + "<axis xyz='" + first + "'/>") +
                    joint("j2", "revolute", "cross", "b", "<axis xyz='" + second + "'/>")));
  }
};

TEST_F(UrdfBeside, SphericalJointOfAYamlFile) {
  const Scene twin = urdf(arm(joint("j", "spherical", "a", "b", turned)));
  EXPECT_EQ(OpenChain(twin).nv(), 5);
  EXPECT_EQ(differs(retyped("SPHERICAL"), twin), 0);
}

TEST_F(UrdfBeside, UniversalJointsTurnAboutTheParentsThenTheChildsAxis) {
  const std::string x = "1 0 0", y = "0 1 0", z = "0 0 1";
  EXPECT_LE(differs(retyped("CARDAN"), pair(x, y)), rounding);
  EXPECT_LE(differs(retyped("UJOINT_XY"), pair(x, y)), rounding);
  EXPECT_LE(differs(retyped("UJOINT_YZ"), pair(y, z)), rounding);
  EXPECT_LE(differs(retyped("UJOINT_ZX"), pair(z, x)), rounding);
  EXPECT_LE(differs(retyped("UJOINT_ZY"), pair(z, y)), rounding);
  EXPECT_GE(differs(retyped("UJOINT_XY"), pair(y, x)), 1e-3);
}

TEST_F(UrdfBeside, FixedJointOfAYamlFile) {
  EXPECT_LE(differs(retyped("FIXED"), urdf(arm(joint("j", "fixed", "a", "b", turned)))), rounding);
}

TEST_F(UrdfBeside, MotorsAreTold) {
  write("r.yaml", "closed_loop: [[k, a]]\ntype: [3d]\nname_mot: [i, j]\n");
  const Scene scene = urdf(arm(joint("j", "revolute", "a", "b")));
  EXPECT_EQ(scene.loops.size(), 1U);
  EXPECT_EQ(
      scene.remarks,
      (std::vector<std::string>{"left out: motors of name_mot, which drive nothing here (2)"}));
}

TEST_F(UrdfBeside, WrongYaml) {
  const std::string robot = "<robot>" + arm(joint("j", "fixed", "a", "b")) + "</robot>";
  const auto says = [&](const std::string& yaml) {
    write("w.yaml", yaml);
    return refused("w.urdf", robot);
  };
  const auto expect = [&](const std::string& yaml, const std::string& words) {
    const std::string sentence = says(yaml);
    EXPECT_NE(sentence.find("w.yaml:"), std::string::npos) << sentence;
    EXPECT_NE(sentence.find(words), std::string::npos) << sentence;
  };
  expect("joint_name: [kk]\njoint_type: [FIXED]\n",
         ":1:14: joint_name has 'kk', expected a joint of ");
  expect("joint_name: [k]\njoint_type:\n - BALL\n",
         ":3:4: joint_type has 'BALL', expected SPHERICAL, FIXED, CARDAN, or UJOINT_ with two of X "
         "Y Z");
  expect("joint_name: [k]\njoint_type: [UJOINT_XX]\n", "joint_type has 'UJOINT_XX'");
  expect(
      "joint_name: [j]\njoint_type: [SPHERICAL]\n",
      ":2:14: joint_type SPHERICAL is for joint 'j', which the URDF fixes, expected a joint that "
      "moves");
  expect("joint_name: [k, k]\njoint_type: [FIXED, FIXED]\n", ":1:17: joint_name has 'k' twice");
  expect("joint_name: [k]\njoint_type: []\n", "joint_name has 1 entries and joint_type 0");
  expect("joint_type: [FIXED]\n", "no key joint_name, expected a list");
  expect("closed_loop: []\ntype: []\nname_mot: [m]\n", ":3:12: name_mot has 'm', expected a joint");
  expect("closed_loop: []\ntype: []\njoint_tipe: []\n",
         ":3:1: key 'joint_tipe' is not known, expected one of: closed_loop, type, joint_name, "
         "joint_type, name_mot; did you mean 'joint_type'?");
}

TEST_F(UrdfBeside, RotorsOfTransmissions) {
  const auto driven = [&](const std::string& inside) {
    return urdf(arm(joint("j", "revolute", "a", "b")) + "<transmission name='t'><joint name='j'/>" +
                inside + "</transmission>");
  };
  const auto rotor = [&](const std::string& inside) {
    const Scene scene = driven(inside);
    return joint_of(scene, "j").rotor_inertia;
  };
  using Numbers = std::vector<double>;
  EXPECT_EQ(rotor("<actuator name='m'><mechanicalReduction>10</mechanicalReduction>"
                  "<motorInertia>0.25</motorInertia></actuator>"),
            Numbers{25});
  EXPECT_EQ(rotor("<actuator name='m'><rotorInertia>0.25</rotorInertia></actuator>"
                  "<mechanicalReduction>-2</mechanicalReduction>"),
            Numbers{1});
  EXPECT_EQ(rotor("<actuator name='m'><drake:rotor_inertia value='0.5'/>"
                  "<drake:gear_ratio value='4'/><mechanicalReduction>99</mechanicalReduction>"
                  "</actuator>"),
            Numbers{8});
  EXPECT_EQ(rotor("<actuator name='m'><drake:rotor_inertia value='0.5'/></actuator><actuator "
                  "name='n'><motorInertia>1</motorInertia></actuator>"),
            Numbers{1.5});
  const Scene none = driven(
      "<actuator name='m'><mechanicalReduction>3</mechanicalReduction>"
      "</actuator>");
  EXPECT_TRUE(joint_of(none, "j").rotor_inertia.empty());
  EXPECT_EQ(none.remarks, std::vector<std::string>{
                              "left out: transmissions, which give no inertia of a rotor (1)"});
}

TEST_F(UrdfBeside, WrongTransmissions) {
  const auto says = [&](const std::string& inside) {
    return refused("t.urdf", "<robot>" + arm(joint("j", "fixed", "a", "b")) +
                                 "\n<transmission name='t'>" + inside + "</transmission></robot>");
  };
  const auto expect = [&](const std::string& inside, const std::string& words) {
    const std::string sentence = says(inside);
    EXPECT_NE(sentence.find(":2: transmission 't': " + words), std::string::npos) << sentence;
  };
  const std::string motor = "<actuator><motorInertia>1</motorInertia></actuator>";
  expect("<joint name='kk'/>" + motor, "<joint> name is 'kk', expected the name of a joint");
  expect("<joint name='j'/>" + motor, "<joint> name is 'j', which has no rate of its own");
  expect("<joint name='i'/><joint name='k'/>" + motor,
         "<transmission> has an inertia of a rotor and 2 joints, expected one joint");
  expect("<joint name='k'/><actuator><motorInertia>-1</motorInertia></actuator>",
         "<motorInertia> is -1, expected a number >= 0 [kg m² or kg]");
  expect("<joint name='k'/><actuator><motorInertia>much</motorInertia></actuator>",
         "<motorInertia> has 'much', expected finite numbers");
  expect("<joint name='k'/><mechanicalReduction>0</mechanicalReduction>" + motor,
         "<mechanicalReduction> is 0, expected another number");
}

TEST_F(UrdfBeside, RootsThatLookAsIfTheyFloat) {
  const auto told = [](const Scene& scene) { return !scene.remarks.empty(); };
  const std::string legs =
      link("l") + link("r") + joint("jl", "revolute", "b", "l") + joint("jr", "revolute", "b", "r");
  const Scene biped = urdf(link("b") + legs);
  EXPECT_EQ(biped.remarks,
            std::vector<std::string>{
                "root link 'b' is fixed to the ground, but has a mass and 2 branches that no loop "
                "ties to each other: if it floats, give --free-root"});
  EXPECT_FALSE(told(urdf("<link name='b'/>" + legs)));  // no mass: a stand
  EXPECT_FALSE(told(urdf(link("b") + link("l") + joint("j", "revolute", "b", "l"))));  // an arm
  EXPECT_FALSE(told(urdf(link("b") + legs +  // a closed linkage on its frame
                         "<loop name='c' type='spherical'><predecessor link='l'/>"
                         "<successor link='r'/></loop>")));
  EXPECT_TRUE(told(urdf(link("b") + legs +  // wheels that a gear couples
                        "<coupling name='c'><predecessor link='l'/><successor link='r'/>"
                        "<ratio value='2'/></coupling>")));
  ReadOptions free;
  free.free_root = true;
  EXPECT_FALSE(told(read("f.urdf", "<robot>" + link("b") + legs + "</robot>", free)));
}

TEST_F(UrdfBeside, XacroIsForItsOwnTool) {
  const std::string expand =
      "is for xacro, expected a URDF: expand the file by \"xacro FILE > robot.urdf\"";
  const std::string head = "<robot name='r' xmlns:xacro='http://ros.org/wiki/xacro'>\n";
  for (const std::string& part :
       {std::string("<xacro:property name='m' value='1'/>"),
        std::string("<link name='a'><inertial><mass value='${m}'/></inertial></link>"),
        std::string("<link name='$(arg prefix)a'/>")}) {
    const std::string sentence = refused("r.urdf.xacro", head + part + "</robot>");
    EXPECT_NE(sentence.find(":2: "), std::string::npos) << sentence;
    EXPECT_NE(sentence.find(expand), std::string::npos) << sentence;
  }
  EXPECT_EQ(read("done.urdf", head + link("a") + "</robot>").bodies.size(), 1U);  // expanded
}

}  // namespace
}  // namespace momenta::core_urdf_beside
