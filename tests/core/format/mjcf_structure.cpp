// include, frame, replicate and attach: the same as the model written out.

#include "equations/any_text.h"
#include "equations/model_folder.h"

#include <momenta/core/format/toml/write_scene.h>
#include <momenta/core/open_chain/open_chain.h>

#include <chrono>
#include <sstream>

namespace momenta::core_mjcf_structure {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

class MjcfStructure : public equations::ModelFolder {
 protected:
  Scene world(const std::string& inside, const std::string& before = "",
              const std::string& behind = "") const {
    return mjcf(before + "<worldbody>" + inside + "</worldbody>" + behind);
  }
};

/// Columns M e_i, and u̇ from rest, at one state of all joints.
MatrixXd mass_and_fall(const Scene& scene) {
  Scene tree = scene;
  tree.loops.clear();
  OpenChain chain(tree);
  VectorXd q = chain.tree().q0;
  for (const JointSpec& joint : tree.joints)
    if (joint.kind == JointKind::spherical || joint.kind == JointKind::free) return {};
  for (Eigen::Index i = 0; i < q.size(); ++i) q[i] = 0.3 * std::sin(1.0 + static_cast<double>(i));
  const Eigen::Index n = chain.nv();
  MatrixXd all(n, n + 1);
  VectorXd column(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    chain.momenta(0, q, VectorXd::Unit(n, i), column);
    all.col(i) = column;
  }
  EXPECT_TRUE(chain.accelerations(0, q, VectorXd::Zero(n), column)) << chain.failure();
  all.col(n) = column;
  return all;
}

/// Names and kinds of bodies, joints and loops are the same, and so is how it moves.
void expect_same(const Scene& a, const Scene& b) {
  const auto names = [](const Scene& scene) {
    std::string all;
    for (const BodySpec& body : scene.bodies) all += body.name + " ";
    for (const JointSpec& j : scene.joints)
      all += "| " + j.name + ": " + j.parent + " " + j.child + " " +
             std::to_string(static_cast<int>(j.kind));
    for (const LoopSpec& loop : scene.loops) {
      all += "| " + loop.name + ": " + loop.parent + " " + loop.child;
      for (const std::string& joint : loop.joints) all += " " + joint;
    }
    return all;
  };
  EXPECT_EQ(names(a), names(b));
  const MatrixXd m = mass_and_fall(a), n = mass_and_fall(b);
  ASSERT_EQ(m.cols(), n.cols());
  ASSERT_GT(m.cols(), 1);
  EXPECT_LE((m - n).norm(), 1e-12 * n.norm());
  ASSERT_EQ(a.loops.size(), b.loops.size());
  for (std::size_t i = 0; i < a.loops.size(); ++i) {
    EXPECT_LE((a.loops[i].origin_parent - b.loops[i].origin_parent).norm(), 1e-14);
    EXPECT_LE((a.loops[i].origin_child - b.loops[i].origin_child).norm(), 1e-14);
  }
}

// Elements of other files in the place of <include>, at any depth, from the folder of the model or
// of the file that includes.
TEST_F(MjcfStructure, IncludeIsTheTextInPlace) {
  write("parts/classes.xml",
        "<mujocoinclude><default><joint axis='0 1 0' damping='.1'/></default></mujocoinclude>");
  write("parts/arm.xml",
        "<mujoco><include file='parts/geoms.xml'/><body name='c' pos='0 0 1'>"
        "<include file='hand.xml'/></body></mujoco>");
  write("parts/geoms.xml", "<x><geom size='.1'/><geom size='.2' pos='1 0 0'/></x>");
  write("parts/hand.xml", "<x><joint name='j3'/><geom size='.3'/></x>");
  const Scene in_parts = mjcf(
      "<include file='parts/classes.xml'/><worldbody><body name='a'><joint name='j1'/><body "
      "name='b' pos='1 0 0'><joint name='j2'/><include file='parts/arm.xml'/></body></body>"
      "</worldbody>");
  const Scene whole = mjcf(
      "<default><joint axis='0 1 0' damping='.1'/></default><worldbody><body name='a'><joint "
      "name='j1'/><body name='b' pos='1 0 0'><joint name='j2'/><geom size='.1'/><geom size='.2' "
      "pos='1 0 0'/><body name='c' pos='0 0 1'><joint name='j3'/><geom size='.3'/></body></body>"
      "</body></worldbody>");
  EXPECT_EQ(scene_text(in_parts), scene_text(whole));
}

// A frame moves bodies, joints, geoms and sites in it, and may have a class.
TEST_F(MjcfStructure, FrameMovesWhatIsInIt) {
  const std::string before =
      "<default><default class='y'><joint axis='0 1 0'/></default></default>";
  const std::string loop = "<equality><connect site1='s' site2='t'/></equality>";
  const Scene framed = world(
      "<site name='t' pos='1 2 3'/><frame pos='1 0 0' euler='0 0 90'><frame pos='0 2 0' euler='90 "
      "0 "
      "0' childclass='y'><body name='a' pos='0 0 1'><frame pos='0 1 0' euler='0 90 0'><joint "
      "name='j' pos='0 0 .5'/><geom type='box' size='.1 .2 .3' pos='.3 0 0' euler='0 0 45'/><site "
      "name='s' pos='0 0 2'/></frame><body name='b' pos='1 1 1'><joint name='k' "
      "type='slide'/><geom "
      "size='.1'/></body></body></frame></frame>",
      before, loop);
  // Rz(90): x → y, y → −x. Rz(90) Rx(90): x → y, y → z, z → x. Ry(90): x → −z, z → x.
  const Scene written = world(
      "<site name='t' pos='1 2 3'/><body name='a' pos='0 0 0' xyaxes='0 1 0 0 0 1'><joint name='j' "
      "pos='.5 1 0' axis='0 1 0'/><geom type='box' size='.1 .2 .3' pos='0 1 -.3' xyaxes='0 .7071 "
      "-.7071 0 .7071 .7071'/><site name='s' pos='2 1 0'/><body name='b' pos='1 1 1'><joint "
      "name='k' type='slide' axis='0 1 0'/><geom size='.1'/></body></body>",
      before, loop);
  expect_same(framed, written);
}

// Copies stand one behind the other, each turned once more; what refers to them is copied too.
TEST_F(MjcfStructure, ReplicateIsItsCopiesWrittenOut) {
  const Scene replicated = world(
      "<replicate count='3' offset='1 0 0' euler='0 0 90' sep='-'><body name='a' pos='0 0 "
      "1'><joint "
      "name='j' axis='0 1 0'/><geom size='.1' pos='.5 0 0'/><replicate count='2' offset='0 0 .5'>"
      "<body name='b' pos='0 1 0'><joint name='k' axis='1 0 0'/><joint name='l' axis='0 1 "
      "0'/><geom "
      "size='.2' pos='0 0 .1'/></body></replicate></body></replicate>",
      "", "<equality><joint name='e' joint1='k' joint2='l'/></equality>");
  std::string bodies, couplers;
  // 0: at 0; 1: at x, turned by 90°; 2: at x + y, by 180°
  const char* places[] = {"pos='0 0 1'", "pos='1 0 1' euler='0 0 90'",
                          "pos='1 1 1' euler='0 0 180'"};
  for (int i = 0; i < 3; ++i) {
    const std::string n = "-" + std::to_string(i);
    bodies += "<body name='a" + n + "' " + places[i] + "><joint name='j" + n +
              "' axis='0 1 0'/><geom size='.1' pos='.5 0 0'/>";
    for (int k = 0; k < 2; ++k)
      bodies += "<body name='b" + std::to_string(k) + n + "' pos='0 1 " + std::to_string(0.5 * k) +
                "'><joint name='k" + std::to_string(k) + n + "' axis='1 0 0'/><joint name='l" +
                std::to_string(k) + n + "' axis='0 1 0'/><geom size='.2' pos='0 0 .1'/></body>";
    bodies += "</body>";
  }
  // Of an element the copies of the inner <replicate> are copied by the outer one.
  for (const char* k : {"0", "1"})
    for (const char* i : {"-0", "-1", "-2"}) {
      const std::string n = std::string(k) + i;
      couplers += "<joint name='e" + n + "' joint1='k" + n + "' joint2='l" + n + "'/>";
    }
  expect_same(replicated, world(bodies, "", "<equality>" + couplers + "</equality>"));
}

// An attached body is as written with its prefix: classes, angles, constraints, meshes of its own.
TEST_F(MjcfStructure, AttachIsTheModelWithAPrefix) {
  write("arms/meshes/box.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  write(
      "arms/finger.xml",
      "<mujoco><compiler angle='radian'/><default><joint damping='.3'/></default><worldbody><body "
      "name='f'><joint name='j' axis='1 0 0' ref='.5'/><geom size='.05'/></body></worldbody>"
      "</mujoco>");
  write(
      "arms/arm.xml",
      "<mujoco><compiler angle='radian' eulerseq='zyx' meshdir='meshes'/><default><joint "
      "axis='0 1 0'/><default class='light'><geom density='10'/></default></default><asset><mesh "
      "file='box.obj'/><model name='finger' file='arms/finger.xml'/></asset><worldbody><body "
      "name='elsewhere'><joint name='x'/><geom size='1'/></body><body name='arm' childclass='light'"
      "><body name='fore' pos='0 0 1' euler='.3 .2 .1'><joint name='j'/><geom type='mesh' "
      "mesh='box'/><site name='s' pos='1 0 0'/><frame pos='0 1 0'><attach model='finger' body='f' "
      "prefix='thumb_'/></frame></body></body></worldbody><equality><joint name='in' joint1='j' "
      "joint2='thumb_j'/><joint joint1='j' joint2='x'/></equality></mujoco>");
  const std::string own =
      "<body name='base'><joint name='j' axis='0 0 1' damping='.7'/><geom size='.2'/>";
  const Scene attached =
      world(own +
                "<frame pos='1 0 0' euler='0 90 0'><attach model='arm' body='fore' "
                "prefix='left_'/></frame><attach model='arm' body='fore' prefix='right_'/></body>",
            "<default><joint damping='.7'/></default><asset><model name='arm' "
            "file='arms/arm.xml'/></asset>");
  using Turn = Eigen::AngleAxisd;
  const Eigen::Quaterniond turn(Turn(.3, Eigen::Vector3d::UnitZ()) *
                                Turn(.2, Eigen::Vector3d::UnitY()) *
                                Turn(.1, Eigen::Vector3d::UnitX()));
  const auto fore = [&](const std::string& p) {
    std::ostringstream quat;
    quat.precision(17);
    quat << turn.w() << " " << turn.vec().transpose();
    return "<body name='" + p + "fore' pos='0 0 1' quat='" + quat.str() + "'><joint name='" + p +
           "j' axis='0 1 0'/><geom type='mesh' mesh='box' density='10'/><body name='" + p +
           "thumb_f' pos='0 1 0'><joint name='" + p +
           "thumb_j' axis='1 0 0' damping='.3'/><geom size='.05'/></body></body>";
  };
  const Scene written =
      world(own + "<frame pos='1 0 0' euler='0 90 0'>" + fore("left_") + "</frame>" +
                fore("right_") + "</body>",
            "<asset><mesh file='arms/meshes/box.obj'/></asset>",
            "<equality><joint name='left_in' joint1='left_j' joint2='left_thumb_j'/><joint "
            "name='right_in' joint1='right_j' joint2='right_thumb_j'/></equality>");
  EXPECT_EQ(attached.joints.size(), 5U);
  for (std::size_t i = 0; i < attached.joints.size(); ++i)
    EXPECT_EQ(attached.joints[i].damping, written.joints[i].damping) << attached.joints[i].name;
  expect_same(attached, written);
}

// Sentences name the file in which the fault stands, and its line there.
TEST_F(MjcfStructure, FaultsInOtherFilesAreNamedThere) {
  write("part.xml", "<x>\n<body name='b'>\n<joint name='j' type='hing'/></body></x>");
  expect_refused("<worldbody><include file='part.xml'/></worldbody>", "part.xml",
                 "part.xml:3: body 'b': <joint> type is 'hing'");
  write("twice.xml", "<x>\n<body name='b'><joint name='j'/><geom size='1'/></body></x>");
  expect_refused(
      "<worldbody><body name='a'><joint name='j'/><geom size='1'/></body><include "
      "file='twice.xml'/></worldbody>",
      "twice.xml", "twice.xml:2: joint 'j': the name is taken since line 1");
  write("sub/model.xml",
        "<mujoco><worldbody><body name='b'>\n<joint name='j' axis='0 0 0'/></body>"
        "</worldbody></mujoco>");
  expect_refused(
      "<asset><model file='sub/model.xml'/></asset><worldbody><attach model='model' "
      "body='b' prefix='p'/></worldbody>",
      "sub/model.xml", "sub/model.xml:2: joint 'pj': <joint> axis is the zero vector");
  write("open.xml", "<x>\n<body></x>");
  expect_refused("<include file='open.xml'/>", "open.xml", ":2: not valid XML");
}

TEST_F(MjcfStructure, WrongFiles) {
  const auto include = [&](const std::string& file, const std::string& expected) {
    expect_refused("\n<include file='" + file + "'/>", "m.xml", ":2: <include> " + expected);
  };
  include("gone.xml",
          "file is 'gone.xml', which does not exist, expected a file in '" + folder.string() + "'");
  include("m.xml", "file is 'm.xml', which this element is a part of");
  include("../m.xml", "file is '../m.xml', which is not in the folder");
  include("/etc/passwd", "file is '/etc/passwd', which is not in the folder");
  include("", "has no file, expected one");
  std::filesystem::create_symlink("/etc/passwd", folder / "link.xml");
  include("link.xml", "file is 'link.xml', which is not in the folder");
  std::filesystem::create_directories(folder / "sub");
  include("sub", "file is 'sub', which is no plain file");
  write("nothing.xml", "<x/>");
  include("nothing.xml", "file holds no elements");
  expect_refused("\n<include/>", "m.xml", ":2: <include> has no file, expected one");
  expect_refused("\n<include file='x.xml'><a/></include>", "m.xml",
                 ":2: <include> has elements in it");

  write("a.xml", "<x>\n\n<include file='b.xml'/></x>");
  write("b.xml", "<x>\n<include file='a.xml'/></x>");
  expect_refused("<include file='a.xml'/>", "b.xml",
                 "b.xml:2: <include> file is 'a.xml', which this");
  write("once.xml", "<x><option/></x>");
  expect_refused("<include file='once.xml'/>\n<include file='once.xml'/>", "m.xml",
                 ":2: <include> file is 'once.xml' a second time, expected each file once");
  for (int i = 0; i < 20; ++i)
    write("deep" + std::to_string(i) + ".xml",
          "<x><include file='deep" + std::to_string(i + 1) + ".xml'/></x>");
  expect_refused("<include file='deep0.xml'/>", "deep9.xml", "10 files that include each other");

  const auto attach = [&](const std::string& said, const std::string& expected) {
    expect_refused("<asset><model name='arm' file='arm.xml'/></asset><worldbody>\n<attach " + said +
                       "/></worldbody>",
                   "m.xml", expected);
  };
  write("arm.xml",
        "<mujoco><asset><model name='arm' file='arm.xml'/></asset><worldbody><attach model='arm' "
        "prefix='p'/></worldbody></mujoco>");
  attach("body='b' prefix='p'", ":2: <attach> has no model");
  attach("model='arms' prefix='p'",
         ":2: <attach> model is 'arms', expected the name of a <model> "
         "of <asset>; did you mean 'arm'?");
  attach("model='arm'", ":2: <attach> has no prefix");
  expect_refused(
      "<asset><model name='arm' file='arm.xml'/></asset><worldbody><attach model='arm' "
      "prefix='p'/></worldbody>",
      "arm.xml", "model is 'arm', which attaches itself");
  write("arm.xml", "<mujoco><worldbody><body name='b'/></worldbody></mujoco>");
  attach("model='arm' body='c' prefix='p'",
         ":2: <attach> body is 'c', expected a body of the model");
  write("arm.xml", "<robot name='r'/>");
  attach("model='arm' prefix='p'", ":1: asset: <model> file holds <robot>, expected <mujoco>");
}

TEST_F(MjcfStructure, WrongReplicates) {
  const auto refused = [&](const std::string& said, const std::string& expected,
                           const std::string& behind = "") {
    expect_refused("<worldbody>\n<replicate " + said +
                       "><body name='a'><joint name='j'/><geom size='1'/></body></replicate><body "
                       "name='b'><joint name='k'/><geom size='1'/></body></worldbody>" +
                       behind,
                   "m.xml", expected);
  };
  refused("", ":2: <replicate> has no count");
  refused("count='0'", ":2: <replicate> count is 0, expected a whole number from 1 to 200000");
  refused("count='2.5'", "count is 2.5, expected a whole number");
  refused("count='1e300'", "count is 1e+300, expected a whole number");
  refused("count='100000'", ":2: <replicate> takes the model over 200000 elements or 64 MiB");
  refused("count='2'",
          ":3: equality: <joint> refers to 'j' in a <replicate> and to 'k' elsewhere, expected all "
          "of it in the same <replicate>",
          "<equality>\n<joint joint1='j' joint2='k'/></equality>");
  std::string nested = "<body/>";
  for (int i = 0; i < 6; ++i) nested = "<replicate count='50'>" + nested + "</replicate>";
  expect_refused("<worldbody>" + nested + "</worldbody>", "m.xml", "over 200000 elements");
  // Deep where the files are put together, though none of them is.
  const auto framed = [](std::string inside) {
    for (int i = 0; i < 60; ++i) inside = "<frame>" + inside + "</frame>";
    return inside;
  };
  for (int i = 0; i < 4; ++i)
    write("deep" + std::to_string(i) + ".xml",
          "<x>" + framed("<include file='deep" + std::to_string(i + 1) + ".xml'/>") + "</x>");
  write("deep4.xml", "<x><body name='b'><joint/><geom size='1'/></body></x>");
  expect_refused("<worldbody><include file='deep0.xml'/></worldbody>", "deep3.xml",
                 ":1: <frame> is nested more than 200 deep, expected no such depth");
  expect_refused("<worldbody><body name='b'>\n<composite/></body></worldbody>", "m.xml",
                 ":2: <composite> makes bodies, joints and constraints by a count, which is not "
                 "read; expected those it stands for");
  expect_refused("<worldbody><body name='b'>\n<flexcomp/></body></worldbody>", "m.xml",
                 ":2: <flexcomp> makes a soft body, which is not read");
  expect_refused(
      "<worldbody><body name='b'><joint/><frame>\n<inertial pos='0 0 0' mass='1' "
      "diaginertia='1 1 1'/></frame></body></worldbody>",
      "m.xml", ":2: <inertial> stands in a <frame>, expected it in its <body>");
}

// Each model attaches the next one twice: 2^9 of the last, which must not take long to refuse.
TEST_F(MjcfStructure, ModelsThatDoubleAreRefusedInTime) {
  for (int i = 0; i < 9; ++i) {
    const std::string next = "m" + std::to_string(i + 1);
    write("m" + std::to_string(i) + ".xml",
          "<mujoco><asset><model name='n' file='" + next +
              ".xml'/></asset><worldbody><attach "
              "model='n' prefix='a'/><attach model='n' prefix='b'/></worldbody></mujoco>");
  }
  std::string bodies;
  for (int i = 0; i < 2000; ++i) bodies += "<body/>";
  write("m9.xml", "<mujoco><worldbody>" + bodies + "</worldbody></mujoco>");
  const auto start = std::chrono::steady_clock::now();
  expect_refused(
      "<asset><model name='n' file='m0.xml'/></asset><worldbody><attach model='n' "
      "prefix='x'/></worldbody>",
      "m8.xml", "takes the model over 200000 elements");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
}

}  // namespace
}  // namespace momenta::core_mjcf_structure
