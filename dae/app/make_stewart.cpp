// The Stewart platform: base points on a circle of 1 m, top points on one of 0.6 m, at alternately
// small and large distances. Every leg has a universal joint below, a prismatic joint with a
// spring, and a spherical joint above, where its loop closes.

#include <cmath>

#include "families.h"

namespace momenta::program {

void print_stewart(int n) {
  constexpr double pi = 3.14159265358979323846;
  constexpr double base = 1, top = 0.6, height = 1.2, half = 0.6, mass = 1, radius = 0.03;
  print_head(numbered("A platform of 20 kg on sprung legs, ", n) + " of them; it starts turning.",
             numbered("Platform, legs: ", n), {0, 0, -9.81}, 5);
  print_box("platform", 20, {0.8, 0.8, 0.1}, {0, 0, 0});
  JointText flying;
  flying.name = "flying";
  flying.kind = "free";
  flying.child = "platform";
  flying.position = "[0.0, 0.0, " + number_text(height) + ", 1.0, 0.0, 0.0, 0.0]";
  flying.velocity = "[0.0, 0.0, 0.0, 0.0, 0.0, 0.5]";
  print_joint(flying);
  for (int i = 1; i <= n; ++i) {
    const double around = 2 * pi * i / n, aside = (i % 2 == 0 ? 0.3 : -0.3) * 2 * pi / n;
    const double below = around - aside, above = around + aside;
    const Triple foot{base * std::cos(below), base * std::sin(below), 0};
    const Triple head{top * std::cos(above), top * std::sin(above), 0};
    const Triple way{head[0] - foot[0], head[1] - foot[1], height};
    const double flat = std::hypot(way[0], way[1]), length = std::hypot(flat, height);
    const std::string lower = numbered("lower", i), upper = numbered("upper", i);
    print_cylinder(lower, mass, half, radius, "x");
    print_cylinder(upper, mass, half, radius, "x");
    JointText universal;
    universal.name = numbered("U", i);
    universal.kind = "universal";
    universal.child = lower;
    universal.origin_parent = foot;
    universal.rpy = {0, -std::atan2(height, flat), std::atan2(way[1], way[0])};
    universal.axis = "y";
    print_joint(universal);
    JointText prismatic;
    prismatic.name = numbered("P", i);
    prismatic.kind = "prismatic";
    prismatic.parent = lower;
    prismatic.child = upper;
    prismatic.origin_parent = {length - half, 0, 0};
    prismatic.axis = "x";
    prismatic.stiffness = 5000;
    prismatic.damping = 20;
    print_joint(prismatic);
    LoopText spherical;
    spherical.name = numbered("S", i);
    spherical.kind = "spherical";
    spherical.parent = "platform";
    spherical.child = upper;
    spherical.origin_parent = head;
    spherical.origin_child = {half, 0, 0};
    print_loop(spherical);
  }
  print_marker("centre", "platform", {0, 0, 0});
}

}  // namespace momenta::program
