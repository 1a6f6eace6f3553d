#pragma once
// Runs that are differentiated, and how they are asked for.

#include <momenta/core/format/toml/write_scene.h>
#include <momenta/core/scene/file_text.h>
#include <momenta/dae/gradient/gradient.h>

#include <string>
#include <vector>

namespace momenta::equations {

/// A four-bar with a spring across it and a point P of its coupler.
inline const std::string four_bar = R"toml(
name = "four-bar"
gravity = [0, "-g", 0]
[parameters]
g = 9.81
crank = 0.5
coupler = 2
rocker = 1.5
mass = 2
k = 30
idle = 3
[assembly]
hold = ["O"]
[[body]]
name = "crank"
mass = 1
shape = { kind = "rod", length = "crank", axis = "x" }
[[body]]
name = "coupler"
mass = "mass"
shape = { kind = "rod", length = "coupler", axis = "x" }
[[body]]
name = "rocker"
mass = 1.5
shape = { kind = "rod", length = "rocker", axis = "x" }
[[joint]]
name = "O"
kind = "revolute"
child = "crank"
position = 1.2
velocity = 0.7
[[joint]]
name = "A"
kind = "revolute"
parent = "crank"
child = "coupler"
origin = { parent = ["crank", 0, 0] }
position = -1.0
[[joint]]
name = "C"
kind = "revolute"
child = "rocker"
origin = { parent = [2, 0, 0] }
position = 1.7
[[loop]]
name = "B"
kind = "revolute"
parent = "coupler"
child = "rocker"
origin = { parent = ["coupler", 0, 0], child = ["rocker", 0, 0] }
[[force]]
kind = "spring-damper"
parent = "ground"
child = "coupler"
origin = { parent = [0, 1, 0], child = ["coupler/2", 0, 0] }
stiffness = "k"
damping = 0.4
rest = 0.6
[[marker]]
name = "P"
body = "coupler"
point = [0.7, 0.4, 0]
)toml";

/// The pendulum of a driven four-bar, with the drive's numbers as parameters.
inline std::string driven() {
  std::string text = reading::text_of(MOMENTA_SOURCE_DIR "/examples/driven/scene.toml");
  const auto put = [&](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  put("amplitude = 2.5", "amplitude = \"swing\"");
  put("length = 0.8", "length = \"long\"");
  return text + "\n[parameters]\nswing = 2.5\nlong = 0.8\n";
}

inline SceneText of_text(const std::string& text) {
  SceneText scene;
  scene.text = text;
  scene.file = "scene.toml";
  scene.options.cut = CutChoice::scene;
  return scene;
}
inline SceneText of_scene(const Scene& scene) {
  return of_text(scene_text(scene));
}

inline GradientRequest asked(const std::string& of, const std::vector<std::string>& by,
                             const std::string& form, const std::string& gauge, double end = 0.5,
                             double step = 0.005) {
  GradientRequest request;
  request.of = of;
  request.by = by;
  request.settings.form = form;
  request.settings.integrator = "rk4";
  request.settings.gauge = gauge;
  request.settings.step = step;
  request.settings.end_time = end;
  request.settings.samples = 1;
  request.settings.baumgarte_alpha = request.settings.baumgarte_beta = 5;
  return request;
}

}  // namespace momenta::equations
