#pragma once
// Rolling wheels and a knife edge, and how the laws of nonholonomic rows run them.

#include <gtest/gtest.h>
#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/dae/form/ode_form.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <cstdio>
#include <string>

#include "equations/runs.h"

namespace momenta::equations {

inline std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

/// A blade at the origin of a body that moves in a plane, its mass centre ahead by `ahead`.
inline Scene sleigh(double ahead, const std::string& gravity, const std::string& velocity) {
  return parse_scene("gravity = " + gravity + R"(
[[body]]
name = "sleigh"
mass = 1.5
inertia = 0.4
com = [)" + number(ahead) +
                         R"(, 0, 0]
[[joint]]
name = "P"
kind = "planar"
child = "sleigh"
direction = [1, 0, 0]
velocity = )" + velocity +
                         R"(
[[marker]]
name = "K"
body = "sleigh"
[[loop]]
name = "blade"
kind = "velocity-equation"
equation = "K.vy*cos(P.q2) - K.vx*sin(P.q2) = 0"
)",
                     "sleigh.toml");
}

/// A wheel on a free carrier whose inertia is that of a sphere, so that it exerts no moment while
/// it turns evenly.
inline std::string wheel(const std::string& gravity, double radius, double crown,
                         const std::string& frame, const std::string& rest = "") {
  return "gravity = " + gravity + R"(
[[body]]
name = "carrier"
mass = 0.5
inertia = [0.02, 0.02, 0.02]
[[body]]
name = "wheel"
mass = 2
inertia = [0.05, 0.09, 0.05]
[[joint]]
name = "F"
kind = "free"
child = "carrier"
)" + frame +
         R"(
[[joint]]
name = "W"
kind = "revolute"
parent = "carrier"
child = "wheel"
axis = [0, 1, 0]
)" + rest +
         R"(
[[loop]]
name = "contact"
kind = "rolling"
child = "wheel"
axis = [0, 1, 0]
radius = )" +
         number(radius) + "\ncrown_radius = " + number(crown) + "\n";
}

inline RunResult run_of(const Mechanism& mechanism, const std::string& form, double end,
                        const std::string& gauge = "none") {
  return run_form(mechanism, assemble(mechanism).start,
                  kept(adaptive(form, is_dae_form(form) ? "ida" : "vern9", gauge,
                                is_dae_form(form) ? 1e-10 : 1e-12, end, 8)));
}
/// The last of a column.
inline double column(const RunResult& run, const std::string& name) {
  for (std::size_t i = 0; i < run.trajectory.columns.size(); ++i)
    if (run.trajectory.columns[i].starts_with(name + " ")) return run.trajectory.rows.back()[i];
  ADD_FAILURE() << "no column " << name;
  return 0;
}

}  // namespace momenta::equations
