#include "equations/large_scenes.h"

#include "equations/linkages.h"
#include "equations/parts.h"

#include <cmath>
#include <numbers>

namespace momenta::equations {
namespace {

Scene hanging(const char* name) {
  Scene s;
  s.name = name;
  s.gravity = {0, -9.81, 0};
  return s;
}

LoopSpec closing(const std::string& name, const std::string& parent, const std::string& child,
                 const Eigen::Vector3d& on_parent, const Eigen::Vector3d& on_child) {
  return make_loop(LoopKind::revolute, name, parent, child, on_parent, on_child);
}

}  // namespace

Scene crossed_bars(int n) {
  Scene s = hanging("crossed bars");
  constexpr double tilt = 0.6, other = std::numbers::pi - tilt;
  for (int i = 0; i < n; ++i) {
    const std::string number = std::to_string(i), a = "a" + number, b = "b" + number;
    BodySpec first = rod(a), second = rod(b);
    first.com = {1, 0, 0};
    second.com = {0, 0, 0};
    s.bodies.push_back(first);
    s.bodies.push_back(second);
    if (i == 0)
      s.joints.push_back(hinge("A0", "ground", a, {0, 0, 0}, tilt));
    else
      s.joints.push_back(
          hinge("A" + number, "b" + std::to_string(i - 1), a, {1, 0, 0}, tilt - other));
    s.joints.back().velocity = {i == 0 ? 0.3 : 0.6};
    s.joints.push_back(hinge("B" + number, a, b, {1, 0, 0}, other - tilt));
    s.joints.back().velocity = {-0.6};
    if (i > 0)
      s.loops.push_back(
          closing("C" + number, "a" + std::to_string(i - 1), b, {2, 0, 0}, {-1, 0, 0}));
  }
  return s;
}

Scene arch(int n) {
  Scene s = hanging("arch");
  const double first = -0.8, step = 1.6 / (n - 1);
  double span = 0;
  for (int i = 0; i < n; ++i) {
    const std::string name = "rod" + std::to_string(i);
    s.bodies.push_back(rod(name));
    s.joints.push_back(hinge("J" + std::to_string(i),
                             i == 0 ? "ground" : "rod" + std::to_string(i - 1), name,
                             {i == 0 ? 0.0 : 1.0, 0, 0}, i == 0 ? first : step));
    span += std::cos(first + i * step);
  }
  s.loops.push_back(
      closing("end", "ground", "rod" + std::to_string(n - 1), {span, 0, 0}, {1, 0, 0}));
  return s;
}

Scene stretched_chain(int n, double reach, bool spherical) {
  Scene s = hanging("stretched chain");
  for (int i = 0; i < n; ++i) {
    const auto name = "rod" + std::to_string(i), before = "rod" + std::to_string(i - 1);
    s.bodies.push_back(rod(name, 0.1));
    s.joints.push_back(hinge("J" + std::to_string(i), i == 0 ? "ground" : before, name,
                             {i == 0 ? 0.0 : 1.0, 0, 0}, 0));
    if (!spherical) continue;
    s.joints.back().kind = JointKind::spherical;
    s.joints.back().position.clear();
    s.joints.back().velocity.clear();
  }
  s.loops.push_back(closing("tip", "ground", s.bodies.back().name, {reach, 0, 0}, {1, 0, 0}));
  if (spherical) s.loops.back().kind = LoopKind::spherical;
  return s;
}

}  // namespace momenta::equations
