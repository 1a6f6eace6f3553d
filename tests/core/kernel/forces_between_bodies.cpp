// What acts between two bodies is computed below their lowest common ancestor alone
// (core/kernel/forced_bodies.h): the generalised forces of random trees against those of a twin
// that places every body from the ground and gathers the wrenches of all; and how many bodies are
// placed. Dampers of balls alone are forces of these joints, and place none.

#include "equations/examples.h"
#include "equations/parts.h"
#include "equations/random_tree.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/kernel/body_forces.h>
#include <momenta/core/kernel/tree/tree.h>

#include <string>
#include <vector>

namespace momenta::core_forces_between_bodies {
namespace {

using equations::RandomTree;

/// Q of the forces at points, from the ground outward and back to it over all bodies.
std::vector<double> from_the_ground(const Model<Spatial>& model, const equations::TreeState& s) {
  Workspace<Spatial, double> w(model);
  poses_outward(w, s.t, s.q.data(), true);
  velocities_outward(w, s.u.data());
  for (auto& body : w.body) body.T = {};
  add_body_forces(w);
  std::vector<double> along(static_cast<std::size_t>(model.nv));
  for (std::size_t k = w.body.size(); k-- > 0;) {
    const auto& b = model.bodies[k];
    auto& body = w.body[k];
    if (b.nv > 0) Joint<Spatial>::project(b, body.edge, body.T, along.data() + b.u);
    if (b.parent >= 0)
      w.body[static_cast<std::size_t>(b.parent)].T +=
          Spatial::to_parent(b.edge, b.kind, body.edge, body.T);
  }
  return along;
}

/// Bushings between any two bodies, springs along the coordinates of any two joints.
void add_forces(RandomTree& random, Scene& scene) {
  const auto any_body = [&] {
    return scene
        .bodies[static_cast<std::size_t>(random.below(static_cast<int>(scene.bodies.size())))]
        .name;
  };
  for (int i = 0; i < 3; ++i) {
    ForceSpec bushing;
    bushing.kind = "bushing";
    bushing.parent = random.chance(0.2) ? "ground" : any_body();
    bushing.child = any_body();
    if (bushing.parent == bushing.child) continue;
    bushing.origin_parent = random.vector(1);
    bushing.origin_child = random.vector(1);
    bushing.rotation = random.turn();
    bushing.stiffness = random.uniform(0, 9);
    bushing.damping = random.uniform(0, 2);
    bushing.rotational_stiffness = random.uniform(0, 9);
    bushing.rotational_damping = random.uniform(0, 2);
    scene.forces.push_back(bushing);
  }
  ForceSpec along;
  along.kind = "coordinate-spring";
  for (const JointSpec& joint : scene.joints)
    if (joint.kind == JointKind::revolute || joint.kind == JointKind::prismatic) {
      along.joints.push_back(joint.name);
      along.ratios.push_back(random.uniform(0.5, 2));
      if (along.joints.size() == 2) break;
    }
  along.stiffness = random.uniform(0, 9);
  along.damping = random.uniform(0, 2);
  if (!along.joints.empty()) scene.forces.push_back(along);
}

TEST(ForcesBetweenBodies, AreThoseSeenFromTheGround) {
  equations::TreeRecipe recipe;
  recipe.bodies = 9;
  int fewer = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    RandomTree random(seed);
    recipe.branching = seed % 3 == 0   ? equations::Branching::serial
                       : seed % 3 == 1 ? equations::Branching::star
                                       : equations::Branching::random;
    Scene scene = random.scene(recipe);
    // Of every second scene no wrench: nothing then asks for the ground but what hangs on it.
    if (seed % 2 == 0)
      std::erase_if(scene.forces, [](const auto& f) { return f.kind == "wrench"; });
    add_forces(random, scene);
    const Tree tree = build_tree(scene);
    const auto model = build_spatial_model(tree, scene);
    Workspace<Spatial, double> w(model);
    fewer += w.forced.size() < model.bodies.size();
    for (int i = 0; i < 3; ++i) {
      const equations::TreeState s = random.state(tree);
      const std::vector<double> expected = from_the_ground(model, s);
      body_force_rates(w, s.t, s.q.data(), s.u.data());
      double largest = 1;
      for (const double value : expected) largest = equations::larger(largest, std::abs(value));
      for (std::size_t k = 0; k < expected.size(); ++k)
        ASSERT_NEAR(w.generalised[k], expected[k], 1e-12 * largest)
            << "seed " << seed << ", rate " << k;
    }
  }
  EXPECT_GT(fewer, 60);
}

/// Dampers of the balls between moving bodies, or on the ground.
int damp_balls(RandomTree& random, Scene& scene) {
  int balls = 0;
  for (const JointSpec& joint : scene.joints) {
    if (joint.kind != JointKind::spherical) continue;
    ForceSpec damper;
    damper.kind = "bushing";
    damper.parent = joint.parent;
    damper.child = joint.child;
    damper.origin_child = random.vector(1);
    damper.rotational_damping = random.uniform(0.1, 2);
    scene.forces.push_back(damper);
    ++balls;
  }
  return balls;
}

TEST(ForcesBetweenBodies, OfDampedBallsAreTheirRates) {
  equations::TreeRecipe recipe;
  recipe.bodies = 9;
  recipe.drives = false;
  int balls = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    RandomTree random(seed);
    recipe.branching = seed % 2 == 0 ? equations::Branching::serial : equations::Branching::random;
    Scene scene = random.scene(recipe);
    scene.forces.clear();
    balls += damp_balls(random, scene);
    const bool mixed = seed % 3 == 0;  // with others: all go the general way
    if (mixed) add_forces(random, scene);
    const Tree tree = build_tree(scene);
    const auto model = build_spatial_model(tree, scene);
    Workspace<Spatial, double> w(model);
    const equations::TreeState s = random.state(tree);
    ASSERT_TRUE(mixed || ball_damper_rates(w, s.u.data())) << "seed " << seed;
    const std::vector<double> expected = from_the_ground(model, s);
    body_force_rates(w, s.t, s.q.data(), s.u.data());
    for (std::size_t k = 0; k < expected.size(); ++k)
      ASSERT_NEAR(w.generalised[k], expected[k], 1e-11) << "seed " << seed << ", rate " << k;
  }
  EXPECT_GT(balls, 40);
}

TEST(ForcesBetweenBodies, OfMoreThanABallGoTheGeneralWay) {
  equations::TreeRecipe recipe;
  recipe.bodies = 6;
  recipe.drives = false;
  int tried = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    RandomTree random(seed);
    Scene scene = random.scene(recipe);
    scene.forces.clear();
    if (damp_balls(random, scene) == 0) continue;
    const auto taken = [&](auto&& change) {
      Scene other = scene;
      change(other.forces.back());
      const Tree tree = build_tree(other);
      const auto model = build_spatial_model(tree, other);
      return damped_ball(model, model.bushings.back()) >= 0;
    };
    ++tried;
    EXPECT_TRUE(taken([](ForceSpec&) {}));
    EXPECT_FALSE(taken([](ForceSpec& f) { f.damping = 1; }));
    EXPECT_FALSE(taken([](ForceSpec& f) { f.stiffness = 1; }));
    EXPECT_FALSE(taken([](ForceSpec& f) { f.rotational_stiffness = 1; }));
    if (scene.forces.back().parent == "ground") continue;
    EXPECT_FALSE(taken([](ForceSpec& f) { f.parent = "ground"; }));
    EXPECT_FALSE(taken([](ForceSpec& f) { std::swap(f.parent, f.child); }));
  }
  EXPECT_GT(tried, 5);
}

/// Bodies placed for the forces at points.
std::size_t placed(const Scene& scene) {
  const Tree tree = build_tree(scene);
  const auto model = build_spatial_model(tree, scene);
  return forced_bodies(model).size();
}

TEST(ForcesBetweenBodies, PlaceWhatMovesAgainstEachOther) {
  // A biped's dampers on two balls of its legs.
  EXPECT_EQ(placed(equations::example("models/agility_cassie/cassie.xml")), 2u);
  // Two branches of three and four bodies on a stem of five.
  Scene scene;
  const auto add = [&](const std::string& parent, const std::string& child) {
    scene.bodies.push_back(equations::make_body(child, 1, {1, 1, 1}));
    scene.joints.push_back(equations::make_joint(JointKind::revolute, child, parent, child));
    return child;
  };
  std::string stem = "ground", left, right;
  for (int i = 0; i < 5; ++i) stem = add(stem, "s" + std::to_string(i));
  left = right = stem;
  for (int i = 0; i < 3; ++i) left = add(left, "l" + std::to_string(i));
  for (int i = 0; i < 4; ++i) right = add(right, "r" + std::to_string(i));
  ForceSpec spring;
  spring.kind = "spring-damper";
  spring.parent = left;
  spring.child = right;
  spring.stiffness = 1;
  scene.forces.push_back(spring);
  EXPECT_EQ(placed(scene), 7u);
  scene.forces.front().parent = stem;
  EXPECT_EQ(placed(scene), 4u);
  scene.forces.front().parent = "ground";
  EXPECT_EQ(placed(scene), 9u);
}

}  // namespace
}  // namespace momenta::core_forces_between_bodies
