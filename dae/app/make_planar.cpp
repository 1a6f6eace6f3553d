// Planar mechanisms in a plane of any orientation: only gravity and the joints at the ground depend
// on it. Angles start at the plane's x, from parent to child.

#include <cmath>

#include "families.h"
#include "scene_text.h"

namespace momenta::program {
namespace {

constexpr double pi = 3.14159265358979323846;

Triple weight(const Plane& plane) {
  return plane.from_plane({0, -9.81, 0});
}

}  // namespace

void print_chain(int n, const Plane& plane) {
  print_head(numbered("A chain of uniform rods of 1 m and 1 kg, level, at rest: ", n) + " of them.",
             numbered("Chain of rods: ", n), weight(plane), 5);
  for (int i = 1; i <= n; ++i) print_rod(numbered("rod", i), 1, 1);
  for (int i = 1; i <= n; ++i)
    print_joint(hinge(numbered("J", i), i == 1 ? "ground" : numbered("rod", i - 1),
                      numbered("rod", i), {i == 1 ? 0.0 : 1.0, 0, 0}, 0, 0, plane));
  print_marker("tip", numbered("rod", n), {1, 0, 0});
}

/// 2N + 1 rods: verticals hinged to ground at (i, 0), horizontals joining their tops. Tree: every
/// vertical on the ground, carrying the next horizontal; N loops close at the far ends.
void print_n_four_bar(int n, const Plane& plane) {
  print_corrected_head(numbered("Four-bars in a row, ", n) +
                           " of them: rods of 1 m and 1 kg, which lie on one line twice a turn.",
                       numbered("N-four-bar, N = ", n), weight(plane), 10);
  for (int i = 0; i <= n; ++i) {
    print_rod(numbered("vertical", i), 1, 1);
    if (i > 0) print_rod(numbered("horizontal", i), 1, 1);
  }
  for (int i = 0; i <= n; ++i) {
    const std::string vertical = numbered("vertical", i);
    print_joint(hinge(numbered("O", i), "ground", vertical, {double(i), 0, 0}, pi / 2, -1, plane));
    if (i < n)
      print_joint(hinge(numbered("B", i), vertical, numbered("horizontal", i + 1), {1, 0, 0},
                        -pi / 2, 1, plane));
  }
  for (int i = 1; i <= n; ++i)
    print_closing(numbered("C", i), numbered("vertical", i), numbered("horizontal", i), {1, 0, 0},
                  {1, 0, 0});
  print_marker("B0", "vertical0", {1, 0, 0});
}

/// N pairs of bars of 2 m crossing at their middles; a bar's far end carries the next pair, and the
/// other far end closes on it: N − 1 loops, each over two pairs.
void print_scissor_ladder(int n, const Plane& plane) {
  constexpr double tilt = 0.6, other = pi - tilt;
  print_head(numbered("Pairs of crossed bars of 2 m and 1 kg, one on another: ", n) +
                 ". Held at one end of the first bar.",
             numbered("Scissor ladder of pairs: ", n), weight(plane), 2);
  for (int i = 0; i < n; ++i) {
    print_plate(numbered("a", i), 1, {1, 0, 0}, 4.0 / 12);
    print_plate(numbered("b", i), 1, {0, 0, 0}, 4.0 / 12);
  }
  for (int i = 0; i < n; ++i) {
    const std::string a = numbered("a", i), b = numbered("b", i);
    if (i == 0)
      print_joint(hinge("A0", "ground", a, {0, 0, 0}, tilt, 0.3, plane));
    else
      print_joint(
          hinge(numbered("A", i), numbered("b", i - 1), a, {1, 0, 0}, tilt - other, 0.6, plane));
    print_joint(hinge(numbered("B", i), a, b, {1, 0, 0}, other - tilt, -0.6, plane));
  }
  for (int i = 1; i < n; ++i)
    print_closing(numbered("C", i), numbered("a", i - 1), numbered("b", i), {2, 0, 0}, {-1, 0, 0});
  print_marker("end", numbered("a", n - 1), {2, 0, 0});
}

/// N rods from one fixed point to another: one loop through all of them. They start on an arc,
/// their angles evenly spread, so that the far end lies level with the first.
void print_closed_chain(int n, const Plane& plane) {
  constexpr double first = -0.8;
  const double step = -2 * first / (n - 1);
  double span = 0;
  for (int i = 0; i < n; ++i) span += std::cos(first + i * step);
  print_head(numbered("Uniform rods of 1 m and 1 kg between two fixed points, ", n) +
                 " of them, let go on an arc.",
             numbered("Closed chain of rods: ", n), weight(plane), 5);
  for (int i = 1; i <= n; ++i) print_rod(numbered("rod", i), 1, 1);
  for (int i = 1; i <= n; ++i)
    print_joint(hinge(numbered("J", i), i == 1 ? "ground" : numbered("rod", i - 1),
                      numbered("rod", i), {i == 1 ? 0.0 : 1.0, 0, 0}, i == 1 ? first : step, 0,
                      plane));
  LoopText end;
  end.name = "end";
  end.child = numbered("rod", n);
  end.origin_parent = plane.from_plane({span, 0, 0});
  end.origin_child = {1, 0, 0};
  end.rpy = plane.rpy;
  end.axis = "z";
  print_loop(end);
  print_marker("middle", numbered("rod", (n + 1) / 2), {1, 0, 0});
}

/// N rows of N parallelograms, hanging: verticals on the lower ends of those above, horizontals
/// between neighbours. N² loops, which reach up to the ground: fronts grow with N. N degrees of
/// freedom.
void print_grid(int n, const Plane& plane) {
  constexpr double lean = 0.2;
  print_corrected_head(
      numbered("Rows of hanging parallelograms of rods of 1 m and 1 kg, as many rows as cells: ",
               n) +
          ". The rows lean to either side by turns; at rest.",
      numbered("Grid, rows and cells: ", n), weight(plane), 5);
  const auto vertical = [](int row, int column) {
    return numbered("v", row) + "_" + std::to_string(column);
  };
  const auto horizontal = [](int row, int column) {
    return numbered("h", row) + "_" + std::to_string(column);
  };
  const auto angle = [](int row) { return -pi / 2 + (row % 2 == 0 ? lean : -lean); };
  for (int c = 0; c <= n; ++c)
    for (int r = 0; r < n; ++r) {
      print_rod(vertical(r, c), 1, 1);
      if (c > 0) print_rod(horizontal(r, c), 1, 1);
    }
  for (int c = 0; c <= n; ++c)
    for (int r = 0; r < n; ++r) {
      const std::string name = std::to_string(r) + "_" + std::to_string(c);
      if (r == 0)
        print_joint(
            hinge("V" + name, "ground", vertical(r, c), {double(c), 0, 0}, angle(0), 0, plane));
      else
        print_joint(hinge("V" + name, vertical(r - 1, c), vertical(r, c), {1, 0, 0},
                          angle(r) - angle(r - 1), 0, plane));
      if (c < n)
        print_joint(hinge("H" + name, vertical(r, c), horizontal(r, c + 1), {1, 0, 0}, -angle(r), 0,
                          plane));
    }
  for (int c = 1; c <= n; ++c)
    for (int r = 0; r < n; ++r)
      print_closing("C" + std::to_string(r) + "_" + std::to_string(c), vertical(r, c),
                    horizontal(r, c), {1, 0, 0}, {1, 0, 0});
  print_marker("corner", vertical(n - 1, n), {1, 0, 0});
}

}  // namespace momenta::program
