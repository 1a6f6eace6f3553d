#include "equations/linkages.h"
#include "equations/parts.h"

#include <cmath>
#include <numbers>

namespace momenta::equations {

std::vector<double> orientations() {
  std::vector<double> all{0};
  for (double small = 1e-8; small < 2e-2; small *= 10) all.push_back(small);
  for (const double corner : {std::numbers::pi / 4, std::numbers::pi / 2})
    all.insert(all.end(), {corner - 1e-4, corner, corner + 1e-7});
  for (int i = 0; i < 11; ++i) all.push_back(0.1 + 0.29 * i);
  return all;
}

BodySpec rod(const std::string& name, double width) {
  BodySpec b = make_body(name, 1, {0, 0, 0}, {0.5, 0, 0});
  const double across = (1 + width * width) / 12, along = width * width / 6;
  b.inertia = Eigen::Vector3d(along, across, across).asDiagonal();
  return b;
}

JointSpec hinge(const std::string& name, const std::string& parent, const std::string& child,
                const Eigen::Vector3d& origin_parent, double angle) {
  return make_joint(JointKind::revolute, name, parent, child, origin_parent, {0, 0, 1}, {angle});
}

Scene row_of_four_bars(int n, double angle, double rate) {
  Scene s;
  s.name = "row of four-bars";
  s.gravity = {0, -9.81, 0};
  const Eigen::Vector3d tip(1, 0, 0);
  for (int i = 0; i <= n; ++i) {
    const std::string upright = "upright" + std::to_string(i);
    s.bodies.push_back(rod(upright));
    s.joints.push_back(hinge("O" + std::to_string(i), "ground", upright, i * tip, angle));
    s.joints.back().velocity = {rate};
    if (i == n) break;
    const std::string level = "level" + std::to_string(i);
    s.bodies.push_back(rod(level));
    s.joints.push_back(hinge("B" + std::to_string(i), upright, level, tip, -angle));
    s.joints.back().velocity = {-rate};
    s.loops.push_back(make_loop(LoopKind::revolute, "C" + std::to_string(i), level,
                                "upright" + std::to_string(i + 1), tip, tip));
  }
  return s;
}

Scene geared(Scene s, const Eigen::Vector3d& weight_at, double weight_turned) {
  BodySpec weight = rod("weight", 0.2), wheel = rod("wheel", 0.3);
  wheel.com.setZero();
  s.bodies.insert(s.bodies.begin(), weight);
  s.bodies.push_back(wheel);
  JointSpec held;
  held.name = "held";
  held.kind = JointKind::weld;
  held.parent = "rocker";
  held.child = "weight";
  held.origin_parent = weight_at;
  held.rotation = Eigen::AngleAxisd(weight_turned, Eigen::Vector3d::UnitZ());
  s.joints.push_back(held);
  s.joints.push_back(hinge("shaft", "ground", "wheel", {-1, 0, 0}, 0.3));
  LoopSpec gear;
  gear.name = "gear";
  gear.kind = LoopKind::coupler;
  gear.joints = {"shaft", "O"};
  gear.ratios = {1, 4};
  gear.offset = 0.3 + 4 * s.joints.front().position.at(0);
  s.loops.push_back(gear);
  return s;
}

Scene bricard() {
  Scene s;
  s.name = "Bricard";
  s.gravity = {0, -9.81, 0};
  const Eigen::Vector3d x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  const Eigen::Vector3d along[] = {x, -y, z, -x, y};  // from each centre to the next
  const Eigen::Vector3d axes[] = {y, z, x, y, z, x};
  Eigen::Quaterniond before = Eigen::Quaterniond::Identity();  // axes of the rod before
  std::string parent = "ground";
  for (int i = 0; i < 5; ++i) {
    const auto name = "rod" + std::to_string(i + 1);
    const Eigen::Quaterniond own = Eigen::Quaterniond::FromTwoVectors(x, along[i]);
    s.bodies.push_back(rod(name, 0.1));
    JointSpec j =
        hinge("P" + std::to_string(i + 1), parent, name, i == 0 ? Eigen::Vector3d(0, 0, 0) : x, 0);
    j.rotation = before.conjugate() * own;
    j.axis = own.conjugate() * axes[i];
    s.joints.push_back(j);
    parent = name;
    before = own;
  }
  LoopSpec l = make_loop(LoopKind::revolute, "P6", "ground", parent, z, x);
  l.rotation = before;
  l.axis = before.conjugate() * axes[5];
  s.loops.push_back(l);
  return s;
}

Scene platform(int legs) {
  Scene s;
  s.name = "Stewart platform";
  s.gravity = {0, 0, -9.81};
  const auto body = [&](const std::string& name, double mass, const Eigen::Vector3d& com,
                        const Eigen::Vector3d& inertia) {
    BodySpec b = make_body(name, mass, {0, 0, 0}, com);
    b.inertia = inertia.asDiagonal();
    s.bodies.push_back(b);
  };
  const auto joint = [&](const std::string& name, JointKind kind, const std::string& parent,
                         const std::string& child) -> JointSpec& {
    s.joints.push_back(make_joint(kind, name, parent, child));
    return s.joints.back();
  };
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(0.15, Eigen::Vector3d::UnitX()))
                                   .toRotationMatrix();
  const Eigen::Vector3d place(0.05, -0.03, 1.1);
  const Eigen::Quaterniond at(turn);
  body("platform", 10, {0, 0, 0.02}, {0.4, 0.4, 0.8});
  joint("P", JointKind::free, "ground", "platform").position = {
      place.x(), place.y(), place.z(), at.w(), at.x(), at.y(), at.z()};
  for (int i = 0; i < legs; ++i) {
    const std::string number = std::to_string(i);
    const double side = i % 2 ? 0.25 : -0.25, around = i * 2 * std::acos(-1.0) / legs;
    const Eigen::Vector3d foot(std::cos(around + side), std::sin(around + side), 0),
        seat(0.5 * std::cos(around - side), 0.5 * std::sin(around - side), 0);
    const Eigen::Vector3d way = place + turn * seat - foot, along = way.normalized();
    body("lower" + number, 2, {0, 0, 0.3}, {0.06, 0.06, 0.01});
    JointSpec& u = joint("U" + number, JointKind::universal, "ground", "lower" + number);
    u.origin_parent = foot;
    u.axis = {1, 0, 0};
    u.axis2 = {0, 1, 0};
    u.position = {std::atan2(-along.y(), along.z()), std::asin(along.x())};
    body("upper" + number, 1, {0, 0, -0.3}, {0.03, 0.03, 0.005});
    JointSpec& p = joint("S" + number, JointKind::prismatic, "lower" + number, "upper" + number);
    p.axis = {0, 0, 1};
    p.position = {way.norm()};
    s.loops.push_back(
        make_loop(LoopKind::spherical, "B" + number, "platform", "upper" + number, seat));
  }
  return s;
}

Scene flying_rod() {
  Scene scene;
  scene.name = "a rod on a spherical joint carries a flying one";
  scene.gravity = {0, -9.81, 0};
  for (const char* name : {"held", "flying"}) scene.bodies.push_back(rod(name, 0.2));
  JointSpec ball =
      make_joint(JointKind::spherical, "A", "ground", "held", {0, 0, 0}, {0, 0, 1}, {1, 0, 0, 0});
  ball.velocity = {0.5, 1, 0.3};
  scene.joints.push_back(ball);
  JointSpec free = ball;
  free.name = "B";
  free.child = "flying";
  free.kind = JointKind::free;
  free.position = {1, 0, 0, std::cos(0.3), 0, std::sin(0.3), 0};
  free.velocity = {0, 0, 0, 0.2, -1, 2};
  scene.joints.push_back(free);
  scene.loops.push_back(make_loop(LoopKind::point, "C", "held", "flying", {1, 0, 0}));
  return scene;
}

}  // namespace momenta::equations
