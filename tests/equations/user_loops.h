#pragma once
// Mechanisms with loops whose joints are built in, and the same ones with user joints in their
// place: a spatial slider-crank in several ways, and a pin that slides on a curve.

#include <momenta/core/format/files/read_scene.h>

#include "equations/parts.h"
#include "equations/user_chain.h"

namespace momenta::equations {

/// Of one degree of freedom: a crank, a rod on a universal joint, a slider on a straight way that
/// crosses the crank's plane; the rod ends in a ball in the slider, off its axis.
inline Scene spatial_slider_crank() {
  return parse_scene(R"(
gravity = [0.3, -9.81, 0.5]

[assembly]
hold = ["O"]

[[body]]
name = "crank"
mass = 1.0
com = [0.2, 0.02, 0.01]
inertia = [0.02, 0.03, 0.04]

[[body]]
name = "rod"
mass = 2.0
com = [0.9, 0.0, 0.05]
inertia = [0.12, 0.6, 0.65]

[[body]]
name = "slider"
mass = 1.5
com = [0.05, 0.1, 0.0]
inertia = [0.2, 0.1, 0.25]

[[joint]]
name = "O"
kind = "revolute"
child = "crank"
axis = [0, 0, 1]
position = 0.7
velocity = 2.0

[[joint]]
name = "U"
kind = "universal"
parent = "crank"
child = "rod"
origin = { parent = [0.5, 0, 0.1] }
axis = [0, 0, 1]
axis2 = [0, 1, 0]
position = [-0.9, 0.05]

[[joint]]
name = "S"
kind = "prismatic"
child = "slider"
origin = { parent = [0, 0.1, 0.2] }
axis = [1, 0, 0]
position = 2.2

[[loop]]
name = "B"
kind = "spherical"
parent = "rod"
child = "slider"
origin = { parent = [2.0, 0, 0], child = [0, 0.2, 0.05] }

[[marker]]
name = "B"
body = "slider"
point = [0, 0.2, 0.05]
)");
}

/// The same with a slider that turns as it goes, 0.3 m a radian.
inline Scene spatial_screw_crank() {
  Scene scene = spatial_slider_crank();
  scene.joints[2].kind = JointKind::helical;
  scene.joints[2].pitch = 1.7;
  scene.joints[2].position = {1.3};
  return scene;
}

/// The same on a carriage that goes to and fro: x = 0.1 sin 3t.
inline Scene carried_slider_crank() {
  Scene scene = spatial_slider_crank();
  BodySpec carriage;
  carriage.name = "carriage";
  JointSpec way;
  way.name = "way";
  way.kind = JointKind::prismatic;
  way.child = "carriage";
  way.axis = {1, 0, 0};
  DriveSpec drive;
  drive.joint = "way";
  drive.kind = "formula";
  drive.law = "0.1*sin(3*t)";
  scene.bodies.insert(scene.bodies.begin(), carriage);
  scene.joints.insert(scene.joints.begin(), way);
  scene.joints[1].parent = "carriage";
  scene.drives.push_back(drive);
  return scene;
}

/// A hinge about z whose origin goes to and fro as the carriage does.
struct Carried {
  template <class S>
  JointPose<S> operator()(const S& t, const S* q) const {
    using std::sin;
    return {turn_about(along<S>(Eigen::Vector3d::UnitZ()), q[0]),
            Vec3<S>{{0.1 * sin(3.0 * t), S(0.0), S(0.0)}}};
  }
};

/// A pin on a twisted parabola that turns as it goes: E hangs on q.
struct Curve {
  template <class S>
  JointPose<S> operator()(const S&, const S* q) const {
    return {turn_about(along<S>(Eigen::Vector3d::UnitZ()), S(0.3 * q[0])),
            Vec3<S>{{q[0], 0.4 * (q[0] * q[0]) - 1.5, 0.1 * q[0]}}};
  }
};

/// Slider-crank with the slider on that curve, by three slides, a hinge and equations.
inline Scene slider_on_curve() {
  Scene scene = spatial_slider_crank();
  scene.joints.pop_back();
  const auto add = [&](const char* name, JointKind kind, const char* parent, const char* child,
                       const Eigen::Vector3d& axis, double position) {
    scene.joints.push_back(make_joint(kind, name, parent, child, {0, 0, 0}, axis, {position}));
    if (std::string(child) == "slider") return;
    BodySpec massless;
    massless.name = child;
    scene.bodies.push_back(massless);
  };
  const double x = 2.0;
  add("X", JointKind::prismatic, "ground", "x", Eigen::Vector3d::UnitX(), x);
  add("Y", JointKind::prismatic, "x", "y", Eigen::Vector3d::UnitY(), 0.4 * x * x - 1.5);
  add("Z", JointKind::prismatic, "y", "z", Eigen::Vector3d::UnitZ(), 0.1 * x);
  add("S", JointKind::revolute, "z", "slider", Eigen::Vector3d::UnitZ(), 0.3 * x);
  for (const char* equation : {"Y.q - 0.4*X.q^2 + 1.5", "Z.q - 0.1*X.q", "S.q - 0.3*X.q"}) {
    LoopSpec loop;
    loop.name = std::string("curve ") + equation[0];
    loop.kind = LoopKind::equation;
    loop.equation = equation;
    scene.loops.push_back(loop);
  }
  return scene;
}
inline Scene slider_on_user_curve() {
  Scene scene = spatial_slider_crank();
  JointSpec& joint = scene.joints[2];
  joint.origin_parent.setZero();
  joint = user(joint, std::make_shared<UserJoint>(1, Curve{}, std::initializer_list<int>{0}));
  joint.position = {2.0};
  return scene;
}

/// The joint of this name as a user joint.
inline Scene with_user(Scene scene, const std::string& name, std::shared_ptr<const UserJoint> law) {
  for (JointSpec& j : scene.joints)
    if (j.name == name) j = user(j, law);
  return scene;
}

/// A mechanism of built-in joints and the same with user joints, of as many coordinates.
struct Pair {
  std::string name;
  Scene built_in, user;
};
inline std::vector<Pair> pairs() {
  const auto law = [](int n, const Chain& chain, std::initializer_list<int> lengths = {}) {
    return std::make_shared<UserJoint>(n, chain, lengths);
  };
  const Scene crank = spatial_slider_crank(), screw = spatial_screw_crank();
  Scene carried = spatial_slider_crank();
  const auto hinge_z = law(1, {{{a_turn, Z}}});
  return {
      {"revolute", crank, with_user(crank, "O", hinge_z)},
      {"universal", crank, with_user(crank, "U", law(2, {{{a_turn, Z}, {a_turn, Y}}}))},
      {"prismatic", crank, with_user(crank, "S", law(1, {{{a_slide, X}}}, {0}))},
      {"helical", screw,
       with_user(screw, "S", law(1, {{{JointKind::helical, X}}, screw.joints[2].pitch}))},
      {"all", crank,
       with_user(
           with_user(with_user(crank, "O", hinge_z), "U", law(2, {{{a_turn, Z}, {a_turn, Y}}})),
           "S", law(1, {{{a_slide, X}}}, {0}))},
      {"carried", carried_slider_crank(),
       with_user(carried, "O", std::make_shared<UserJoint>(1, Carried{}))},
  };
}

}  // namespace momenta::equations
