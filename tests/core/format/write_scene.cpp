// Scenes written as TOML and read again are the same, bit by bit.

#include "equations/random_tree.h"
#include "equations/same_scene.h"

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/format/toml/write_scene.h>

#include <filesystem>

namespace momenta::core_write_scene {
namespace {

namespace fs = std::filesystem;
using equations::difference;

/// Read, written, read: nothing differs, and the text does not change any more.
void expect_exact(const Scene& scene) {
  const std::string text = scene_text(scene);
  const Scene again = parse_scene(text, "written.toml");
  EXPECT_EQ(difference(scene, again), "");
  Scene named = again;
  named.remarks = scene.remarks;
  EXPECT_EQ(scene_text(named), text);
}

std::vector<fs::path> files_with(const std::vector<std::string>& endings) {
  std::vector<fs::path> files;
  for (const auto& entry :
       fs::recursive_directory_iterator(fs::path(MOMENTA_SOURCE_DIR) / "examples"))
    for (const std::string& ending : endings)
      if (entry.path().extension() == ending &&
          entry.path().string().find("/suites/") == std::string::npos)  // equations, no scenes
        files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

// Coordinates with dots, both units of constraints, forces on some coordinates only.
TEST(WriteScene, EveryKeyOfALagrangian) {
  const Scene scene = parse_scene(R"toml(
[parameters]
k = 3
[lagrangian]
coordinates = ["x", "arm.angle"]
units = ["m", "rad"]
position = ["k / 2", 0.25]
velocity = [0, -1]
kinetic = "x.dot^2 + arm.angle.dot^2"
potential = "k * x^2"
force = { "arm.angle" = "-k * arm.angle.dot" }
[[lagrangian.constraints]]
name = "turn"
equation = "arm.angle - t"
unit = "rad"
[[lagrangian.constraints]]
name = "shift"
equation = "x - k * sin(t)"
)toml",
                                  "typed.toml");
  const std::string text = scene_text(scene);
  const Scene again = parse_scene(text, "written.toml");
  EXPECT_EQ(equations::difference(scene, again), "");
  EXPECT_EQ(scene_text(again), text);
  ASSERT_EQ(again.lagrangian->constraints.size(), 2U);
  EXPECT_TRUE(again.lagrangian->constraints[0].angle);
  EXPECT_FALSE(again.lagrangian->constraints[1].angle);
  EXPECT_EQ(again.lagrangian->coordinates[0].position, 1.5);
  EXPECT_EQ(again.lagrangian->coordinates[1].velocity, -1);
  EXPECT_EQ(again.lagrangian->coordinates[1].unit, "rad");
  ASSERT_EQ(again.lagrangian->forces.size(), 1U);
  EXPECT_EQ(again.lagrangian->forces[0].coordinate, "arm.angle");
}

TEST(WriteScene, EveryKeyOfABearing) {
  const Scene scene = parse_scene(R"toml(
[[body]]
name = "a"
mass = 1
inertia = 0.1
[[body]]
name = "b"
mass = 1
inertia = 0.1
[[joint]]
name = "A"
kind = "revolute"
child = "a"
bearing = { dynamic = 0.1, static = 0.3, transition = 0.02, radius = 0.01, length = 0.4 }
[[joint]]
name = "B"
kind = "prismatic"
child = "b"
bearing = { dynamic = 0.2 }
)toml",
                                  "typed.toml");
  expect_exact(scene);
  const BearingSpec &pin = *scene.joints[0].bearing, &slide = *scene.joints[1].bearing;
  EXPECT_EQ(pin.dynamic_friction, 0.1);
  EXPECT_EQ(pin.static_friction, 0.3);
  EXPECT_EQ(pin.transition_velocity, 0.02);
  EXPECT_EQ(pin.radius, 0.01);
  EXPECT_EQ(pin.length, 0.4);
  EXPECT_EQ(slide.static_friction, 0.2);
  EXPECT_EQ(slide.transition_velocity, 0.01);
}

TEST(WriteScene, EveryExample) {
  const auto files = files_with({".toml"});
  EXPECT_GE(files.size(), 11U);
  for (const fs::path& file : files) {
    SCOPED_TRACE(file.string());
    expect_exact(read_scene(file));
  }
}

TEST(WriteScene, EveryModel) {
  const auto files = files_with({".urdf", ".xml"});
  EXPECT_GE(files.size(), 10U);
  for (const fs::path& file : files) {
    SCOPED_TRACE(file.string());
    expect_exact(read_scene(file));
    ReadOptions floating;
    floating.free_root = true;
    if (file.extension() == ".urdf" && file.filename() != "revolute_rotor_chain.urdf")
      expect_exact(read_scene(file, floating));
  }
}

TEST(WriteScene, CurvesAndEquations) {
  const Scene scene = parse_scene(R"(
[parameters]
size = 0.3
[[body]]
name = "b"
mass = 1
inertia = 0.1
[[joint]]
name = "left-knee"
kind = "planar"
child = "b"
[[marker]]
name = "A"
body = "b"
[[loop]]
name = "line"
kind = "slot"
child = "b"
axis = [1, 1, 0]
[[loop]]
name = "ring"
kind = "slot"
child = "b"
curve = "circle"
radius = "size / 3"
axis = [1, 2, 3]
[[loop]]
name = "groove"
kind = "slot"
child = "b"
curve = "spline"
closed = true
points = [["size", 0, -0.0], [0.1, 1e-7, 0], [0.1, 0.7, 0]]
rotation = { rpy = [0.1, 0.2, 0.3] }
[[loop]]
name = "cam"
kind = "cam"
child = "b"
profile = { parent = { kind = "ellipse", semi_axes = [0.1, "2 * size"], direction = [1, 1, 0] }, child = { kind = "flat", normal = [0.28, 0.96, 0] } }
[[loop]]
name = "other cam"
kind = "cam"
child = "b"
profile = { parent = { kind = "spline", points = [[1, 0, 0], [0, 1, 0], [-1, -1, 0]] }, child = { kind = "circle", radius = 0.1 } }
[[loop]]
name = "rack"
kind = "rack"
child = "b"
radius = 0.1
offset = -0.0
direction = [1, 2, 0]
[[loop]]
name = "formula"
kind = "equation"
equation = "A.x^2 + sin('left-knee'.q2) = size"
)",
                                  "scene.toml");
  EXPECT_TRUE(scene.loops[2].curve.closed);
  EXPECT_EQ(scene.loops[2].curve.points[0].x(), 0.3);
  EXPECT_EQ(scene.loops[3].curve.semi_axes[1], 0.6);
  EXPECT_EQ(scene.loops[6].equation, "(A.x^2 + sin('left-knee'.q2) ) - ( 0.3)");
  expect_exact(scene);
}

// Every key of the format, with numbers that are hard to write.
TEST(WriteScene, EveryKey) {
  const Scene scene = parse_scene(R"(
name = "a \"quoted\" \\ name\nwith ü and \u0001"
gravity = [-0.0, 1e300, -5e-324]
[[body]]
name = "rod"
mass = 18446744073709551616.0
shape = { kind = "rod", length = 0.1, axis = [1, 2, 3] }
[[body]]
name = "box"
mass = 1
shape = { kind = "box", size = [0.1, 0.2, 0.3] }
com = [1, -0.0, 2]
[[body]]
name = "cylinder"
mass = 0.1
shape = { kind = "cylinder", length = 0.3, radius = 0.7, axis = "-y" }
[[body]]
name = "ball"
mass = 3
shape = { kind = "sphere", radius = 1e-7 }
[[body]]
name = "point"
mass = 1e22
shape = { kind = "point" }
[[body]]
name = "any"
mass = 0.3
inertia = [1, 2, 9, 0.1, -0.2, 0.3]
any_inertia = true
[[body]]
name = "planar"
mass = 0.3
inertia = 0.7
[[body]]
name = "none"
mass = 0
[[joint]]
name = "A"
kind = "revolute"
child = "rod"
origin = { parent = [1, 2, 3] }
rotation = { rpy = [0.1, 0.2, 0.3] }
axis = [1, 1, 1]
position = 0.1
velocity = -0.0
stiffness = 1e15
rest = 0.2
damping = 123456789012345680000.0
[[joint]]
name = "B"
kind = "helical"
parent = "rod"
child = "box"
pitch = 0
limits = [-1, 2]
restitution = 0.25
[[joint]]
name = "C"
kind = "universal"
parent = "box"
child = "cylinder"
axis2 = [3, 1, 1]
origin = { child = [1, 2, 3] }
[[joint]]
name = "D"
kind = "planar"
parent = "cylinder"
child = "ball"
direction = [1, 1, 0]
[[joint]]
name = "E"
kind = "free"
child = "point"
position = [1, 2, 3, 0.6, 0, 0.8000001, 0]
velocity = [1, 2, 3, 4, 5, 6]
[[joint]]
name = "F"
kind = "cylindrical"
parent = "ball"
child = "any"
[[joint]]
name = "G"
kind = "prismatic"
parent = "any"
child = "planar"
limits = [-0.1, 0.3]
stop_stiffness = 1000.1
stop_damping = 0.7
stop_width = 0.003
friction = 0.1
friction_rate = 0.3
[[joint]]
name = "H"
kind = "weld"
parent = "any"
child = "none"
rotation = { axis = [1, 2, 3], angle = 1 }
[[loop]]
name = "L"
kind = "distance"
parent = "box"
child = "point"
length = 0.1
[[loop]]
name = "M"
kind = "coupler"
joints = ["A", "D"]
coordinates = [0, 2]
ratios = [1, -0.1]
powers = [0.1, 0, -0.3]
offset = 0.3
[[loop]]
name = "N"
kind = "universal"
child = "any"
axis2 = "x"
[[loop]]
name = "P"
kind = "planar"
child = "point"
direction = "y"
[[drive]]
joint = "F"
coordinate = 0
kind = "harmonic"
amplitude = 0.1
frequency = 3
offset = 0.1
phase = 0.2
[[drive]]
loop = "P"
coordinate = 1
kind = "polynomial"
coefficients = [0, 0.1]
[[drive]]
loop = "N"
origin = "x"
kind = "step"
to = 0.1
duration = 0.3
from = 0.2
start = 0.1
[[drive]]
joint = "F"
coordinate = 1
kind = "table"
times = [0, 0.1]
values = [0, 0.3]
[[force]]
kind = "spring-damper"
name = "spring"
parent = "rod"
child = "point"
origin = { parent = [1, 0, 0], child = [0, 0.1, 0] }
stiffness = 0.1
damping = 0.2
rest = 0.3
[[force]]
kind = "bushing"
parent = "rod"
child = "point"
origin = { parent = [1, 0, 0], child = [0, 0.1, 0] }
rotation = { quaternion = [0.6, 0, 0.8, 0] }
stiffness = 0.1
damping = 0.2
rotational_stiffness = 0.3
rotational_damping = 0.4
[[force]]
kind = "coordinate-spring"
joints = ["A", "D"]
coordinates = [0, 2]
ratios = [1, -0.1]
stiffness = 0.1
damping = 0.2
rest = -0.3
[[force]]
kind = "torque"
joint = "A"
value = 0.1
[[force]]
kind = "wrench"
body = "any"
point = [1, 2, 3]
force = [4, 5, 6]
torque = [7, 8, 9]
axes = "body"
[[marker]]
name = "m"
body = "rod"
point = [0.1, 0, 0]
[[event]]
name = "up there"
when = "m.y - 0.2"
direction = "up"
stop = true
[[event]]
when = "m.vx"
direction = "down"
[[visual]]
body = "rod"
kind = "box"
size = [0.1, 0.2, 0.3]
position = [1, -0.0, 2]
rotation = { rpy = [0.1, 0.2, 0.3] }
colour = [0.1, 0, 1]
[[visual]]
body = "ground"
kind = "sphere"
radius = 0.1
[[visual]]
body = "rod"
kind = "capsule"
length = 0.1
radius = 0.3
[[visual]]
body = "rod"
kind = "cylinder"
length = 0.3
radius = 0.7
[[visual]]
body = "box"
kind = "ellipsoid"
size = [0.1, 0.2, 0.3]
[[visual]]
body = "box"
kind = "mesh"
file = "meshes/a \"b\".stl"
scale = [0.001, 1, -1]
[[visual]]
body = "box"
kind = "mesh"
file = "a.obj"
[assembly]
hold = ["A"]
[run]
end = 0.1
step = 0.001
leak = 3
samples = 7
project = true
)");
  expect_exact(scene);
}

TEST(WriteScene, RandomTrees) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    // once read, directions are of unit length to the last bit
    equations::RandomTree random(seed);
    equations::TreeRecipe recipe;
    expect_exact(parse_scene(scene_text(random.scene(recipe))));
  }
}

}  // namespace
}  // namespace momenta::core_write_scene
