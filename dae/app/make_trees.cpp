// Spatial open chains and trees, z up. The bodies are cylinders, not slender rods, so that every
// body has inertia about its own axis.

#include <cmath>

#include "families.h"
#include "scene_text.h"

namespace momenta::program {
namespace {

constexpr Triple down{0, 0, -9.81};

/// y and z by turns: axes of universal joints, split along a chain.
const char* by_turns(int i) {
  return i % 2 == 0 ? "y" : "z";
}

}  // namespace

void print_random_chain(int n) {
  print_head(numbered("Blocks on revolute joints, ", n) +
                 " of them: axes, places and masses at random, the same ones every time.",
             numbered("Random chain of ", n), down, 5);
  Draw draw(7);
  std::string parent = "ground";
  for (int i = 1; i <= n; ++i) {
    const std::string body = numbered("block", i);
    const Triple size{draw.between(0.1, 0.3), draw.between(0.1, 0.3), draw.between(0.1, 0.3)};
    print_box(body, draw.between(0.8, 1.2), size,
              {draw.between(-0.1, 0.1), draw.between(-0.1, 0.1), draw.between(0.1, 0.3)});
    JointText joint;
    joint.name = numbered("J", i);
    joint.parent = parent;
    joint.child = body;
    const Triple next{draw.between(-0.2, 0.2), draw.between(-0.2, 0.2), 0.4};
    if (i > 1) joint.origin_parent = next;
    joint.axis = triple_text(draw.direction());
    joint.position = number_text(draw.between(-1, 1));
    print_joint(joint);
    parent = body;
  }
  print_marker("tip", parent, {0, 0, 0.4});
}

void print_rope(int n) {
  constexpr double length = 0.1, radius = 0.005, mass = 0.01;
  print_head(numbered("A rope of links of 0.1 m, ", n) +
                 " of them, pinned across by turns; let go level and nearly straight.",
             numbered("Rope, links: ", n), down, 1);
  Draw draw(11);
  std::string parent = "ground";
  for (int i = 1; i <= n; ++i) {
    const std::string body = numbered("link", i);
    print_cylinder(body, mass, length, radius, "x");
    JointText joint;
    joint.name = numbered("J", i);
    joint.parent = parent;
    joint.child = body;
    if (i > 1) joint.origin_parent = {length, 0, 0};
    joint.axis = by_turns(i - 1);
    joint.position = number_text(draw.between(-0.02, 0.02));
    print_joint(joint);
    parent = body;
  }
  print_marker("end", parent, {length, 0, 0});
}

void print_spherical_chain(int n) {
  constexpr double length = 0.5, radius = 0.05, mass = 1;
  print_head(
      numbered("Cylinders of 0.5 m on spherical joints, ", n) + " of them, at random angles.",
      numbered("Spherical chain of ", n), down, 5);
  Draw draw(13);
  std::string parent = "ground";
  for (int i = 1; i <= n; ++i) {
    const std::string body = numbered("link", i);
    print_cylinder(body, mass, length, radius, "x");
    JointText joint;
    joint.name = numbered("S", i);
    joint.kind = "spherical";
    joint.parent = parent;
    joint.child = body;
    if (i > 1) joint.origin_parent = {length, 0, 0};
    const Triple axis = draw.direction();
    const double half = 0.5 * draw.between(-1, 1), c = std::cos(half), s = std::sin(half);
    joint.position = "[" + number_text(c) + ", " + number_text(s * axis[0]) + ", " +
                     number_text(s * axis[1]) + ", " + number_text(s * axis[2]) + "]";
    print_joint(joint);
    parent = body;
  }
  print_marker("tip", parent, {length, 0, 0});
}

void print_tree(int n) {
  constexpr double length = 0.5, radius = 0.03, mass = 1;
  print_head(numbered("A binary tree on revolute joints, bodies: ", n) +
                 "; body i hangs on body i / 2, axes across by turns from level to level.",
             numbered("Binary tree of ", n), down, 5);
  for (int i = 1; i <= n; ++i) {
    const std::string body = numbered("branch", i);
    print_cylinder(body, mass, length, radius, "x");
    JointText joint;
    joint.name = numbered("J", i);
    joint.child = body;
    if (i > 1) {
      joint.parent = numbered("branch", i / 2);
      joint.origin_parent = {length, 0, 0};
    }
    int level = 0;
    for (int k = i; k > 1; k /= 2) ++level;
    joint.axis = by_turns(level);
    joint.position = number_text(i == 1 ? 0 : i % 2 == 0 ? 0.6 : -0.6);
    print_joint(joint);
  }
  print_marker("tip", numbered("branch", n), {length, 0, 0});
}

void print_star(int n) {
  constexpr int revolutes = 6;
  constexpr double hub = 0.5, length = 0.3, radius = 0.03, mass = 1;
  const double turn = 4 * std::acos(0.0) / n;
  print_head(numbered("A free sphere with legs of six revolute joints each, legs: ", n) +
                 "; it falls, the legs wave.",
             numbered("Star, legs: ", n), down, 2);
  print_ball("hub", 20, hub, {});
  JointText base;
  base.name = "base";
  base.kind = "free";
  base.child = "hub";
  print_joint(base);
  for (int leg = 1; leg <= n; ++leg) {
    const double angle = (leg - 1) * turn;
    std::string parent = "hub";
    for (int i = 1; i <= revolutes; ++i) {
      const std::string body = numbered("leg", leg) + numbered("_", i);
      print_cylinder(body, mass, length, radius, "x");
      JointText joint;
      joint.name = numbered("J", leg) + numbered("_", i);
      joint.parent = parent;
      joint.child = body;
      joint.axis = by_turns(i - 1);
      if (i == 1) {
        joint.origin_parent = {hub * std::cos(angle), hub * std::sin(angle), 0};
        joint.rpy = {0, 0, angle};
        joint.velocity = leg % 2 == 0 ? "-1" : "1";
      } else {
        joint.origin_parent = {length, 0, 0};
        joint.position = "0.3";
      }
      print_joint(joint);
      parent = body;
    }
  }
  print_marker("toe", "leg1_6", {length, 0, 0});
}

}  // namespace momenta::program
