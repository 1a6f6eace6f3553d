// A joint and a loop are interchangeable, and the room has no preferred direction: the same motion
// wherever the loops are cut, however the scene is turned, in the plane or in space.

#include "equations/ensemble.h"
#include "equations/examples.h"
#include "equations/linkages.h"
#include "equations/recut.h"
#include "equations/runs.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/dae/run/run_form.h>

namespace momenta::dae_cut_anywhere {
namespace {

using namespace equations;
using equations::example;

/// How far each hinge has turned since the start, by name, at the end of a run.
std::map<std::string, double> turns(const Scene& scene, Algebra algebra, double end) {
  const Mechanism mechanism(scene, {.algebra = algebra});
  const RunResult run =
      run_form(mechanism, equations::start_of(mechanism),
               equations::kept(equations::adaptive("momentum", "dop853", "leak", 1e-11, end, 1)));
  EXPECT_EQ(run.status, "done") << run.reason;
  std::map<std::string, double> by_name;
  for (std::size_t i = 0; i < run.trajectory.columns.size(); ++i)
    if (run.trajectory.columns[i].find(".q [") != std::string::npos)
      by_name[run.trajectory.columns[i]] =
          run.trajectory.rows.back()[i] - run.trajectory.rows.front()[i];
  return by_name;
}

void expect_same(const std::map<std::string, double>& found,
                 const std::map<std::string, double>& expected, const std::string& what) {
  int common = 0;
  for (const auto& [name, value] : found) {
    const auto at = expected.find(name);
    if (at == expected.end()) continue;
    ++common;
    EXPECT_NEAR(value, at->second, 2e-8 * (1 + std::abs(at->second))) << what << ": " << name;
  }
  EXPECT_GE(common, 2) << what;
}

TEST(SameMotion, FourBarCutAnywhere) {
  const Scene scene = example("four_bar");
  const Mechanism mechanism(scene);
  const auto expected = turns(scene, Algebra::automatic, 2);
  for (const auto& cut : {"O", "A", "C"}) {
    const Scene other = recut(scene, mechanism.tree(), assemble(mechanism).start.q, cut, "B");
    EXPECT_EQ(other.joints.size(), 3u);
    expect_same(turns(other, Algebra::automatic, 2), expected, cut);
    expect_same(turns(other, Algebra::spatial, 2), expected, std::string("in space ") + cut);
  }
}

TEST(SameMotion, SqueezerCutElsewhere) {
  const Scene scene = example("andrews");
  const Mechanism mechanism(scene);
  const auto expected = turns(scene, Algebra::automatic, 0.02);
  EXPECT_GT(std::abs(expected.at("O.q [rad]")), 5);
  for (const auto& [cut, closed] :
       {std::pair{"F", "E2"}, std::pair{"B", "E2"}, std::pair{"A5", "E4"}, std::pair{"H", "E6"}})
    expect_same(turns(recut(scene, mechanism.tree(), assemble(mechanism).start.q, cut, closed),
                      Algebra::automatic, 0.02),
                expected, cut);
}

TEST(SameMotion, TurnedRoomPlaneOrSpace) {
  for (const auto& [name, end] : {std::pair{"four_bar", 2.0}, std::pair{"andrews", 0.02}}) {
    const Scene scene = example(name);
    const auto expected = turns(scene, Algebra::automatic, end);
    for (const Eigen::Vector3d& axis :
         {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, 2, -1), Eigen::Vector3d(-1, 0.1, 3)}) {
      const Eigen::Quaterniond r(Eigen::AngleAxisd(1.3, axis.normalized()));
      const Scene other = turned(scene, r);
      EXPECT_TRUE(Mechanism(other).plan().planar);
      expect_same(turns(other, Algebra::automatic, end), expected, "turned in the plane");
      expect_same(turns(other, Algebra::spatial, end), expected, "turned in space");
    }
  }
}

TEST(SameMotion, TurnedBricard) {
  const auto expected = turns(bricard(), Algebra::spatial, 3);
  const Eigen::Quaterniond r(Eigen::AngleAxisd(0.9, Eigen::Vector3d(1, 2, -1).normalized()));
  expect_same(turns(turned(bricard(), r), Algebra::spatial, 3), expected, "turned");
}

}  // namespace
}  // namespace momenta::dae_cut_anywhere
