// What <compiler> makes of masses, and weights that gravcomp takes back: each against the same
// model with its numbers worked out by hand. And tendons that an <equality> keeps at their length.

#include "equations/model_folder.h"
#include "equations/refusal.h"
#include "equations/same_open_chain.h"

namespace momenta::core_mjcf_masses {
namespace {

using namespace equations;
using Eigen::Vector3d;

constexpr double rounding = 1e-13;

std::string inertial(const std::string& mass, const std::string& moments,
                     const std::string& more = "") {
  return "<inertial pos='.3 0 .1' mass='" + mass + "' diaginertia='" + moments + "' " + more + "/>";
}

class MjcfMasses : public ModelFolder {
 protected:
  /// Two bodies in a row, and one that stays.
  Scene arm(const std::string& compiler, const std::string& a, const std::string& b,
            const std::string& before = "", const std::string& of_b = "") const {
    return mjcf("<compiler " + compiler + "/>" + before +
                "<worldbody><body name='a'><joint name='j' axis='0 1 0'/>" + a + "<body name='b' " +
                of_b + " pos='0 0 1'><joint name='k' axis='1 2 0'/>" + b +
                "</body></body><body name='still' pos='1 0 0'><inertial pos='0 0 0' mass='1' "
                "diaginertia='1 1 1'/></body></worldbody>");
  }
};

constexpr const char* skew = "quat='.9 .1 .2 .3'";

TEST_F(MjcfMasses, SmallMassesAndMomentsAreRaised) {
  const std::string b = inertial("2", ".1 .3 .25");
  EXPECT_LE(
      differs(arm("boundmass='.5' boundinertia='.02'", inertial(".1", ".001 .03 .025", skew), b),
              arm("", inertial(".5", ".02 .03 .025", skew), b)),
      rounding);
  EXPECT_EQ(differs(arm("boundmass='.05' boundinertia='.0005'", inertial(".1", ".001 .03 .025"), b),
                    arm("", inertial(".1", ".001 .03 .025"), b)),
            0);
}

// With inertiafromgeom="true" geoms go before <inertial>, which stays where they weigh nothing: no
// geoms, none in the range of groups, or of no mass.
TEST_F(MjcfMasses, GeomsThatWeighNothingLeaveTheInertial) {
  const std::string a = inertial("1", ".1 .2 .25"), b = inertial("2", ".1 .3 .25", skew);
  const std::string range = "inertiafromgeom='true' inertiagrouprange='0 1'";
  EXPECT_EQ(differs(arm(range, a + "<geom size='1' mass='0'/>", b + "<geom size='1' group='2'/>"),
                    arm("", a, b)),
            0);
  EXPECT_LE(differs(arm(range, a + "<geom size='1' mass='5'/>", b),
                    arm("", "<inertial pos='0 0 0' mass='5' diaginertia='2 2 2'/>", b)),
            rounding);
}

TEST_F(MjcfMasses, WhatHasTwoMeaningsIsRefused) {
  const std::string b = inertial("2", ".1 .3 .25");
  const auto refused = [&](const std::string& a) {
    return equations::thrown<SceneError>([&] { arm("", a, b); });
  };
  for (const char* turn : {"quat='1 1 0 0'", "euler='1 0 0'", "zaxis='1 0 0'"}) {
    const std::string found =
        refused(std::string("<inertial pos='0 0 0' mass='1' fullinertia='1 2 2.5 .1 .2 .3' ") +
                turn + "/>");
    EXPECT_NE(found.find("expected diaginertia with an orientation, or fullinertia alone"),
              std::string::npos)
        << found;
  }
  const std::string found = refused("<geom type='sphere' size='.1' fromto='0 0 0 1 0 0'/>");
  EXPECT_NE(found.find("expected a capsule, cylinder, ellipsoid or box"), std::string::npos)
      << found;
}

// At the point of the body that its own pos names in its parent.
TEST_F(MjcfMasses, WhatHasNoMassIsRaisedAsMuJoCoRaisesIt) {
  const auto hung = [&](const std::string& compiler, const std::string& c) {
    return arm(compiler, inertial("1", ".1 .2 .25"),
               inertial("2", ".1 .3 .25") + "<body name='c' pos='.5 .1 0'><joint name='l'/>" + c +
                   "</body>");
  };
  EXPECT_LE(differs(hung("boundmass='.5' boundinertia='.02'", ""),
                    hung("", "<inertial pos='.5 .1 0' mass='.5' diaginertia='.02 .02 .02'/>")),
            rounding);
}

// .001 + .03 < .3: no rigid body, so each is the mean. Those raised are balanced after that.
TEST_F(MjcfMasses, MomentsOfNoRigidBodyAreBalanced) {
  const std::string b = inertial("2", ".1 .3 .25"), a = inertial("1", ".001 .03 .299", skew);
  const Scene balanced = arm("balanceinertia='true'", a, b);
  EXPECT_LE(differs(balanced, arm("", inertial("1", ".11 .11 .11"), b)), rounding);
  EXPECT_EQ(balanced.remarks, std::vector<std::string>{});
  EXPECT_LE(differs(arm("balanceinertia='true' boundinertia='.016'", a, b),
                    arm("", inertial("1", ".115 .115 .115"), b)),
            rounding);
}

// Over all bodies but the world, those that stay and those raised among them: (1 + 2 + 1) → 8.
TEST_F(MjcfMasses, TheTotalMassScalesAllBodies) {
  const Scene scaled =
      arm("settotalmass='8'", inertial("1", ".1 .2 .25", skew), inertial("2", "1 1 1"));
  EXPECT_LE(differs(scaled, arm("", inertial("2", ".2 .4 .5", skew), inertial("4", "2 2 2"))),
            rounding);
  double sum = 0;
  for (const BodySpec& body : scaled.bodies) sum += body.mass;
  EXPECT_NEAR(sum, 8, 1e-14);
  EXPECT_LE(differs(arm("settotalmass='9' boundmass='1.5'", inertial("1", ".1 .2 .25"),
                        inertial("3", "1 1 1")),
                    arm("", inertial("2.25", ".15 .3 .375"), inertial("4.5", "1.5 1.5 1.5"))),
            rounding);
  EXPECT_EQ(differs(arm("settotalmass='-1'", inertial("1", ".1 .2 .25"), inertial("2", "1 1 1")),
                    arm("", inertial("1", ".1 .2 .25"), inertial("2", "1 1 1"))),
            0);
}

// A mesh that stays weighs in the sum: that of the corners of a cube of 2 m is 8000 kg.
TEST_F(MjcfMasses, MeshesThatStayCount) {
  const auto scene = [&](const std::string& compiler) {
    return mjcf(
        "<compiler " + compiler +
        "/><asset><mesh name='m' vertex='-1 -1 -1 1 -1 -1 -1 1 -1 1 "
        "1 -1 -1 -1 1 1 -1 1 -1 1 1 1 1 1'/></asset><worldbody><body><geom type='mesh' mesh='m'/>"
        "</body><body><joint name='j'/>" +
        inertial("8000", "1 1 1") + "</body></worldbody>");
  };
  EXPECT_EQ(scene("").bodies[0].mass, 0);
  EXPECT_NEAR(scene("settotalmass='4'").bodies[1].mass, 2, 1e-12);
}

TEST_F(MjcfMasses, TheTotalOfAnAttachedModelIsRefused) {
  write("part.xml",
        "<mujoco><compiler settotalmass='3'/><worldbody><body name='p'><geom size='1'/>"
        "</body></worldbody></mujoco>");
  expect_refused(
      "<asset><model name='m' file='part.xml'/></asset><worldbody><body name='a'>"
      "<joint/><geom size='1'/><attach model='m' body='p' prefix='x'/></body></worldbody>",
      "part.xml", "<compiler> settotalmass is of an attached model");
}

TEST_F(MjcfMasses, WeightsTakenBack) {
  const auto hung = [&](const std::string& gravity, const std::string& a, const std::string& b,
                        const std::string& compiler = "") {
    return mjcf(compiler + "<option gravity='" + gravity + "'/><worldbody><body name='a' " + a +
                "><joint name='j' axis='0 1 0'/>" + inertial("2", ".1 .2 .25") + "<body name='b' " +
                b + "><joint name='k' type='slide' axis='0 0 1'/>" + inertial("3", "1 1 1") +
                "</body></body></worldbody>");
  };
  const std::string half = "gravcomp='.5'", g = "1 2 -8";
  EXPECT_LE(differs(hung(g, half, half), hung(".5 1 -4", "", "")), rounding);
  EXPECT_LE(differs(hung(g, half, half, "<compiler settotalmass='50'/>"),
                    hung(".5 1 -4", "", "", "<compiler settotalmass='50'/>")),
            rounding);
  EXPECT_EQ(hung(g, half, half).remarks, std::vector<std::string>{});
  // The slide alone feels what is left: −8 (1 − .25), through the centres' line.
  const Scene alone = mjcf(
      "<option gravity='0 0 -8'/><worldbody><body gravcomp='.25'><joint name='k' type='slide' "
      "axis='0 "
      "0 1'/>" +
      inertial("3", "1 1 1") + "</body></worldbody>");
  OpenChain chain(alone);
  Eigen::VectorXd a(1);
  ASSERT_TRUE(chain.accelerations(0, chain.tree().q0, chain.tree().u0, a)) << chain.failure();
  EXPECT_NEAR(a[0], -6, 1e-14);
}

constexpr const char* rope =
    "<worldbody><site name='hook' pos='0 0 2'/><body name='a' pos='0 0 1'><freejoint/><geom "
    "size='.1'/>"
    "<site name='tip' pos='.6 0 .2'/><site name='other'/></body></worldbody><tendon><spatial "
    "name='t'><site site='tip'/><site site='hook'/></spatial><spatial name='short'><site "
    "site='tip'/>"
    "<site site='other'/></spatial><spatial name='long'><site site='tip'/><site site='hook'/><site "
    "site='other'/></spatial></tendon>";

TEST_F(MjcfMasses, ATendonKeptAtItsLengthIsADistance) {
  const Scene s =
      mjcf(std::string(rope) + "<equality><tendon tendon1='t' polycoef='.5'/></equality>");
  ASSERT_EQ(s.loops.size(), 1U);
  EXPECT_EQ(s.loops[0].kind, LoopKind::distance);
  EXPECT_EQ(s.loops[0].parent, "ground");
  EXPECT_EQ(s.loops[0].child, "a");
  EXPECT_EQ(s.loops[0].origin_parent, Vector3d(0, 0, 2));
  EXPECT_EQ(s.loops[0].origin_child, Vector3d(.6, 0, .2));
  EXPECT_NEAR(s.loops[0].length, 1 + .5, 1e-15);  // √(.6² + .8²) as drawn
  EXPECT_EQ(s.remarks,
            (std::vector<std::string>{"left out: geoms as shapes to touch (1)",
                                      "left out: spatial tendons without spring or damper (2)"}));
}

TEST_F(MjcfMasses, OtherTendonsThatAreKeptAreRefused) {
  const auto wrong = [&](const std::string& equality, const std::string& expected) {
    expect_refused(std::string(rope) + "<equality>" + equality + "</equality>", "m.xml", expected);
  };
  wrong("<tendon tendon1='t' polycoef='-1'/>",
        "keeps a tendon at the length 0, expected one above 0");
  wrong("<tendon tendon1='short'/>", "keeps the length of a tendon in one body, expected two");
  wrong("<tendon tendon1='long'/>",
        "tendon1 is 'long', expected a fixed tendon, or alone one between");
  wrong("<tendon tendon1='t' tendon2='short'/>",
        "tendon1 is 't', expected a fixed tendon, or alone");
}

}  // namespace
}  // namespace momenta::core_mjcf_masses
