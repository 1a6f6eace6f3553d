// Jansen's walking linkage: legs on one crank, at equal differences of phase. Published
// proportions, in units of 10 mm; every bar has 1 kg/m, and triangles consist of three bars.
//
//         E            O  crank's axle       crank m = OP
//        /|\  j        B  fixed, left of O by a and below it by l
//      e  | b  P       bars j = PE, k = PG, c = BG, f = FH
//      /  |/  /        triangles b, d, e = BE, BF, FE and g, i, h = GH, GI, HI; I is the foot
//     F-d-B  / k
//     |f   \c
//     H--g--G
//      h\  /i
//        I

#include <cmath>

#include "families.h"
#include "scene_text.h"

namespace momenta::program {
namespace {

constexpr double unit = 0.01;
constexpr double a = 38 * unit, b = 41.5 * unit, c = 39.3 * unit, d = 40.1 * unit, e = 55.8 * unit,
                 f = 39.4 * unit, g = 36.7 * unit, h = 65.7 * unit, i = 49 * unit, j = 50 * unit,
                 k = 61.9 * unit, l = 7.8 * unit, m = 15 * unit;
constexpr double pi = 3.14159265358979323846;

struct Point {
  double x, y;
};
double angle(const Point& from, const Point& to) {
  return std::atan2(to.y - from.y, to.x - from.x);
}

/// The point at r from p and at s from q, left of the way from p to q.
Point meet(const Point& p, double r, const Point& q, double s) {
  const double dx = q.x - p.x, dy = q.y - p.y, way = std::hypot(dx, dy);
  const double along = (way * way + r * r - s * s) / (2 * way);
  const double across = std::sqrt(r * r - along * along);
  return {p.x + (along * dx - across * dy) / way, p.y + (along * dy + across * dx) / way};
}

/// Three bars from the origin: to (first, 0), to `second`, and between the two.
void print_triangle(const std::string& name, double first, const Point& second) {
  const Point corners[3] = {{0, 0}, {first, 0}, second};
  double mass = 0, x = 0, y = 0, about_origin = 0;
  for (int n = 0; n < 3; ++n) {
    const Point &p = corners[n], &q = corners[(n + 1) % 3];
    const double length = std::hypot(q.x - p.x, q.y - p.y);
    const Point middle{(p.x + q.x) / 2, (p.y + q.y) / 2};
    mass += length;
    x += length * middle.x;
    y += length * middle.y;
    about_origin += length * (length * length / 12 + middle.x * middle.x + middle.y * middle.y);
  }
  x /= mass;
  y /= mass;
  print_plate(name, mass, {x, y, 0}, about_origin - mass * (x * x + y * y));
}

}  // namespace

void print_jansen_legs(int n, const Plane& plane) {
  print_head(numbered("Jansen's linkage, legs on one crank: ", n) +
                 ". The crank starts at one turn a second and is free.",
             numbered("Jansen's legs: ", n), plane.from_plane({0, -9.81, 0}), 5);
  const Point B{-a, -l};
  print_held("axle");
  // Corners in the frames of the triangles: BEF with E on x, GIH with I on x.
  const Point F_in = meet({0, 0}, d, {b, 0}, e), H_in = meet({0, 0}, g, {i, 0}, h);
  const Point H_right{H_in.x, -H_in.y};
  print_rod("crank", m, m);
  for (int leg = 1; leg <= n; ++leg) {
    const auto name = [leg](const char* part) { return numbered(part, leg); };
    print_triangle(name("upper"), b, F_in);
    print_rod(name("j"), j, j);
    print_rod(name("k"), k, k);
    print_rod(name("c"), c, c);
    print_rod(name("f"), f, f);
    print_triangle(name("lower"), i, H_right);
  }
  print_joint(hinge("axle", "ground", "crank", {0, 0, 0}, 0, 2 * pi, plane));
  for (int leg = 1; leg <= n; ++leg) {
    const double phase = 2 * pi * (leg - 1) / n;
    // P of this leg: the crank stands at 0, the pin at `phase` on it.
    const Point P{m * std::cos(phase), m * std::sin(phase)};
    const Point E = meet(B, b, P, j), G = meet(P, k, B, c);
    const double upper = angle(B, E);
    const Point F{B.x + std::cos(upper) * F_in.x - std::sin(upper) * F_in.y,
                  B.y + std::sin(upper) * F_in.x + std::cos(upper) * F_in.y};
    const Point H = meet(G, g, F, f);
    const double lower = angle(G, H) - std::atan2(H_right.y, H_right.x);
    const auto name = [leg](const char* part) { return numbered(part, leg); };
    const auto pinned = [&](const char* joint, const std::string& parent, const char* child,
                            const Triple& at, double position) {
      print_joint(hinge(name(joint), parent, name(child), at, position, 0, plane));
    };
    pinned("B", "ground", "upper", {B.x, B.y, 0}, upper);
    pinned("Bc", "ground", "c", {B.x, B.y, 0}, angle(B, G));
    pinned("F", name("upper"), "f", {F_in.x, F_in.y, 0}, angle(F, H) - upper);
    pinned("G", name("c"), "lower", {c, 0, 0}, lower - angle(B, G));
    pinned("Pj", "crank", "j", {P.x, P.y, 0}, angle(P, E));
    pinned("Pk", "crank", "k", {P.x, P.y, 0}, angle(P, G));
    print_closing(name("E"), name("upper"), name("j"), {b, 0, 0}, {j, 0, 0});
    print_closing(name("Gk"), name("c"), name("k"), {c, 0, 0}, {k, 0, 0});
    print_closing(name("H"), name("lower"), name("f"), {H_right.x, H_right.y, 0}, {f, 0, 0});
    print_marker(name("foot"), name("lower"), {i, 0, 0});
  }
}

}  // namespace momenta::program
