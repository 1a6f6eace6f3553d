// What URDF and MJCF mean, where no model of examples/models says it: each piece against the same
// thing said otherwise.

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/open_chain/open_chain.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <random>
#include <string>

namespace momenta::core_robots {
namespace {

namespace fs = std::filesystem;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Turn = Eigen::AngleAxisd;

class Robots : public testing::Test {
 protected:
  Robots()
      : folder_(fs::temp_directory_path() /
                ("momenta_robot_" + std::to_string(static_cast<long>(std::random_device{}())))) {
    fs::create_directories(folder_);
  }
  ~Robots() override { fs::remove_all(folder_); }
  Scene read(const std::string& name, const std::string& text, const ReadOptions& o = {}) const {
    std::ofstream(folder_ / name) << text;
    return read_scene(folder_ / name, o);
  }
  Scene urdf(const std::string& inside, const ReadOptions& o = {}) const {
    return read("r.urdf", "<robot name='r'>" + inside + "</robot>", o);
  }
  Scene mjcf(const std::string& inside, const std::string& before = "") const {
    return read("m.xml", "<mujoco>" + before + "<worldbody>" + inside + "</worldbody></mujoco>");
  }
  fs::path folder_;
};

const JointSpec& joint(const Scene& scene, const std::string& name) {
  for (const JointSpec& j : scene.joints)
    if (j.name == name) return j;
  throw std::out_of_range(name);
}
const BodySpec& body(const Scene& scene, const std::string& name) {
  for (const BodySpec& b : scene.bodies)
    if (b.name == name) return b;
  throw std::out_of_range(name);
}

std::string link(const std::string& name) {
  return "<link name='" + name + "'><inertial><origin xyz='0.1 0.2 0.3' rpy='0.4 0.5 0.6'/>" +
         "<mass value='2'/><inertia ixx='0.1' iyy='0.2' izz='0.25' ixy='0.01'/></inertial></link>";
}
std::string between(const std::string& name, const std::string& type, const std::string& parent,
                    const std::string& child, const std::string& more = "") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/>" + more + "</joint>";
}

TEST_F(Robots, UrdfInertiaInTurnedAxes) {
  const Scene scene = urdf(link("a"));
  const Matrix3d r =
      (Turn(0.6, Vector3d::UnitZ()) * Turn(0.5, Vector3d::UnitY()) * Turn(0.4, Vector3d::UnitX()))
          .toRotationMatrix();
  Matrix3d own;
  own << 0.1, 0.01, 0, 0.01, 0.2, 0, 0, 0, 0.25;
  EXPECT_LE((body(scene, "a").inertia - r * own * r.transpose()).norm(), 1e-15);
  EXPECT_EQ(body(scene, "a").com, Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(scene.gravity, Vector3d(0, 0, -9.81));
  EXPECT_EQ(joint(scene, "root").kind, JointKind::weld);
}

TEST_F(Robots, UrdfJointsOfEveryType) {
  const Scene scene = urdf(
      // joints before links, and children before parents
      between("p", "planar", "b", "c", "<axis xyz='0 3 0'/>") +
      between("f", "floating", "world", "d", "<origin xyz='1 2 3' rpy='0 0 1'/>") +
      between("s", "prismatic", "c", "e", "<dynamics damping='0.7' friction='0'/>") +
      between("x", "fixed", "a", "b") + between("r", "continuous", "world", "a") + link("e") +
      link("d") + link("c") + "<link name='b'/>" + link("a") + "<link name='world'/>");
  EXPECT_EQ(joint(scene, "p").kind, JointKind::planar);
  EXPECT_EQ(joint(scene, "p").axis, Vector3d::UnitY());
  EXPECT_EQ(joint(scene, "f").kind, JointKind::free);
  EXPECT_EQ(joint(scene, "f").origin_parent, Vector3d(1, 2, 3));
  EXPECT_EQ(joint(scene, "s").axis, Vector3d::UnitX());
  EXPECT_EQ(joint(scene, "s").damping, 0.7);
  EXPECT_EQ(joint(scene, "r").kind, JointKind::revolute);
  EXPECT_EQ(body(scene, "b").mass, 0);
  OpenChain chain(scene);  // it moves
  EXPECT_EQ(chain.nv(), 1 + 3 + 1 + 6);
}

TEST_F(Robots, UrdfMimicRootAndRemarks) {
  ReadOptions floating;
  floating.free_root = true;
  const Scene scene = urdf(
      link("a") + link("b") + link("c") +
          between("j", "revolute", "a", "b", "<limit effort='1' velocity='1'/>") +
          between("k", "prismatic", "a", "c", "<mimic joint='j' multiplier='-2.5' offset='0.1'/>"),
      floating);
  EXPECT_EQ(joint(scene, "root").kind, JointKind::free);
  ASSERT_EQ(scene.loops.size(), 1U);
  EXPECT_EQ(scene.loops[0].joints, (std::vector<std::string>{"k", "j"}));
  EXPECT_EQ(scene.loops[0].ratios, (std::vector<double>{1, 2.5}));  // q_k + 2.5 q_j = 0.1
  EXPECT_EQ(scene.loops[0].offset, 0.1);
  EXPECT_EQ(scene.remarks,
            (std::vector<std::string>{"left out: joint limits without a range (1)"}));
}

// The frame of each end, R1 of the predecessor and R2 of the successor, has the axis a in it.
TEST_F(Robots, UrdfPlusLoopInTurnedFrames) {
  const std::string two = link("a") + link("b") + between("j", "revolute", "g", "a") +
                          between("k", "revolute", "g", "b") + "<link name='g'/>";
  const Scene scene = urdf(two +
                           "<loop name='l' type='revolute'><predecessor link='a'><origin xyz='1 0 "
                           "0' rpy='0.1 0.2 0.3'/></predecessor><successor link='b'><origin "
                           "xyz='0 1 0' rpy='0.4 0.5 0.6'/></successor><axis xyz='1 2 2'/></loop>");
  const auto turned = [](double r, double p, double y) {
    return Turn(y, Vector3d::UnitZ()) * Turn(p, Vector3d::UnitY()) * Turn(r, Vector3d::UnitX());
  };
  const LoopSpec& loop = scene.loops.at(0);
  const Vector3d a = Vector3d(1, 2, 2) / 3;
  EXPECT_LE((loop.axis - turned(0.4, 0.5, 0.6) * a).norm(), 1e-15);
  EXPECT_LE((loop.rotation * loop.axis - turned(0.1, 0.2, 0.3) * a).norm(), 1e-15);
}

TEST_F(Robots, LoopsBesideAUrdf) {
  std::ofstream(folder_ / "r.yaml") << "closed_loop: [[j, b], [a, k]]\ntype: ['3d', '6d']\n";
  const Scene scene = urdf(link("a") + link("b") + "<link name='g'/>" +
                           between("j", "revolute", "g", "a") + between("k", "revolute", "g", "b"));
  ASSERT_EQ(scene.loops.size(), 2U);
  EXPECT_EQ(scene.loops[0].kind, LoopKind::point);
  EXPECT_EQ(scene.loops[1].kind, LoopKind::weld);
  for (const LoopSpec& loop : scene.loops) {
    EXPECT_EQ(loop.parent, "a");
    EXPECT_EQ(loop.child, "b");
  }
  EXPECT_TRUE(scene.remarks.empty());
  std::ofstream(folder_ / "r.yaml") << "colour: red\n";  // another matter: no loops
  EXPECT_TRUE(read_scene(folder_ / "r.urdf").loops.empty());
}

// Five ways to say one turn.
TEST_F(Robots, MjcfOrientations) {
  const auto turn = [&](const std::string& said, const std::string& compiler = "") {
    return joint(mjcf("<body name='b' " + said + "><joint name='j'/><geom size='1'/></body>",
                      "<compiler " + compiler + "/>"),
                 "j")
        .rotation.toRotationMatrix();
  };
  const auto same = [](const Matrix3d& a, const Matrix3d& b) { return (a - b).norm() < 1e-15; };
  const Matrix3d z30 = Turn(std::numbers::pi / 6, Vector3d::UnitZ()).toRotationMatrix();
  EXPECT_TRUE(same(turn("quat='2 0 0 0'"), Matrix3d::Identity()));
  EXPECT_TRUE(same(turn("axisangle='0 0 2 30'"), z30));
  EXPECT_TRUE(same(turn("euler='0 0 30'"), z30));
  EXPECT_TRUE(same(turn("xyaxes='0 2 0 -3 1 0'"),
                   Turn(std::numbers::pi / 2, Vector3d::UnitZ()).toRotationMatrix()));
  EXPECT_TRUE(same(turn("zaxis='0 -1 0'"),
                   Turn(std::numbers::pi / 2, Vector3d::UnitX()).toRotationMatrix()));
  const auto about = [](int i, double angle) {
    return Turn(angle, Vector3d::Unit(i)).toRotationMatrix();
  };
  const Matrix3d intrinsic = about(0, 0.1) * about(1, 0.2) * about(2, 0.3);
  const Matrix3d zyx = about(2, 0.1) * about(1, 0.2) * about(0, 0.3);
  const Matrix3d fixed = about(2, 0.3) * about(1, 0.2) * about(0, 0.1);
  EXPECT_TRUE(same(turn("euler='.1 .2 .3'", "angle='radian'"), intrinsic));
  EXPECT_TRUE(same(turn("euler='.1 .2 .3'", "angle='radian' eulerseq='zyx'"), zyx));
  EXPECT_TRUE(same(turn("euler='.1 .2 .3'", "angle='radian' eulerseq='XYZ'"), fixed));
}

/// Mass and moments of a body of density 1000, by slices across z: `x(z)`, `y(z)` the half widths.
/// A slice is an ellipse of area π x y, ¼ of whose squares are its moments per mass, or a rectangle
/// of 4 x y and ⅓.
struct Sliced {
  double mass = 0;
  Vector3d moments = Vector3d::Zero();
  Sliced(double height, bool box, const std::function<double(double)>& x,
         const std::function<double(double)>& y) {
    constexpr int n = 200000;
    const double dz = 2 * height / n, area = box ? 4 : std::numbers::pi, part = box ? 1. / 3 : 0.25;
    for (int i = 0; i < n; ++i) {
      const double z = -height + (i + 0.5) * dz, a = x(z), b = y(z), m = 1000 * area * a * b * dz;
      mass += m;
      moments += m * Vector3d(part * b * b + z * z, part * a * a + z * z, part * (a * a + b * b));
    }
  }
};

TEST_F(Robots, MjcfInertiaOfGeoms) {
  const auto geom = [&](const std::string& said) {
    return body(mjcf("<body name='b'><joint/><geom " + said + "/></body>"), "b");
  };
  const auto expect_same = [&](const BodySpec& found, const Sliced& expected) {
    EXPECT_NEAR(found.mass, expected.mass, 1e-8 * expected.mass);
    EXPECT_LE((found.inertia.diagonal() - expected.moments).norm(), 1e-8 * expected.moments.norm());
    EXPECT_LE((found.inertia - Matrix3d(found.inertia.diagonal().asDiagonal())).norm(), 1e-12);
  };
  const auto constant = [](double value) { return [value](double) { return value; }; };
  const auto arc = [](double r, double c) {
    return [r, c](double z) { return r * std::sqrt(std::max(0.0, 1 - z * z / (c * c))); };
  };
  expect_same(geom("size='.3'"), Sliced(.3, false, arc(.3, .3), arc(.3, .3)));
  expect_same(geom("type='ellipsoid' size='.3 .2 .1'"),
              Sliced(.1, false, arc(.3, .1), arc(.2, .1)));
  expect_same(geom("type='box' size='.3 .2 .1'"), Sliced(.1, true, constant(.3), constant(.2)));
  expect_same(geom("type='cylinder' size='.3 .2'"), Sliced(.2, false, constant(.3), constant(.3)));
  const auto capsule = [](double z) {
    const double over = std::max(0.0, std::abs(z) - 0.5);
    return std::sqrt(std::max(0.0, 0.09 - over * over));
  };
  expect_same(geom("type='capsule' size='.3 .5'"), Sliced(.8, false, capsule, capsule));
  // the same by its two ends, in another direction, and by its mass
  const BodySpec across = geom("type='capsule' size='.3' fromto='1 0 0 0 0 0' mass='2'");
  const Sliced upright(.8, false, capsule, capsule);
  EXPECT_EQ(across.com, Vector3d(0.5, 0, 0));
  EXPECT_EQ(across.mass, 2);
  EXPECT_NEAR(across.inertia(0, 0), upright.moments[2] * 2 / upright.mass, 1e-8);
  EXPECT_NEAR(across.inertia(1, 1), upright.moments[0] * 2 / upright.mass, 1e-8);
}

// A box cut in two is the whole box.
TEST_F(Robots, MjcfGeomsAddUp) {
  const Scene whole = mjcf("<body name='b'><joint/><geom type='box' size='.3 .2 .1'/></body>");
  const Scene halves = mjcf(
      "<body name='b'><joint/><geom type='box' size='.1 .2 .1' pos='-.2 0 0'/><geom type='box' "
      "size='.2 .2 .1' pos='.1 0 0'/></body>");
  EXPECT_NEAR(body(whole, "b").mass, body(halves, "b").mass, 1e-12);
  EXPECT_LE((body(whole, "b").inertia - body(halves, "b").inertia).norm(), 1e-13);
  EXPECT_LE(body(halves, "b").com.norm(), 1e-15);
}

TEST_F(Robots, MjcfSpringsCountFromRef) {
  const Scene scene = mjcf(
      "<body name='b'><joint name='j' ref='30' springref='75' stiffness='2' damping='.3'/><joint "
      "name='s' type='slide' ref='.5' springref='2' stiffness='3'/><geom size='1'/></body>");
  EXPECT_NEAR(joint(scene, "j").rest, std::numbers::pi / 4, 1e-15);
  EXPECT_EQ(joint(scene, "j").stiffness, 2);
  EXPECT_EQ(joint(scene, "j").damping, 0.3);
  EXPECT_EQ(joint(scene, "s").rest, 1.5);
}

// A class gives what an element does not say; classes inherit, in whatever order they are written.
TEST_F(Robots, MjcfDefaults) {
  const Scene scene = mjcf(
      "<body name='a' childclass='outer'><joint name='j'/><geom/><body name='b'><joint name='k' "
      "class='inner' damping='9'/><geom/></body></body><body name='c'><joint name='l'/><geom "
      "size='2'/></body>",
      "<default><joint damping='1'/><default class='outer'><default class='inner'><joint "
      "stiffness='3'/></default><joint axis='1 0 0' damping='2'/><geom "
      "size='1'/></default></default>");
  EXPECT_EQ(joint(scene, "j").axis, Vector3d::UnitX());
  EXPECT_EQ(joint(scene, "j").damping, 2);
  EXPECT_EQ(joint(scene, "k").axis, Vector3d::UnitX());
  EXPECT_EQ(joint(scene, "k").stiffness, 3);
  EXPECT_EQ(joint(scene, "k").damping, 9);
  EXPECT_EQ(joint(scene, "l").axis, Vector3d::UnitZ());
  EXPECT_EQ(joint(scene, "l").damping, 1);
}

// What acts on one joint alone is said once a kind; gravity and equality are read.
TEST_F(Robots, MjcfOptionsEqualityAndRemarks) {
  const Scene scene = read(
      "m.xml",
      "<mujoco model='x'><option gravity='0 1 2'/><worldbody><body name='b'><joint name='j' ref='9'"
      "/><joint name='k' range='0 1'/><geom size='1'/></body></worldbody><equality><joint name='e' "
      "joint1='j' joint2='k' polycoef='.1 -2'/><joint joint1='k'/><connect body1='b' anchor='1 2 "
      "3' "
      "active='false'/></equality><actuator><motor joint='j'/><motor "
      "joint='k'/></actuator></mujoco>");
  EXPECT_EQ(scene.gravity, Vector3d(0, 1, 2));
  ASSERT_EQ(scene.loops.size(), 2U);
  EXPECT_EQ(scene.loops[0].name, "e");
  EXPECT_EQ(scene.loops[0].ratios, (std::vector<double>{1, 2}));
  EXPECT_EQ(scene.loops[0].offset, 0.1);
  EXPECT_EQ(scene.loops[1].joints, std::vector<std::string>{"k"});
  EXPECT_EQ(scene.remarks,
            (std::vector<std::string>{"left out: geoms as shapes to touch (1)",
                                      "left out: actuators, which --control lets act (2)",
                                      "left out: equality constraints that are not active (1)"}));
}

// A link called ground below a root of another name is a body as any, under another name.
TEST_F(Robots, LinksMayBeCalledGround) {
  const std::string tree = "<link name='world'/>" + link("ground") + link("a") +
                           between("w", "fixed", "world", "ground") +
                           between("j", "continuous", "ground", "a") +
                           "<gazebo reference='ground'><turnGravityOff value='true'/></gazebo>";
  const Scene scene = urdf(tree);
  EXPECT_EQ(body(scene, "ground 2").mass, 2);
  EXPECT_EQ(joint(scene, "j").parent, "ground 2");
  EXPECT_EQ(joint(scene, "root").parent, "ground");
  ASSERT_EQ(scene.forces.size(), 1U);
  EXPECT_EQ(scene.forces[0].body, "ground 2");
  ReadOptions free;
  free.free_root = true;
  const Scene floats =
      urdf(link("ground") + link("a") + between("j", "continuous", "ground", "a"), free);
  EXPECT_EQ(joint(floats, "root").child, "ground 2");
  // The root that is welded is the ground itself.
  EXPECT_EQ(
      urdf(link("ground") + link("a") + between("j", "continuous", "ground", "a")).bodies.size(),
      1U);
  const Scene sdf = read(
      "g.sdf",
      "<sdf version='1.7'><model name='m'><link name='ground'/><link name='a'/><joint name='w' "
      "type='fixed'><parent>world</parent><child>ground</child></joint><joint name='j' "
      "type='revolute'><parent>ground</parent><child>a</child><axis><xyz>0 1 0</xyz></axis></joint>"
      "</model></sdf>");
  EXPECT_EQ(joint(sdf, "j").parent, "ground 2");
  EXPECT_EQ(joint(sdf, "w").parent, "ground");
  const Scene mj = mjcf(
      "<body name='ground'><joint name='k'/><geom size='1'/></body></worldbody>"
      "<equality><connect body1='ground' anchor='1 0 0'/></equality><worldbody>");
  EXPECT_EQ(joint(mj, "k").child, "ground 2");
  EXPECT_EQ(mj.loops.at(0).child, "ground 2");
}

// What does not move mimics nothing; and is 0 to what mimics it.
TEST_F(Robots, MimicOfFixedJoints) {
  const std::string before = link("base") + link("a") + link("b");
  const Scene of_fixed = urdf(before + between("j", "continuous", "base", "a") +
                              between("k", "fixed", "a", "b", "<mimic joint='j' multiplier='2'/>"));
  EXPECT_TRUE(of_fixed.loops.empty());
  const Scene by_fixed =
      urdf(before + between("j", "fixed", "base", "a") +
           between("k", "continuous", "a", "b", "<mimic joint='j' multiplier='2' offset='0.3'/>"));
  ASSERT_EQ(by_fixed.loops.size(), 1U);
  EXPECT_EQ(by_fixed.loops[0].joints, std::vector<std::string>{"k"});
  EXPECT_EQ(by_fixed.loops[0].offset, 0.3);
}

}  // namespace
}  // namespace momenta::core_robots
