// Other joints cut, the same mechanism: every body where it was, as fast, and accelerated alike.

#include "equations/recut.h"
#include "equations/examples.h"
#include "equations/large_scenes.h"
#include "equations/linkages.h"
#include "equations/point_motions.h"
#include "equations/random_tree.h"

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/core/format/toml/write_scene.h>
#include <momenta/core/open_chain/open_chain.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/kkt/sweeps/slots/loop_plan.h>
#include <momenta/dae/topology/assembly/assembly.h>
#include <momenta/dae/topology/cut/interchange.h>
#include <momenta/dae/topology/cut/recut.h>
#include <momenta/dae/topology/cut/relative_motion.h>

#include <map>
#include <random>

namespace momenta::dae_recut {
namespace {

using namespace equations;
using Eigen::VectorXd;
using equations::example;

/// Places and velocities of the markers at the assembled start, and a little later along the
/// accelerations found there.
std::vector<double> motion(const Scene& scene, double& moved) {
  const Mechanism mechanism(marked(scene));
  const Assembly a = assemble(mechanism);
  moved = a.moved;
  const auto e = mechanism.evaluation<double>();
  std::vector<double> values(6 * mechanism.scene().markers.size()), all;
  VectorXd q = a.start.q, u = a.start.u, qdot(mechanism.nq());
  for (const double h : {0.0, 1e-3}) {
    e->place(h, q.data());
    const VectorXd later = u + h * a.start.udot;
    e->move(later.data());
    e->markers(values.data());
    all.insert(all.end(), values.begin(), values.end());
    e->coordinate_rates(q.data(), u.data(), qdot.data());
    q += 1e-3 * qdot;
  }
  return all;
}

/// The accelerations are compared by velocities after h, to within what the second order of the
/// step leaves, h² times the fastest rate and the length of joints' ways.
void expect_same_motion(const Scene& scene, const Scene& other, const std::string& what) {
  double moved = 0, other_moved = 0;
  const auto expected = motion(scene, moved), found = motion(other, other_moved);
  EXPECT_LT(other_moved, 1e-9) << what << ": it was assembled already";
  ASSERT_EQ(expected.size(), found.size());
  const std::size_t half = expected.size() / 2;
  for (std::size_t i = 0; i < half; ++i)
    EXPECT_NEAR(found[i], expected[i], 1e-8 * (1 + std::abs(expected[i]))) << what << " " << i;
  double fastest = 1;
  for (std::size_t i = 0; i < expected.size(); ++i)
    fastest = std::max(fastest, std::abs(expected[i]));
  for (std::size_t i = half; i < expected.size(); ++i)
    EXPECT_NEAR(found[i], expected[i], 2e-5 * fastest * fastest) << what << " later " << i;
}

/// recut() of a scene, read back from its text.
Scene recut_text(const Recut& found) {
  return parse_scene(scene_text(found.scene));
}

TEST(Recut, HingesBadlyCutAreCutBetterAndMoveAlike) {
  Scene chain = arch(60);
  const Recut found = [&] {
    const Mechanism mechanism(chain);
    return recut(mechanism, assemble(mechanism).start);
  }();
  ASSERT_TRUE(found.gains());
  EXPECT_EQ(found.joined, std::vector<std::string>{"end"});
  EXPECT_LT(found.after.mass_entries, 0.6 * static_cast<double>(found.before.mass_entries));
  EXPECT_EQ(found.after.depth, 30);
  expect_same_motion(chain, recut_text(found), "arch");
}

TEST(Recut, WhateverWasCutTheWorkIsNoMore) {
  int bettered = 0;
  for (const auto& [name, cut, closed] :
       {std::tuple{"four_bar", "A", "B"}, std::tuple{"four_bar", "C", "B"},
        std::tuple{"andrews", "F", "E2"}, std::tuple{"andrews", "B", "E2"},
        std::tuple{"andrews", "A5", "E4"}, std::tuple{"andrews", "H", "E6"}}) {
    const Scene scene = example(name);
    const Mechanism mechanism(scene);
    const Scene bad = recut(scene, mechanism.tree(), assemble(mechanism).start.q, cut, closed);
    const Mechanism worse(bad);
    const Recut found = recut(worse, assemble(worse).start);
    EXPECT_LE(found.after.work, found.before.work);
    if (found.gains()) expect_same_motion(bad, recut_text(found), std::string(name) + " " + cut);
    // what is worse than the example was cut badly; a local minimum may be (pairs of ties that meet
    // in one point are chosen after the cuts)
    bettered += 10 * found.before.work > 11 * cut_cost(mechanism).work &&
                found.after.work < found.before.work;
  }
  EXPECT_GT(bettered, 0);
}

TEST(Recut, LeavesWhatItsAuthorSaysSomethingOf) {
  const auto joined = [](const Scene& scene, std::vector<std::string> keep) {
    const Mechanism mechanism(scene);
    return recut(mechanism, assemble(mechanism).start, keep);
  };
  const std::string middle = "J30";
  Scene chain = arch(60);
  EXPECT_FALSE(joined(chain, {"end"}).gains());
  EXPECT_EQ(joined(chain, {}).cut, std::vector<std::string>{middle});
  const auto elsewhere = joined(chain, {middle}).cut;
  ASSERT_EQ(elsewhere.size(), 1u);
  EXPECT_NE(elsewhere.front(), middle);
  Scene sprung = chain;
  sprung.joints[30].stiffness = 3;
  EXPECT_EQ(joined(sprung, {}).cut, elsewhere);
  Scene damped = chain;
  damped.joints[30].damping = 1;
  EXPECT_EQ(joined(damped, {}).cut, elsewhere);
  Scene pulled = chain;
  ForceSpec torque;
  torque.kind = "torque";
  torque.joint = middle;
  torque.value = 2;
  pulled.forces.push_back(torque);
  EXPECT_EQ(joined(pulled, {}).cut, elsewhere);
  expect_same_motion(pulled, recut_text(joined(pulled, {})), "pulled");
  EXPECT_THROW(joined(chain, {"nobody"}), SceneError);
}

/// Two bodies, a joint of any kind between them, seen from either.
TEST(Recut, JointsTurnedRoundHoldTheSamePose) {
  int tried = 0;
  for (unsigned seed = 0; seed < 120; ++seed) {
    RandomTree random(seed);
    TreeRecipe recipe{.bodies = 2, .branching = Branching::serial, .drives = false};
    recipe.joint_forces = recipe.body_forces = false;
    const JointKind kind = recipe.kinds[seed % recipe.kinds.size()];
    recipe.kinds = {kind};
    Scene scene = random.scene(recipe);
    // the first body flies, the joint in question carries the second
    JointSpec& free = scene.joints[0];
    free = JointSpec{};
    free.name = "free";
    free.kind = JointKind::free;
    free.child = scene.bodies[0].name;
    JointSpec& joint = scene.joints[1];
    const auto at = [](const Scene& s, const VectorXd& q, const VectorXd& u) {
      const Mechanism mechanism(marked(s));
      const auto e = mechanism.evaluation<double>();
      e->place(0, q.data());
      e->move(u.data());
      std::vector<double> values(6 * mechanism.scene().markers.size());
      e->markers(values.data());
      return values;
    };
    const Mechanism mechanism(scene);
    const TreeState s = random.state(mechanism.tree());
    const auto expected = at(scene, s.q, s.u);
    // its motion from its markers
    std::map<std::string, BodyMotion> bodies;
    for (std::size_t k = 0; k < 2; ++k) {
      const auto poses = OpenChain(scene).poses(0, s.q);
      BodyMotion m;
      m.pose = poses[static_cast<std::size_t>(mechanism.tree().body(scene.bodies[k].name))];
      Eigen::Matrix3d points, rates;
      for (int i = 0; i < 3; ++i)
        for (int c = 0; c < 3; ++c) {
          const double* v = expected.data() + 18 * k + 6 * static_cast<std::size_t>(i);
          points(c, i) = v[c], rates(c, i) = v[3 + c];
        }
      // v_i = v + ω × (x_i − x): six of the nine equations decide
      Eigen::Matrix<double, 9, 6> A = Eigen::Matrix<double, 9, 6>::Zero();
      Eigen::Matrix<double, 9, 1> b;
      for (int i = 0; i < 3; ++i) {
        const Eigen::Vector3d r = points.col(i) - m.pose.translation();
        A.block<3, 3>(3 * i, 0).setIdentity();
        A.block<3, 3>(3 * i, 3) << 0, r[2], -r[1], -r[2], 0, r[0], r[1], -r[0], 0;
        b.segment<3>(3 * i) = rates.col(i);
      }
      const Eigen::Matrix<double, 6, 1> x = A.colPivHouseholderQr().solve(b);
      m.v = x.head<3>();
      m.omega = x.tail<3>();
      bodies[scene.bodies[k].name] = m;
    }
    // as it is: its own q and u are found
    joint.position.assign(static_cast<std::size_t>(coordinates_of(kind)), 0.0);
    const JointMotion own = joint_motion(joint, bodies[joint.parent], bodies[joint.child]);
    EXPECT_LT(own.shift, 1e-9);
    EXPECT_LT(own.tilt, 1e-9);
    // turned round: the same place of both bodies
    joint.position = own.q, joint.velocity = own.u;
    Scene other = scene;
    other.joints[1] = reversed(joint);
    JointSpec& turned = other.joints[1];
    if (!keeps_coordinates(kind)) {
      const JointMotion m = joint_motion(turned, bodies[turned.parent], bodies[turned.child]);
      EXPECT_LT(m.shift, 1e-9);
      EXPECT_LT(m.tilt, 1e-9);
      turned.position = m.q, turned.velocity = m.u;
    }
    JointSpec& flies = other.joints[0];
    flies.child = turned.parent;
    const JointMotion m = joint_motion(flies, BodyMotion{}, bodies[flies.child]);
    flies.position = m.q, flies.velocity = m.u;
    const Mechanism turned_mechanism(other);
    const auto found = at(other, turned_mechanism.tree().q0, turned_mechanism.tree().u0);
    for (std::size_t i = 0; i < expected.size(); ++i)
      EXPECT_NEAR(found[i], expected[i], 1e-9 * (1 + std::abs(expected[i])))
          << seed << " kind " << static_cast<int>(kind) << " " << i;
    ++tried;
  }
  EXPECT_EQ(tried, 120);
}

/// Of a planar mechanism a planar joint ties nothing: as a loop it would make a spatial one of it.
TEST(Recut, PlanarMechanismsStayPlanar) {
  Scene scene = crossed_bars(4);
  BodySpec plate = rod("plate");
  JointSpec floats = hinge("floats", "ground", "plate", {0, 0, 0}, 0);
  floats.kind = JointKind::planar;
  floats.position = {0.5, -0.7, 0.2};
  scene.bodies.push_back(plate);
  scene.joints.push_back(floats);
  // it carries a second chain, whose loops are better cut there
  for (int i = 0; i < 6; ++i) {
    const std::string name = "link" + std::to_string(i),
                      parent = i == 0 ? "plate" : "link" + std::to_string(i - 1);
    scene.bodies.push_back(rod(name));
    scene.joints.push_back(hinge("K" + std::to_string(i), parent, name, {1, 0, 0}, 0.3));
  }
  LoopSpec closing;
  closing.name = "closing";
  closing.kind = LoopKind::revolute;
  closing.parent = "ground";
  closing.child = "link5";
  closing.origin_child = {1, 0, 0};
  closing.origin_parent = {4, 1, 0};
  scene.loops.push_back(closing);
  const Mechanism mechanism(scene);
  ASSERT_TRUE(mechanism.plan().planar);
  const Recut found = recut(mechanism, assemble(mechanism).start);
  ASSERT_TRUE(found.gains());
  EXPECT_TRUE(Mechanism(found.scene).plan().planar);
  EXPECT_EQ(std::count(found.cut.begin(), found.cut.end(), "floats"), 0);
  EXPECT_FALSE(as_loop(JointKind::planar, true).has_value());
  EXPECT_TRUE(as_loop(JointKind::planar, false).has_value());
}

TEST(Recut, PlatformOnManyLegsAndOtherGivenScenes) {
  for (const Scene& scene :
       {platform(6), bricard(), crossed_bars(8), row_of_four_bars(5, 1.1, 1)}) {
    const Mechanism mechanism(scene);
    const Recut found = recut(mechanism, assemble(mechanism).start);
    EXPECT_LE(found.after.open, std::max(found.before.open, LoopPlan::most_slots));
    if (found.gains()) expect_same_motion(scene, recut_text(found), scene.name);
  }
}

/// Two loops on a tree whose neighbours change the best one without making it cheaper: the tree
/// from which they are tried must stay.
TEST(Recut, TheBestTreeMayChangeWhileItsNeighboursAreTried) {
  const Scene scene = parse_scene(R"(
[[body]]
name = "b0"
mass = 0.4188672925771823
com = [-0.4250486745467955, -0.0918686155765841, 0.0]
inertia = 0.04794713827803702
[[body]]
name = "b1"
mass = 2.820886417866595
inertia = 0.3236515702755325
[[body]]
name = "b2"
mass = 0.0
[[body]]
name = "b3"
mass = 5.428268949894632
inertia = 0.06624427271561305
[[body]]
name = "b4"
mass = 0.1549419949116786
inertia = 0.02123508778838345
[[body]]
name = "b5"
mass = 5.877814252877529
inertia = 0.8711104421575208
[[joint]]
name = "J0"
kind = "revolute"
parent = "ground"
child = "b0"
[[joint]]
name = "J1"
kind = "revolute"
parent = "b0"
child = "b1"
[[joint]]
name = "J2"
kind = "revolute"
parent = "b1"
child = "b2"
origin = { parent = [-0.5216036999103837, 1.1061461657075153, 0.0] }
[[joint]]
name = "J3"
kind = "revolute"
parent = "b1"
child = "b3"
[[joint]]
name = "J4"
kind = "revolute"
parent = "b3"
child = "b4"
[[joint]]
name = "J5"
kind = "prismatic"
parent = "b4"
child = "b5"
origin = { parent = [-1.3852812928037386, -0.15550311025028307, 0.0] }
axis = [0.5205742977198897, 0.8538163740251434, 0.0]
[[loop]]
name = "L0"
kind = "revolute"
parent = "ground"
child = "b2"
origin = { parent = [0.24850585846077533, 0.08654285458185607, 0.0], child = [1.1287757510836003, -0.7326803612019799, 0.0] }
[[loop]]
name = "L1"
kind = "point"
parent = "ground"
child = "b5"
origin = { parent = [0.3623258532987399, 0.1809309427941026, 0.0], child = [0.8075264398833681, -0.3521810377966432, 0.0] }
)");
  const Mechanism mechanism(scene);
  const Recut found = recut(mechanism, assemble(mechanism).start);
  EXPECT_LE(found.after.open, found.before.open);
  if (found.gains()) expect_same_motion(scene, recut_text(found), "two loops");
}

/// Bodies hung anywhere on each other by hinges and slides, loops between any two of them.
TEST(Recut, RandomScenesMoveAlike) {
  int gained = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    const auto below = [&](unsigned n) { return random() % n; };
    const auto place = [&] {
      return Eigen::Vector3d(0.01 * static_cast<double>(below(200)) - 1,
                             0.01 * static_cast<double>(below(200)) - 1, 0);
    };
    Scene scene;
    scene.gravity = {0, -9.81, 0};
    std::vector<Eigen::Vector3d> at{{0, 0, 0}};  // frames stay parallel to the ground's
    const auto body = [](std::size_t k) {
      return k == 0 ? std::string("ground") : "b" + std::to_string(k);
    };
    const std::size_t bodies = 5 + below(4);
    for (std::size_t k = 1; k <= bodies; ++k) {
      scene.bodies.push_back(rod(body(k), 0.2));
      const std::size_t parent = below(static_cast<unsigned>(k));
      const Eigen::Vector3d on_parent = place();
      at.push_back(at[parent] + on_parent);
      JointSpec joint = hinge("J" + std::to_string(k), body(parent), body(k), on_parent, 0);
      if (below(6) == 0) {
        joint.kind = JointKind::prismatic;
        joint.axis = {0.6, 0.8, 0};
      }
      scene.joints.push_back(joint);
    }
    for (std::size_t k = 0; k < 2 + below(2); ++k) {
      const std::size_t a = below(static_cast<unsigned>(bodies + 1)),
                        b = 1 + below(static_cast<unsigned>(bodies));
      if (a == b) continue;
      LoopSpec loop;
      loop.name = "L" + std::to_string(k);
      loop.kind = below(2) ? LoopKind::revolute : LoopKind::point;
      loop.axis = {0, 0, 1};
      loop.parent = body(a);
      loop.child = body(b);
      loop.origin_child = place();
      loop.origin_parent = at[b] + loop.origin_child - at[a];
      scene.loops.push_back(loop);
    }
    const Mechanism mechanism(scene);
    const Recut found = recut(mechanism, assemble(mechanism).start);
    if (!found.gains()) continue;
    ++gained;
    expect_same_motion(scene, recut_text(found), "seed " + std::to_string(seed));
  }
  EXPECT_GT(gained, 10);
}

}  // namespace
}  // namespace momenta::dae_recut
