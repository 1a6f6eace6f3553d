// Poses followed along their curve against trigonometry, against assembly pose by pose, and against
// each other.

#include "equations/examples.h"
#include "equations/parts.h"
#include "equations/refusal.h"
#include "equations/swept_four_bar.h"

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/dae/analysis/kinematics/move.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <random>

namespace momenta::dae_kinematics {
namespace {

using Eigen::VectorXd;
using equations::FourBar, equations::moved, equations::example;
using std::numbers::pi;

/// Rows stand in the order in which the curve passes them: between dead points one way.
void expect_in_order(const MoveResult& r) {
  double way = 0;
  for (std::size_t i = 1; i < r.poses.size(); ++i) {
    const double ahead = r.poses[i].s - r.poses[i - 1].s;
    EXPECT_GE(ahead * way, 0) << r.scene << ", row " << i;
    way = r.poses[i].kind == MovedPose::Kind::dead_point ? 0 : ahead != 0 ? ahead : way;
  }
}

// Four-bars of any lengths that can be put together, swept by the crank and by the rocker: every
// pose is the one of trigonometry, on the side that the branch tells, which changes at dead points
// alone; the crank turns where the links are stretched or folded.
TEST(Kinematics, FourBarsByTrigonometry) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(0.3, 2);
  int dead = 0, round = 0;
  for (int k = 0; k < 60;) {
    const FourBar bars{any(random), any(random), any(random), any(random)};
    const double theta = any(random);
    // Near a change point the two sides are one pose to rounding.
    const double longest = std::max({bars.crank, bars.coupler, bars.rocker, bars.ground}),
                 shortest = std::min({bars.crank, bars.coupler, bars.rocker, bars.ground}),
                 all = bars.crank + bars.coupler + bars.rocker + bars.ground;
    if (!bars.reaches(theta) || std::abs(2 * (longest + shortest) - all) < 0.02) continue;
    const int side = k++ % 2 == 0 ? 1 : -1;
    const MoveResult r = moved(bars.scene(theta, side), "O");
    ASSERT_EQ(r.end, MoveResult::End::closed) << r.why;
    EXPECT_EQ(r.change_points(), 0);
    expect_in_order(r);
    dead += r.dead_points();
    round += r.dead_points() == 0;
    const int branch = r.poses.front().branch;
    ASSERT_NE(branch, 0);
    for (const MovedPose& pose : r.poses) {
      if (pose.kind == MovedPose::Kind::dead_point) {
        EXPECT_TRUE(bars.is_dead_point(pose.q[0])) << pose.q[0];
        continue;
      }
      const int there = pose.branch == branch ? side : -side;
      const auto rocked = [&](double at) { return bars.rocker_angle(at, there); };
      const double h = 1e-5, before = rocked(pose.q[0] - h), after = rocked(pose.q[0] + h);
      EXPECT_LT(std::abs(std::remainder(pose.q[2] - rocked(pose.q[0]), 2 * pi)), 1e-6);
      if (!(std::abs(pose.u[2]) < 20) || std::isnan(before) || std::isnan(after)) continue;
      const double middle = rocked(pose.q[0]);
      const double ratio = std::remainder(after - before, 2 * pi) / (2 * h);
      const double rate =
          (std::remainder(after - middle, 2 * pi) - std::remainder(middle - before, 2 * pi)) /
          (h * h);
      EXPECT_NEAR(pose.u[2], ratio, 1e-5 * std::pow(1 + std::abs(ratio), 5));
      EXPECT_NEAR(pose.udot[2], rate, 1e-4 * std::pow(1 + std::abs(ratio), 5));
    }
  }
  EXPECT_GT(dead, 20);
  EXPECT_GT(round, 5);
}

// Many four-bars, however near a change point: a curve ends where it began or in a sentence, and no
// pose is on the other side than its branch tells. MOMENTA_SWEEPS: how many, 100 without.
TEST(Kinematics, NoSweepFlipsUnnoticed) {
  const char* given = std::getenv("MOMENTA_SWEEPS");
  const int sweeps = given ? std::atoi(given) : 100;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(0.3, 2);
  int closed = 0, told = 0;
  long poses = 0;
  for (int k = 0; k < sweeps;) {
    const FourBar bars{any(random), any(random), any(random), any(random)};
    const double theta = any(random);
    if (!bars.reaches(theta)) continue;
    const int side = k++ % 2 == 0 ? 1 : -1;
    MoveRequest request;
    request.by = 0.2;
    const MoveResult r = moved(bars.scene(theta, side), "O", request);
    closed += r.end == MoveResult::End::closed;
    told += r.end != MoveResult::End::closed && !r.why.empty();
    poses += static_cast<long>(r.poses.size());
    const int branch = r.poses.front().branch;
    for (const MovedPose& pose : r.poses) {
      if (pose.kind != MovedPose::Kind::sample || pose.branch == 0) continue;
      const int there = pose.branch == branch ? side : -side;
      const auto off = [&](int on) {
        return std::abs(std::remainder(pose.q[2] - bars.rocker_angle(pose.q[0], on), 2 * pi));
      };
      // Where the two sides are one to rounding, neither can be told.
      if (off(1) + off(-1) > 1e-5) {
        EXPECT_LT(off(there), off(-there)) << k;
      }
    }
  }
  EXPECT_EQ(closed + told, sweeps);
  EXPECT_GE(closed, sweeps - sweeps / 100);
  std::printf("%d sweeps, %d closed, %d told, %ld poses\n", sweeps, closed, told, poses);
}

// Wherever it starts, whatever is swept and however finely, the curve is the same.
TEST(Kinematics, TheCurveDoesNotDependOnItsStart) {
  const Scene scene = example("four_bar");
  const MoveResult by_crank = moved(scene, "O");
  MoveRequest coarse;
  coarse.by = 0.37;
  Scene elsewhere = scene;
  const VectorXd& q = by_crank.poses[123].q;
  for (std::size_t i = 0; i < 3; ++i)
    elsewhere.joints[i].position = {q[static_cast<Eigen::Index>(i)]};
  for (const MoveResult& other :
       {moved(scene, "C"), moved(elsewhere, "O"), moved(elsewhere, "A.q", coarse)}) {
    EXPECT_EQ(other.end, MoveResult::End::closed) << other.why;
    EXPECT_NEAR(other.reach[2].least, by_crank.reach[2].least, 1e-9);
    EXPECT_NEAR(other.reach[2].most, by_crank.reach[2].most, 1e-9);
  }
  EXPECT_EQ(moved(scene, "C").dead_points(), 2);
}

// Each pose is the one that assembly finds from its neighbour with the swept joint held, and u̇ is
// how u changes.
TEST(Kinematics, PosesAreAssembledOnes) {
  for (const std::string name : {"andrews", "spatial_slider_crank", "bricard"}) {
    Scene scene = example(name);
    MoveRequest request;
    request.by = 1e-3;
    const std::string first = scene.joints.front().name;
    const Mechanism mechanism(scene);
    const Assembly a = assemble(mechanism, Assembled::rates);
    request.sweep = {{first, 1}};
    const int at = mechanism.tree().bodies.front().q;
    request.to = a.start.q[at] + 0.05;
    const MoveResult r = move(mechanism, 0, a.start.q, request);
    ASSERT_EQ(r.end, MoveResult::End::reached) << name << r.why;
    ASSERT_EQ(r.poses.size(), 51u);
    EXPECT_NEAR(r.poses.back().q[at], *request.to, 1e-13);
    scene.held = {first};
    const Mechanism holding(scene);
    for (std::size_t k = 1; k + 1 < r.poses.size(); k += 7) {
      VectorXd guess = r.poses[k - 1].q;
      guess[at] = r.poses[k].q[at];
      const Assembly there =
          assemble(holding, 0, guess, VectorXd::Zero(mechanism.nv()), Assembled::rates);
      EXPECT_LT((there.start.q - r.poses[k].q).cwiseAbs().maxCoeff(), 1e-9) << name;
      const double h = request.by;
      const VectorXd rate = (r.poses[k + 1].u - r.poses[k - 1].u) / (2 * h);
      EXPECT_LT((rate - r.poses[k].udot).cwiseAbs().maxCoeff(),
                100 * h * h * (1 + r.poses[k].udot.cwiseAbs().maxCoeff()))
          << name;
    }
  }
}

// A row of parallelograms is flat at 0 and π, where every one of them may become crossed: passed
// straight on.
TEST(Kinematics, ChangePointsArePassedStraightOn) {
  for (const int n : {1, 2, 5}) {
    const MoveResult r = moved(equations::row_of_four_bars(n, 1), "O0");
    ASSERT_EQ(r.end, MoveResult::End::closed) << r.why;
    EXPECT_EQ(r.dead_points(), 0);
    ASSERT_EQ(r.change_points(), 2) << n;
    expect_in_order(r);
    for (const MovedPose& pose : r.poses) {
      if (pose.kind == MovedPose::Kind::change_point)
        EXPECT_NEAR(std::remainder(pose.q[0], pi), 0, 1e-6);
      else
        EXPECT_NEAR(std::abs(pose.u[1]), 1, 1e-6);
    }
  }
}

// A neutral linkage, whose shortest and longest links together are as long as the other two: flat
// at θ = π, where it may fold over. The curve crosses there from one side to the other and comes
// back by a second turn, at whatever steps.
TEST(Kinematics, NeutralLinkagesCrossWhereTheyAreFlat) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(0.5, 1.5);
  for (int k = 0; k < 8; ++k) {
    const double crank = 0.3 + 0.02 * k, coupler = any(random), rocker = any(random);
    const FourBar bars{crank, coupler, rocker, coupler + rocker - crank};
    const int side = k % 2 == 0 ? 1 : -1;
    MoveRequest request;
    request.by = std::array{0.0, 0.3, 0.01, 1.0}[static_cast<std::size_t>(k % 4)];
    const MoveResult r = moved(bars.scene(1, side), "O", request);
    ASSERT_EQ(r.end, MoveResult::End::closed) << k << r.why;
    EXPECT_EQ(r.dead_points(), 0);
    ASSERT_EQ(r.change_points(), 2) << k;
    EXPECT_NEAR(r.poses.back().s, 4 * pi, 1e-6);
    expect_in_order(r);
    const int branch = r.poses.front().branch;
    for (const MovedPose& pose : r.poses) {
      if (pose.kind == MovedPose::Kind::change_point) {
        EXPECT_NEAR(std::remainder(pose.q[0] - pi, 2 * pi), 0, 1e-9);
        continue;
      }
      const int there = pose.branch == branch ? side : -side;
      EXPECT_EQ(pose.branch == branch, pose.s < pi - 1 || pose.s > 3 * pi - 1) << pose.s;
      const auto off = [&](int on) {
        return std::abs(std::remainder(pose.q[2] - bars.rocker_angle(pose.q[0], on), 2 * pi));
      };
      if (off(1) + off(-1) > 1e-5) {
        EXPECT_LT(off(there), off(-there)) << pose.s;
      }
    }
  }
}

// As little as 1e-5 beside a neutral one: the crank goes round on its side, or turns back where the
// law of cosines says.
TEST(Kinematics, BesideNeutralLinkagesTheCurveKeepsItsSide) {
  for (const double off : {-1e-5, -1e-7, 1e-4, 1e-6}) {
    const FourBar bars{0.4, 1, 0.8, 1.4 + off};
    const MoveResult r = moved(bars.scene(1, 1), "O");
    ASSERT_EQ(r.end, MoveResult::End::closed) << off << r.why;
    EXPECT_EQ(r.change_points(), 0);
    EXPECT_EQ(r.dead_points(), off < 0 ? 0 : 2) << off;
    if (off < 0) {
      EXPECT_NEAR(r.poses.back().s, 2 * pi, 1e-9);
      continue;
    }
    const double d = bars.ground, turns = std::acos((0.16 + d * d - 3.24) / (0.8 * d));
    EXPECT_NEAR(r.reach[0].most, turns, 1e-8);
    EXPECT_NEAR(r.reach[0].least, -turns, 1e-8);
  }
}

/// Crank, rod and a slide along x through O; in line at the start.
Scene in_line(double crank, double rod) {
  Scene s;
  s.name = "slider-crank";
  s.bodies = {equations::rod("crank"), equations::rod("rod"), equations::rod("piston")};
  s.joints = {equations::hinge("O", "ground", "crank", {0, 0, 0}, 0),
              equations::hinge("A", "crank", "rod", {crank, 0, 0}, 0),
              equations::hinge("P", "ground", "piston", {0, 0, 0}, crank + rod)};
  s.joints[2].kind = JointKind::prismatic;
  s.joints[2].axis = {1, 0, 0};
  s.loops.push_back(equations::make_loop(LoopKind::revolute, "B", "rod", "piston", {rod, 0, 0}));
  return s;
}

// Swept from a dead point, the slide comes back to it by the other one. Where the rod is as long as
// the crank it passes O, where the crank may turn alone.
TEST(Kinematics, ACurveMayStartAtADeadPoint) {
  for (const double by : {0.0, 0.3}) {
    MoveRequest request;
    request.by = by;
    const MoveResult r = moved(in_line(0.3, 0.8), "P", request);
    ASSERT_EQ(r.end, MoveResult::End::closed) << r.why;
    EXPECT_EQ(r.dead_points(), 2);
    EXPECT_NEAR(r.reach[2].least, 0.5, 1e-12);
    EXPECT_NEAR(r.reach[2].most, 1.1, 1e-12);
    const MoveResult equal = moved(in_line(0.8, 0.8), "P", request);
    ASSERT_EQ(equal.end, MoveResult::End::closed) << equal.why;
    EXPECT_EQ(equal.dead_points(), 2);
    EXPECT_EQ(equal.change_points(), 2);
    EXPECT_NEAR(equal.reach[2].least, -1.6, 1e-12);
  }
}

// The curve of a parallelogram is a straight line in its angles: steps along it end on rows, which
// are rows all the same.
TEST(Kinematics, StepsThatEndOnARowLoseNone) {
  const Scene scene = FourBar{1, 2, 1, 2}.scene(1, -1);
  for (const double by : {0.3, 0.1, 0.07, 0.05, 0.02}) {
    MoveRequest request;
    request.by = by;
    const MoveResult round = moved(scene, "O", request);
    ASSERT_EQ(round.end, MoveResult::End::closed) << by << round.why;
    EXPECT_EQ(round.change_points(), 2);
    request.to = 3;
    for (const MoveResult& r : {round, moved(scene, "O", request)}) {
      int k = 0;
      for (const MovedPose& pose : r.poses)
        if (pose.kind == MovedPose::Kind::sample && std::abs(pose.s - k * by) < 1e-12) {
          EXPECT_NEAR(pose.q[2], 1 + k * by, 1e-11);
          ++k;
        }
      EXPECT_EQ(k, static_cast<int>(r.poses.back().s / by + 1e-9) + 1) << by;
    }
  }
}

// Steps smaller than what is told apart from the start are not back there.
TEST(Kinematics, TheStartIsLeftBeforeItIsComeBackTo) {
  for (const double by : {1e-6, 1e-7, 3e-8, 1e-8, 1e-9}) {
    MoveRequest request;
    request.by = by;
    request.most_rows = 20;
    const MoveResult r = moved(example("four_bar"), "O", request);
    EXPECT_EQ(r.end, MoveResult::End::stopped) << by;
    EXPECT_EQ(r.poses.size(), 20U) << by;
  }
}

TEST(Kinematics, WhatIsNotReachedIsSaid) {
  MoveRequest request;
  request.to = 1.2;
  const MoveResult r = moved(in_line(0.3, 0.8), "P", request);
  EXPECT_EQ(r.end, MoveResult::End::stopped);
  EXPECT_NE(r.why.find("does not come to 1.2"), std::string::npos) << r.why;
}

// Peaucellier's straight-line linkage ends where its two arms lie on each other, at |OC| = 1 − 0.4:
// two ranks are lost at once there, and the crank turns back.
TEST(Kinematics, SingularEndsAreFoundAtEveryStep) {
  const double arm = 1, side = 0.4, crank = 0.35, theta = 0.5;
  const double C = 2 * crank * std::cos(theta / 2), half = theta / 2,
               opens = std::acos((C * C + arm * arm - side * side) / (2 * C * arm));
  Scene s;
  s.name = "Peaucellier";
  for (const char* name : {"crank", "oa", "ob", "ac", "ad", "bc", "bd"})
    s.bodies.push_back(equations::rod(name));
  const auto point = [](double length, double angle) {
    return Eigen::Vector2d(length * std::cos(angle), length * std::sin(angle));
  };
  const auto angle = [](const Eigen::Vector2d& x) { return std::atan2(x.y(), x.x()); };
  const Eigen::Vector2d A = point(arm, half + opens), B = point(arm, half - opens),
                        c = point(C, half), D = A + B - c;
  s.joints = {equations::hinge("O", "ground", "crank", {crank, 0, 0}, theta),
              equations::hinge("oa", "ground", "oa", {0, 0, 0}, half + opens),
              equations::hinge("ob", "ground", "ob", {0, 0, 0}, half - opens),
              equations::hinge("ac", "oa", "ac", {arm, 0, 0}, angle(c - A) - half - opens),
              equations::hinge("ad", "oa", "ad", {arm, 0, 0}, angle(D - A) - half - opens),
              equations::hinge("bc", "ob", "bc", {arm, 0, 0}, angle(c - B) - half + opens),
              equations::hinge("bd", "ob", "bd", {arm, 0, 0}, angle(D - B) - half + opens)};
  const auto pin = [&](const char* name, const char* parent, const char* child, double at,
                       double there) {
    s.loops.push_back(
        equations::make_loop(LoopKind::revolute, name, parent, child, {at, 0, 0}, {there, 0, 0}));
  };
  pin("C", "crank", "ac", crank, side);
  pin("C2", "crank", "bc", crank, side);
  pin("D", "ad", "bd", side, side);
  for (const double by : {0.0, 0.01, 0.3}) {
    MoveRequest request;
    request.by = by;
    const MoveResult r = moved(s, "O", request);
    ASSERT_EQ(r.end, MoveResult::End::closed) << by << r.why;
    EXPECT_GE(r.change_points(), 2) << by;
    const double end = 2 * std::acos((arm - side) / (2 * crank));
    EXPECT_NEAR(r.reach[0].most, end, 1e-9);
    EXPECT_NEAR(r.reach[0].least, -end, 1e-9);
  }
}

// A coupler between two balls spins as it likes: that is held. The crank goes round once, and the
// rocker swings between the angles at which its ball is as far from the crank's circle as the
// coupler is long.
TEST(Kinematics, IdleSpinsOfCouplersAreHeld) {
  const std::string text = R"(
[[body]]
name = "crank"
mass = 1
shape = { kind = "rod", length = 0.2 }
[[body]]
name = "rod"
mass = 1
shape = { kind = "rod", length = 0.9 }
[[body]]
name = "rocker"
mass = 1
shape = { kind = "rod", length = 0.5 }
[[joint]]
name = "O"
kind = "revolute"
child = "crank"
[[joint]]
name = "S1"
kind = "spherical"
parent = "crank"
child = "rod"
origin = { parent = [0.2, 0, 0] }
[[joint]]
name = "C"
kind = "revolute"
child = "rocker"
origin = { parent = [0.7, 0.3, 0.1] }
axis = "y"
position = -1
[[loop]]
name = "S2"
kind = "spherical"
parent = "rod"
child = "rocker"
origin = { parent = [0.9, 0, 0], child = [0.5, 0, 0] }
[assembly]
hold = ["O"]
)";
  const Scene scene = parse_scene(text, "RSSR");
  MoveRequest request;
  for (const std::string hold : {"", "S1.wx"}) {
    request.hold.clear();
    if (!hold.empty()) request.hold = {hold};
    const MoveResult r = moved(scene, "O", request);
    ASSERT_EQ(r.end, MoveResult::End::closed) << r.why;
    EXPECT_EQ(r.idle, hold.empty() ? std::vector<std::string>{"S1"} : std::vector<std::string>());
    const auto rocker = static_cast<Eigen::Index>(r.poses.front().q.size() - 1);
    for (const MovedPose& pose : r.poses) {
      const Eigen::Vector3d crank(0.2 * std::cos(pose.q[0]), 0.2 * std::sin(pose.q[0]), 0),
          ball(0.7 + 0.5 * std::cos(pose.q[rocker]), 0.3, 0.1 - 0.5 * std::sin(pose.q[rocker]));
      EXPECT_NEAR((crank - ball).norm(), 0.9, 1e-9);
    }
  }
}

// Two freedoms: one swept, one held, or both in proportion.
TEST(Kinematics, WhatIsLeftFreeIsHeldOrNamed) {
  Scene open = FourBar{1, 1.5, 1.2, 2}.scene(1, 1);
  open.loops.front().kind = LoopKind::distance;
  open.loops.front().length = 0.7;
  open.loops.front().origin_parent = {1, 0, 0};
  EXPECT_THROW(
      {
        try {
          moved(open, "O");
        } catch (const SceneError& e) {
          EXPECT_NE(std::string(e.what()).find("leaves 1 more degree of freedom"),
                    std::string::npos)
              << e.what();
          throw;
        }
      },
      SceneError);
  MoveRequest held;
  held.hold = {"A"};
  held.to = 1.1;
  const MoveResult r = moved(open, "O", held);
  ASSERT_EQ(r.end, MoveResult::End::reached) << r.why;
  EXPECT_EQ(r.poses.back().q[1], r.poses.front().q[1]);
  EXPECT_THROW(moved(open, "X"), SceneError);
  held.hold = {"A", "C"};
  EXPECT_THROW(moved(open, "O", held), SceneError);
  Scene driven = open;
  driven.loops.clear();
  for (const JointSpec& joint : driven.joints) {
    driven.drives.emplace_back();
    driven.drives.back().joint = joint.name;
    driven.drives.back().kind = "polynomial";
    driven.drives.back().coefficients = {1};
  }
  EXPECT_EQ(equations::thrown<SceneError>([&] { moved(driven, "O"); }),
            "coordinate 'O' is not known: all joints are welds, are driven or have quaternions; "
            "expected another joint");
}

// A four-bar with a driven crank carries a pendulum, which alone is free: the hinges of the loop
// stay.
TEST(Kinematics, WhatTheLoopsHoldIsNotSwept) {
  const Scene driven = example("driven");
  EXPECT_TRUE(equations::says(equations::thrown<SceneError>([&] { moved(driven, "A"); }),
                              "the loops hold it where it is"));
  const MoveResult r = moved(driven, "M");
  EXPECT_EQ(r.end, MoveResult::End::closed) << r.why;
}

}  // namespace
}  // namespace momenta::dae_kinematics
