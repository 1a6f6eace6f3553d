#pragma once
// Trees with user joints for the tests: laws, bodies, and everything a chain answers at one state.

#include <gtest/gtest.h>
#include <momenta/core/open_chain/open_chain.h>
#include <momenta/core/open_chain/user_joint.h>

#include <functional>
#include <map>
#include <random>

#include "equations/parts.h"

namespace momenta::equations {

template <class S>
Vec3<S> along(const Eigen::Vector3d& v) {
  return {{S(v.x()), S(v.y()), S(v.z())}};
}

/// A chain of turns and slides about and along fixed axes, one coordinate each; a slide goes in the
/// axes before it. `pitch`: the first coordinate slides besides.
struct Chain {
  struct Step {
    JointKind kind;
    Eigen::Vector3d axis;
  };
  std::vector<Step> steps;
  double pitch = 0;
  template <class S>
  JointPose<S> operator()(const S&, const S* q) const {
    JointPose<S> pose{identity3<S>(), {}};
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const auto axis = along<S>(steps[i].axis);
      if (steps[i].kind != JointKind::revolute)
        pose.position += pose.rotation * (S(pitch != 0 ? pitch : 1.0) * q[i] * axis);
      if (steps[i].kind != JointKind::prismatic)
        pose.rotation = pose.rotation * turn_about(axis, q[i]);
    }
    return pose;
  }
};

/// A hinge whose axis turns and whose origin travels with time, and a second one whose axis in the
/// child moves: E depends on q and t.
struct Moving {
  template <class S>
  JointPose<S> operator()(const S& t, const S* q) const {
    using std::cos, std::sin;
    const auto x = along<S>(Eigen::Vector3d::UnitX()), y = along<S>(Eigen::Vector3d::UnitY()),
               z = along<S>(Eigen::Vector3d::UnitZ());
    const Mat3<S> held = turn_about(x, S(0.4 * sin(1.3 * t))) * turn_about(y, S(0.2 * t * t));
    const Mat3<S> after = turn_about(y, S(0.7 * cos(t)));
    const Mat3<S> first = held * turn_about(z, q[0]);
    const Vec3<S> origin{{0.3 * sin(2.0 * t), 0.1 * t, S(0.2) * q[1] * cos(t)}};
    return {first * after * turn_about(x, S(q[1] + 0.3 * t * q[0])), origin + first * (S(0.2) * y)};
  }
};

inline BodySpec body(const std::string& name, double mass, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-0.4, 0.4);
  BodySpec b = make_body(name, mass, {0, 0, 0}, {number(random), number(random), number(random)});
  b.inertia.diagonal() << 0.3, 0.4, 0.5;
  b.inertia(0, 1) = b.inertia(1, 0) = 0.05;
  return b;
}

inline JointSpec joint(const std::string& name, JointKind kind, const std::string& parent,
                       const std::string& child, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-0.5, 0.5);
  const auto point = [&] {
    return Eigen::Vector3d(number(random), number(random), number(random));
  };
  JointSpec j;
  j.name = name;
  j.kind = kind;
  j.parent = parent;
  j.child = child;
  j.origin_parent = point();
  j.origin_child = point();
  j.axis = point().normalized();
  j.rotation = Eigen::Quaterniond(1, number(random), number(random), number(random)).normalized();
  return j;
}

inline JointSpec user(JointSpec j, std::shared_ptr<const UserJoint> law) {
  j.kind = JointKind::user;
  j.axis = Eigen::Vector3d::UnitZ();
  j.axis2.setZero();
  j.pitch = 0;
  j.law = std::move(law);
  return j;
}

/// `put` adds the joints "U1" and "U2" to the scene, in the place of the hinges it is given. Bodies
/// a, b, c in a chain, d beside b.
using Put = std::function<void(Scene&, JointSpec)>;
inline Scene tree_of(const Put& put, bool forces) {
  Scene scene;
  scene.gravity = {1, -2, -9.81};
  scene.bodies = {body("a", 1.3, 1), body("b", 0.8, 2), body("c", 1.1, 3), body("d", 0.6, 4)};
  put(scene, joint("U1", JointKind::revolute, "ground", "a", 11));
  scene.joints.push_back(joint("J2", JointKind::revolute, "a", "b", 12));
  put(scene, joint("U2", JointKind::revolute, "b", "c", 13));
  scene.joints.push_back(joint("J4", JointKind::prismatic, "a", "d", 14));
  scene.joints.back().stiffness = 3;
  if (forces) {
    ForceSpec spring;
    spring.kind = "spring-damper";
    spring.parent = "d";
    spring.child = "c";
    spring.origin_child = {0.1, 0.2, 0.3};
    spring.stiffness = 5;
    spring.rest = 0.2;
    scene.forces.push_back(spring);
  }
  return scene;
}

struct State {
  double t = 0.4;
  Eigen::VectorXd q, u;
  explicit State(int n, unsigned seed) : q(n), u(n) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> number(-1.2, 1.2);
    for (auto& x : q) x = number(random);
    for (auto& x : u) x = number(random);
  }
};

struct Answer {
  Eigen::VectorXd p, qdot, pdot, udot, solved;
  Eigen::MatrixXd mass, jacobian;
  Eigen::Vector3d energies;
  std::map<std::string, Reaction> reactions;
  Answer(OpenChain& chain, const State& s)
      : p(chain.nv()), qdot(chain.nq()), pdot(chain.nv()), udot(chain.nv()), solved(chain.nv()) {
    chain.momenta(s.t, s.q, s.u, p);
    EXPECT_TRUE(chain.rates(s.t, s.q, p, qdot, pdot)) << chain.failure();
    EXPECT_TRUE(chain.accelerations(s.t, s.q, s.u, udot)) << chain.failure();
    EXPECT_TRUE(chain.inverse_mass_times(s.t, s.q, s.u, solved)) << chain.failure();
    mass = chain.mass_matrix(s.t, s.q);
    jacobian = chain.jacobian(s.t, s.q, p);
    const Energies e = chain.energies(s.t, s.q, s.u);
    energies << e.kinetic, e.potential, e.hamiltonian;
    for (const auto& r : chain.reactions(s.t, s.q, s.u)) reactions[r.joint] = r;
  }
};

inline const Eigen::Vector3d slanted = Eigen::Vector3d(0.3, -0.5, 0.8).normalized();
inline const Eigen::Vector3d X = Eigen::Vector3d::UnitX(), Y = Eigen::Vector3d::UnitY(),
                             Z = Eigen::Vector3d::UnitZ();
inline constexpr auto a_turn = JointKind::revolute;
inline constexpr auto a_slide = JointKind::prismatic;

inline Scene rheonomic() {
  const auto law = std::make_shared<UserJoint>(2, Moving{});
  return tree_of([&](Scene& s, const JointSpec& j) { s.joints.push_back(user(j, law)); }, true);
}

/// One body on one user joint.
inline Scene alone(const Chain& law) {
  Scene scene;
  scene.bodies = {body("a", 1, 1)};
  scene.joints = {user(joint("U", a_turn, "ground", "a", 11),
                       std::make_shared<UserJoint>(static_cast<int>(law.steps.size()), law))};
  return scene;
}

}  // namespace momenta::equations
