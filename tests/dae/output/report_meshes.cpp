// Meshes of a page: as they are where there is room, else with the points of each cell as one;
// placed as the file of each format says; what is left out is told. Faces of solids for figures.

#include "equations/scene_folder.h"

#include <momenta/dae/output/figure.h>
#include <momenta/dae/output/mechanism_view.h>
#include <momenta/dae/output/meshes.h>
#include <momenta/dae/output/picture_data.h>
#include <momenta/dae/run/motion.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <numbers>

namespace momenta::dae_report_meshes {
namespace {

using Eigen::Vector3d;

/// A ball of radius 1 about (0, 0, 2) with n × 2n quadrangles.
std::string ball(int n) {
  std::string text;
  for (int i = 0; i <= n; ++i)
    for (int k = 0; k < 2 * n; ++k) {
      const double u = std::numbers::pi * i / n, v = std::numbers::pi * k / n;
      text += "v " + std::to_string(std::sin(u) * std::cos(v)) + " " +
              std::to_string(std::sin(u) * std::sin(v)) + " " + std::to_string(2 + std::cos(u)) +
              "\n";
    }
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < 2 * n; ++k) {
      const auto at = [&](int a, int b) { return std::to_string(1 + a * 2 * n + b % (2 * n)); };
      text +=
          "f " + at(i, k) + " " + at(i + 1, k) + " " + at(i + 1, k + 1) + " " + at(i, k + 1) + "\n";
    }
  return text;
}

class PageMeshes : public equations::SceneFolder {
 protected:
  Picture picture(const Scene& scene) const { return picture_of(Mechanism(scene)); }
};

const std::string one_body =
    "[[body]]\nname='a'\nmass=1\ninertia=1\n[[joint]]\nname='A'\nkind='revolute'\nchild='a'\n";

TEST_F(PageMeshes, KeepTheirShapeWithinTheBytes) {
  write("ball.obj", ball(60));
  const Scene scene = read("s.toml", one_body +
                                         "[[visual]]\nbody='a'\nkind='mesh'\nfile="
                                         "'ball.obj'\nscale=[2, 1, -1]\n");
  double last = 0;
  for (const std::size_t bytes : {5'000UL, 50'000UL, 400'000UL}) {
    Picture p = picture(scene);
    EXPECT_TRUE(take_meshes(p, scene.file, bytes).empty());
    ASSERT_EQ(p.meshes.size(), 1U);
    const Picture::Triangles& mesh = p.meshes[0];
    EXPECT_LE(8 * (mesh.points.size() + mesh.corners.size()), bytes);
    EXPECT_GT(mesh.corners.size(), bytes / 100);
    // Turned the right way round, though the scale mirrors: its inside is positive, 8/3 π.
    double volume = 0;  // seen from the middle
    const Vector3d o(0, 0, -2);
    for (const auto& t : mesh.corners)
      volume += (mesh.points[t[0]] - o).dot((mesh.points[t[1]] - o).cross(mesh.points[t[2]] - o)) /
                (6 * 8 * std::numbers::pi / 3);
    EXPECT_GT(volume, last);
    last = volume;
    const std::string json = picture_json(p).dump();
    EXPECT_LT(json.size(), bytes + 4000);
    EXPECT_GT(json.size(), 8 * mesh.corners.size());
  }
  EXPECT_NEAR(last, 1, 2e-3);  // as it is in the file
  Picture none = picture(scene);
  EXPECT_EQ(take_meshes(none, scene.file, 0),
            std::vector<std::string>{"left out of the page: meshes (1), by --mesh-bytes 0"});
  EXPECT_TRUE(none.meshes.empty());
  EXPECT_EQ(picture_json(none)["solids"].size(), 0U);
}

TEST_F(PageMeshes, OnesThatCannotBeReadAreTold) {
  write("bad.stl", "solid x\nvertex 1 2\n");
  const Scene scene =
      read("s.toml", one_body +
                         "[[visual]]\nbody='a'\nkind='mesh'\nfile='bad.stl'\n[[visual]]\n"
                         "body='a'\nkind='mesh'\nfile='none.stl'\n");
  Picture p = picture(scene);
  const auto told = take_meshes(p, scene.file, 1000);
  ASSERT_EQ(told.size(), 2U);
  EXPECT_NE(told[0].find("bad.stl"), std::string::npos) << told[0];
  EXPECT_NE(told[1].find("none.stl"), std::string::npos) << told[1];
  EXPECT_TRUE(p.meshes.empty());
}

TEST_F(PageMeshes, LimitsAreInThePicture) {
  const std::string limits = "limits = [-0.5, 1.25]\n";
  const auto json = picture_json(picture(read("l.toml", one_body + limits)));
  EXPECT_EQ(json["bodies"][0]["limits"], nlohmann::ordered_json::array({-0.5, 1.25}));
  EXPECT_FALSE(picture_json(picture(read("n.toml", one_body)))["bodies"][0].contains("limits"));
}

/// Where the picture has the point (0, 0, 1) of the mesh's file, body axes.
Vector3d drawn_point(const Picture& p) {
  const VisualSpec& v = p.solids.at(0).visual;
  return v.position + v.rotation * v.size.cwiseProduct(Vector3d(0, 0, 1));
}

TEST_F(PageMeshes, StandWhereTheFilesSay) {
  std::filesystem::create_directories(write("x", "").parent_path() / "robot" / "meshes");
  write("robot/meshes/b.obj", ball(4));
  write("b.obj", ball(4));
  const auto urdf = [&](const std::string& name) {
    return "<robot name='r'><link name='base'/><link name='a'><inertial><mass value='1'/><inertia "
           "ixx='1' iyy='1' izz='1'/></inertial><visual><origin xyz='1 2 3' "
           "rpy='1.5707963267948966 "
           "0 0'/><geometry><mesh filename='" +
           name +
           "' scale='1 1 2'/></geometry><material name="
           "'blue'/></visual></link><joint name='j' type='continuous'><parent link='base'/><child "
           "link='a'/></joint><material name='blue'><color rgba='0 0 1 1'/></material></robot>";
  };
  for (const char* name : {"b.obj", "file://b.obj", "package://robot/meshes/b.obj"}) {
    const Scene scene = read("r.urdf", urdf(name));
    ASSERT_EQ(scene.visuals.size(), 1U) << name;
    EXPECT_LE((drawn_point(picture(scene)) - Vector3d(1, 0, 3)).norm(), 1e-12) << name;
    EXPECT_EQ(*scene.visuals[0].colour, Vector3d(0, 0, 1));
  }
  const Scene gone = read("r.urdf", urdf("package://robot/none.obj"));
  EXPECT_TRUE(gone.visuals.empty());
  EXPECT_EQ(gone.remarks,
            std::vector<std::string>{"left out: meshes to draw whose files are not there (1)"});

  const auto mjcf = [&](const std::string& asset) {
    return read("m.xml", "<mujoco><compiler angle='radian'/><asset><mesh name='b' file='b.obj' " +
                             asset +
                             "/></asset><worldbody><body pos='9 9 9'><joint/><inertial pos="
                             "'0 0 0' mass='1' diaginertia='1 1 1'/><geom type='mesh' mesh='b' "
                             "pos='1 2 3' euler='1.5707963267948966 0 0'/></body></worldbody>"
                             "</mujoco>");
  };
  // scale · Rᵀ (p − refpos), then the geom's frame: x stays, y → z, z → −y
  EXPECT_LE((drawn_point(picture(mjcf("scale='1 1 2'"))) - Vector3d(1, 0, 3)).norm(), 1e-12);
  EXPECT_LE(
      (drawn_point(picture(mjcf("scale='1 1 2' refpos='0 0 .5'"))) - Vector3d(1, 1, 3)).norm(),
      1e-12);
  // refquat turns x to y: its inverse takes z to z
  EXPECT_LE((drawn_point(picture(mjcf("refquat='.5 .5 .5 .5' refpos='0 0 .5'"))) -
             (Vector3d(1, 2, 3) + Vector3d(0, 0, 0.5)))
                .norm(),
            1e-12);
}

// Faces of every kind enclose the solid: their volume by the divergence theorem, outside outwards.
TEST(SolidFaces, EncloseTheirSolids) {
  const double pi = std::numbers::pi;
  const auto volume = [](const char* kind, const Vector3d& size) {
    Picture::Solid solid;
    solid.visual.kind = kind;
    solid.visual.size = size;
    solid.visual.position = {3, 4, 5};
    solid.visual.rotation = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized());
    double sum = 0;
    for (const Face& face : faces_of({}, solid))
      for (std::size_t i = 1; i + 1 < face.size(); ++i)
        sum += face[0].dot(face[i].cross(face[i + 1])) / 6;
    return sum;
  };
  const double polygon = 14 * std::sin(2 * pi / 14) / (2 * pi);  // of 14 sides, over its circle
  EXPECT_NEAR(volume("box", {1, 2, 3}), 6, 1e-12);
  EXPECT_NEAR(volume("cylinder", {2, 0.5, 0}), polygon * pi * 0.25 * 2, 1e-12);
  EXPECT_NEAR(volume("sphere", {0.5, 0, 0}) / (pi / 6), 1, 0.08);
  EXPECT_NEAR(volume("ellipsoid", {1, 2, 3}) / (8 * pi), 1, 0.08);
  EXPECT_NEAR(volume("capsule", {2, 0.5, 0}) / (pi * 0.5 + pi / 6), 1, 0.1);
}

// What view shows of a scene that drives move: the crank at the end where the law has it, the loop
// closed in every frame.
TEST_F(PageMeshes, ViewPlaysWhatDrivesMove) {
  const Scene scene = read("d.toml", R"(
[run]
end = 3
[[body]]
name = "crank"
mass = 1
shape = { kind = "rod", length = 1 }
[[body]]
name = "coupler"
mass = 1
shape = { kind = "rod", length = 2 }
[[body]]
name = "rocker"
mass = 1
shape = { kind = "rod", length = 2 }
[[joint]]
name = "O"
kind = "revolute"
child = "crank"
[[joint]]
name = "A"
kind = "revolute"
parent = "crank"
child = "coupler"
origin = { parent = [1, 0, 0] }
position = 0.5
[[joint]]
name = "C"
kind = "revolute"
child = "rocker"
origin = { parent = [2.2, 0, 0] }
position = 1.5
[[loop]]
name = "B"
kind = "revolute"
parent = "coupler"
child = "rocker"
origin = { parent = [2, 0, 0], child = [2, 0, 0] }
[[drive]]
joint = "O"
kind = "polynomial"
coefficients = [0.3, 2]
)");
  const Mechanism mechanism(scene);
  const Assembly assembly = assemble(mechanism);
  StudyResult study;
  EXPECT_TRUE(show(study, mechanism, assembly).empty());
  ASSERT_EQ(study.motions.size(), 1U);
  const Motion& motion = study.motions[0];
  ASSERT_GT(motion.frames.size(), 50U);
  EXPECT_NEAR(motion.start + motion.every * static_cast<double>(motion.frames.size() - 1), 3, 0.05);
  for (std::size_t k = 0; k < motion.frames.size(); ++k) {
    const double t = motion.start + motion.every * static_cast<double>(k);
    EXPECT_LE(motion.frames[k].gap[0].norm(), 1e-9) << t;
    const auto at = places(study.picture, motion.frames[k]);
    const double angle = std::atan2(at[0].linear()(1, 0), at[0].linear()(0, 0));
    EXPECT_NEAR(std::remainder(angle - 0.3 - 2 * t, 2 * std::numbers::pi), 0, 1e-9) << t;
  }
}

}  // namespace
}  // namespace momenta::dae_report_meshes
