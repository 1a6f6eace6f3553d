// Loops that close where the fronts of a body's children are gathered, against the assembled
// matrix: trees in space of which one body has several children tied to each other, to it and to
// others, one state and batches.

#include "equations/random_loops.h"
#include "equations/sweeps_against_matrix.h"

#include <gtest/gtest.h>
#include <momenta/core/kernel/model.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/kkt/sweeps/levels/loop_sweeps.h>

#include <algorithm>
#include <vector>

namespace momenta::dae_gathered_loops {
namespace {

using namespace equations;

/// Per body of the tree, its parent; −1: the ground.
std::vector<int> parents_of(const Tree& tree) {
  std::vector<int> parents;
  for (const Tree::Body& b : tree.bodies) parents.push_back(b.parent);
  return parents;
}

/// The name of some body below `k`, or of itself; those between the parts of a joint have none.
std::string below(RandomTree& random, const Tree& tree, int k) {
  std::vector<int> all{k};
  std::vector<std::string> names;
  for (int i = k; i < static_cast<int>(tree.bodies.size()); ++i) {
    const Tree::Body& b = tree.bodies[static_cast<std::size_t>(i)];
    if (i > k) {
      if (std::find(all.begin(), all.end(), b.parent) == all.end()) continue;
      all.push_back(i);
    }
    if (!b.name.empty()) names.push_back(b.name);
  }
  return names[static_cast<std::size_t>(random.below(static_cast<int>(names.size())))];
}

/// Ties neighbouring children of the body that has most, some of them to the body itself and one to
/// the ground.
void tie_children(RandomTree& random, Scene& scene) {
  const Tree tree = build_tree(scene);
  const std::vector<int> parents = parents_of(tree);
  std::vector<std::vector<int>> children(parents.size());
  for (std::size_t k = 0; k < parents.size(); ++k)
    if (parents[k] >= 0)
      children[static_cast<std::size_t>(parents[k])].push_back(static_cast<int>(k));
  const auto most =
      std::max_element(children.begin(), children.end(),
                       [](const auto& a, const auto& b) { return a.size() < b.size(); });
  const auto body = static_cast<std::size_t>(most - children.begin());
  const auto tie = [&](const std::string& child, const std::string& parent) {
    LoopSpec l =
        random_loop(random, scene, random.chance(0.3) ? LoopKind::point : LoopKind::distance);
    l.child = child;
    l.parent = parent;
    scene.loops.push_back(l);
  };
  for (std::size_t i = 0; i + 1 < most->size(); i += random.chance(0.5) ? 1 : 2)
    tie(below(random, tree, (*most)[i]),
        random.chance(0.3) ? tree.bodies[body].name : below(random, tree, (*most)[i + 1]));
  if (random.chance(0.4)) tie(below(random, tree, most->front()), "ground");
  if (random.chance(0.2)) tie(below(random, tree, most->back()), "ground");
}

/// Whether the plan of a scene closes loops where children are gathered.
bool gathers(const Scene& scene) {
  const Tree tree = build_tree(scene);
  const auto model = build_spatial_model(tree, scene);
  const std::vector<int> parents = parents_of(tree);
  const LoopPlan plan = swept_loops(tree, model, build_loops(scene, tree, model)).plan;
  for (std::size_t k = 0; plan.fits() && k < parents.size(); ++k)
    if (const auto& r = plan.gathered_closings_of[k]; parents[k] >= 0 && r.first != r.last)
      return true;
  return false;
}

Scene hand(RandomTree& random) {
  Scene scene = random.scene({.bodies = 11, .branching = Branching::random});
  tie_children(random, scene);
  return scene;
}

TEST(GatheredLoops, AgreeWithTheAssembledMatrix) {
  Worst worst;
  int gathered = 0;
  for (unsigned seed = 0; seed < 1500; ++seed) {
    RandomTree random(seed + 40000);
    const Scene scene = hand(random);
    if (scene.loops.empty() || !gathers(scene)) continue;
    const int before = worst.tried;
    compare(scene, random, {.algebra = Algebra::spatial}, worst);
    gathered += worst.tried > before;
  }
  EXPECT_GT(gathered, 60);
  expect_rounding(worst, 11);
}

TEST(GatheredLoops, BatchesAgree) {
  int compared = 0;
  for (unsigned seed = 0; seed < 600; ++seed) {
    RandomTree random(seed + 60000);
    Scene scene = hand(random);
    scene.forces.clear();
    if (scene.loops.empty() || !gathers(scene)) continue;
    const Mechanism mechanism(scene);
    if (mechanism.m() > mechanism.nv() || mechanism.solver().kkt() != KktChoice::sweeps) continue;
    compared += compare_batches(mechanism, random, 9);
  }
  EXPECT_GT(compared, 150);
}

}  // namespace
}  // namespace momenta::dae_gathered_loops
