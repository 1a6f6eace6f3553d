// <include> of SDF: the same scene as with the model written in its place; limits and friction.

#include "equations/same_scene.h"
#include "equations/scene_folder.h"

#include <momenta/core/open_chain/open_chain.h>

namespace momenta::core_sdf_includes {
namespace {

using equations::joint_of;

const std::string arm =
    "<link name='a'><pose>0 0 1 0.1 0.2 "
    "0.3</pose><inertial><mass>2</mass><inertia><ixx>1</ixx><iyy>1"
    "</iyy><izz>1</izz></inertia></inertial></link><joint name='j' type='revolute'><parent>world"
    "</parent><child>a</child><axis><xyz>1 0 0</xyz></axis></joint>";

class SdfIncludes : public equations::SceneFolder {
 protected:
  Scene world(const std::string& inside, const std::string& version = "1.9") const {
    return read("w.world",
                "<sdf version='" + version + "'><world name='w'>" + inside + "</world></sdf>");
  }
  void expect_refused(const std::string& inside, const std::string& words) const {
    const std::string sentence =
        refused("w.world", "<sdf version='1.9'><world name='w'>" + inside + "</world></sdf>");
    EXPECT_NE(sentence.find(words), std::string::npos) << sentence;
  }
};

TEST_F(SdfIncludes, GoBeforeWhatTheModelSays) {
  write("arm.sdf",
        "<sdf version='1.8'><model name='arm'><pose>5 5 5 0 0 0</pose>" + arm + "</model></sdf>");
  const Scene included = world(
      "<include><uri>arm.sdf</uri><name>left</name><pose>1 2 3 0 0 0.5</pose></include>"
      "<include><uri>file://arm.sdf</uri></include>");
  Scene written = world("<model name='left'>" + arm +
                        "<pose>1 2 3 0 0 0.5</pose></model>"
                        "<model name='arm'><pose>5 5 5 0 0 0</pose>" +
                        arm + "</model>");
  ASSERT_EQ(included.bodies.size(), 2U);
  EXPECT_EQ(included.bodies[0].name, "left::a");
  ASSERT_EQ(written.joints.size(), included.joints.size());
  for (std::size_t i = 0; i < written.joints.size(); ++i) {
    EXPECT_EQ(included.joints[i].name, written.joints[i].name);
    EXPECT_EQ(included.joints[i].origin_parent, written.joints[i].origin_parent);
    EXPECT_EQ(included.joints[i].axis, written.joints[i].axis);
    EXPECT_TRUE(included.joints[i].rotation.isApprox(written.joints[i].rotation, 1e-15));
  }
  const Scene still = world(
      "<include><uri>arm.sdf</uri><static>1</static></include><model name='m'>" + arm + "</model>");
  EXPECT_EQ(OpenChain(still).nv(), 1);
}

TEST_F(SdfIncludes, WrongOnes) {
  write("arm.sdf", "<sdf version='1.8'><model name='arm'>" + arm + "</model></sdf>");
  write("old.sdf", "<sdf version='1.4'><model name='arm'>" + arm + "</model></sdf>");
  write("two.sdf", "<sdf version='1.9'><model name='p'/><model name='q'/></sdf>");
  write("self.sdf", "<sdf version='1.9'><model name='s'><include><uri>self.sdf</uri></include>" +
                        arm + "</model></sdf>");
  write("bad.sdf",
        "<sdf version='1.9'><model name='s'><link name='l'><pose>1</pose></link></model>"
        "</sdf>");
  write("urdf.sdf", "<robot name='r'/>");
  const auto include = [](const std::string& uri, const std::string& more = "") {
    return "<include" + more + "><uri>" + uri + "</uri></include>";
  };
  expect_refused(include("https://fuel.example/m"),
                 "<uri> is 'https://fuel.example/m', expected a file beside this one");
  expect_refused(include("../x.sdf"), "which is not in the folder");
  expect_refused(include("none.sdf"), "<uri> is 'none.sdf', which does not exist");
  expect_refused(include("model://none"), "<uri> is 'none', which does not exist");
  expect_refused(include("arm.sdf", " merge='true'"),
                 "merge is true, expected a model that stands");
  expect_refused(include("old.sdf"), "version is '1.4', which reads joints in another way");
  expect_refused(include("two.sdf"), "<sdf> holds 2 <model>, expected one where it is included");
  expect_refused(include("self.sdf"), "which this element is a part of");
  expect_refused(include("bad.sdf"), "bad.sdf:1: link 'l': <pose> has 1 numbers, expected 6");
  expect_refused(include("urdf.sdf"), "holds <robot>, expected <sdf>");
  expect_refused("<include/>", "<include> has no <uri>, expected one");
}

// Limits of the file are those of the scene; friction is smooth; what no joint of the tree can have
// is told.
TEST_F(SdfIncludes, LimitsAndFrictionOfJoints) {
  const auto hinge = [&](const std::string& type, const std::string& in_axis) {
    return world("<model name='m'><link name='a'/><joint name='j' type='" + type +
                 "'><parent>world</parent><child>a</child><axis><xyz>0 0 1</xyz>" + in_axis +
                 "</axis></joint></model>");
  };
  const auto limits = [&](const std::string& bounds, const std::string& type = "revolute") {
    return joint_of(hinge(type, "<limit>" + bounds + "</limit>"), "j").limits;
  };
  using Limits = std::array<double, 2>;
  EXPECT_EQ(limits("<lower>-1</lower><upper>2</upper>"), (Limits{-1, 2}));
  EXPECT_EQ(limits("<lower>-1</lower>"), (Limits{-1, 1e16}));
  EXPECT_EQ(limits("<upper>2</upper><lower>-inf</lower>"), (Limits{-1e16, 2}));
  EXPECT_FALSE(limits("<lower>-1e16</lower><upper>1e16</upper>"));
  EXPECT_FALSE(limits("<lower>1</lower><upper>-1</upper>"));
  EXPECT_FALSE(limits("<lower>-1</lower><upper>2</upper>", "continuous"));
  EXPECT_EQ(
      joint_of(hinge("revolute", "<dynamics><friction>.5</friction></dynamics>"), "j").friction,
      .5);
  const Scene universal = world(
      "<model name='m'><link name='a'/><joint name='j' "
      "type='universal'><parent>world</parent><child>"
      "a</child><axis><xyz>1 0 0</xyz><limit><lower>-1</lower></limit></axis><axis2><xyz>0 1 "
      "0</xyz><dynamics><friction>.5</friction></dynamics></axis2></joint></model>");
  EXPECT_EQ(joint_of(universal, "j").limits, (Limits{-1, 1e16}));
  EXPECT_EQ(joint_of(universal, "j axis2").friction, .5);
}

// A joint that closes a loop has no coordinate: its limits and its friction are told.
TEST_F(SdfIncludes, LoopsHaveNoLimits) {
  const std::string two =
      "<link name='a'/><link name='b'/><joint name='i' "
      "type='revolute'><parent>world</parent><child>a"
      "</child><axis><xyz>0 0 1</xyz></axis></joint><joint name='j' type='revolute'><parent>world"
      "</parent><child>b</child><axis><xyz>0 0 1</xyz></axis></joint><joint name='k' "
      "type='revolute'>"
      "<parent>a</parent><child>b</child><axis><xyz>0 0 1</xyz><limit><lower>-1</lower></limit>"
      "<dynamics><friction>1</friction></dynamics></axis></joint>";
  const Scene scene = world("<model name='m'>" + two + "</model>");
  ASSERT_EQ(scene.loops.size(), 1U);
  EXPECT_EQ(scene.loops[0].name, "k");
  EXPECT_EQ(std::vector<std::string>(scene.remarks.end() - 2, scene.remarks.end()),
            (std::vector<std::string>{"left out: limits of joints that close loops (1)",
                                      "left out: friction of joints that close loops (1)"}));
}

// The pose relative to a link is that of the body; colours and sizes are those of the file.
TEST_F(SdfIncludes, VisualsAreDrawn) {
  const Scene scene = world(
      "<model name='m'><link name='a'><visual name='v'><pose>1 2 3 0 0 "
      "0</pose><geometry><box><size>"
      "1 2 3</size></box></geometry><material><diffuse>1 0 .5 "
      "1</diffuse></material></visual><visual "
      "name='w'><geometry><capsule><radius>.1</radius><length>2</length></capsule></geometry></"
      "visual>"
      "<visual "
      "name='x'><geometry><mesh><uri>none.stl</uri></mesh></geometry></visual></link></model>");
  ASSERT_EQ(scene.visuals.size(), 2U);
  EXPECT_EQ(scene.visuals[0].kind, "box");
  EXPECT_EQ(scene.visuals[0].size, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(scene.visuals[0].position, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(*scene.visuals[0].colour, Eigen::Vector3d(1, 0, .5));
  EXPECT_EQ(scene.visuals[1].size, Eigen::Vector3d(2, .1, 0));
  EXPECT_NE(std::find(scene.remarks.begin(), scene.remarks.end(),
                      "left out: meshes to draw whose files are not there (1)"),
            scene.remarks.end());
}

}  // namespace
}  // namespace momenta::core_sdf_includes
