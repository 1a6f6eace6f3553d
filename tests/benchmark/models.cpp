#include "models.h"

#include <cmath>
#include <random>

namespace momenta::benchmark_models {
namespace {

constexpr double right_angle = 1.5707963267948966;

BodySpec rod(const std::string& name) {
  BodySpec b;
  b.name = name;
  b.mass = 1;
  b.com = {0.5, 0, 0};
  b.inertia = Eigen::Vector3d(0, 1.0 / 12, 1.0 / 12).asDiagonal();
  b.shape = {"rod", {1, 0, 0}, {1, 0, 0}};
  return b;
}

/// A solid block with its com off every axis.
BodySpec block(const std::string& name, std::mt19937& random) {
  std::uniform_real_distribution<double> any(0.1, 0.3);
  BodySpec b;
  b.name = name;
  b.mass = 1 + any(random);
  b.com = {any(random), -any(random), any(random)};
  const double x = any(random), y = any(random), z = any(random);
  b.inertia = Eigen::Vector3d(y * y + z * z, x * x + z * z, x * x + y * y).asDiagonal();
  return b;
}

JointSpec joint(const std::string& name, JointKind kind, const std::string& parent,
                const std::string& child) {
  JointSpec j;
  j.name = name;
  j.kind = kind;
  j.parent = parent;
  j.child = child;
  return j;
}

std::string number(const char* what, int i) {
  return what + std::to_string(i);
}

template <class Shape>
Scene serial(int n, JointKind kind, Shape&& shape) {
  Scene s;
  s.name = "chain";
  s.gravity = {0, 0, -9.81};
  for (int i = 0; i < n; ++i) {
    JointSpec j =
        joint(number("J", i), kind, i == 0 ? "ground" : number("b", i - 1), number("b", i));
    shape(i, j, s);
    s.joints.push_back(j);
  }
  return s;
}

}  // namespace

Scene random_chain(int n) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  return serial(n, JointKind::revolute, [&](int i, JointSpec& j, Scene& s) {
    s.bodies.push_back(block(number("b", i), random));
    if (i > 0) j.origin_parent = {0.4 * any(random), 0.4 * any(random), 0.4};
    // Body axes stay parallel to the last axis as z; the next leans by 17° to 163°.
    const double lean = right_angle * (1 + 0.81 * any(random)),
                 around = 2 * right_angle * any(random);
    j.rotation = Eigen::AngleAxisd(around, Eigen::Vector3d::UnitZ()) *
                 Eigen::AngleAxisd(lean, Eigen::Vector3d::UnitX());
    j.position = {any(random)};
  });
}

Scene prismatic_and_revolute_chain(int n) {
  Scene s = random_chain(n);
  for (std::size_t i = 1; i < s.joints.size(); i += 2) s.joints[i].kind = JointKind::prismatic;
  return s;
}

Scene helical_chain(int n) {
  Scene s = random_chain(n);
  for (JointSpec& j : s.joints) {
    j.kind = JointKind::helical;
    j.pitch = 0.1;
  }
  return s;
}

Scene right_angle_chain(int n) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  return serial(n, JointKind::revolute, [&](int i, JointSpec& j, Scene& s) {
    s.bodies.push_back(block(number("b", i), random));
    if (i > 0) j.origin_parent = {0.4, 0, 0};
    j.axis = i % 2 == 0 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitY();
    j.position = {any(random)};
  });
}

Scene planar_chain(int n) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  Scene s = serial(n, JointKind::revolute, [&](int i, JointSpec& j, Scene& scene) {
    scene.bodies.push_back(rod(number("b", i)));
    if (i > 0) j.origin_parent = {1, 0, 0};
    j.position = {any(random)};
  });
  s.gravity = {0, -9.81, 0};
  return s;
}

Scene binary_tree(int n) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  Scene s = serial(n, JointKind::revolute, [&](int i, JointSpec& j, Scene& scene) {
    scene.bodies.push_back(block(number("b", i), random));
    j.axis = Eigen::Vector3d(any(random), any(random), any(random)).normalized();
    j.position = {any(random)};
    if (i > 0) {
      j.parent = number("b", (i - 1) / 2);
      j.origin_parent = {0.4 * any(random), 0.4 * any(random), 0.4};
    }
  });
  return s;
}

Scene rope(int n) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  return serial(n, JointKind::revolute, [&](int i, JointSpec& j, Scene& s) {
    BodySpec b = rod(number("b", i));
    b.com /= 10;
    b.mass /= 10;
    b.inertia = Eigen::Vector3d(1e-6, 1e-4, 1e-4).asDiagonal();
    s.bodies.push_back(b);
    if (i > 0) j.origin_parent = {0.1, 0, 0};
    j.axis = i % 2 == 0 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitY();
    j.position = {0.02 * any(random)};
  });
}

Scene star(int n) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  return serial(n, JointKind::revolute, [&](int i, JointSpec& j, Scene& s) {
    s.bodies.push_back(block(number("b", i), random));
    if (i == 0) {
      j.kind = JointKind::free;
      return;
    }
    if (i % 6 == 1) j.parent = "b0";
    j.origin_parent = {0.4 * any(random), 0.4 * any(random), 0.4};
    j.axis = Eigen::Vector3d(any(random), any(random), any(random)).normalized();
    j.position = {any(random)};
  });
}

Scene humanoid(int) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  Scene s;
  s.name = "humanoid";
  s.gravity = {0, 0, -9.81};
  const auto add = [&](const std::string& parent, const std::string& name, JointKind kind,
                       const Eigen::Vector3d& axis, const Eigen::Vector3d& at) {
    s.bodies.push_back(block(name, random));
    JointSpec j = joint("to_" + name, kind, parent, name);
    j.axis = axis;
    j.origin_parent = at;
    if (kind == JointKind::revolute) j.position = {0.3 * any(random)};
    s.joints.push_back(j);
  };
  const Eigen::Vector3d x(1, 0, 0), y(0, 1, 0), z(0, 0, 1), here(0, 0, 0), down(0, 0, -0.4);
  add("ground", "trunk", JointKind::free, z, here);
  const auto branch = [&](const std::string& name, const std::string& parent,
                          const Eigen::Vector3d& at, std::initializer_list<Eigen::Vector3d> axes,
                          std::initializer_list<int> lengths) {
    std::string last = parent;
    int i = 0;
    auto step = lengths.begin();
    for (const auto& axis : axes) {
      const std::string body = name + std::to_string(i);
      add(last, body, JointKind::revolute, axis,
          i == 0 ? at : Eigen::Vector3d(static_cast<double>(*step) * down));
      last = body;
      if (i++ > 0) ++step;
    }
    return last;
  };
  const std::string chest = branch("torso", "trunk", {0, 0, 0.1}, {z, x, y}, {0, -1});
  branch("neck", chest, {0, 0, 0.4}, {y}, {});
  for (const double side : {1.0, -1.0}) {
    const std::string name = side > 0 ? "left_" : "right_";
    branch(name + "leg", "trunk", {0, 0.1 * side, 0}, {z, x, y, y, y, x}, {0, 0, 1, 1, 0});
    branch(name + "arm", chest, {0, 0.2 * side, 0.3}, {y, x, z, y, z, y, x}, {0, 0, 1, 0, 1, 0});
  }
  return s;
}

Scene spherical_chain(int n) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  return serial(n, JointKind::spherical, [&](int i, JointSpec& j, Scene& s) {
    s.bodies.push_back(block(number("b", i), random));
    if (i > 0) j.origin_parent = {0.4 * any(random), 0.4 * any(random), 0.4};
    const Eigen::Quaterniond q =
        Eigen::Quaterniond(1, any(random), any(random), any(random)).normalized();
    j.position = {q.w(), q.x(), q.y(), q.z()};
  });
}

Scene four_bar() {
  Scene s = n_four_bar(1);
  s.name = "four-bar";
  return s;
}

Scene n_four_bar(int n) {
  Scene s;
  s.name = "N-four-bar";
  s.gravity = {0, -9.81, 0};
  // Away from the flat pose: every vertical leans by 0.3 rad, horizontals stay level.
  const double lean = right_angle - 0.3;
  for (int i = 0; i <= n; ++i) {
    s.bodies.push_back(rod(number("v", i)));
    JointSpec o = joint(number("O", i), JointKind::revolute, "ground", number("v", i));
    o.origin_parent = {static_cast<double>(i), 0, 0};
    o.position = {lean};
    o.velocity = {-1};
    s.joints.push_back(o);
    if (i == n) break;
    s.bodies.push_back(rod(number("h", i + 1)));
    JointSpec b = joint(number("B", i), JointKind::revolute, number("v", i), number("h", i + 1));
    b.origin_parent = {1, 0, 0};
    b.position = {-lean};
    b.velocity = {1};
    s.joints.push_back(b);
    LoopSpec c;
    c.name = number("C", i + 1);
    c.kind = LoopKind::revolute;
    c.parent = number("v", i + 1);
    c.child = number("h", i + 1);
    c.origin_parent = c.origin_child = {1, 0, 0};
    s.loops.push_back(c);
  }
  return s;
}

Scene scissor_ladder(int n) {
  Scene s;
  s.name = "scissor ladder";
  s.gravity = {0, -9.81, 0};
  const double tilt = 0.6, other = 2 * right_angle - tilt;
  const auto bar = [&](const std::string& name, double centre) {
    BodySpec b = rod(name);
    b.com = {centre, 0, 0};
    b.inertia = Eigen::Vector3d(0, 4.0 / 12, 4.0 / 12).asDiagonal();
    s.bodies.push_back(b);
  };
  for (int i = 0; i < n; ++i) {
    bar(number("a", i), 1);
    bar(number("b", i), 0);
    JointSpec a = joint(number("A", i), JointKind::revolute, i == 0 ? "ground" : number("b", i - 1),
                        number("a", i));
    if (i > 0) a.origin_parent = {1, 0, 0};
    a.position = {i == 0 ? tilt : tilt - other};
    a.velocity = {i == 0 ? 0.3 : 0.6};
    s.joints.push_back(a);
    JointSpec b = joint(number("B", i), JointKind::revolute, number("a", i), number("b", i));
    b.origin_parent = {1, 0, 0};
    b.position = {other - tilt};
    b.velocity = {-0.6};
    s.joints.push_back(b);
    if (i == 0) continue;
    LoopSpec c;
    c.name = number("C", i);
    c.kind = LoopKind::revolute;
    c.parent = number("a", i - 1);
    c.child = number("b", i);
    c.origin_parent = {2, 0, 0};
    c.origin_child = {-1, 0, 0};
    s.loops.push_back(c);
  }
  return s;
}

}  // namespace momenta::benchmark_models
