// Which loop equations depend on which, by name, here and elsewhere; and which multipliers are
// unique.

#include "equations/ensemble.h"
#include "equations/examples.h"
#include "equations/linkages.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/dae/run/measure/rank.h>
#include <momenta/dae/run/measure/reactions.h>
#include <momenta/dae/topology/assembly/assembly.h>

namespace momenta::dae_rank {
namespace {

using namespace equations;
using equations::example;

RankReport report_of(const Mechanism& mechanism) {
  return rank_report(mechanism, equations::start_of(mechanism));
}
const Eigen::Quaterniond tilt(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));

/// What a dependency claims: its row is a combination of those it names, and the forces in `idle`
/// move nothing.
void expect_true(const Mechanism& mechanism, const RankReport& r) {
  const Start start = equations::start_of(mechanism);
  const auto e = mechanism.evaluation<double>();
  e->place(start.t, start.q.data());
  std::vector<double> values(mechanism.kkt_pattern().constraint.size());
  e->constraint_entries(values.data());
  Eigen::MatrixXd j = Eigen::MatrixXd::Zero(mechanism.m(), mechanism.nv());
  for (std::size_t i = 0; i < values.size(); ++i)
    j(mechanism.kkt_pattern().constraint[i].row, mechanism.kkt_pattern().constraint[i].column) =
        values[i];
  const double size = j.cwiseAbs().maxCoeff();
  for (const Dependency& d : r.dependencies) {
    Eigen::VectorXd left = j.row(d.row).transpose();
    if (!d.on.empty()) {
      Eigen::MatrixXd others(mechanism.nv(), static_cast<Eigen::Index>(d.on.size()));
      for (std::size_t k = 0; k < d.on.size(); ++k)
        others.col(static_cast<Eigen::Index>(k)) = j.row(d.on[k]).transpose();
      left -= others * others.completeOrthogonalDecomposition().solve(left);
    }
    EXPECT_LT(left.norm(), 1e-9 * size) << in_words(mechanism, d);
  }
  for (Eigen::Index k = 0; k < r.idle.cols(); ++k)
    EXPECT_LT((j.transpose() * r.idle.col(k)).norm(), 1e-9 * size * r.idle.col(k).norm());
  EXPECT_EQ(static_cast<int>(r.dependencies.size()), mechanism.m() - r.rank);
  EXPECT_EQ(r.idle.cols(), mechanism.m() - r.rank);
}

TEST(Rank, IndependentLoopsHaveNothingToTell) {
  const Mechanism mechanism(example("four_bar/scene.toml"));
  const RankReport r = report_of(mechanism);
  EXPECT_EQ(r.rank, 2);
  EXPECT_EQ(r.rank_nearby, 2);
  EXPECT_EQ(r.poses, 8);
  EXPECT_GT(r.kept, 0.1);
  EXPECT_TRUE(r.dependencies.empty());
  EXPECT_TRUE(r.simpler.empty());
  EXPECT_TRUE(r.unique(0));
}

TEST(Rank, HingesOfAPlanarLoopInSpaceAreThreeTooMany) {
  for (const Scene& scene :
       {example("four_bar/scene.toml"), turned(example("four_bar/scene.toml"), tilt)}) {
    const Mechanism mechanism(scene, {.algebra = Algebra::spatial});
    const RankReport r = report_of(mechanism);
    EXPECT_EQ(r.rank, 2);
    EXPECT_EQ(r.rank_nearby, 2);
    EXPECT_LT(r.dropped, 1e-12);
    EXPECT_FALSE(r.singular_here());
    expect_true(mechanism, r);
    for (const Dependency& d : r.dependencies) EXPECT_FALSE(d.only_here);
    ASSERT_EQ(r.simpler.size(), 1u);
    EXPECT_EQ(r.simpler[0].kind, "point");
    EXPECT_EQ(r.simpler[0].fewer, 2);
    // The advice is true: with it the mechanism moves alike and has two equations less to spare.
    Scene better = scene;
    better.loops[0].kind = LoopKind::point;
    const Mechanism advised(better, {.algebra = Algebra::spatial});
    const RankReport after = report_of(advised);
    EXPECT_EQ(after.rank, 2);
    EXPECT_EQ(advised.m(), 3);
  }
}

TEST(Rank, BricardHasOneEquationTooManyWhereverItGoes) {
  for (const Scene& scene : {bricard(), turned(bricard(), tilt)}) {
    const Mechanism mechanism(scene);
    const RankReport r = report_of(mechanism);
    EXPECT_EQ(r.rank, 4);
    EXPECT_EQ(r.rank_nearby, 4);
    EXPECT_GT(r.poses, 0);
    ASSERT_EQ(r.dependencies.size(), 1u);
    EXPECT_FALSE(r.dependencies[0].only_here);
    EXPECT_NE(in_words(mechanism, r.dependencies[0]).find("loop 'P6' row"), std::string::npos);
    expect_true(mechanism, r);
    // A loop ties as much with a row less, whichever its axes are.
    ASSERT_EQ(r.simpler.size(), 1u);
    EXPECT_EQ(r.simpler[0].loop, "P6");
    EXPECT_EQ(r.simpler[0].kind, "cylindrical");
    EXPECT_EQ(r.simpler[0].fewer, 1);
  }
}

TEST(Rank, SingularPosesAreToldFromRedundancy) {
  for (const int n : {1, 2, 3})
    for (const bool is_turned : {false, true}) {
      Scene scene = row_of_four_bars(n, 0, 1);
      if (is_turned) scene = turned(scene, tilt);
      const Mechanism mechanism(scene);
      const RankReport r = report_of(mechanism);
      EXPECT_EQ(r.rank, n);
      EXPECT_EQ(r.rank_nearby, 2 * n);
      EXPECT_TRUE(r.singular_here());
      EXPECT_TRUE(r.simpler.empty());
      expect_true(mechanism, r);
      for (const Dependency& d : r.dependencies) EXPECT_TRUE(d.only_here);
    }
}

TEST(Rank, ThreeCranksShareALoadThatIsNotDetermined) {
  const Mechanism mechanism(example("extremes/three_cranks.toml"));
  const RankReport r = report_of(mechanism);
  EXPECT_EQ(mechanism.m(), 4);
  EXPECT_EQ(r.rank, 3);
  ASSERT_EQ(r.dependencies.size(), 1u);
  EXPECT_EQ(mechanism.rows()[static_cast<std::size_t>(r.dependencies[0].row)].loop, "C");
  EXPECT_FALSE(r.dependencies[0].only_here);
  expect_true(mechanism, r);
  // Along the cranks the two loops' forces trade; no row of either is free of it here.
  int unique = 0;
  for (int row = 0; row < 4; ++row) unique += r.unique(row);
  EXPECT_LT(unique, 4);
}

TEST(Rank, ALoopWrittenTwiceCanBeLeftOut) {
  Scene scene = example("four_bar/scene.toml");
  scene.loops.push_back(scene.loops[0]);
  scene.loops.back().name = "again";
  const Mechanism mechanism(scene);
  const RankReport r = report_of(mechanism);
  EXPECT_EQ(r.rank, 2);
  ASSERT_EQ(r.dependencies.size(), 2u);
  EXPECT_EQ(in_words(mechanism, r.dependencies[0]),
            "loop 'again' row 1, point along axis 1, follows from loop 'B' row 1");
  EXPECT_EQ(in_words(mechanism, r.dependencies[1]),
            "loop 'again' row 2, point along axis 2, follows from loop 'B' row 2");
  ASSERT_EQ(r.simpler.size(), 1u);
  EXPECT_EQ(r.simpler[0].loop, "again");
  EXPECT_EQ(r.simpler[0].kind, "");
  for (int row = 0; row < 4; ++row) EXPECT_FALSE(r.unique(row));
}

TEST(Rank, UnitsAndSizesDoNotMatter) {
  for (const double length : {1e-6, 1e-3, 1e3, 1e6}) {
    const Scene scene = in_units(bricard(), {.length = length, .time = 1, .mass = 1e3});
    const Mechanism mechanism(scene);
    Start start;
    start.q.setZero(mechanism.nq());
    start.u.setZero(mechanism.nv());
    const RankReport r = rank_report(mechanism, start);
    EXPECT_EQ(r.rank, 4) << length;
    EXPECT_EQ(r.rank_nearby, 4) << length;
  }
  // Nor do they decide which multipliers are unique.
  std::vector<bool> expected;
  for (const double length : {1.0, 1e-8, 1e8}) {
    const Mechanism mechanism(in_units(bricard(), {.length = length}));
    Start start;
    start.q.setZero(mechanism.nq());
    start.u.setZero(mechanism.nv());
    const RankReport r = rank_report(mechanism, start);
    std::vector<bool> unique;
    for (int row = 0; row < mechanism.m(); ++row) unique.push_back(r.unique(row));
    if (length == 1) expected = unique;
    EXPECT_EQ(unique, expected) << length;
  }
}

Reactions marked(const Mechanism& mechanism, const Start& s) {
  Reactions r = reactions(mechanism, s.t, s.q, s.u, s.udot, s.lambda);
  mark_undetermined(r, mechanism, s.t, s.q, idle_forces(mechanism, s.t, s.q));
  return r;
}

TEST(Rank, ReactionsThatRedundantLoopsShareAreMarked) {
  // Independent loops: everything is unique.
  const Mechanism plain(example("four_bar/scene.toml"));
  for (const auto& r : marked(plain, equations::start_of(plain)).joints)
    EXPECT_TRUE(r.unique) << r.name;

  // Three cranks: every crank carries a share that is not determined.
  const Mechanism shared(example("extremes/three_cranks.toml"));
  const Reactions three = marked(shared, equations::start_of(shared));
  for (const auto& r : three.joints) EXPECT_FALSE(r.unique) << r.name;
  for (const auto& r : three.loops) EXPECT_FALSE(r.unique) << r.name;

  // A pendulum beside them has nothing to do with it.
  Scene beside = example("extremes/three_cranks.toml");
  BodySpec bob = beside.bodies[0];
  bob.name = "bob";
  JointSpec revolute = beside.joints[0];
  revolute.name = "P9";
  revolute.child = "bob";
  revolute.origin_parent = {5, 0, 0};
  beside.bodies.push_back(bob);
  beside.joints.push_back(revolute);
  const Mechanism both(beside);
  for (const auto& r : marked(both, equations::start_of(both)).joints)
    EXPECT_EQ(r.unique, r.name == "P9") << r.name;

  // What is unique does not depend on which of the answers is given; what is not, does.
  const Start start = equations::start_of(shared);
  const Eigen::MatrixXd idle = idle_forces(shared, start.t, start.q);
  const Reactions a = reactions(shared, start.t, start.q, start.u, start.udot, start.lambda),
                  b = reactions(shared, start.t, start.q, start.u, start.udot,
                                start.lambda + 3 * idle.col(0) / idle.col(0).norm());
  double changed = 0;
  for (std::size_t i = 0; i < a.joints.size(); ++i)
    changed = equations::larger(changed, (a.joints[i].force - b.joints[i].force).norm());
  EXPECT_GT(changed, 0.1);
}

}  // namespace
}  // namespace momenta::dae_rank
