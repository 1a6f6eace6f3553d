// What acts in an MJCF: springs, dampers, friction, tendons, actuators, couplings and limits.

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/open_chain/open_chain.h>

#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>

#include "equations/refusal.h"

namespace momenta::core_mjcf_acts {
namespace {

namespace fs = std::filesystem;
using Strings = std::vector<std::string>;
using Numbers = std::vector<double>;
constexpr double pi = std::numbers::pi;

class MjcfActs : public testing::Test {
 protected:
  MjcfActs()
      : file_(fs::temp_directory_path() /
              ("momenta_acts_" + std::to_string(static_cast<long>(std::random_device{}())) +
               ".xml")) {}
  ~MjcfActs() override { fs::remove(file_); }
  /// Two hinges, a slide and a ball, and what stands behind the bodies.
  Scene scene(const std::string& joint, const std::string& after = "",
              const Strings& controls = {}) const {
    std::ofstream(file_)
        << "<mujoco><compiler angle='radian'/><worldbody><site name='w' pos='0 0 2'/>"
           "<body name='a'><joint name='j' axis='0 1 0' ref='.25' "
        << joint
        << "/><geom type='box' size='.3 .2 .1'/><site name='s' pos='.1 0 0'/><body name='b' "
           "pos='.5 0 0'><joint name='k' axis='1 0 0'/><geom type='box' size='.1 .2 .1'/><body "
           "name='c' pos='0 .5 0'><joint name='l' type='slide'/><geom type='box' size='.1 .1 .2'/>"
           "</body></body></body></worldbody>"
        << after << "</mujoco>";
    ReadOptions options;
    options.controls = controls;
    return read_scene(file_, options);
  }
  void expect_refused(const std::string& sentence, const std::string& joint,
                      const std::string& after = "", const Strings& controls = {}) const {
    EXPECT_TRUE(equations::says(
        equations::thrown<SceneError>([&] { scene(joint, after, controls); }), sentence))
        << "read, expected: " << sentence;
  }
  fs::path file_;
};

TEST_F(MjcfActs, SpringDamperIsOfTheJointsInertia) {
  const Scene s = scene("springdamper='.2 .5'");
  OpenChain chain(s);
  const Eigen::MatrixXd inverse = chain.mass_matrix(0, chain.tree().q0).inverse();
  const double inertia = 1 / inverse(0, 0);
  EXPECT_NEAR(s.joints[0].stiffness, inertia / (.2 * .2 * .5 * .5), 1e-10 * inertia);
  EXPECT_NEAR(s.joints[0].damping, 2 * inertia / .2, 1e-12 * inertia);
  EXPECT_EQ(s.joints[0].rest, -.25);  // springref 0 of the file
}

TEST_F(MjcfActs, SpringDampersOfNegativeNumbersAreRefused) {
  expect_refused("joint 'j': <joint> springdamper has a negative number", "springdamper='-.2 .5'");
  expect_refused("joint 'j': <joint> springdamper has a negative number", "springdamper='0 -1'");
  EXPECT_EQ(scene("springdamper='0 0' stiffness='3'").joints[0].stiffness, 3);
}

TEST_F(MjcfActs, BallsAndFreeBodies) {
  std::ofstream(file_) << "<mujoco><worldbody><body name='a' pos='1 2 3' quat='0 1 0 0'><joint "
                          "type='free' damping='.5' springdamper='.2 .5'/><geom size='1'/></body>"
                          "<body name='b' pos='0 0 1'><joint type='ball' stiffness='2' damping='.3'"
                          " frictionloss='1'/><geom size='1'/></body></worldbody></mujoco>";
  const Scene s = read_scene(file_);
  ASSERT_EQ(s.forces.size(), 2U);
  const ForceSpec& ball = s.forces[0];
  EXPECT_EQ(ball.kind, "bushing");
  EXPECT_EQ(ball.rotational_stiffness, 2);
  EXPECT_EQ(ball.rotational_damping, .3);
  EXPECT_EQ(ball.stiffness, 0);
  const ForceSpec& free = s.forces[1];  // of a sphere: n/Σ M⁻¹ of m three times and J three times
  const double m = 4000 * pi / 3, mean = 2 / (1 / m + 1 / (.4 * m));
  EXPECT_NEAR(free.damping, 2 * mean / .2, 1e-9 * mean);
  EXPECT_EQ(free.rotational_damping, free.damping);
  EXPECT_NEAR(free.stiffness, mean / (.2 * .2 * .5 * .5), 1e-9 * mean);
  EXPECT_EQ(free.origin_parent, Eigen::Vector3d(1, 2, 3));
  OpenChain chain(s);  // at rest where it starts
  const Energies e = chain.energies(0, chain.tree().q0, chain.tree().u0);
  Scene weightless = s;
  weightless.gravity.setZero();
  OpenChain floating(weightless);
  EXPECT_NEAR(floating.energies(0, chain.tree().q0, chain.tree().u0).potential, 0, 1e-12 * m);
  EXPECT_EQ(e.kinetic, 0);
}

TEST_F(MjcfActs, LimitsAndFriction) {
  const Scene s = scene("range='-1 2' frictionloss='.3'");
  ASSERT_TRUE(s.joints[0].limits);
  EXPECT_EQ((*s.joints[0].limits)[0], -1.25);
  EXPECT_EQ((*s.joints[0].limits)[1], 1.75);
  EXPECT_EQ(s.joints[0].friction, .3);
  EXPECT_FALSE(scene("range='-1 2' limited='false'").joints[0].limits);
  expect_refused("joint 'j': <joint> range has its first number not below its second",
                 "range='2 1'");
  expect_refused("frictionloss is negative", "frictionloss='-1'");
}

// Tendons keep their range, counted as their length, and a dead band between two lengths; balls
// keep the angle that their range allows.
TEST_F(MjcfActs, LimitsOfTendonsAndBalls) {
  using Limits = std::array<double, 2>;
  const Scene s = scene("",
                        "<tendon><fixed name='t' range='-1 3' stiffness='3' springlength='.5 2'>"
                        "<joint joint='j' coef='2'/></fixed><fixed range='0 1'><joint joint='k' "
                        "coef='1'/></fixed><spatial range='0 2'><site site='s'/><site site='w'/>"
                        "</spatial><fixed range='0 1' limited='false'><joint joint='k' coef='1'/>"
                        "</fixed></tendon>");
  ASSERT_EQ(s.forces.size(), 3U);
  EXPECT_EQ(s.forces[0].limits, (Limits{-1.5, 2.5}));
  EXPECT_EQ(s.forces[0].rest, .5 - 2 * .25);
  EXPECT_EQ(s.forces[0].dead_band, 1.5);
  EXPECT_EQ(s.forces[1].limits, (Limits{0, 1}));
  EXPECT_EQ(s.forces[1].stiffness, 0);
  EXPECT_EQ(s.forces[2].kind, "spring-damper");
  EXPECT_EQ(s.forces[2].limits, (Limits{0, 2}));
  const auto ball = [&](const std::string& joint) {
    std::ofstream(file_) << "<mujoco><worldbody><body><joint type='ball' " << joint
                         << "/><geom size='1'/></body></worldbody></mujoco>";
    ReadOptions options;
    options.stops = {5, 0};
    return read_scene(file_, options).joints[0];
  };
  EXPECT_EQ(ball("range='0 90'").limits, (Limits{0, pi / 2}));
  EXPECT_EQ(ball("range='0 90'").stop_stiffness, 5);
  EXPECT_FALSE(ball("range='0 180'").limits);  // beyond no turn can go
  EXPECT_FALSE(ball("range='0 90' limited='false'").limits);
}

TEST_F(MjcfActs, PolynomialCoupling) {
  const Scene s = scene("",
                        "<equality><joint joint1='j' joint2='k' polycoef='.1 2 3 4 5'/><joint "
                        "joint1='j' joint2='k' polycoef='0 0 1'/></equality>");
  EXPECT_EQ(s.loops.at(0).joints, (Strings{"j", "k"}));
  EXPECT_EQ(s.loops[0].ratios, (Numbers{1, -2}));
  EXPECT_EQ(s.loops[0].powers, (Numbers{-3, -4, -5}));
  EXPECT_EQ(s.loops[0].offset, .1);
  EXPECT_EQ(s.loops.at(1).ratios, (Numbers{1, 0}));
  EXPECT_EQ(s.loops[1].powers, (Numbers{-1}));
}

TEST_F(MjcfActs, Tendons) {
  const std::string tendon =
      "<tendon><fixed name='t' stiffness='3' damping='.2' springlength='1'><joint joint='j' "
      "coef='2'/><joint joint='l' coef='-4'/></fixed><fixed name='v'><joint joint='k' coef='3'/>"
      "</fixed><spatial stiffness='5'><site site='s'/><site site='w'/></spatial></tendon>";
  const Scene s = scene("", tendon +
                                "<equality><tendon tendon1='t' tendon2='v' polycoef='.1 .5'/>"
                                "<tendon tendon1='t' tendon2='v' polycoef='0 0 2'/></equality>");
  ASSERT_EQ(s.forces.size(), 2U);
  EXPECT_EQ(s.forces[0].kind, "coordinate-spring");
  EXPECT_EQ(s.forces[0].joints, (Strings{"j", "l"}));
  EXPECT_EQ(s.forces[0].ratios, (Numbers{2, -4}));
  EXPECT_EQ(s.forces[0].rest, 1 - 2 * .25);
  EXPECT_EQ(s.forces[1].kind, "spring-damper");
  EXPECT_EQ(s.forces[1].parent, "ground");
  EXPECT_EQ(s.forces[1].child, "a");
  // at springref, j = 0 of the file
  EXPECT_NEAR(s.forces[1].rest, std::hypot(.1 * std::cos(.25), 2 - .1 * std::sin(.25)), 1e-15);
  EXPECT_EQ(s.loops.at(0).joints, (Strings{"j", "k", "l"}));
  EXPECT_EQ(s.loops[0].ratios, (Numbers{2, -1.5, -4}));
  EXPECT_EQ(s.loops.at(1).joints, (Strings{"j", "l", "k"}));
  EXPECT_EQ(s.loops[1].powers, (Numbers{-18}));
  expect_refused("goes by 3 sites, expected two", "",
                 "<tendon><spatial stiffness='5'><site site='s'/><site site='w'/><site "
                 "site='s'/></spatial></tendon>");
  expect_refused("tendon1 is 'x', expected the name of a tendon", "",
                 "<equality><tendon tendon1='x'/></equality>");
}

/// The force on joint j at (q, q̇): from the scene, and from the actuator's law.
TEST_F(MjcfActs, ActuatorsAtConstantControls) {
  const std::string actuators =
      "<actuator><motor name='m' joint='j' gear='3' ctrlrange='-1 1'/><position name='p' joint='j' "
      "kp='7' kv='.5' gear='2'/><velocity name='v' joint='j' kv='.9'/><general name='g' joint='j' "
      "gainprm='4' biastype='affine' biasprm='1 -2 -3'/></actuator>";
  EXPECT_EQ(scene("", actuators).remarks.back(),
            "left out: actuators, which --control lets act (4)");
  const Scene s = scene("stiffness='2' springref='.5' damping='.1'", actuators,
                        {"m=5", "p=.6", "v=.2", "g=-1"});
  const JointSpec& j = s.joints[0];
  double torque = 0;
  for (const ForceSpec& f : s.forces) torque += f.joint == "j" ? f.value : 0;
  for (const double q : {0.0, .7, -1.1})
    for (const double v : {0.0, 1.3}) {
      const double file = q + .25;
      const double expected = -2 * (file - .5) - .1 * v + 3 * 1 +
                              2 * (7 * .6 - 7 * 2 * file - .5 * 2 * v) + .9 * (.2 - v) +
                              (-4 + 1 - 2 * file - 3 * v);
      EXPECT_NEAR(torque - j.stiffness * (q - j.rest) - j.damping * v, expected, 1e-13);
    }
  const Scene zero = scene("", actuators, {"0"});  // at control 0 a position actuator is a spring
  EXPECT_EQ(zero.joints[0].stiffness, 7 * 4 + 2);
  expect_refused("--control: actuator 'x' is not in the file", "", actuators, {"x=1"});
  expect_refused("--control: found 'm=a'", "", actuators, {"m=a"});
  expect_refused("actuator 'y': <muscle> is not read under --control", "",
                 "<actuator><muscle name='y' joint='j'/></actuator>", {"0"});
  expect_refused("has a state of its own", "",
                 "<actuator><general joint='j' dyntype='filter'/></actuator>", {"0"});
}

// What an actuator acts on is in the model, whether a control is given or not.
TEST_F(MjcfActs, ActuatorsOnWhatIsNotThereAreRefused) {
  for (const Strings& controls : {Strings{}, Strings{"0"}}) {
    const auto refused = [&](const std::string& sentence, const std::string& actuator) {
      expect_refused(sentence, "", "\n<actuator>\n<" + actuator + "/></actuator>", controls);
    };
    refused(":3: actuator: <motor> joint is 'jj', expected the name of a joint; did you mean 'j'?",
            "motor joint='jj'");
    refused(":3: actuator 'm': <motor> jointinparent is 'x'", "motor name='m' jointinparent='x'");
    refused("tendon is 'u', expected the name of a tendon", "motor tendon='u'");
    refused("site is 'nowhere', expected the name of a site", "general site='nowhere'");
    refused("body is 'z', expected the name of a body", "adhesion body='z'");
    refused("class is 'strong'", "motor joint='j' class='strong'");
  }
  for (const char* fine : {"motor joint='k'", "general site='s' refsite='w'", "adhesion body='a'"})
    EXPECT_EQ(scene("", std::string("<actuator><") + fine + "/></actuator>").remarks.back(),
              "left out: actuators, which --control lets act (1)");
}

TEST_F(MjcfActs, ActuatorsOfTendons) {
  const std::string tendon =
      "<tendon><fixed name='t'><joint joint='j' coef='2'/><joint joint='l' coef='-4'/></fixed>"
      "</tendon>";
  const Scene motor =
      scene("", tendon + "<actuator><motor tendon='t' gear='3'/></actuator>", {"2"});
  ASSERT_EQ(motor.forces.size(), 2U);
  EXPECT_EQ(motor.forces[0].value, 12);
  EXPECT_EQ(motor.forces[1].value, -24);
  const Scene position =
      scene("", tendon + "<actuator><position tendon='t' kp='5'/></actuator>", {"2"});
  ASSERT_EQ(position.forces.size(), 1U);
  EXPECT_EQ(position.forces[0].stiffness, 5);
  EXPECT_EQ(position.forces[0].rest, 2 - 2 * .25);
}

}  // namespace
}  // namespace momenta::core_mjcf_acts
