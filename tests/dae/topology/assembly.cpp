// A consistent start from a guess: positions close, held joints stay, what cannot close is said.

#include "equations/examples.h"
#include "equations/large_scenes.h"
#include "equations/linkages.h"
#include "equations/parts.h"
#include "equations/random_tree.h"
#include "equations/refusal.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/dae/kkt/loop_rank.h>
#include <momenta/dae/topology/assembly/assembly.h>
#include <momenta/dae/topology/assembly/start_accelerations.h>

#include <Eigen/SVD>

#include <numbers>
#include <random>

namespace momenta::dae_assembly {
namespace {

using namespace equations;
using Eigen::VectorXd;
using equations::example;

std::string complaint(const Scene& scene) {
  const Mechanism mechanism(scene);
  return equations::thrown<SceneError>([&] { assemble(mechanism); });
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
    EXPECT_LT(a.dropped, 1e-7 * a.kept);
    expect_consistent(mechanism, a);

    const Mechanism flat(turned(row_of_four_bars(3, 1.1, 1), r), {.algebra = Algebra::spatial});
    const Assembly b = assemble(flat);
    EXPECT_EQ(b.rank, 6);
    EXPECT_EQ(b.mobility, 1);
    EXPECT_EQ(b.dependent_rows.size(), 9u);
    expect_consistent(flat, b);
  }
}

/// The closed pose `at` (nq), and a start from which the loops are open by 0.8 · 10⁻⁸ lengths, less
/// than a file may leave of redundant equations: along the weakest motion that they forbid, σ the
/// singular value of Φ_q there. One step of Newton's leaves (δ² / 2), δ = 0.8 · 10⁻⁸ / σ.
VectorXd slightly_open(const Mechanism& mechanism, const VectorXd& at) {
  const auto e = mechanism.evaluation<double>();
  e->place(0, at.data());
  const Eigen::MatrixXd a = scaled_jacobian(mechanism, *e).a;
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeFullV);
  const int rank = rank_and_idle(a).rank;
  EXPECT_LT(rank, mechanism.m());
  const LoopUnits units(mechanism);
  const VectorXd step = 0.8e-8 / svd.singularValues()[rank - 1] *
                        svd.matrixV().col(rank - 1).cwiseProduct(units.rates);
  VectorXd phi(mechanism.m());
  const VectorXd q = at + step;
  e->place(0, q.data());
  e->positions(phi.data());
  const double open = phi.cwiseQuotient(units.equations).cwiseAbs().maxCoeff();
  EXPECT_GT(open, 1e-10);
  EXPECT_LT(open, left_by_files);
  return q;
}

/// What is open by less than a file leaves is closed all the same, where it can be.
TEST(Assembly, SmallGapsOfRedundantLoopsThatCloseAreClosed) {
  for (const double angle : {1e-3, 2e-3})
    for (unsigned seed = 0; seed < 6; ++seed) {
      SCOPED_TRACE(testing::Message() << angle << ", " << seed);
      const Eigen::Quaterniond r(
          Eigen::AngleAxisd(0.4 * seed, Eigen::Vector3d(1, 2, 0.3 * seed).normalized()));
      const Mechanism mechanism(turned(row_of_four_bars(3, angle, 1), r),
                                {.algebra = Algebra::spatial});
      const Assembly closed = assemble(mechanism);
      const VectorXd q = slightly_open(mechanism, closed.start.q);
      const Assembly a = assemble(mechanism, 0, q, closed.start.u, Assembled::rates);
      EXPECT_EQ(a.residue, "");
      EXPECT_LT(a.position_residual, 1e-14);
    }
}

/// Numbers that contradict each other are closed as far as they can be: to where no step of any
/// joint takes some of |Φ| away, the end of the dense Gauss-Newton steps
///
///   q ← q − A⁺ D⁻¹ Φ.
TEST(Assembly, SmallGapsOfContradictingLoopsEndAtTheLeastSquares) {
  for (const double angle : {6e-4, 8e-4})
    for (unsigned seed = 0; seed < 6; ++seed) {
      SCOPED_TRACE(testing::Message() << angle << ", " << seed);
      RandomTree random(seed);
      Scene scene = example("extremes/three_cranks.toml");
      for (JointSpec& j : scene.joints) j.position = {std::copysign(angle, j.position[0])};
      for (LoopSpec& l : scene.loops) l.origin_child[0] += 2e-9 * random.uniform(-1, 1);
      const Mechanism mechanism(scene);
      const LoopUnits units(mechanism);
      const auto e = mechanism.evaluation<double>();
      // Φ in units, what of it can be closed, and the step that does.
      const auto open = [&](const VectorXd& q, VectorXd* in_range, VectorXd* step) {
        VectorXd phi(mechanism.m());
        e->place(0, q.data());
        e->positions(phi.data());
        phi = phi.cwiseQuotient(units.equations);
        const Eigen::MatrixXd a = scaled_jacobian(mechanism, *e).a;
        const Eigen::BDCSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeThinU | Eigen::ComputeThinV);
        const Eigen::MatrixXd u = svd.matrixU().leftCols(3), v = svd.matrixV().leftCols(3);
        *in_range = u * (u.transpose() * phi);
        const VectorXd parts = (u.transpose() * phi).cwiseQuotient(svd.singularValues().head(3));
        *step = -(v * parts).cwiseProduct(units.rates);
        return phi;
      };
      VectorXd in_range, step;
      const Assembly closed = assemble(mechanism);
      ASSERT_EQ(closed.rank, 3);
      const VectorXd q = slightly_open(mechanism, closed.start.q);
      VectorXd least_q = q;
      for (int i = 0; i < 20; ++i) {
        open(least_q, &in_range, &step);
        least_q += step;
      }
      const VectorXd least = open(least_q, &in_range, &step);
      ASSERT_LT(in_range.norm(), 1e-14);
      const Assembly a = assemble(mechanism, 0, q, closed.start.u, Assembled::rates);
      const VectorXd found = open(a.start.q, &in_range, &step);
      EXPECT_NE(a.residue, "");
      EXPECT_LT(in_range.cwiseAbs().maxCoeff(), 2e-12);
      EXPECT_LT((found - least).norm(), 1e-11);
      EXPECT_LT((a.start.residue - found.cwiseProduct(units.equations)).norm(), 1e-15);
    }
}

/// Bars of a plane, their last pin d lengths out of it: whatever d, as little as six digits leave,
/// the pose is that in the plane, and it is told.
TEST(Assembly, LoopsALittleOutOfTheirPlaneCloseInIt) {
  for (const double size : {1.0, 1e-3, 40.0})
    for (const double off : {0.0, 3e-10, 6e-9, 2e-8, 4e-7, 4e-6}) {
      SCOPED_TRACE(testing::Message() << size << ", " << off);
      Scene scene = example("four_bar");
      for (BodySpec& b : scene.bodies) b.com *= size, b.inertia *= size * size;
      for (JointSpec& j : scene.joints) j.origin_parent *= size;
      LoopSpec& loop = scene.loops.front();
      loop.origin_parent *= size;
      loop.origin_child *= size;
      loop.kind = LoopKind::point;
      const Mechanism flat(scene, {.algebra = Algebra::spatial});
      const double length = length_of(scene);
      loop.origin_child[2] += off * length;
      const Mechanism mechanism(scene, {.algebra = Algebra::spatial});
      if (off > 1e-6) {
        EXPECT_THROW(assemble(mechanism), SceneError);
        continue;
      }
      const Assembly a = assemble(mechanism), plane = assemble(flat);
      EXPECT_LT((a.start.q - plane.start.q).norm(), 1e-11);
      EXPECT_EQ(a.rank, plane.rank);
      EXPECT_LT((a.start.udot - plane.start.udot).norm(), 1e-5 * plane.start.udot.norm());
      EXPECT_EQ(a.residue.empty(), off == 0);
      EXPECT_NEAR(a.position_residual, off * length, 1e-11 * length);
    }
}

/// A planar scene whose loop has one side a little higher is closed in space; a higher one is
/// refused.
TEST(Assembly, SidesOfALoopALittleApartAcrossThePlaneCloseInSpace) {
  for (const double off : {5e-10, 7e-9, 5e-7, 1e-4}) {
    Scene scene = example("four_bar");
    const Assembly plane = assemble(Mechanism(scene));
    scene.loops.front().origin_child[2] += off;
    if (off > 1e-5) {
      EXPECT_THROW(Mechanism{scene}, SceneError);
      continue;
    }
    const Mechanism mechanism(scene);
    EXPECT_EQ(mechanism.plan().planar, off < 1e-9);
    const Assembly a = assemble(mechanism);
    EXPECT_EQ(a.residue.empty(), off < 1e-9);
    EXPECT_EQ(a.mobility, 1);
    EXPECT_LT((a.start.q - plane.start.q).norm(), 1e-9);
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

// A crank-rocker with the crank held: from any guess of the others its two assemblies are mirror
// images about the line from the crank's tip to C. The guess's own is taken.
TEST(Assembly, KeepsToTheBranchOfTheGuess) {
  Scene scene = example("four_bar");
  const Assembly open = assemble(Mechanism(scene));
  // In the plane the loop's rows are places in the ground, and Newton's steps alone end in the same
  // assembly as the continued gap; in space, along axes of a body that turns, they do not always.
  int kept = 0, told = 0;
  for (int n = 0; n < 2 * 24 * 24; ++n) {
    const int i = n / 24 % 24, j = n % 24;
    Scene s = scene;
    s.joints[1].position = {open.start.q[1] + 0.26 * (i - 11.5)};
    s.joints[2].position = {open.start.q[2] + 0.26 * (j - 11.5)};
    const Mechanism mechanism(s, {.algebra = n < 24 * 24 ? Algebra::planar : Algebra::spatial});
    const Assembly a = assemble(mechanism);
    expect_consistent(mechanism, a);
    const double near = std::max(std::abs(s.joints[1].position[0] - open.start.q[1]),
                                 std::abs(s.joints[2].position[0] - open.start.q[2]));
    const bool here = (a.start.q - open.start.q).cwiseAbs().maxCoeff() < 1e-9;
    if (near < 0.8) {
      EXPECT_TRUE(here) << i << " " << j << ": " << a.branch;
    }
    kept += here;
    told += !a.branch.empty();
  }
  EXPECT_GT(told, 0);
  RecordProperty("kept", kept);
  RecordProperty("told", told);
}

// From anywhere: it closes, or says which loops stay open; never anything else.
TEST(Assembly, ClosesFromAnywhereOrSaysWhatStaysOpen) {
  int closed = 0, refused = 0;
  for (const char* name : {"four_bar", "andrews", "slider_crank", "spatial_slider_crank", "bricard",
                           "driven", "n_four_bar"}) {
    const Scene scene = example(name);
    RandomTree random(7);
    const int tries = std::string(name) == "n_four_bar" ? 4 : 40;
    for (int i = 0; i < tries; ++i) {
      Scene s = scene;
      const double length = length_of(s);
      for (JointSpec& joint : s.joints)
        for (double& x : joint.position) {
          const double unit = joint.kind == JointKind::prismatic ? length : std::numbers::pi;
          x = random.uniform(-unit, unit);
        }
      try {
        const Mechanism mechanism(s);
        const Assembly a = assemble(mechanism);
        EXPECT_LT(a.position_residual, 1e-12 * length) << name;
        EXPECT_TRUE(a.start.q.allFinite() && a.start.lambda.allFinite());
        ++closed;
      } catch (const SceneError& e) {
        const std::string what = e.what();
        EXPECT_NE(what.find("stays open by"), std::string::npos) << name << ": " << what;
        EXPECT_NE(what.find("free rates"), std::string::npos) << name << ": " << what;
        ++refused;
      }
    }
  }
  RecordProperty("closed", closed);
  RecordProperty("refused", refused);
  EXPECT_GT(closed, 100);
}

// Rods in line: Φ_qᵀ Φ = 0 though Φ is not, so no step, however short, closes the loop further.
TEST(Assembly, LeavesPosesWhereNoShortStepCloses) {
  for (const int n : {3, 4, 6, 12})
    for (const double part : {0.3, 0.6, 0.9})
      for (const bool in_space : {false, true}) {
        Scene scene = stretched_chain(n, part * n);
        if (in_space)
          scene = turned(scene, Eigen::Quaterniond(
                                    Eigen::AngleAxisd(1, Eigen::Vector3d(1, 2, 3).normalized())));
        const Mechanism mechanism(scene,
                                  {.algebra = in_space ? Algebra::spatial : Algebra::automatic});
        const Assembly a = assemble(mechanism);
        EXPECT_LT(a.position_residual, 1e-12 * n) << n << " " << part;
        EXPECT_NE(a.branch.find("short steps from the guess leave the loops open"),
                  std::string::npos)
            << n << " " << part << a.branch;
      }
  for (const int n : {3, 6}) {
    const std::string what = complaint(stretched_chain(n, n + 0.25));
    EXPECT_NE(what.find("loop 'tip' stays open by 0.25"), std::string::npos) << what;
  }
}

/// Three legs of two rods each under a plate, feet on a circle: a planar parallel robot whose
/// angles are counted from legs stretched along x.
Scene three_legs(RandomTree& random) {
  Scene s;
  s.name = "planar parallel robot";
  const double radius = random.uniform(1, 1.6), plate = random.uniform(0.2, 0.5);
  s.bodies.push_back(rod("plate"));
  s.joints.push_back(hinge("A2", "shin0", "plate", {1, 0, 0}, 0));
  for (int i = 0; i < 3; ++i) {
    const auto number = std::to_string(i);
    const double around = 2 * std::numbers::pi / 3 * i + random.uniform(-0.3, 0.3);
    const Eigen::Vector3d out(std::cos(around), std::sin(around), 0);
    s.bodies.push_back(rod("thigh" + number));
    s.bodies.push_back(rod("shin" + number));
    s.joints.push_back(hinge("O" + number, "ground", "thigh" + number, radius * out, 0));
    s.joints.push_back(hinge("K" + number, "thigh" + number, "shin" + number, {1, 0, 0}, 0));
    if (i == 0) continue;
    s.loops.push_back(equations::make_loop(LoopKind::revolute, "L" + number, "shin" + number,
                                           "plate", {1, 0, 0},
                                           plate * Eigen::Vector3d(std::cos(i), std::sin(i), 0)));
  }
  return s;
}

TEST(Assembly, ParallelRobotsCloseFromZero) {
  RandomTree random(11);
  for (int i = 0; i < 200; ++i) {
    const Scene scene = three_legs(random);
    EXPECT_EQ(complaint(scene), "") << i;
  }
}

/// The loop written from its other end: x_A and x_B, axes in the new parent's, which turn with it.
LoopSpec from_the_other_end(const LoopSpec& loop) {
  LoopSpec other = loop;
  other.parent = loop.child;
  other.child = loop.parent;
  other.origin_parent = loop.origin_child;
  other.origin_child = loop.origin_parent;
  other.rotation = loop.rotation.inverse();
  other.axis = loop.rotation * loop.axis;
  return other;
}

/// What stands on the ground stands on a body welded to it, so that all loops have two bodies.
Scene on_a_table(Scene scene) {
  for (JointSpec& joint : scene.joints)
    if (joint.parent == "ground") joint.parent = "table";
  for (LoopSpec& loop : scene.loops)
    if (loop.parent == "ground") loop.parent = "table";
  BodySpec table = rod("table");
  JointSpec weld;
  weld.name = "T";
  weld.kind = JointKind::weld;
  weld.child = "table";
  scene.bodies.insert(scene.bodies.begin(), table);
  scene.joints.insert(scene.joints.begin(), weld);
  return scene;
}

// Which end of a loop is written as its parent changes neither the pose that an open guess leads
// to, nor what is said of it: of welds that close half a turn off, hinges, balls and redundant
// loops, in a plane and in space. Rounding moves the pose of redundant loops by up to its root: on
// the way their pivots are as small as the gap.
TEST(Assembly, DoesNotDependOnWhichEndOfALoopIsItsParent) {
  const std::vector<std::pair<Scene, int>> scenes{{example("models/epr_robot_delta/robot.urdf"), 1},
                                                  {example("andrews"), 4},
                                                  {example("four_bar"), 4},
                                                  {on_a_table(bricard()), 4},
                                                  {on_a_table(platform(6)), 4}};
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  double moved = 0;
  for (const auto& [scene, guesses] : scenes)
    for (int guess = 0; guess < guesses; ++guess) {
      Scene here = scene;
      if (guess > 0)
        for (JointSpec& joint : here.joints)
          if (joint.kind == JointKind::revolute)
            joint.position = {(joint.position.empty() ? 0 : joint.position[0]) + 0.3 * any(random)};
      const Assembly written = assemble(Mechanism(here), Assembled::rates);
      moved = std::max(moved, written.moved);
      for (unsigned which = 1; which < (1U << std::min<std::size_t>(here.loops.size(), 3));
           ++which) {
        Scene other = here;
        for (std::size_t i = 0; i < here.loops.size(); ++i)
          if ((which >> (i % 3) & 1) != 0) other.loops[i] = from_the_other_end(here.loops[i]);
        const Assembly found = assemble(Mechanism(other), Assembled::rates);
        EXPECT_LT((found.start.q - written.start.q).cwiseAbs().maxCoeff(), 1e-8)
            << scene.name << " " << guess << " " << which;
        EXPECT_LT((found.start.u - written.start.u).cwiseAbs().maxCoeff(), 1e-8)
            << scene.name << " " << guess << " " << which;
        EXPECT_EQ(found.branch, written.branch) << scene.name;
      }
    }
  EXPECT_GT(moved, 1);
}

TEST(Assembly, WithoutLoopsTheGuessStays) {
  const Mechanism mechanism(example("chain"));
  const Assembly a = assemble(mechanism);
  EXPECT_EQ(a.rank, 0);
  EXPECT_EQ(a.mobility, mechanism.nv());
  EXPECT_EQ(a.start.q, mechanism.tree().q0);
  EXPECT_EQ(a.start.u, mechanism.tree().u0);
}

TEST(Assembly, RandomStartsOfTheExamplesAssembleOrAreRefusedWithTheReason) {
  RandomTree random(4);
  int assembled = 0, refused = 0;
  for (const char* name : {"four_bar", "slider_crank", "andrews", "bricard", "n_four_bar"}) {
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
  EXPECT_GT(assembled, 1500);
  EXPECT_EQ(assembled + refused, 2010);
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

// Rates of a scene that its loops do not let be are replaced by the nearest, and that is told: of
// two joints with u_A = 2 u_B by (2, 1) (2 u_A + u_B)/5; of a point on a circle along its tangent.
TEST(Assembly, ReplacedRatesAreTold) {
  const auto told = [](const std::string& text) {
    const Mechanism mechanism(parse_scene(text, "s.toml"));
    return replaced_rates_in_words(mechanism, assemble(mechanism).start);
  };
  const auto geared = [&](const std::string& a, const std::string& b,
                          const std::string& more = "") {
    const std::string body = "[[body]]\nmass = 1\nshape = { kind = 'rod', length = 1 }\nname = ";
    const std::string joint = "\n[[joint]]\nkind = 'revolute'\n";
    return told(body + "'a'\n" + body + "'b'" + joint + "name = 'A'\nchild = 'a'\nvelocity = " + a +
                joint + "name = 'B'\nchild = 'b'\nvelocity = " + b +
                "\n[[loop]]\nname = 'C'\nkind = 'coupler'\njoints = ['A', 'B']\n"
                "ratios = [1, -2]\n" +
                more);
  };
  EXPECT_EQ(
      geared("1", "1"),
      "start rates replaced by the nearest that the loops allow: A.u from 1 to 1.2 rad/s, B.u "
      "from 1 to 0.6 rad/s");
  EXPECT_EQ(geared("1", "0"),
            "start rates replaced by the nearest that the loops allow: A.u from 1 to 0.8 rad/s");
  EXPECT_EQ(geared("1", "1", "[assembly]\nhold = ['A']\n"),
            "start rates replaced by the nearest that the loops allow: B.u from 1 to 0.5 rad/s");
  EXPECT_EQ(geared("2", "1"), "");
  EXPECT_EQ(geared("0", "0"), "");
  EXPECT_EQ(told("[lagrangian]\ncoordinates = ['x', 'y']\nposition = [0.6, -0.8]\nvelocity = [1, "
                 "1]\nkinetic = '0.5*(x.dot^2+y.dot^2)'\npotential = 'y'\n"
                 "constraints = [{ name = 'rod', equation = 'x^2+y^2-1' }]\n"),
            "start rates replaced by the nearest that the constraints allow: x.dot from 1 to 1.12 "
            "1/s, y.dot from 1 to 0.84 1/s");
}

TEST(Assembly, TellsADriveWithoutASecondDerivativeAtTheStart) {
  const std::string text = R"(
[[body]]
name = "c"
mass = 1
inertia = 0.1
[[body]]
name = "p"
mass = 0.4
shape = { kind = "rod", length = 0.7 }
[[joint]]
name = "X"
kind = "prismatic"
axis = "x"
child = "c"
[[joint]]
name = "J"
kind = "revolute"
parent = "c"
child = "p"
[[drive]]
joint = "X"
kind = "formula"
law = "t^)";
  EXPECT_TRUE(says(complaint(parse_scene(text + "1.5\"\n", "law.toml")),
                   "the drive of joint 'X' has no finite second derivative at t = 0 s"));
  EXPECT_EQ(complaint(parse_scene(text + "3\"\n", "law.toml")), "");
}

}  // namespace
}  // namespace momenta::dae_assembly
