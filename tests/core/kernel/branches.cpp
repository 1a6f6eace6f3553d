// Branches of one shape side by side against the same trees body by body: which subtrees become
// branches, and that neither motion nor what is refused depends on it.
#include <gtest/gtest.h>
#include <momenta/core/kernel/branches/branches.h>
#include <momenta/core/kernel/levels/open_sweeps.h>
#include <momenta/core/open_chain/open_chain.h>

#include <algorithm>

#include "equations/parts.h"
#include "equations/random_tree.h"
#include "equations/tolerance.h"

namespace momenta::core_branches {
namespace {

using namespace equations;

/// A remaining tree of any joints, and on its bodies and the ground copies of random branches:
/// parents by number within the branch, constants each their own. Sizes and numbers of copies at
/// random, up to `copies` + 1, or all as said.
Scene with_branches(RandomTree& random, int remaining_tree, int shapes, int copies, bool forces,
                    int same_size = 0) {
  TreeRecipe recipe{
      .bodies = remaining_tree, .drives = true, .joint_forces = forces, .body_forces = forces};
  Scene s = random.scene(recipe);
  const TreeRecipe revolutes{.bodies = 6,
                             .placing = random.chance(0.5) ? Placing::general : Placing::degenerate,
                             .kinds = {JointKind::revolute},
                             .drives = false,
                             .joint_forces = forces,
                             .body_forces = false};
  for (int shape = 0; shape < shapes; ++shape) {
    std::vector<int> parents{-1};
    const int size = same_size > 0 ? same_size : 1 + random.below(6);
    for (int k = 1; k < size; ++k) parents.push_back(random.below(k));
    const int count = same_size > 0 ? copies : 2 + random.below(copies);
    for (int copy = 0; copy < count; ++copy) {
      const std::string name = "branch" + std::to_string(shape) + "_" + std::to_string(copy) + "_";
      const Scene from = random.scene(revolutes);
      const std::string on = random.chance(0.2) ? "ground" : s.bodies.front().name;
      for (int k = 0; k < size; ++k) {
        const auto i = static_cast<std::size_t>(k);
        BodySpec b = from.bodies[i];
        b.name = name + std::to_string(k);
        JointSpec j = from.joints[i];
        j.name = "to_" + b.name;
        j.child = b.name;
        j.parent = k == 0 ? on : name + std::to_string(parents[i]);
        s.bodies.push_back(b);
        s.joints.push_back(j);
      }
    }
  }
  return s;
}

/// How many bodies of the scene go side by side.
std::size_t expect_sound_branches(const Scene& scene, int lanes) {
  const Tree tree = build_tree(scene);
  const Model<Spatial> model = build_spatial_model(tree, scene);
  const LinkTree links = build_links(model);
  const auto branches = find_branches(links, lanes);
  if (!branches) return 0;
  std::vector<int> met(links.links.size(), 0);
  for (const int k : branches->bodies) ++met[static_cast<std::size_t>(k)];
  std::size_t side_by_side = 0;
  for (const BranchGroup& g : branches->groups) {
    EXPECT_GE(g.count, 2);
    EXPECT_LE(g.count, lanes);
    const auto link = [&](std::size_t place, int lane) {
      return g.links[place * static_cast<std::size_t>(g.lanes) + static_cast<std::size_t>(lane)];
    };
    for (std::size_t k = 0; k < g.places.size(); ++k)
      for (int lane = 0; lane < g.count; ++lane) {
        ++met[static_cast<std::size_t>(link(k, lane))];
        ++side_by_side;
        const Link& l = links.links[static_cast<std::size_t>(link(k, lane))];
        EXPECT_EQ(l.kind, LinkKind::revolute);
        EXPECT_EQ(l.leaf, g.places[k].leaf);
        if (k > 0) {
          EXPECT_EQ(l.parent, link(static_cast<std::size_t>(g.places[k].parent), lane));
        }
      }
  }
  // Every body once, in a branch or in the remaining tree; parents within the remaining tree come
  // first.
  EXPECT_TRUE(std::all_of(met.begin(), met.end(), [](int times) { return times == 1; }));
  for (std::size_t k = 0; k < branches->remaining_tree.links.size(); ++k)
    EXPECT_LT(branches->remaining_tree.links[k].parent, static_cast<int>(k));
  return side_by_side;
}

double growth_of(OpenChain& chain, const TreeState& s) {
  const Eigen::VectorXd singular = chain.mass_matrix(s.t, s.q).jacobiSvd().singularValues();
  return singular[0] / singular[singular.size() - 1];
}

void compare(const Scene& scene, RandomTree& random, int level) {
  OpenChain limbed(scene, Algebra::spatial, level), plain(scene, Algebra::spatial, level, false);
  // Twice: what the first evaluation leaves in slots must not show in the second.
  for (int time = 0; time < 2; ++time) {
    const TreeState s = random.state(plain.tree());
    Eigen::VectorXd p(plain.nv()), qdot(plain.nq()), pdot(plain.nv()), udot(plain.nv());
    plain.momenta(s.t, s.q, s.u, p);
    Eigen::VectorXd qdot2(qdot), pdot2(pdot), udot2(udot), solved(pdot), solved2(pdot);
    ASSERT_TRUE(plain.rates(s.t, s.q, p, qdot, pdot)) << plain.failure();
    ASSERT_TRUE(limbed.rates(s.t, s.q, p, qdot2, pdot2)) << limbed.failure();
    ASSERT_TRUE(plain.accelerations(s.t, s.q, s.u, udot));
    ASSERT_TRUE(limbed.accelerations(s.t, s.q, s.u, udot2));
    ASSERT_TRUE(plain.inverse_mass_times(s.t, s.q, p, solved));
    ASSERT_TRUE(limbed.inverse_mass_times(s.t, s.q, p, solved2));
    const double tolerance = algebra_tol(12) * growth_of(plain, s);
    EXPECT_LT(relative_error(qdot2, qdot), tolerance);
    EXPECT_LT(relative_error(pdot2, pdot), tolerance);
    EXPECT_LT(relative_error(udot2, udot), tolerance);
    EXPECT_EQ(solved2, solved);
    // At the place of the last evaluation, whichever it was.
    for (OpenChain* chain : {&plain, &limbed}) {
      ASSERT_TRUE(chain->inverse_mass_times(p, solved2));
      EXPECT_EQ(solved2, solved);
      const TreeState other = random.state(plain.tree());
      ASSERT_TRUE(chain->rates(other.t, other.q, p, qdot2, pdot2));
      ASSERT_TRUE(chain->accelerations(s.t, s.q, s.u, udot2));
      for (int again = 0; again < 2; ++again) {
        ASSERT_TRUE(chain->inverse_mass_times(s.u, solved2));
        EXPECT_LT(relative_error(plain.mass_matrix(other.t, other.q) * solved2, s.u),
                  algebra_tol(12) * growth_of(plain, other));
      }
    }
  }
}

TEST(Branches, MoveAsBodyByBody) {
  std::size_t bodies = 0;
  for (unsigned seed = 0; seed < 150; ++seed) {
    RandomTree random(seed);
    const Scene scene = with_branches(random, 1 + static_cast<int>(seed % 5),
                                      1 + static_cast<int>(seed % 3), 8, seed % 2 == 0);
    for (const int level : {1, 3, 4})
      if (level_at_most(level) == level) {
        bodies += expect_sound_branches(scene, branch_lanes_at(level));
        compare(scene, random, level);
      }
    if (HasFailure()) FAIL() << "seed " << seed;
  }
  EXPECT_GT(bodies, 150U * 4);
}

TEST(Branches, OnTheGroundLeaveNoRemainingTree) {
  RandomTree random(3);
  Scene scene = with_branches(random, 1, 1, 9, false, 4);
  scene.bodies.erase(scene.bodies.begin());
  scene.joints.erase(scene.joints.begin());
  scene.drives.clear();
  for (JointSpec& j : scene.joints)
    if (j.parent == "body0") j.parent = "ground";
  const std::size_t bodies = expect_sound_branches(scene, branch_lanes_at(best_level()));
  EXPECT_EQ(bodies, 8U * 4);  // the ninth branch stays with the remaining tree
  for (const bool gravity : {true, false}) {
    if (!gravity) scene.gravity.setZero();
    compare(scene, random, 0);
  }
}

/// One long branch twice, or many short ones of the same bodies: whatever saves more.
TEST(Branches, AreChosenByWhatTheySave) {
  const auto legs = [](int count, int length) {
    Scene s;
    const auto add = [&](const std::string& name, const std::string& parent) {
      s.bodies.push_back(equations::make_body(name, 1, {0.1, 0.1, 0.1}, {0.1, 0.2, 0.3}));
      s.joints.push_back(
          equations::make_joint(parent == "ground" ? JointKind::free : JointKind::revolute,
                                "to_" + name, parent, name, {0.3, 0.1, 0}, {0, 1, 0}));
    };
    add("base", "ground");
    for (int leg = 0; leg < count; ++leg)
      for (int k = 0; k < length; ++k) {
        const std::string name = "leg" + std::to_string(leg) + "_";
        add(name + std::to_string(k), k == 0 ? "base" : name + std::to_string(k - 1));
      }
    return s;
  };
  const auto words = [&](const Scene& s, int lanes) {
    const Tree tree = build_tree(s);
    const Model<Spatial> model = build_spatial_model(tree, s);
    return branches_in_words(build_links(model), lanes);
  };
  // Along a leg every length is a shape of its own, the whole leg the one that saves most.
  EXPECT_EQ(words(legs(4, 6), 4), "4 of 6 revolute joints side by side in 4 lanes");
  EXPECT_EQ(words(legs(6, 6), 4), "6 of 6 revolute joints side by side in 4 lanes");
  // Two short ones gain nothing, nor do leaves alone.
  EXPECT_EQ(words(legs(6, 3), 4), "4 of 3 revolute joints side by side in 4 lanes");
  EXPECT_EQ(words(legs(4, 1), 4), "");
  EXPECT_EQ(words(legs(5, 3), 4), "4 of 3 revolute joints side by side in 4 lanes");
  EXPECT_EQ(words(legs(1, 6), 4), "");
}

/// A branch's joint without inertia has the same name in either way of going.
TEST(Branches, RefuseAJointWithoutInertiaByName) {
  RandomTree random(5);
  Scene scene = with_branches(random, 2, 1, 8, false, 5);
  ASSERT_GT(expect_sound_branches(scene, branch_lanes_at(best_level())), 0U);
  const std::string leaf = scene.bodies.back().name;
  scene.bodies.back().mass = 0;
  scene.bodies.back().com.setZero();
  scene.bodies.back().inertia.setZero();
  scene.joints.back().rotor_inertia.clear();
  OpenChain limbed(scene, Algebra::spatial), plain(scene, Algebra::spatial, 0, false);
  const TreeState s = random.state(plain.tree());
  Eigen::VectorXd rates(plain.nq()), pdot(plain.nv());
  EXPECT_FALSE(limbed.rates(0, s.q, s.u, rates, pdot));
  EXPECT_FALSE(plain.rates(0, s.q, s.u, rates, pdot));
  EXPECT_NE(limbed.failure().find(leaf), std::string::npos) << limbed.failure();
  EXPECT_EQ(limbed.failure(), plain.failure());
}

}  // namespace
}  // namespace momenta::core_branches
