// Ties that meet in one point, paired along the tree: the same σ, rates and motion as with the
// pairs of the scene.

#include "equations/linkages.h"
#include "equations/parts.h"
#include "equations/sweeps_against_matrix.h"

#include <gtest/gtest.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/kkt/sweeps/levels/loop_sweeps.h>
#include <momenta/dae/mechanism/loop/shared_points.h>

#include <algorithm>
#include <numeric>

namespace momenta::dae_shared_points {
namespace {

using namespace equations;

SharedPoints shared_points(const Mechanism& mechanism) {
  const auto model =
      build_planar_model(mechanism.tree(), mechanism.scene(), mechanism.plan().basis);
  std::vector<int> parents;
  for (const auto& b : model.bodies) parents.push_back(b.parent);
  LoopModel<Planar> anew;
  return SharedPoints(parents, build_loops(mechanism.scene(), mechanism.tree(), model), anew);
}

/// A planar tree of rods, and up to five of them, now and then the ground too, tied in one point of
/// each: a star, a path or any other tree of pairs, either side first. Nothing says that the points
/// are in one place.
Scene tied_rods(RandomTree& random, unsigned bodies, unsigned tied, double grounded_part = 0.6) {
  Scene s;
  s.name = "tied rods";
  s.gravity = {0, -9.81, 0};
  const auto name = [](unsigned i) { return "rod" + std::to_string(i); };
  for (unsigned i = 0; i < bodies; ++i) {
    s.bodies.push_back(rod(name(i)));
    const bool grounded = i == 0 || random.chance(grounded_part);
    s.joints.push_back(
        hinge("O" + std::to_string(i),
              grounded ? "ground" : name(static_cast<unsigned>(random.below(static_cast<int>(i)))),
              name(i), {random.uniform(0.2, 1), random.uniform(-1, 1), 0}, random.uniform(-3, 3)));
  }
  std::vector<std::string> sides;
  for (unsigned i = 0; i < bodies; ++i) sides.push_back(name(i));
  if (random.chance(0.3)) sides.push_back("ground");
  for (std::size_t i = sides.size(); i-- > 1;)
    std::swap(sides[i], sides[static_cast<std::size_t>(random.below(static_cast<int>(i + 1)))]);
  sides.resize(tied + 1);
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < sides.size(); ++i)
    points.emplace_back(random.uniform(-1, 1), random.uniform(-1, 1), 0);
  for (std::size_t i = 1; i < sides.size(); ++i) {
    const auto other = static_cast<std::size_t>(random.below(static_cast<int>(i)));
    LoopSpec l;
    l.name = "tie" + std::to_string(i);
    l.kind = random.chance(0.5) ? LoopKind::point : LoopKind::revolute;
    l.axis = Eigen::Vector3d::UnitZ();
    const bool forward = sides[i] != "ground" && (sides[other] == "ground" || random.chance(0.5));
    const std::size_t child = forward ? i : other, parent = forward ? other : i;
    l.parent = sides[parent];
    l.child = sides[child];
    l.origin_parent = points[parent];
    l.origin_child = points[child];
    s.loops.push_back(l);
  }
  return s;
}

TEST(SharedPoints, PairedAnewTheSolutionIsTheSame) {
  Worst worst;
  for (unsigned seed = 0; seed < 6000; ++seed) {
    RandomTree random(seed);
    const Scene scene = tied_rods(random, 7 + seed % 4, 2 + seed % 3, 0.8);
    compare(scene, random, {.algebra = Algebra::planar}, worst);
  }
  EXPECT_GT(worst.tried, 400);
  EXPECT_GT(worst.anew, 200);
  expect_rounding(worst, 10);
}

/// To the other pairs and back nothing is lost, and one step on its own changes something.
TEST(SharedPoints, BasesAreInverse) {
  int changed = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    RandomTree random(seed);
    const Mechanism mechanism(tied_rods(random, 8, 2 + seed % 5));
    SharedPoints shared = shared_points(mechanism);
    if (shared.empty()) continue;
    const auto m = static_cast<std::size_t>(mechanism.m());
    std::vector<double> given(m);
    for (double& x : given) x = random.uniform(-1, 1);
    const double* paired = shared.to_paired(given.data());
    std::vector<double> back(paired, paired + m);
    changed += back != given;
    shared.to_given(back.data(), 1);
    for (std::size_t i = 0; i < m; ++i) EXPECT_NEAR(back[i], given[i], 1e-14);
  }
  EXPECT_GT(changed, 30);
}

/// The same motion whichever rods of a shared point the scene pairs, and no slots beyond a path's.
TEST(SharedPoints, AStarTakesTheSlotsOfAPath) {
  Scene star;
  star.name = "star";
  for (int i = 0; i < 6; ++i) {
    const std::string name = "rod" + std::to_string(i);
    star.bodies.push_back(rod(name));
    star.joints.push_back(
        hinge("O" + std::to_string(i), "ground", name, {0.1 * i, 0.02 * i * i, 0}, 0.2 * i));
    if (i == 0) continue;
    LoopSpec l = equations::make_loop(LoopKind::revolute, "tie" + std::to_string(i), "rod0", name,
                                      Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitX());
    l.axis = Eigen::Vector3d::UnitZ();
    star.loops.push_back(l);
  }
  const Mechanism mechanism(star);
  EXPECT_TRUE(mechanism.solver().pairs_anew());
  EXPECT_EQ(mechanism.solver().sweeps()->slots(), 4);
  EXPECT_EQ(mechanism.solver().sweeps_as_given()->slots(), 16);
  const auto lines = plan_lines(mechanism);
  EXPECT_NE(lines.back().second.find("paired along the tree"), std::string::npos);
}

/// Points that are not the same, or are shared round a ring, stay as they are.
TEST(SharedPoints, OnlyTreesOfOnePoint) {
  RandomTree random(3);
  Scene scene = tied_rods(random, 8, 3, 1);
  const auto pairs_of = [](const Scene& s) { return !shared_points(Mechanism(s)).empty(); };
  EXPECT_TRUE(pairs_of(scene));
  Scene ring = scene;
  LoopSpec closing = scene.loops.front();
  closing.name = "again";
  ring.loops.push_back(closing);
  EXPECT_FALSE(pairs_of(ring));
  Scene apart = scene;
  for (std::size_t i = 0; i < apart.loops.size(); ++i) {
    apart.loops[i].origin_child.x() += 1e-3 * static_cast<double>(i + 1);
    apart.loops[i].origin_parent.x() += 1e-3 * static_cast<double>(i + 1);
  }
  EXPECT_FALSE(pairs_of(apart));
  // One point of a body, held at two of the ground.
  Scene torn;
  torn.name = "torn";
  torn.bodies = {rod("rod")};
  torn.joints = {hinge("O", "ground", "rod", Eigen::Vector3d::Zero(), 0)};
  for (const Eigen::Vector3d& at : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0)}) {
    closing.name = "tie" + std::to_string(torn.loops.size());
    closing.parent = "ground";
    closing.child = "rod";
    closing.origin_parent = at;
    closing.origin_child = Eigen::Vector3d::UnitX();
    torn.loops.push_back(closing);
  }
  EXPECT_FALSE(pairs_of(torn));
}

}  // namespace
}  // namespace momenta::dae_shared_points
