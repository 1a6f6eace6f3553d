#pragma once
// A four-bar with a point of its coupler as a scene of nine parameters, and where its points are by
// trigonometry, in any scalar.

#include <momenta/core/scalar/quad.h>

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace momenta::equations {

/// A four-bar at (x0, y0), turned by tilt, with a point P of its coupler: ξ along it, η across.
inline std::string traced_four_bar(const std::string& more = "") {
  return R"toml(
name = "four-bar"
[parameters]
crank = 1
coupler = 2.6
rocker = 2.2
ground = 2.4
along = 1.4
across = 0.7
x0 = 0.2
y0 = -0.3
tilt = 0.3
)toml" + more +
         R"toml(
[assembly]
hold = ["O"]
[[body]]
name = "crank"
mass = 1
shape = { kind = "rod", length = "crank", axis = "x" }
[[body]]
name = "coupler"
mass = 1
shape = { kind = "rod", length = "coupler", axis = "x" }
[[body]]
name = "rocker"
mass = 1
shape = { kind = "rod", length = "rocker", axis = "x" }
[[joint]]
name = "O"
kind = "revolute"
parent = "ground"
child = "crank"
origin = { parent = ["x0", "y0", 0] }
rotation = { rpy = [0, 0, "tilt"] }
axis = [0, 0, 1]
position = 0.8
[[joint]]
name = "A"
kind = "revolute"
parent = "crank"
child = "coupler"
origin = { parent = ["crank", 0, 0] }
axis = [0, 0, 1]
position = -0.4
[[joint]]
name = "C"
kind = "revolute"
parent = "ground"
child = "rocker"
origin = { parent = ["x0 + ground*cos(tilt)", "y0 + ground*sin(tilt)", 0] }
rotation = { rpy = [0, 0, "tilt"] }
axis = [0, 0, 1]
position = 1.4
[[loop]]
name = "B"
kind = "revolute"
parent = "coupler"
child = "rocker"
origin = { parent = ["coupler", 0, 0], child = ["rocker", 0, 0] }
axis = [0, 0, 1]
[[marker]]
name = "P"
body = "coupler"
point = ["along", "across", 0]
)toml";
}

/// Hoecken's linkage: crank 1 on a ground of 2 at height y0, coupler and rocker of one `length`,
/// its point twice as far. `parameters` are put before, `length` among them.
inline std::string hoecken(const std::string& parameters, const std::string& y0) {
  std::string scene = traced_four_bar();
  const auto set = [&](const std::string& line, const std::string& by) {
    scene.replace(scene.find(line), line.size(), by);
  };
  set("coupler = 2.6", parameters + "coupler = \"length\"");
  set("rocker = 2.2", "rocker = \"length\"");
  set("ground = 2.4", "ground = 2");
  set("along = 1.4", "along = \"2 * length\"");
  set("across = 0.7", "across = 0");
  set("x0 = 0.2", "x0 = 0");
  set("y0 = -0.3", "y0 = " + y0);
  set("tilt = 0.3", "tilt = 0");
  return scene;
}

inline const std::vector<std::string> all_names{"crank",  "coupler", "rocker", "ground", "along",
                                                "across", "x0",      "y0",     "tilt"};

inline double angle_of(double y, double x) {
  return std::atan2(y, x);
}
inline Quad angle_of(const Quad& y, const Quad& x) {
  return Quad::of(atan2q(y.v, x.v));
}

/// x, y of P and the rocker's angle, for the parameters in that order and the crank at s, by
/// trigonometry; the assembly with the rocker's tip on the left of the way from crank to C.
template <class S>
std::array<S, 3> by_trigonometry(const std::vector<S>& v, S s) {
  using std::cos, std::sin, std::sqrt;
  const S crank = v[0], coupler = v[1], rocker = v[2], ground = v[3];
  const S ax = crank * cos(s), ay = crank * sin(s), dx = ground - ax, dy = -ay;
  const S squares = dx * dx + dy * dy, d = sqrt(squares);
  // B: the part of the coupler along the way from A to C, and across it.
  const S part = (coupler * coupler - rocker * rocker + squares) / (2 * d);
  const S off = sqrt(coupler * coupler - part * part);
  const S bx = ax + (part * dx - off * dy) / d, by = ay + (part * dy + off * dx) / d;
  const S cx = (bx - ax) / coupler, cy = (by - ay) / coupler;
  const S px = ax + v[4] * cx - v[5] * cy, py = ay + v[4] * cy + v[5] * cx;
  return {v[6] + px * cos(v[8]) - py * sin(v[8]), v[7] + px * sin(v[8]) + py * cos(v[8]),
          angle_of(by, bx - ground)};
}

/// Height of the point of Hoecken's linkage on a ground at 0, the crank at s.
inline double hoecken_height(double length, double s) {
  return by_trigonometry<double>({1, length, length, 2, 2 * length, 0, 0, 0, 0}, s)[1];
}
/// Where a function with one minimum between two numbers has it, by thirds, to `within`.
inline double place_of_least(const std::function<double(double)>& f, double low, double high,
                             double within) {
  while (high - low > within) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    (f(a) < f(b) ? high : low) = f(a) < f(b) ? b : a;
  }
  return 0.5 * (low + high);
}

/// Of f at x, by x_j, in quadruple precision: central differences whose error is below 1e-18.
inline double slope(const std::function<Quad(const std::vector<Quad>&)>& f, std::vector<Quad> x,
                    std::size_t j) {
  const Quad h = 1e-10, at = x[j];
  x[j] = at + h;
  const Quad above = f(x);
  x[j] = at - h;
  return value_of((above - f(x)) / (h + h));
}

}  // namespace momenta::equations
