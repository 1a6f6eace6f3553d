// A consistent start from a guess: positions close, held joints stay, what cannot close is said.

#include "equations/linkages.h"
#include "equations/random_tree.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/scene/read_scene.h>
#include <momenta/dae/assembly.h>
#include <momenta/dae/assembly_side.h>

#include <filesystem>
#include <numbers>

namespace momenta {
namespace {

using namespace equations;
using Eigen::VectorXd;

Scene example(const std::string& name) {
  return read_scene(std::filesystem::path(MOMENTA_SOURCE_DIR) / "examples" / name / "scene.toml");
}

std::string complaint(const Scene& scene) {
  const Mechanism mechanism(scene);
  try {
    assemble(mechanism);
  } catch (const SceneError& e) {
    return e.what();
  }
  return "";
}

/// Φ, Φ̇, Φ̈ and (1a) at the start, all zero.
void expect_consistent(const Mechanism& mechanism, const Assembly& a) {
  const auto e = mechanism.evaluation<double>();
  const Start& s = a.start;
  VectorXd row(mechanism.m()), tau(mechanism.nv());
  e->place(s.t, s.q.data());
  e->positions(row.data());
  EXPECT_LT(row.cwiseAbs().maxCoeff(), 1e-14);
  e->move(s.u.data());
  e->velocities(row.data());
  const double speed = 1 + s.u.cwiseAbs().maxCoeff();
  EXPECT_LT(row.cwiseAbs().maxCoeff(), 1e-13 * speed);
  e->joint_forces(s.q.data(), s.u.data(), s.udot.data(), s.lambda.data(), tau.data());
  e->accelerations(row.data());
  const double strength = 1 + s.udot.cwiseAbs().maxCoeff();
  EXPECT_LT(row.cwiseAbs().maxCoeff(), 1e-11 * strength);
  EXPECT_LT(tau.cwiseAbs().maxCoeff(), 1e-11 * (1 + s.lambda.cwiseAbs().maxCoeff()));
}

TEST(Assembly, FourBarClosesFromBadGuesses) {
  // Angles of the reference solution at t = 0.
  const double crank = 1.5707963267948966, coupler = 0.51099074729704354,
               rocker = 1.7419501646378182;
  for (const double off : {0.0, 0.1, -0.3, 0.5}) {
    Scene scene = example("four_bar");
    scene.joints[1].position = {coupler - crank + off};
    scene.joints[2].position = {rocker + off};
    const Mechanism mechanism(scene);
    const Assembly a = assemble(mechanism);
    EXPECT_EQ(a.start.q[0], crank) << "a held joint moved";
    EXPECT_NEAR(a.start.q[0] + a.start.q[1], coupler, 1e-14) << off;
    EXPECT_NEAR(a.start.q[2], rocker, 1e-14) << off;
    EXPECT_NEAR(a.moved, std::abs(off), 1e-14);
    EXPECT_EQ(a.rank, 2);
    EXPECT_EQ(a.mobility, 1);
    EXPECT_LT(a.position_residual, 1e-15);
    expect_consistent(mechanism, a);
  }
}

TEST(Assembly, RatesFollowTheHeldOne) {
  Scene scene = example("four_bar");
  scene.joints[0].velocity = {3};
  const Mechanism mechanism(scene);
  const Assembly a = assemble(mechanism);
  EXPECT_EQ(a.start.u[0], 3);
  EXPECT_GT(a.start.u.tail(2).cwiseAbs().minCoeff(), 0.01);
  expect_consistent(mechanism, a);
}

TEST(Assembly, RedundantLoopsClose) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Eigen::Quaterniond r =
        seed == 0 ? Eigen::Quaterniond::Identity()
                  : Eigen::Quaterniond(Eigen::AngleAxisd(
                        0.3 * seed, Eigen::Vector3d(1, -2, 0.1 * seed).normalized()));
    Scene scene = turned(bricard(), r);
    for (std::size_t i = 0; i < scene.joints.size(); ++i)
      scene.joints[i].position = {0.1 * std::sin(3.0 * static_cast<double>(i) + seed)};
    const Mechanism mechanism(scene);
    const Assembly a = assemble(mechanism);
    EXPECT_EQ(a.rank, 4);
    EXPECT_EQ(a.mobility, 1);
    EXPECT_EQ(a.dependent_rows.size(), 1u);
    EXPECT_LT(a.largest_neglected, 1e-7 * a.smallest_pivot);
    expect_consistent(mechanism, a);

    const Mechanism flat(turned(row_of_four_bars(3, 1.1, 1), r), {.algebra = Algebra::spatial});
    const Assembly b = assemble(flat);
    EXPECT_EQ(b.rank, 6);
    EXPECT_EQ(b.mobility, 1);
    EXPECT_EQ(b.dependent_rows.size(), 9u);
    expect_consistent(flat, b);
  }
}

TEST(Assembly, SingularPoseIsSeen) {
  const Mechanism mechanism(row_of_four_bars(3, 0, 1));
  const Assembly a = assemble(mechanism);
  EXPECT_EQ(a.rank, 3);
  EXPECT_EQ(a.mobility, 4);
  EXPECT_EQ(a.iterations, 0);
}

TEST(Assembly, WhatStaysOpenIsNamedWithItsGap) {
  Scene scene = example("four_bar");
  scene.joints[2].origin_parent = {9, 0, 0};  // 9 m from O: links of 0.5, 2 and 1.5 m cannot reach
  scene.held.clear();
  const std::string what = complaint(scene);
  EXPECT_NE(what.find("scene.toml:"), std::string::npos) << what;
  EXPECT_NE(what.find("cannot be assembled"), std::string::npos) << what;
  EXPECT_NE(what.find("loop 'B' stays open by"), std::string::npos) << what;
  const auto number = what.find("open by ") + 8;
  EXPECT_NEAR(std::stod(what.substr(number)), 5, 0.1) << what;  // 9 − 4 m
}

TEST(Assembly, HeldJointsThatForbidClosingAreSaid) {
  Scene scene = example("four_bar");
  scene.held = {"O", "A", "C"};
  scene.joints[2].position = {1.0};
  EXPECT_NE(complaint(scene).find("while joints are held"), std::string::npos) << complaint(scene);
}

TEST(Assembly, HeldRatesThatTearALoopAreSaid) {
  Scene scene = example("four_bar");
  scene.held = {"O", "C"};
  scene.joints[0].velocity = {1};
  scene.joints[2].velocity = {5};
  scene.joints[2].position = {1.7419501646378182};
  const std::string what = complaint(scene);
  EXPECT_NE(what.find("loop 'B'"), std::string::npos) << what;
  EXPECT_NE(what.find("rates that the loops allow"), std::string::npos) << what;
}

TEST(Assembly, WithoutLoopsTheGuessStays) {
  const Mechanism mechanism(example("chain"));
  const Assembly a = assemble(mechanism);
  EXPECT_EQ(a.rank, 0);
  EXPECT_EQ(a.mobility, mechanism.nv());
  EXPECT_EQ(a.start.q, mechanism.tree().q0);
  EXPECT_EQ(a.start.u, mechanism.tree().u0);
}

/// Above or below the line from the crank's tip to the rocker's pivot: which of its two assemblies
/// a four-bar is in.
bool is_open(const Eigen::VectorXd& q) {
  const Eigen::Vector2d tip(0.5 * std::cos(q[0]), 0.5 * std::sin(q[0]));
  const Eigen::Vector2d to_pivot = Eigen::Vector2d(2, 0) - tip;
  const Eigen::Vector2d coupler(std::cos(q[0] + q[1]), std::sin(q[0] + q[1]));
  return to_pivot.x() * coupler.y() - to_pivot.y() * coupler.x() > 0;
}

TEST(Assembly, KeepsToTheSideOfTheGuessOrSaysThatItDidNot) {
  // From anywhere: what comes out closes the loop; it is on the side of the guess, or said not to
  // be.
  RandomTree random(3);
  int kept = 0, told = 0, refused = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    Scene scene = example("four_bar");
    for (int i = 0; i < 3; ++i)
      scene.joints[static_cast<std::size_t>(i)].position = {std::numbers::pi *
                                                            random.uniform(-1, 1)};
    const Mechanism mechanism(scene);
    Assembly a;
    try {
      a = assemble(mechanism);
    } catch (const SceneError& e) {
      ++refused;
      EXPECT_NE(std::string(e.what()).find("stays open by"), std::string::npos) << e.what();
      continue;
    }
    ASSERT_LT(a.position_residual, 1e-11);
    const Eigen::VectorXd& guess = mechanism.tree().q0;
    // The determinant of the loop's equations in the coupler's and the rocker's angle, by hand:
    // 2 m · 1.5 m · sin(rocker − coupler).
    const auto side = [](const Eigen::VectorXd& q) { return std::sin(q[2] - q[0] - q[1]); };
    if (std::abs(side(guess)) < 1e-4) continue;
    const bool crossed = (side(guess) > 0) != (side(a.start.q) > 0);
    EXPECT_EQ(crossed, !a.mirrored.empty()) << trial;
    EXPECT_EQ(side(a.start.q) > 0, is_open(a.start.q)) << trial;
    ++(crossed ? told : kept);
    if (crossed) {
      EXPECT_NE(mirror_sentence(a).find("loop 'B'"), std::string::npos);
    }
  }
  EXPECT_GT(kept, 2700);
  RecordProperty("kept", kept);
  RecordProperty("told", told);
  RecordProperty("refused", refused);
}

TEST(Assembly, RandomStartsOfTheExamplesAssembleOrAreRefusedWithTheReason) {
  RandomTree random(4);
  int assembled = 0, refused = 0;
  for (const char* name : {"slider_crank", "andrews", "n_four_bar"}) {
    const Scene plain = example(name);
    for (int trial = 0; trial < (plain.bodies.size() > 20 ? 10 : 500); ++trial) {
      Scene scene = plain;
      for (JointSpec& j : scene.joints)
        for (double& x : j.position) x += 0.5 * random.uniform(-1, 1);
      const Mechanism mechanism(scene);
      try {
        const Assembly a = assemble(mechanism);
        ++assembled;
        ASSERT_LT(a.position_residual, 1e-10) << name << trial;
        ASSERT_TRUE(a.start.udot.allFinite() && a.start.lambda.allFinite()) << name << trial;
      } catch (const SceneError& e) {
        ++refused;
        const std::string what = e.what();
        EXPECT_TRUE(what.find("stays open by") != std::string::npos ||
                    what.find("cannot move") != std::string::npos ||
                    what.find("apart") != std::string::npos)
            << what;
      }
    }
  }
  EXPECT_GT(assembled, 900);
  EXPECT_EQ(assembled + refused, 1010);
}

TEST(Assembly, TwoLoopsHaveTwoSides) {
  // Two four-bars that share nothing: mirroring both must not cancel out.
  Scene scene = example("four_bar");
  const Scene other = example("four_bar");
  const auto second = [](std::string name) { return name == "ground" ? name : name + "2"; };
  for (BodySpec b : other.bodies) {
    b.name = second(b.name);
    scene.bodies.push_back(b);
  }
  for (JointSpec j : other.joints) {
    j.name = second(j.name);
    j.parent = second(j.parent);
    j.child = second(j.child);
    scene.joints.push_back(j);
  }
  LoopSpec loop = other.loops[0];
  loop.name = second(loop.name);
  loop.parent = second(loop.parent);
  loop.child = second(loop.child);
  scene.loops.push_back(loop);
  scene.markers.clear();
  const Mechanism mechanism(scene);
  Eigen::MatrixXd from = Eigen::MatrixXd::Zero(4, 6), to = from;
  // Columns of the cranks are held; the others' blocks by hand, det > 0 before, < 0 after.
  from.block<2, 2>(0, 1) << 1, 0, 0, 1;
  from.block<2, 2>(2, 4) << 0, 1, -1, 0;
  to.block<2, 2>(0, 1) << 1, 0, 0, -1;
  to.block<2, 2>(2, 4) << 0, 1, 1, 0.5;
  EXPECT_EQ(rows_that_changed_side(from, to).size(), 2u);
  to.block<2, 2>(2, 4) = from.block<2, 2>(2, 4);
  const auto one = rows_that_changed_side(from, to);
  int rows = 0;
  for (const auto& block : one) rows += static_cast<int>(block.size());
  EXPECT_GE(one.size(), 1u);
  for (const auto& block : one)
    for (const int row : block) EXPECT_LT(row, 2);
  EXPECT_TRUE(rows_that_changed_side(from, from).empty());
  // Free columns to spare: nothing is told.
  from.col(0).setOnes();
  EXPECT_TRUE(rows_that_changed_side(from, to).empty());
  EXPECT_GT(rows, 0);
  EXPECT_EQ(assemble(mechanism).mirrored.size(), 0u);
}

TEST(Assembly, UnitsDoNotMatter) {
  Scene scene = example("slider_crank");
  scene.joints[0].position = {0.7};
  scene.joints[2].position = {1.8};
  scene.held.clear();
  const Mechanism plain(scene);
  const Assembly a = assemble(plain);
  for (const double s : {1e-6, 1e-3, 1e3, 1e6}) {
    const Mechanism other(in_units(scene, {.length = s, .time = 0.1, .mass = 7}));
    const Assembly b = assemble(other);
    EXPECT_NEAR(b.start.q[0], a.start.q[0], 1e-12) << s;
    EXPECT_NEAR(b.start.q[1], a.start.q[1], 1e-12) << s;
    EXPECT_NEAR(b.start.q[2] / s, a.start.q[2], 1e-12) << s;
    EXPECT_NEAR(b.start.u[2] / s * 0.1, a.start.u[2], 1e-11) << s;
    EXPECT_LT(b.position_residual, 1e-12 * s) << s;
  }
}

}  // namespace
}  // namespace momenta
