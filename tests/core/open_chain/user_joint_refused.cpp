// User joints in batches, without inertia, and in scenes that refuse them.
#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/open_chain/open_chain.h>
#include <momenta/core/open_chain/operations.h>

#include "equations/parts.h"
#include "equations/refusal.h"
#include "equations/tolerance.h"
#include "equations/user_chain.h"

namespace momenta::core_user_joint_refused {
namespace {

using namespace equations;

TEST(UserJoint, Batches) {
  const auto law = std::make_shared<UserJoint>(2, Moving{});
  Scene scene =
      tree_of([&](Scene& s, const JointSpec& j) { s.joints.push_back(user(j, law)); }, false);
  scene.joints.back().stiffness = 0;
  for (const int level : {1, 3, 4}) {
    OpenChain chain(scene, Algebra::automatic, level);
    const int n = chain.nv(), count = 11;
    StateMatrix q(n, count), u(n, count), p(n, count), qdot(n, count), pdot(n, count),
        udot(n, count);
    Eigen::VectorXd one(n), two(n);
    for (int i = 0; i < count; ++i) {
      const State s(n, 300 + static_cast<unsigned>(i));
      q.col(i) = s.q;
      u.col(i) = s.u;
      chain.momenta(s.t, s.q, s.u, one);
      p.col(i) = one;
    }
    ASSERT_TRUE(chain.rates_of_states(0.4, q, p, qdot, pdot)) << chain.failure();
    ASSERT_TRUE(chain.accelerations_of_states(0.4, q, u, udot)) << chain.failure();
    for (int i = 0; i < count; ++i) {
      ASSERT_TRUE(chain.rates(0.4, q.col(i), p.col(i), one, two));
      EXPECT_LE(relative_error(qdot.col(i), one), 1e-13) << level;
      EXPECT_LE(relative_error(pdot.col(i), two), 1e-13) << level;
      ASSERT_TRUE(chain.accelerations(0.4, q.col(i), u.col(i), one));
      EXPECT_LE(relative_error(udot.col(i), one), 1e-13) << level;
    }
  }
}

TEST(UserJoint, WithoutInertiaItIsNamed) {
  const auto failure = [](const Scene& scene) {
    OpenChain chain(scene);
    const State s(chain.nv(), 3);
    Eigen::VectorXd a(chain.nv()), b(chain.nv());
    EXPECT_FALSE(chain.rates(0, s.q, s.u, a, b));
    const std::string by_momenta = chain.failure();
    EXPECT_FALSE(chain.accelerations(0, s.q, s.u, a));
    EXPECT_EQ(chain.failure(), by_momenta);
    return by_momenta;
  };
  const auto expected = [](const std::string& rates) {
    return "joint 'U' has no inertia: body 'a' and what it carries have none in some direction, as "
           "at rates " +
           rates +
           " of joint 'U' no mass moves; expected a mass, a rotor's inertia, or a fixed joint";
  };
  EXPECT_EQ(failure(alone({{{a_turn, slanted}, {a_turn, slanted}}})), expected("(1, -1)"));
  Scene rod = alone({{{a_turn, Z}, {a_turn, Y}, {a_turn, X}}});
  rod.bodies[0].com = rod.joints[0].origin_child + slanted;
  rod.bodies[0].inertia = 0.1 * (Eigen::Matrix3d::Identity() - slanted * slanted.transpose());
  EXPECT_EQ(failure(rod), expected("(1, 0.25, 0.96)"));
}

TEST(UserJoint, WhatIsRefused) {
  const auto message = [](const auto& change) -> std::string {
    Scene scene = alone({{{a_turn, slanted}}});
    change(scene, scene.joints[0]);
    return equations::thrown<SceneError>([&] { OpenChain chain(scene); });
  };
  EXPECT_EQ(message([](Scene&, JointSpec&) {}), "");
  EXPECT_EQ(message([](Scene&, JointSpec& j) { j.law.reset(); }),
            "scene: joint 'U': law is missing, expected a UserJoint");
  for (const int n : {0, 7})
    EXPECT_EQ(
        message([&](Scene&, JointSpec& j) { j.law = std::make_shared<UserJoint>(n, Chain{}); }),
        "scene: joint 'U': law has " + std::to_string(n) + " coordinates, expected 1 to 6");
  EXPECT_EQ(message([](Scene&, JointSpec& j) { j.kind = a_turn; }),
            "scene: joint 'U': law is for user joints only");
  EXPECT_EQ(message([](Scene&, JointSpec& j) {
              j.position = {1, 2};
            }),
            "scene: joint 'U': position must be empty or of the size of its kind");
  EXPECT_EQ(message([](Scene&, JointSpec& j) {
              j.velocity = {1, 2};
            }),
            "scene: joint 'U': velocity must be empty or of the size of its kind");
  EXPECT_EQ(message([](Scene&, JointSpec& j) {
              j.law = std::make_shared<UserJoint>(1, Chain{{{a_turn, 1.1 * slanted}}});
              j.position = {0.5};
            }),
            "scene: joint 'U': law gives a matrix at the start that is no rotation within 1e-10");
  EXPECT_EQ(message([](Scene& s, JointSpec&) { s.drives = {equations::polynomial("U", {1})}; }),
            "scene: drive of joint 'U': joint 'U' is user, expected what moves it in its law");
  EXPECT_NE(message([](Scene& s, JointSpec&) {
              LoopSpec loop;
              loop.name = "L";
              loop.child = "a";
              s.loops = {loop};
            }),
            "");
  EXPECT_THROW(OpenChain(alone({{{a_turn, Z}}}), Algebra::planar), SceneError);
}

TEST(UserJoint, StartsWhereTheSceneSays) {
  Scene scene = alone({{{a_turn, Z}, {a_turn, Y}, {a_turn, X}, {a_slide, Z}}});
  scene.joints[0].position = {0.1, 0.2, 0.3, 2};
  scene.joints[0].velocity = {1, 2, 3, 4};
  OpenChain chain(scene);
  EXPECT_EQ(chain.tree().q0, Eigen::Vector4d(0.1, 0.2, 0.3, 2));
  EXPECT_EQ(chain.tree().u0, Eigen::Vector4d(1, 2, 3, 4));
  EXPECT_FALSE(chain.plan().quasi_velocities);
  EXPECT_GT(
      count_operations(chain.tree(), scene, chain.plan(), Recursion::momentum).executed.total(), 0);
}

}  // namespace
}  // namespace momenta::core_user_joint_refused
