#pragma once
// Four-bars by their lengths, whose poses trigonometry knows, and sweeps of them.

#include "equations/linkages.h"
#include "equations/parts.h"

#include <momenta/dae/analysis/kinematics/move.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace momenta::equations {

struct FourBar {
  double crank, coupler, rocker, ground;

  /// Of the rocker, for the crank at θ; side ±1. Not a number where the links do not reach.
  double rocker_angle(double theta, int side) const {
    const double x = crank * std::cos(theta) - ground, y = crank * std::sin(theta);
    const double d = std::hypot(x, y);
    const double c = (d * d + rocker * rocker - coupler * coupler) / (2 * d * rocker);
    return std::atan2(y, x) + side * std::acos(c);
  }
  /// Where the crank turns back, as distances of its tip from C: b + c and |b − c|.
  bool is_dead_point(double theta) const {
    const double d = std::hypot(crank * std::cos(theta) - ground, crank * std::sin(theta));
    return std::min(std::abs(d - coupler - rocker), std::abs(d - std::abs(coupler - rocker))) <
           1e-9;
  }
  bool reaches(double theta) const { return std::isfinite(rocker_angle(theta, 1)); }

  Scene scene(double theta, int side) const {
    Scene s;
    s.name = "four-bar";
    const double rocked = rocker_angle(theta, side);
    const double ax = crank * std::cos(theta), ay = crank * std::sin(theta);
    const double bx = ground + rocker * std::cos(rocked), by = rocker * std::sin(rocked);
    s.bodies = {rod("crank"), rod("coupler"), rod("rocker")};
    s.joints = {hinge("O", "ground", "crank", {0, 0, 0}, theta),
                hinge("A", "crank", "coupler", {crank, 0, 0}, std::atan2(by - ay, bx - ax) - theta),
                hinge("C", "ground", "rocker", {ground, 0, 0}, rocked)};
    s.loops.push_back(
        make_loop(LoopKind::revolute, "B", "coupler", "rocker", {coupler, 0, 0}, {rocker, 0, 0}));
    return s;
  }
};

inline MoveResult moved(const Scene& scene, const std::string& sweep, MoveRequest request = {}) {
  const Mechanism mechanism(scene);
  const Assembly a = assemble(mechanism, Assembled::rates);
  request.sweep = {{sweep, 1}};
  return move(mechanism, 0, a.start.q, request);
}

}  // namespace momenta::equations
