#pragma once
// A scissor lift whose foot a drive moves to and fro once a second.

#include "equations/linkages.h"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace momenta::equations {

/// A scissor lifts a platform, its foot on a slide; `actuator`, a second tie along the slide, is
/// driven. In space ten of fifteen equations (eleven of sixteen) have no entries at all: across the
/// plane of the scissor nothing moves, and on the slide nothing turns.
inline Scene driven_scissor(LoopKind actuator, double slope = 0.6) {
  constexpr double pi = std::numbers::pi;
  const double foot = std::cos(slope);
  Scene s;
  s.name = "driven scissor";
  s.gravity = {0, -9.81, 0};
  s.bodies = {rod("a"), rod("b"), rod("platform", 5), rod("roller", 0.2), rod("foot", 0.5)};
  s.joints = {hinge("O", "ground", "a", {0, 0, 0}, slope),
              hinge("M", "a", "b", {0.5, 0, 0}, pi - 2 * slope),
              hinge("T", "a", "platform", {1, 0, 0}, pi - slope),
              hinge("S", "platform", "roller", {0, 0, 0}, foot),
              hinge("F", "ground", "foot", {0, 0, 0}, foot)};
  s.joints[1].origin_child = {0.5, 0, 0};
  for (const std::size_t i : {3u, 4u}) {
    s.joints[i].kind = JointKind::prismatic;
    s.joints[i].axis = {1, 0, 0};
  }
  LoopSpec top, bottom, along;
  top.name = "top";
  top.kind = bottom.kind = LoopKind::revolute;
  top.parent = "b";
  top.child = "roller";
  top.origin_parent = {1, 0, 0};
  bottom.name = "bottom";
  bottom.parent = "foot";
  bottom.child = "b";
  along.name = "actuator";
  along.kind = actuator;
  along.axis = {1, 0, 0};
  along.child = "foot";
  s.loops = {top, bottom, along};
  DriveSpec drive;
  drive.loop = along.name;
  drive.kind = "harmonic";
  drive.offset = foot;
  drive.amplitude = 0.1;
  drive.frequency = 2 * pi;
  s.drives = {drive};
  return s;
}

}  // namespace momenta::equations
