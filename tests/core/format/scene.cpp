// Scenes that are right: every key of the format arrives where scene.h says.

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

namespace momenta::core_scene {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double algebra_tol = 1e-15;  // a few roundings of numbers of order one

/// A scene of one body, held by one revolute joint; `body` and `joint` are further lines of theirs.
Scene with(const std::string& body, const std::string& joint = "",
           const std::string& kind = "revolute") {
  return parse_scene("[[body]]\nname = \"b\"\nmass = 3.0\n" + body +
                     "\n[[joint]]\nname = \"j\"\nkind = \"" + kind + "\"\nchild = \"b\"\n" + joint);
}

const std::string point = "shape = { kind = \"point\" }";

TEST(Scene, CrankRocker) {
  const Scene scene = parse_scene(R"(
name    = "Planar crank-rocker"
gravity = [0.0, -9.81, 0]

[[body]]
name  = "crank"
mass  = 1
shape = { kind = "rod", length = 0.5, axis = "x" }
[[body]]
name    = "coupler"
mass    = 2.5
com     = [0.5, 0.25, 0]
inertia = [1, 2, 2.5, 0.1, 0.2, 0.3]

[[joint]]
name     = "O"
kind     = "revolute"
parent   = "ground"
child    = "crank"
origin   = { parent = [1, 2, 3], child = [4, 5, 6] }
axis     = [0, 0, 2]
position = 1.5
velocity = -2
stiffness = 3.5
rest      = 0.25
damping   = 0.125
[[joint]]
name   = "A"
kind   = "prismatic"
parent = "crank"
child  = "coupler"
position = [0.75]

[[loop]]
name   = "C"
kind   = "revolute"
parent = "crank"
child  = "coupler"
origin = { parent = [0.1, 0.2, 0.3] }
axis   = "-y"
[[loop]]
name   = "D"
kind   = "distance"
child  = "coupler"
length = 2

[[marker]]
name  = "tip"
body  = "crank"
point = [0.5, 0, 0]

[assembly]
hold = ["O"]

[run]
end     = 5
step    = 1e-3
leak    = 10
samples = 200
project = true
)",
                                  "crank.toml");
  EXPECT_EQ(scene.file, "crank.toml");
  EXPECT_EQ(scene.name, "Planar crank-rocker");
  EXPECT_EQ(scene.gravity, Vector3d(0, -9.81, 0));

  ASSERT_EQ(scene.bodies.size(), 2U);
  EXPECT_EQ(scene.bodies[0].name, "crank");
  EXPECT_EQ(scene.bodies[0].mass, 1);
  EXPECT_EQ(scene.bodies[0].shape.kind, "rod");
  EXPECT_EQ(scene.bodies[0].at.line, 5);
  EXPECT_EQ(scene.bodies[0].at.column, 1);
  EXPECT_EQ(scene.bodies[1].com, Vector3d(0.5, 0.25, 0));
  EXPECT_EQ(scene.bodies[1].inertia,
            (Matrix3d() << 1, 0.1, 0.2, 0.1, 2, 0.3, 0.2, 0.3, 2.5).finished());

  ASSERT_EQ(scene.joints.size(), 2U);
  const JointSpec& o = scene.joints[0];
  EXPECT_EQ(o.name, "O");
  EXPECT_EQ(o.kind, JointKind::revolute);
  EXPECT_EQ(o.parent, "ground");
  EXPECT_EQ(o.child, "crank");
  EXPECT_EQ(o.origin_parent, Vector3d(1, 2, 3));
  EXPECT_EQ(o.origin_child, Vector3d(4, 5, 6));
  EXPECT_EQ(o.axis, Vector3d::UnitZ());
  EXPECT_EQ(o.rotation.coeffs(), Eigen::Quaterniond::Identity().coeffs());
  EXPECT_EQ(o.position, std::vector<double>{1.5});
  EXPECT_EQ(o.velocity, std::vector<double>{-2.0});
  EXPECT_EQ(o.stiffness, 3.5);
  EXPECT_EQ(o.rest, 0.25);
  EXPECT_EQ(o.damping, 0.125);
  EXPECT_EQ(o.at.line, 15);
  const JointSpec& a = scene.joints[1];
  EXPECT_EQ(a.kind, JointKind::prismatic);
  EXPECT_EQ(a.parent, "crank");
  EXPECT_EQ(a.origin_parent, Vector3d::Zero());
  EXPECT_EQ(a.position, std::vector<double>{0.75});
  EXPECT_TRUE(a.velocity.empty());

  ASSERT_EQ(scene.loops.size(), 2U);
  const LoopSpec& c = scene.loops[0];
  EXPECT_EQ(c.name, "C");
  EXPECT_EQ(c.kind, LoopKind::revolute);
  EXPECT_EQ(c.parent, "crank");
  EXPECT_EQ(c.child, "coupler");
  EXPECT_EQ(c.origin_parent, Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(c.origin_child, Vector3d::Zero());
  EXPECT_EQ(c.axis, -Vector3d::UnitY());
  EXPECT_EQ(scene.loops[1].kind, LoopKind::distance);
  EXPECT_EQ(scene.loops[1].parent, "ground");
  EXPECT_EQ(scene.loops[1].length, 2);

  ASSERT_EQ(scene.markers.size(), 1U);
  EXPECT_EQ(scene.markers[0].name, "tip");
  EXPECT_EQ(scene.markers[0].body, "crank");
  EXPECT_EQ(scene.markers[0].point, Vector3d(0.5, 0, 0));

  EXPECT_EQ(scene.held, std::vector<std::string>{"O"});
  EXPECT_EQ(scene.run.end_time, 5);
  EXPECT_EQ(scene.run.step, 1e-3);
  EXPECT_EQ(scene.run.leak, 10);
  EXPECT_EQ(scene.run.samples, 200);
  EXPECT_TRUE(scene.run.project);
}

TEST(Scene, DefaultsAreThoseOfTheHeader) {
  const Scene scene = with(point);
  const Scene blank;
  EXPECT_EQ(scene.file, "scene");
  EXPECT_EQ(scene.name, "");
  EXPECT_EQ(scene.gravity, Vector3d::Zero());
  EXPECT_EQ(scene.run.end_time, blank.run.end_time);
  EXPECT_FALSE(scene.run.step.has_value());
  EXPECT_FALSE(scene.run.leak.has_value());
  EXPECT_EQ(scene.run.samples, blank.run.samples);
  EXPECT_EQ(scene.joints[0].parent, "ground");
  EXPECT_EQ(scene.joints[0].axis, Vector3d::UnitZ());
  EXPECT_TRUE(scene.joints[0].position.empty());
  EXPECT_TRUE(scene.held.empty());
}

TEST(Scene, InlineTablesAndMassless) {
  const Scene scene = parse_scene(R"(
body  = [{ name = "b", mass = 0 }]
joint = [{ name = "j", kind = "weld", child = "b" }]
loop  = []
)");
  ASSERT_EQ(scene.bodies.size(), 1U);
  EXPECT_EQ(scene.bodies[0].mass, 0);
  EXPECT_EQ(scene.bodies[0].inertia, Matrix3d::Zero());
  EXPECT_EQ(scene.joints[0].kind, JointKind::weld);
}

TEST(Scene, Shapes) {
  const auto body = [](const std::string& lines) { return with(lines).bodies[0]; };

  // rod, m l²/12 across: 3·4/12 = 1
  const BodySpec rod = body("shape = { kind = \"rod\", length = 2, axis = \"-y\" }");
  EXPECT_EQ(rod.com, Vector3d(0, -1, 0));
  EXPECT_EQ(rod.inertia, Matrix3d(Vector3d(1, 0, 1).asDiagonal()));
  EXPECT_EQ(rod.shape.axis, -Vector3d::UnitY());
  const BodySpec slanted = body("shape = { kind = \"rod\", length = 2, axis = [3, 4, 0] }");
  EXPECT_LT((slanted.com - Vector3d(0.6, 0.8, 0)).norm(), algebra_tol);
  EXPECT_LT((slanted.inertia * slanted.com).norm(), algebra_tol);

  // box, m/12 (y² + z²): 3/12 (4 + 9), ...
  const BodySpec box = body("shape = { kind = \"box\", size = [1, 2, 3] }");
  EXPECT_EQ(box.com, Vector3d::Zero());
  EXPECT_EQ(box.inertia, Matrix3d(Vector3d(13.0 / 4, 10.0 / 4, 5.0 / 4).asDiagonal()));
  EXPECT_EQ(body("com = [1, 0, 0]\nshape = { kind = \"box\", size = [1, 2, 3] }").com,
            Vector3d::UnitX());

  // cylinder, m r²/2 = 6 along, m (3 r² + l²)/12 = 4 across
  const BodySpec cylinder =
      body("shape = { kind = \"cylinder\", length = 2, radius = 2, axis = \"z\" }");
  EXPECT_EQ(cylinder.inertia, Matrix3d(Vector3d(4, 4, 6).asDiagonal()));
  EXPECT_EQ(cylinder.shape.size, Vector3d(2, 2, 0));

  // sphere, 2/5 m r² = 4.8
  const BodySpec sphere = body("shape = { kind = \"sphere\", radius = 2 }");
  EXPECT_LT((sphere.inertia - 4.8 * Matrix3d::Identity()).norm(), 4 * algebra_tol);

  const BodySpec particle = body("com = [1, 2, 3]\n" + point);
  EXPECT_EQ(particle.com, Vector3d(1, 2, 3));
  EXPECT_EQ(particle.inertia, Matrix3d::Zero());
}

TEST(Scene, WrittenOutWinsOverShape) {
  const BodySpec body =
      with("com = [0, 0, 1]\ninertia = [1, 1, 1]\nshape = { kind = \"rod\", length = 2 }")
          .bodies[0];
  EXPECT_EQ(body.com, Vector3d::UnitZ());
  EXPECT_EQ(body.inertia, Matrix3d::Identity());
  EXPECT_EQ(body.shape.kind, "rod");
  EXPECT_EQ(body.shape.size, Vector3d(2, 0, 0));
}

TEST(Scene, PlanarInertiaIsThatOfAPlate) {
  EXPECT_EQ(with("inertia = 0.5").bodies[0].inertia,
            Matrix3d(Vector3d(0.25, 0.25, 0.5).asDiagonal()));
  EXPECT_EQ(with("inertia = 0").bodies[0].inertia, Matrix3d::Zero());
}

TEST(Scene, InertiaOnTheEdgeOfTheTriangleInequality) {
  EXPECT_NO_THROW(with("inertia = [1, 2, 3]"));
  EXPECT_NO_THROW(with("inertia = [1, 2, 3.000000001]"));
  EXPECT_THROW(with("inertia = [1, 2, 3.00000001]"), SceneError);
  EXPECT_NO_THROW(with("inertia = [1e-300, 2e-300, 3e-300]"));
  EXPECT_THROW(with("inertia = [1e300, 2e300, 4e300]"), SceneError);
}

TEST(Scene, Rotations) {
  const auto rotated = [](const std::string& rotation, const Vector3d& v) -> Vector3d {
    return with(point, "rotation = { " + rotation + " }").joints[0].rotation * v;
  };
  // Rz(π/2) Ry(0) Rx(π/2) takes z over −y to x
  const std::string quarter = std::to_string(std::numbers::pi / 2);
  const double digits_tol = 1e-6;  // std::to_string writes six decimals
  EXPECT_LT((rotated("rpy = [" + quarter + ", 0, " + quarter + "]", Vector3d::UnitZ()) -
             Vector3d::UnitX())
                .norm(),
            digits_tol);
  const Matrix3d expected =
      (Eigen::AngleAxisd(0.3, Vector3d::UnitZ()) * Eigen::AngleAxisd(0.2, Vector3d::UnitY()) *
       Eigen::AngleAxisd(0.1, Vector3d::UnitX()))
          .toRotationMatrix();
  const Vector3d v(1, 2, 3);
  EXPECT_LT((rotated("rpy = [0.1, 0.2, 0.3]", v) - expected * v).norm(), 8 * algebra_tol);
  EXPECT_LT((rotated("quaternion = [0.6, 0.8, 0, 0]", Vector3d::UnitY()) - Vector3d(0, -0.28, 0.96))
                .norm(),
            2 * algebra_tol);
  EXPECT_LT((rotated("axis = \"z\", angle = 0.5", Vector3d::UnitX()) -
             Vector3d(std::cos(0.5), std::sin(0.5), 0))
                .norm(),
            2 * algebra_tol);
  EXPECT_LT((rotated("axis = [0, 0, 7], angle = 0.5", v) - rotated("axis = \"z\", angle = 0.5", v))
                .norm(),
            8 * algebra_tol);
  const Eigen::Quaterniond nearly =
      with(point, "rotation = { quaternion = [0.9999995, 0, 0, 0] }").joints[0].rotation;
  EXPECT_EQ(nearly.w(), 1);
}

TEST(Scene, AxesOfAnyLength) {
  for (const char* axis : {"[3, 4, 0]", "[3e200, 4e200, 0]", "[3e-300, 4e-300, 0]"})
    EXPECT_LT(
        (with(point, std::string("axis = ") + axis).joints[0].axis - Vector3d(0.6, 0.8, 0)).norm(),
        algebra_tol);
}

TEST(Scene, StatesOfManyNumbers) {
  const JointSpec spherical =
      with(point, "position = [0.6, 0, 0, 0.8000004]\nvelocity = [1, 2, 3]", "spherical").joints[0];
  ASSERT_EQ(spherical.position.size(), 4U);
  EXPECT_NEAR(std::hypot(spherical.position[0], spherical.position[3]), 1, algebra_tol);
  EXPECT_EQ(spherical.velocity, (std::vector<double>{1, 2, 3}));
  const JointSpec loose =
      with(point, "position = [1, 2, 3, 1, 0, 0, 0]\nvelocity = [1, 2, 3, 4, 5, 6]", "free")
          .joints[0];
  EXPECT_EQ(loose.position, (std::vector<double>{1, 2, 3, 1, 0, 0, 0}));
  EXPECT_EQ(loose.velocity.size(), 6U);
}

TEST(Scene, AllJointKinds) {
  const std::pair<const char*, JointKind> kinds[] = {
      {"revolute", JointKind::revolute},
      {"prismatic", JointKind::prismatic},
      {"cylindrical", JointKind::cylindrical},
      {"universal", JointKind::universal},
      {"spherical", JointKind::spherical},
      {"planar", JointKind::planar},
      {"free", JointKind::free},
      {"weld", JointKind::weld},
  };
  for (const auto& [name, kind] : kinds) EXPECT_EQ(with(point, "", name).joints[0].kind, kind);

  const JointSpec screw =
      with(point, "pitch = -0.25\nposition = 1.5\nstiffness = 2", "helical").joints[0];
  EXPECT_EQ(screw.kind, JointKind::helical);
  EXPECT_EQ(screw.pitch, -0.25);
  EXPECT_EQ(screw.position, std::vector<double>{1.5});
  EXPECT_EQ(screw.stiffness, 2);

  const JointSpec cross =
      with(point, "axis = \"x\"\naxis2 = [0, 3, 4]\nposition = [1, 2]", "universal").joints[0];
  EXPECT_LT((cross.axis2 - Vector3d(0, 0.6, 0.8)).norm(), algebra_tol);
  EXPECT_EQ(cross.position, (std::vector<double>{1, 2}));
  EXPECT_EQ(with(point, "", "universal").joints[0].axis2, Vector3d::Zero());

  const JointSpec table =
      with(point, "direction = [1, 0, 1]\nposition = [1, 2, 3]\nvelocity = [4, 5, 6]", "planar")
          .joints[0];
  EXPECT_LT((table.direction - Vector3d(1, 0, 1).normalized()).norm(), algebra_tol);
  EXPECT_EQ(table.position, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(table.velocity, (std::vector<double>{4, 5, 6}));
}

TEST(Scene, PerpendicularByHand) {
  EXPECT_EQ(perpendicular_to(Vector3d::UnitX()), Vector3d::UnitY());
  EXPECT_EQ(perpendicular_to(Vector3d::UnitY()), Vector3d::UnitZ());
  EXPECT_EQ(perpendicular_to(Vector3d::UnitZ()), Vector3d::UnitX());
  EXPECT_EQ(perpendicular_to(-2 * Vector3d::UnitZ()), Vector3d::UnitX());
  // x and y equally near: the first, x, so along y, less its part along the axis
  EXPECT_LT((perpendicular_to({1, -1, 0}) - Vector3d(1, 1, 0).normalized()).norm(), algebra_tol);
  EXPECT_LT((perpendicular_to({1 - 1e-15, 1, 0}) - Vector3d(-1, 1, 0).normalized()).norm(), 1e-14);
}

TEST(Scene, DrivesOfCoordinates) {
  const auto drive = [](int coordinate) {
    return "[[drive]]\njoint = \"j\"\ncoordinate = " + std::to_string(coordinate) +
           "\nkind = \"polynomial\"\ncoefficients = [1]\n";
  };
  const Scene scene = with(point, drive(2) + drive(0), "planar");
  ASSERT_EQ(scene.drives.size(), 2U);
  EXPECT_EQ(scene.drives[0].coordinate, 2);
  EXPECT_EQ(scene.drives[1].coordinate, 0);
  EXPECT_NO_THROW(with(point, drive(1) + drive(2) + drive(0), "spherical"));
  std::string all;
  for (int i = 0; i < 6; ++i) all += drive(i);
  EXPECT_NO_THROW(with(point, all, "free"));
}

TEST(Scene, LoopKinds) {
  const std::pair<const char*, LoopKind> kinds[] = {
      {"point", LoopKind::point},
      {"revolute", LoopKind::revolute},
      {"spherical", LoopKind::spherical},
      {"weld", LoopKind::weld},
      {"prismatic", LoopKind::prismatic},
      {"universal", LoopKind::universal},
      {"cylindrical", LoopKind::cylindrical},
      {"planar", LoopKind::planar},
  };
  for (const auto& [name, kind] : kinds)
    EXPECT_EQ(
        with(point, std::string("[[loop]]\nname = \"c\"\nchild = \"b\"\nkind = \"") + name + "\"")
            .loops.at(0)
            .kind,
        kind);
}

TEST(Scene, DrivesAndForces) {
  const Scene scene = with(point, R"(
[[body]]
name = "c"
mass = 0
[[body]]
name = "d"
mass = 0
[[body]]
name = "e"
mass = 0
[[joint]]
name = "k"
kind = "prismatic"
parent = "b"
child = "c"
[[joint]]
name = "l"
kind = "revolute"
parent = "c"
child = "d"
[[joint]]
name = "m"
kind = "revolute"
parent = "d"
child = "e"

[[drive]]
joint = "j"
kind = "polynomial"
coefficients = [1, 2.5]
[[drive]]
joint = "k"
kind = "harmonic"
offset = 1
amplitude = 2
frequency = 3
phase = 4
[[drive]]
joint = "l"
kind = "step"
from = 1
to = 2
start = 3
duration = 4
[[drive]]
joint = "m"
kind = "table"
times = [0, 1, 3]
values = [0, 1, 0.5]

[[force]]
name = "spring"
kind = "spring-damper"
parent = "b"
child = "c"
origin = { parent = [1, 0, 0], child = [0, 1, 0] }
stiffness = 5
damping = 6
rest = 7
[[force]]
kind = "torque"
joint = "k"
value = -2
[[force]]
kind = "wrench"
body = "c"
point = [1, 2, 3]
force = [4, 5, 6]
torque = [7, 8, 9]
axes = "body"
)");
  ASSERT_EQ(scene.drives.size(), 4U);
  EXPECT_EQ(scene.drives[0].joint, "j");
  EXPECT_EQ(scene.drives[0].kind, "polynomial");
  EXPECT_EQ(scene.drives[0].coefficients, (std::vector<double>{1, 2.5}));
  EXPECT_EQ(scene.drives[1].offset, 1);
  EXPECT_EQ(scene.drives[1].amplitude, 2);
  EXPECT_EQ(scene.drives[1].frequency, 3);
  EXPECT_EQ(scene.drives[1].phase, 4);
  EXPECT_EQ(scene.drives[2].from, 1);
  EXPECT_EQ(scene.drives[2].to, 2);
  EXPECT_EQ(scene.drives[2].start, 3);
  EXPECT_EQ(scene.drives[2].duration, 4);
  EXPECT_EQ(scene.drives[3].times, (std::vector<double>{0, 1, 3}));
  EXPECT_EQ(scene.drives[3].values, (std::vector<double>{0, 1, 0.5}));

  ASSERT_EQ(scene.forces.size(), 3U);
  const ForceSpec& spring = scene.forces[0];
  EXPECT_EQ(spring.name, "spring");
  EXPECT_EQ(spring.kind, "spring-damper");
  EXPECT_EQ(spring.parent, "b");
  EXPECT_EQ(spring.child, "c");
  EXPECT_EQ(spring.origin_parent, Vector3d::UnitX());
  EXPECT_EQ(spring.origin_child, Vector3d::UnitY());
  EXPECT_EQ(spring.stiffness, 5);
  EXPECT_EQ(spring.damping, 6);
  EXPECT_EQ(spring.rest, 7);
  EXPECT_EQ(scene.forces[1].joint, "k");
  EXPECT_EQ(scene.forces[1].value, -2);
  const ForceSpec& wrench = scene.forces[2];
  EXPECT_EQ(wrench.body, "c");
  EXPECT_EQ(wrench.point, Vector3d(1, 2, 3));
  EXPECT_EQ(wrench.force, Vector3d(4, 5, 6));
  EXPECT_EQ(wrench.torque, Vector3d(7, 8, 9));
  EXPECT_TRUE(wrench.in_body_axes);
}

TEST(Scene, ReadFromFile) {
  const auto file = std::filesystem::temp_directory_path() / "momenta_core_scene_read.toml";
  std::ofstream(file) << "\xef\xbb\xbfname = \"ü\"\r\n[[body]]\r\nname = \"b\"\r\nmass = 0\r\n"
                         "[[joint]]\r\nname = \"j\"\r\nkind = \"free\"\r\nchild = \"b\"\r\n";
  const Scene scene = read_scene(file);
  EXPECT_EQ(scene.file, file.string());
  EXPECT_EQ(scene.name, "ü");
  EXPECT_EQ(scene.bodies.size(), 1U);
  std::filesystem::remove(file);
}

TEST(Scene, Where) {
  Scene scene;
  EXPECT_EQ(scene.where({}), "scene: ");
  scene.file = "a.toml";
  EXPECT_EQ(scene.where({}), "a.toml: ");
  EXPECT_EQ(scene.where({3, 4}), "a.toml:3:4: ");
}

TEST(Scene, LongChain) {
  std::string text;
  const int n = 20000;
  for (int i = 0; i < n; ++i) {
    const std::string name = "b" + std::to_string(i);
    text += "[[body]]\nname = \"" + name + "\"\nmass = 1\ninertia = 1\n[[joint]]\nname = \"j" +
            std::to_string(i) + "\"\nkind = \"revolute\"\nchild = \"" + name + "\"\nparent = \"" +
            (i == 0 ? "ground" : "b" + std::to_string(i - 1)) + "\"\n";
  }
  EXPECT_EQ(parse_scene(text).bodies.size(), static_cast<std::size_t>(n));
  // closed upon itself: told in one short sentence
  text.replace(text.find("\"ground\""), 8, "\"b19999\"");
  try {
    parse_scene(text);
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("form a cycle"), std::string::npos);
    EXPECT_LT(std::string(error.what()).size(), 500U);
  }
}

}  // namespace
}  // namespace momenta::core_scene
