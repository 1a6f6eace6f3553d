#pragma once
// Mechanisms whose assemblies are counted, and how they are asked for.

#include "equations/linkages.h"
#include "equations/parts.h"

#include <momenta/dae/analysis/kinematics/assemblies.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <cmath>
#include <string>

namespace momenta::equations {

inline Eigen::Vector2d along(double angle) {
  return {std::cos(angle), std::sin(angle)};
}
inline double angle_of(const Eigen::Vector2d& x) {
  return std::atan2(x.y(), x.x());
}

inline Assemblies found_in(const Scene& scene, const AssembliesRequest& request) {
  const Mechanism mechanism(scene);
  const Assembly own = assemble(mechanism, Assembled::rates);
  return find_assemblies(mechanism, 0, own.start.q, request);
}

/// A rod of this length from the ground, at `foot`, to a place of a body.
inline LoopSpec rod_between(const std::string& name, const std::string& body,
                            const Eigen::Vector3d& foot, const Eigen::Vector3d& seat,
                            double length) {
  LoopSpec loop = make_loop(LoopKind::distance, name, "ground", body, foot, seat);
  loop.length = length;
  return loop;
}

inline LoopSpec pin(const std::string& name, const std::string& parent, const std::string& child,
                    const Eigen::Vector3d& at_parent, const Eigen::Vector3d& at_child) {
  return make_loop(LoopKind::revolute, name, parent, child, at_parent, at_child);
}

/// A four-bar whose crank, joint O, stands at θ, closed; 1, 2, 1.8 on a ground of 2.2.
inline Scene closed_four_bar(double theta) {
  const double a = 1, b = 2, c = 1.8, d = 2.2;
  const Eigen::Vector2d A = a * along(theta), C(d, 0);
  const double reach = (A - C).norm(),
               inside = std::acos((reach * reach + c * c - b * b) / (2 * reach * c));
  const double rocker = angle_of(A - C) - inside;
  const Eigen::Vector2d B = C + c * along(rocker);
  Scene s;
  s.name = "four-bar";
  s.bodies = {rod("crank"), rod("coupler"), rod("rocker")};
  s.joints = {hinge("O", "ground", "crank", {0, 0, 0}, theta),
              hinge("A", "crank", "coupler", {a, 0, 0}, angle_of(B - A) - theta),
              hinge("C", "ground", "rocker", {d, 0, 0}, rocker)};
  s.loops = {pin("B", "coupler", "rocker", {b, 0, 0}, {c, 0, 0})};
  return s;
}

}  // namespace momenta::equations
