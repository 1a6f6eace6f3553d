// The order of the children of a body: with it fronts are as narrow as with the best of all orders.

#include "equations/examples.h"
#include "equations/linkages.h"
#include "equations/random_tree.h"

#include <gtest/gtest.h>
#include <momenta/dae/kkt/sweeps/slots/loop_plan.h>
#include <momenta/dae/topology/assembly/assembly.h>
#include <momenta/dae/topology/cut/recut.h>
#include <momenta/dae/topology/cut/tree_order.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace momenta::dae_child_order {
namespace {

using namespace equations;

std::string finger(int i, int part) {
  return "finger" + std::to_string(i) + (part == 0 ? "" : "." + std::to_string(part));
}

/// An arm, a hand, fingers of two bodies each; ties between fingers, to the hand and to the ground.
Scene hand(RandomTree& random, int fingers) {
  Scene s;
  const auto add = [&](const std::string& name, const std::string& parent) {
    s.bodies.push_back(rod(name));
    s.joints.push_back(hinge("J " + name, parent, name, {1, 0, 0}, 0.1));
  };
  add("arm", "ground");
  add("hand", "arm");
  for (int i = 0; i < fingers; ++i) {
    add(finger(i, 0), "hand");
    add(finger(i, 1), finger(i, 0));
  }
  for (int i = 1 + random.below(5); i > 0; --i) {
    LoopSpec l;
    l.name = "loop " + std::to_string(i);
    l.kind = LoopKind::point;
    l.child = finger(random.below(fingers), random.below(2));
    l.parent = random.chance(0.2)   ? "ground"
               : random.chance(0.2) ? "hand"
                                    : finger(random.below(fingers), random.below(2));
    if (l.parent != l.child) s.loops.push_back(l);
  }
  return s;
}

/// Lanes of the fronts, of two equations a loop.
int lanes(const Scene& scene) {
  const Tree tree = build_tree(scene);
  std::map<std::string, int> number{{"ground", -1}};
  std::vector<int> parents;
  for (const Tree::Body& b : tree.bodies) {
    number[b.name] = static_cast<int>(parents.size());
    parents.push_back(b.parent);
  }
  std::vector<LoopShape> loops;
  for (const LoopSpec& l : scene.loops) loops.push_back({number[l.child], number[l.parent], 2});
  return lanes_for(plan_loops(parents, loops, false, true).slots, true);
}

/// The fewest lanes of all orders of the fingers.
int fewest(const Scene& scene, int fingers) {
  std::vector<int> order;
  for (int i = 0; i < fingers; ++i) order.push_back(i);
  int least = lanes(scene);
  do {
    Scene s = scene;
    for (std::size_t i = 0; i < order.size(); ++i)
      s.joints[2 + 2 * i] = scene.joints[2 + 2 * static_cast<std::size_t>(order[i])];
    least = std::min(least, lanes(s));
  } while (std::next_permutation(order.begin(), order.end()));
  return least;
}

TEST(ChildOrder, IsTheBestOfAll) {
  int tried = 0, fewer = 0, best = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    RandomTree random(seed);
    const int fingers = 3 + random.below(2);
    const Scene scene = hand(random, fingers);
    const auto ordered = with_children_ordered(scene);
    const int given = lanes(scene), now = ordered ? lanes(*ordered) : given,
              least = fewest(scene, fingers);
    ASSERT_GE(now, least);
    ASSERT_LE(now, 2 * least) << "seed " << seed;
    ++tried;
    fewer += now < given;
    best += now == least;
  }
  EXPECT_GT(fewer, 20);
  EXPECT_GE(best, tried * 95 / 100);
}

// Cassie's legs as they are written, and with the heel spring behind the foot, where it brings the
// loop of the achilles rod before that of the plantar rod has closed.
TEST(ChildOrder, OfCassieIsFoundAgain) {
  const Scene given = equations::example("models/agility_cassie/cassie.xml");
  Scene written = given;
  for (const char* side : {"left", "right"}) {
    const auto joint = [&](const char* name) {
      return std::find_if(written.joints.begin(), written.joints.end(),
                          [&](const JointSpec& j) { return j.name == std::string(side) + name; });
    };
    std::iter_swap(joint("-heel-spring"), joint("-foot"));
  }
  const auto found = [](const Scene& scene) {
    const Mechanism mechanism(scene);
    return recut(mechanism, assemble(mechanism).start);
  };
  EXPECT_FALSE(found(given).children_reordered);
  EXPECT_EQ(found(given).after.open, 3);
  const Recut other = found(written);
  EXPECT_TRUE(other.children_reordered);
  EXPECT_GT(other.before.open, 4);
  EXPECT_EQ(other.after.open, 3);
  EXPECT_EQ(other.after.sweeps, found(given).after.sweeps);
}

}  // namespace
}  // namespace momenta::dae_child_order
