// Solids to be drawn, from MJCF and URDF: where they lie in their bodies, and which of them there
// are.
#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>

#include <filesystem>
#include <fstream>

namespace momenta::core_visuals {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

Scene read(const std::string& ending, const std::string& text) {
  const fs::path file = fs::path(testing::TempDir()) / ("visuals" + ending);
  std::ofstream(file) << text;
  return read_scene(file);
}

// The two ends of a capsule's axis, in body axes, are the points of `fromto`.
TEST(Visuals, CapsuleEndsWhereTheFileSays) {
  const Scene scene = read(".xml", R"(<mujoco><worldbody><body pos="1 2 3" quat="1 2 3 4">
    <inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/><joint/>
    <geom type="capsule" size="0.05" fromto="0.1 -0.2 0.3 0.4 0.7 -0.6"/>
    <geom type="box" size="0.1 0.2 0.3" pos="1 0 0" group="1" rgba="1 0.5 0 1"/>
    <geom type="sphere" size="9" group="3"/>
    <geom type="plane" size="1 1 1"/>
  </body></worldbody></mujoco>)");
  ASSERT_EQ(scene.visuals.size(), 2U);  // the sphere is one to touch
  const VisualSpec &capsule = scene.visuals[0], &box = scene.visuals[1];
  EXPECT_EQ(capsule.kind, "capsule");
  EXPECT_EQ(capsule.body, scene.bodies[0].name);
  const Vector3d half = capsule.rotation * Vector3d(0, 0, 0.5 * capsule.size[0]);
  const Vector3d a(0.1, -0.2, 0.3), b(0.4, 0.7, -0.6);
  EXPECT_LT((capsule.position - half - a).norm() * (capsule.position + half - a).norm(), 1e-14);
  EXPECT_LT((capsule.position - half - b).norm() * (capsule.position + half - b).norm(), 1e-14);
  EXPECT_DOUBLE_EQ(capsule.size[1], 0.05);
  EXPECT_EQ(box.size, Vector3d(0.2, 0.4, 0.6));  // edges, of half edges
  ASSERT_TRUE(box.colour);
  EXPECT_EQ(*box.colour, Vector3d(1, 0.5, 0));
}

// A body that only meshes show is drawn by its shapes to touch.
TEST(Visuals, ShapesToTouchStandForMeshes) {
  const Scene scene = read(".xml", R"(<mujoco><default><default class="touch">
    <geom group="3" type="cylinder" size="0.1 0.2"/></default></default>
    <worldbody><body><inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/><joint/>
    <geom class="touch" pos="0 0 1"/></body></worldbody></mujoco>)");
  ASSERT_EQ(scene.visuals.size(), 1U);
  EXPECT_EQ(scene.visuals[0].kind, "cylinder");
  EXPECT_EQ(scene.visuals[0].size, Vector3d(0.4, 0.1, 0));
  EXPECT_EQ(scene.visuals[0].position, Vector3d(0, 0, 1));
}

TEST(Visuals, OfLinks) {
  const Scene scene = read(".urdf", R"(<robot name="r"><link name="base"/>
    <link name="a"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial>
      <visual><origin xyz="1 2 3" rpy="1.5707963267948966 0 0"/><geometry><cylinder length="4" radius="5"/></geometry>
        <material name=""><color rgba="0 1 0 1"/></material></visual>
      <visual><geometry><mesh filename="a.stl"/></geometry></visual>
      <visual><geometry><box size="1 2 3"/></geometry></visual>
      <visual><geometry><sphere radius="4"/></geometry></visual>
      <collision><geometry><sphere radius="1"/></geometry></collision></link>
    <joint name="j" type="continuous"><parent link="base"/><child link="a"/></joint></robot>)");
  ASSERT_EQ(scene.visuals.size(), 3U);
  EXPECT_EQ(scene.visuals[1].size, Vector3d(1, 2, 3));
  EXPECT_EQ(scene.visuals[2].size, Vector3d(4, 0, 0));
  const VisualSpec& v = scene.visuals[0];
  EXPECT_EQ(v.body, "a");
  EXPECT_EQ(v.size, Vector3d(4, 5, 0));
  EXPECT_EQ(v.position, Vector3d(1, 2, 3));
  EXPECT_LT((v.rotation * Vector3d::UnitZ() + Vector3d::UnitY()).norm(), 1e-15);
  EXPECT_EQ(*v.colour, Vector3d(0, 1, 0));
}

// What is wrong in pictures alone is told, and refuses no mechanism.
TEST(Visuals, WhatIsWrongInThemIsToldAlone) {
  const auto told = [](const Scene& scene) {
    int count = 0;
    for (const std::string& remark : scene.remarks) count += remark.starts_with("not drawn: ");
    return count;
  };
  const std::string link =
      "<robot name='r'><link name='base'/><link name='a'><inertial><mass value='1'/><inertia "
      "ixx='1' iyy='1' izz='1'/></inertial>";
  const std::string joint =
      "</link><joint name='j' type='continuous'><parent link='base'/><child link='a'/></joint>"
      "</robot>";
  for (const std::string wrong :
       {"<geometry><mesh filename='none.stl' scale='1 1 1 1'/></geometry>",
        "<geometry><sphere/></geometry>", "<geometry><box size='1 x 2'/></geometry>",
        "<origin rpy='0 0'/><geometry><sphere radius='1'/></geometry>",
        "<geometry><mesh/></geometry>"}) {
    const Scene scene = read(".urdf", link + "<visual>" + wrong + "</visual>" + joint);
    EXPECT_EQ(told(scene), 1) << wrong;
    EXPECT_TRUE(scene.visuals.empty()) << wrong;
  }
  EXPECT_EQ(told(read(".urdf", link +
                                   "<visual><material name='m'><color rgba='1 1'/></material>"
                                   "</visual>" +
                                   joint)),
            1);
  const auto sdf = [](const std::string& visual) {
    return read(".sdf", "<sdf version='1.9'><model name='m'><link name='a'><visual name='v'>" +
                            visual + "</visual></link></model></sdf>");
  };
  const std::string box = "<geometry><box><size>1 1 1</size></box></geometry>";
  EXPECT_EQ(told(sdf("<geometry><sphere><size>1</size></sphere></geometry>")), 1);
  EXPECT_EQ(told(sdf(box + "<material><diffuse>1 0</diffuse></material>")), 1);
  const Scene short_form = sdf(box + "<material><diffuse>1 0 0</diffuse></material>");
  EXPECT_EQ(told(short_form), 0);
  EXPECT_EQ(*short_form.visuals.at(0).colour, Vector3d(1, 0, 0));
  const auto mjcf = [](const std::string& geom, const std::string& asset = "") {
    return read(".xml", "<mujoco><asset>" + asset +
                            "</asset><worldbody><body><joint/><inertial mass='1' pos='0 0 0' "
                            "diaginertia='1 1 1'/><geom " +
                            geom + "/></body></worldbody></mujoco>");
  };
  for (const std::string wrong :
       {"type='sphare' size='1'", "size='-1'", "type='box' size='1'", "size='1' rgba='1 2'"})
    EXPECT_EQ(told(mjcf(wrong)), 1) << wrong;
  EXPECT_EQ(told(mjcf("size='1' material='m'", "<material name='m' rgba='1'/>")), 1);
  // No value is as not given.
  const Scene empty = mjcf("size='1' rgba='' quat='' name=''");
  EXPECT_EQ(told(empty), 0);
  EXPECT_EQ(empty.visuals.size(), 1U);
}

}  // namespace
}  // namespace momenta::core_visuals
