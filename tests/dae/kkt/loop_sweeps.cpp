// Loops carried by the sweeps against the assembled matrix: momentum and acceleration form,
// position correction, every joint and loop kind, open and closed loops, in the plane and in space,
// at every instruction level.

#include "equations/level_symbols.h"
#include "equations/levels.h"
#include "equations/linkages.h"
#include "equations/parts.h"
#include "equations/quad_loops.h"
#include "equations/random_loops.h"
#include "equations/sweeps_against_matrix.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/kernel/model.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/kkt/solver_choice.h>

#include <Eigen/Dense>

namespace momenta::dae_loop_sweeps {
namespace {

using namespace equations;
using Eigen::VectorXd;

TEST(LoopSweeps, AgreeWithTheAssembledMatrixInSpace) {
  Worst worst;
  for (unsigned seed = 0; seed < 2400; ++seed) {
    RandomTree random(seed);
    Scene scene = random.scene({.bodies = 8});
    scene.loops.push_back(random_loop(random, scene, loop_kinds[seed % loop_kinds.size()]));
    if (seed % 3 > 0) scene.loops.push_back(random_loop(random, scene, LoopKind::point));
    if (seed % 3 > 1) scene.loops.push_back(random_loop(random, scene, LoopKind::distance));
    compare(scene, random, {.algebra = Algebra::spatial}, worst);
  }
  EXPECT_GT(worst.tried, 600);
  expect_rounding(worst, 8);
}

TEST(LoopSweeps, AgreeWithTheAssembledMatrixInThePlane) {
  Worst worst;
  for (unsigned seed = 0; seed < 1200; ++seed) {
    RandomTree random(seed);
    Scene scene = random.planar_scene({.bodies = 10});
    const Tree tree = build_tree(scene);
    const auto plane = find_plane(tree, scene);
    ASSERT_TRUE(plane.basis) << seed << ": " << plane.why;
    const Eigen::Vector3d normal = plane.basis->col(2);
    for (unsigned i = 0; i < 1 + seed % 3; ++i) {
      LoopSpec l = into_plane(
          random, scene,
          random_loop(random, scene, planar_loop_kinds[(seed + i) % planar_loop_kinds.size()]),
          normal);
      level(l, scene, tree, normal);
      scene.loops.push_back(l);
    }
    compare(scene, random, {.algebra = Algebra::planar}, worst);
  }
  EXPECT_GT(worst.tried, 400);
  expect_rounding(worst, 10);
}

TEST(LoopSweeps, DrivenLoopsInSpace) {
  Worst worst;
  for (unsigned seed = 0; seed < 1200; ++seed) {
    RandomTree random(seed + 5000);
    Scene scene = random.scene({.bodies = 8});
    const LoopKind kind = loop_kinds[seed % loop_kinds.size()];
    for (unsigned i = 0; i < 1 + seed % 2; ++i) {
      scene.loops.push_back(random_loop(random, scene, i == 0 ? kind : LoopKind::distance));
      drive_loop(random, scene, scene.loops.back(), random.below(8), random.below(8));
    }
    compare(scene, random, {.algebra = Algebra::spatial}, worst);
  }
  EXPECT_GT(worst.tried, 250);
  expect_rounding(worst, 8);
}

TEST(LoopSweeps, DrivenLoopsInThePlane) {
  Worst worst;
  for (unsigned seed = 0; seed < 800; ++seed) {
    RandomTree random(seed + 7000);
    Scene scene = random.planar_scene({.bodies = 9});
    const Tree tree = build_tree(scene);
    const auto plane = find_plane(tree, scene);
    ASSERT_TRUE(plane.basis) << seed << ": " << plane.why;
    const Eigen::Vector3d normal = plane.basis->col(2);
    for (unsigned i = 0; i < 1 + seed % 2; ++i) {
      LoopSpec l = into_plane(
          random, scene,
          random_loop(random, scene, planar_loop_kinds[(seed + i) % planar_loop_kinds.size()]),
          normal);
      level(l, scene, tree, normal);
      int origins = 0;
      const auto axes = axes_at_zero(scene).at(l.parent);
      for (int k = 0; k < 3; ++k)
        if (std::abs((axes * Eigen::Vector3d::Unit(k)).dot(normal)) < 1e-12) origins |= 1 << k;
      scene.loops.push_back(l);
      drive_loop(random, scene, l, l.kind == LoopKind::spherical ? 0 : 1, origins);
    }
    compare(scene, random, {.algebra = Algebra::planar}, worst);
  }
  EXPECT_GT(worst.tried, 250);
  expect_rounding(worst, 9);
}

TEST(LoopSweeps, Couplers) {
  for (const bool planar : {false, true}) {
    Worst worst;
    for (unsigned seed = 0; seed < 700; ++seed) {
      RandomTree random(seed + 9000);
      const TreeRecipe recipe{.bodies = 9};
      Scene scene = planar ? random.planar_scene(recipe) : random.scene(recipe);
      if (!planar && seed % 3 == 0)
        scene.loops.push_back(random_loop(random, scene, loop_kinds[seed % loop_kinds.size()]));
      for (unsigned i = 0; i < 1 + seed % 4; ++i)
        if (const auto coupler = random_coupler(random, scene)) {
          scene.loops.push_back(*coupler);
          if (random.chance(0.4)) drive_loop(random, scene, *coupler, 1, 0);
        }
      if (scene.loops.empty()) continue;
      compare(scene, random, {.algebra = planar ? Algebra::planar : Algebra::spatial}, worst);
    }
    EXPECT_GT(worst.tried, 300);
    expect_rounding(worst, 9);
  }
}

/// Errors of u from p = M u₀ + Φ_qᵀσ, u₀ on the branch and σ of order one, a little away from the
/// flat pose where a row of four-bars loses rank: against u₀, and against quad precision at the
/// same q and p, whose rounding an exact solution takes for motion.
struct FlatErrors {
  double from_branch = 0, from_quad = 0;
};
FlatErrors errors_near_flat(const Scene& scene, Algebra algebra, double fade, bool centred,
                            bool with_quad) {
  const Mechanism mechanism(scene, {.algebra = algebra, .kkt = KktChoice::sweeps});
  const auto e = mechanism.evaluation<double>();
  const VectorXd& q = mechanism.tree().q0;
  const VectorXd& u0 = mechanism.tree().u0;
  const VectorXd sigma = VectorXd::LinSpaced(mechanism.m(), 0.6, -0.9);
  VectorXd p(mechanism.nv()), u(mechanism.nv()), found(mechanism.m());
  e->place(0, q.data());
  e->move(u0.data());
  e->momenta(sigma.data(), p.data());
  const auto solver = make_sweep_solver(mechanism, *e);
  EXPECT_TRUE(solver->momentum(0, q.data(), p.data(), centred ? sigma.data() : nullptr, fade, 0,
                               u.data(), found.data(), nullptr));
  FlatErrors errors;
  errors.from_branch = (u - u0).cwiseAbs().maxCoeff();
  if (with_quad)
    errors.from_quad = (u - quad_rates(mechanism, q, p, u0, 0, 0).u).cwiseAbs().maxCoeff();
  return errors;
}

// The sharp filter, fading towards zero, solves the data as they are; it costs at most what a
// fading row carries, δ σ. The default one, fading towards the centre, keeps to the branch.
TEST(LoopSweeps, NearlyFlatRowsInEveryOrientation) {
  const auto axis = Eigen::Vector3d::UnitZ();
  for (const int n : {1, 2, 40})
    for (const auto& [delta, bound] :
         {std::pair{1e-2, 2e-12}, std::pair{1e-3, 2e-11}, std::pair{1e-4, 1e-10},
          std::pair{1e-5, 1e-9}, std::pair{1e-6, 1e-8}, std::pair{1e-7, 1e-7},
          std::pair{1e-8, 1e-7}, std::pair{1e-9, 1e-7}, std::pair{0.0, 1e-12}}) {
      const bool kept = delta > 5e-7;
      double sharp = 0, centred = 0;
      for (const double angle : orientations()) {
        const Scene scene = turned(row_of_four_bars(n, delta, 1),
                                   Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis)));
        const FlatErrors found = errors_near_flat(scene, Algebra::planar, 1e-14, false, kept);
        sharp = std::max(sharp, kept ? found.from_quad : found.from_branch);
        centred = std::max(
            centred,
            errors_near_flat(scene, Algebra::planar, fade_evaluation, true, false).from_branch);
      }
      EXPECT_LT(sharp, delta > 0 && !kept ? 2e-7 : bound) << n << " at " << delta;
      EXPECT_LT(centred, bound) << n << " at " << delta;
      RecordProperty("n" + std::to_string(n) + "_delta_" + std::to_string(delta * 1e9),
                     std::to_string(centred * 1e15) + "e-15");
    }
}

TEST(LoopSweeps, NearlyFlatRowsTurnedInSpace) {
  for (const int n : {1, 2, 40})
    for (const auto& [delta, bound] :
         {std::pair{1e-2, 1e-11}, std::pair{1e-4, 1e-10}, std::pair{1e-5, 1e-9},
          std::pair{1e-6, 1e-8}, std::pair{1e-7, 1e-7}, std::pair{1e-8, 1e-7},
          std::pair{0.0, 1e-12}}) {
      double worst = 0;
      for (unsigned seed = 0; seed < 25; ++seed) {
        RandomTree random(seed);
        worst =
            std::max(worst, errors_near_flat(turned(row_of_four_bars(n, delta, 1), random.turn()),
                                             Algebra::spatial, fade_evaluation, true, false)
                                .from_branch);
      }
      EXPECT_LT(worst, bound) << n << " at " << delta;
    }
}

/// Redundant rows: u and the loops' wrenches are those of least squares, the dense twin's.
TEST(LoopSweeps, RedundantRows) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    RandomTree random(seed);
    const Eigen::Quaterniond r = seed == 0 ? Eigen::Quaterniond::Identity() : random.turn();
    Scene doubled = row_of_four_bars(2, 1.1);  // two connects on one pair of bodies
    doubled.loops.push_back(doubled.loops.front());
    doubled.loops.back().name = "again";
    for (const Scene& scene : {row_of_four_bars(3, 0.8), bricard(), doubled}) {
      const Scene there = turned(scene, r);
      const Mechanism mechanism(there, {.algebra = Algebra::spatial, .kkt = KktChoice::sweeps}),
          twin(there, {.algebra = Algebra::spatial, .kkt = KktChoice::dense});
      const auto e = mechanism.evaluation<double>();
      const VectorXd& q = mechanism.tree().q0;
      VectorXd p(mechanism.nv()), centre(mechanism.m());
      for (double& x : p) x = random.uniform(-2, 2);
      for (double& x : centre) x = random.uniform(-2, 2);
      const auto sweeps = make_sweep_solver(mechanism, *e), dense = make_assembled_solver(twin, *e);
      VectorXd u[2], w[2], sigma(mechanism.m());
      std::size_t faded[2];
      for (int i = 0; i < 2; ++i) {
        auto& solver = i == 0 ? *sweeps : *dense;
        u[i].resize(mechanism.nv());
        w[i].resize(mechanism.nv());
        EXPECT_TRUE(solver.momentum(0, q.data(), p.data(), centre.data(), fade_evaluation, 0,
                                    u[i].data(), sigma.data(), nullptr));
        EXPECT_LT(sigma.norm(), 1000.0);
        faded[i] = solver.faded_rows().size();
        e->place(0, q.data());
        e->constraint_forces(sigma.data(), w[i].data());
      }
      EXPECT_EQ(faded[0], faded[1]) << there.name;
      EXPECT_LT(relative_error(u[0], u[1]), 1e-13) << there.name;
      EXPECT_LT(relative_error(w[0], w[1]), 1e-12) << there.name;
    }
  }
}

/// Every level computes the same, and a batch what single states do.
TEST(LoopSweeps, LevelsAndBatchesAgree) {
  int compared = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    RandomTree random(seed);
    const bool planar = seed % 2 == 0;
    Scene scene =
        planar ? row_of_four_bars(2, 1.1) : random.scene({.bodies = 6, .body_forces = false});
    if (!planar) scene.loops.push_back(random_loop(random, scene, LoopKind::point));
    if (seed % 4 == 1) drive_loop(random, scene, scene.loops.back(), 0, 5);
    if (seed % 8 > 5) {
      LoopSpec gear;
      gear.name = "gear";
      gear.kind = LoopKind::coupler;
      if (planar)
        gear.joints = {"B0", "O2"};
      else if (const auto coupler = random_coupler(random, scene))
        gear = *coupler;
      if (planar) gear.ratios = {1.2, -0.7};
      if (!gear.joints.empty()) scene.loops.push_back(gear);
    }
    const Mechanism mechanism(scene);
    if (mechanism.m() == 0 || mechanism.solver().kkt() != KktChoice::sweeps) continue;
    compared += compare_batches(mechanism, random, 11);
  }
  EXPECT_GT(compared, 200);
}

/// Loops of every kind, alone, beside each other and inside one another: slots open and close in
/// groups, some of them shared.
TEST(LoopSweeps, BatchesOfEveryLoop) {
  int planar = 0, spatial = 0;
  for (unsigned seed = 0; seed < 240; ++seed) {
    RandomTree random(seed);
    const bool in_plane = seed % 2 == 0;
    Scene scene = in_plane ? random.planar_scene({.bodies = 10})
                           : random.scene({.bodies = 8, .body_forces = false});
    const Tree tree = build_tree(scene);
    const unsigned kind = seed / 2;
    if (in_plane) {
      const auto plane = find_plane(tree, scene);
      ASSERT_TRUE(plane.basis) << seed << ": " << plane.why;
      const Eigen::Vector3d normal = plane.basis->col(2);
      for (unsigned i = 0; i < 1 + seed % 3; ++i) {
        LoopSpec l = into_plane(
            random, scene,
            random_loop(random, scene, planar_loop_kinds[(kind + i) % planar_loop_kinds.size()]),
            normal);
        level(l, scene, tree, normal);
        scene.loops.push_back(l);
      }
    } else {
      scene.loops.push_back(random_loop(random, scene, loop_kinds[kind % loop_kinds.size()]));
      if (seed % 3 > 0) scene.loops.push_back(random_loop(random, scene, LoopKind::distance));
    }
    const Mechanism mechanism(scene);
    if (mechanism.m() > mechanism.nv() || mechanism.solver().kkt() != KktChoice::sweeps) continue;
    (in_plane ? planar : spatial) += compare_batches(mechanism, random, 9);
  }
  const auto levels = static_cast<int>(equations::levels().size());
  EXPECT_GT(planar, 400 * levels);
  EXPECT_GT(spatial, 400 * levels);
}

/// Where no sweeps carry loops there is a sentence, and nothing to call.
TEST(LoopSweeps, AreRefusedWhereThereAreNone) {
  Scene open = row_of_four_bars(1, 0.5);
  open.loops.clear();
  EXPECT_THROW(Mechanism(open).solver().sweeps(), std::logic_error);
  EXPECT_THROW(Mechanism(open).solver().sweeps_as_given(), std::logic_error);
}

/// Records of a pack beyond the cache: the batch takes the states one by one, to the last bit.
TEST(LoopSweeps, LargeBatchesGoStateByState) {
  RandomTree random(1);
  const int cells = best_level() >= 4 ? 4000 : best_level() >= 3 ? 8000 : 16000;
  const Mechanism mechanism(row_of_four_bars(cells, 1.1));
  EXPECT_EQ(mechanism.plan().planar, true);
  const Eigen::Index nq = mechanism.nq(), nv = mechanism.nv(), m = mechanism.m();
  const VectorXd q = mechanism.tree().q0;
  VectorXd p(nv), u(nv), pdot(nv), sigma(m), u1(nv), pdot1(nv), sigma1(m);
  for (double& x : p) x = random.uniform(-2, 2);
  ASSERT_EQ(q.size(), nq);
  const auto sweeps = mechanism.solver().sweeps();
  RightSide<double> right;
  right.fade = fade_evaluation;
  right.leak = 0.5;
  right.rates = true;
  EXPECT_TRUE(sweeps->momentum(0, {q.data(), p.data(), u.data(), sigma.data(), pdot.data(), 1, 1},
                               right.fade, right.leak));
  EXPECT_TRUE(
      sweeps->momentum(0, q.data(), p.data(), right, u1.data(), sigma1.data(), pdot1.data()));
  EXPECT_EQ(u, u1);
  EXPECT_EQ(sigma, sigma1);
  EXPECT_EQ(pdot, pdot1);
}

TEST(LoopSweeps, CodeOfALevelIsItsOwn) {
  expect_own_symbols(
      MOMENTA_BINARY_DIR "/dae", "*_kernels.cpp.o",
      {"Pack<", "LoopedSweepsAt<", "looped_sweeps_at<", "TangentSweepsAt<", "tangent_sweeps_at<",
       "KineticSweepAt<", "kinetic_sweep_at<", "NumberSweepAt<", "number_sweep_at<", "LoopNumbers<",
       "PlacedAlong<", "DirectionSweepsAt<", "direction_sweeps_at<", "NumberRowsAt<",
       "number_rows_at<", "MovedLoops<", "MixedSweepAt<", "mixed_sweep_at<"});
}

/// Legs folded onto a platform; the same loops as more slots than there are go to the matrix.
TEST(LoopSweeps, FoldedLoopedBranches) {
  Scene scene = platform(6);
  const Mechanism mechanism(scene, {.kkt = KktChoice::sweeps}),
      twin(scene, {.kkt = KktChoice::dense});
  EXPECT_EQ(mechanism.m(), 18);
  RandomTree random(3);
  TreeState s = random.state(mechanism.tree());
  VectorXd p(mechanism.nv()), centre(mechanism.m());
  for (double& x : p) x = random.uniform(-2, 2);
  for (double& x : centre) x = random.uniform(-2, 2);
  const auto e = mechanism.evaluation<double>();
  for (int pose = 0; pose < 20; ++pose) {
    s = random.state(mechanism.tree());
    for (int leg = 0; leg < 6; ++leg) s.q[7 + 3 * leg + 2] = 1 + 0.1 * leg;  // no leg of no length
    const Result a = solved(*make_sweep_solver(mechanism, *e), mechanism, s, p, centre),
                 b = solved(*make_assembled_solver(twin, *e), twin, s, p, centre);
    EXPECT_LT(relative_error(a.u, b.u), 1e-11);
    EXPECT_LT(relative_error(a.sigma, b.sigma), 1e-11);
    EXPECT_LT(relative_error(a.pdot, b.pdot), 1e-11);
    EXPECT_LT(relative_error(a.udot, b.udot), 1e-11);
    EXPECT_LT(relative_error(a.delta, b.delta), 1e-11);
  }
  // A leg at its gimbal pose, axis 2 turned along axis 1's way, or of no length: no rank by itself.
  s.q[7 + 2] = 0;
  const Result a = solved(*make_sweep_solver(mechanism, *e), mechanism, s, p, centre),
               b = solved(*make_assembled_solver(twin, *e), twin, s, p, centre);
  EXPECT_LT(relative_error(a.u, b.u), 1e-9);
  EXPECT_LT(relative_error(a.pdot, b.pdot), 1e-9);
}

TEST(LoopSweeps, PlanSaysWhatItCannotCarry) {
  // Nine points of one body held: more equations open at once than there are slots.
  Scene scene = row_of_four_bars(1, 1.1);
  for (int i = 0; i < 8; ++i) {
    scene.loops.push_back(equations::make_loop(LoopKind::point, "more" + std::to_string(i),
                                               "ground", "level0", {0.1 * i, 0.5, 0},
                                               {0.1 * i, 0, 0}));
  }
  const Mechanism fallen(scene);
  EXPECT_EQ(fallen.solver().kkt(), KktChoice::sparse);
  EXPECT_THROW(Mechanism(scene, {.kkt = KktChoice::sweeps}).solver(), SceneError);
  // A joint without inertia until its loop closes.
  Scene light = row_of_four_bars(1, 1.1);
  light.bodies[1].mass = 0;
  light.bodies[1].inertia.setZero();
  const Mechanism massless(light);
  EXPECT_EQ(massless.solver().kkt(), KktChoice::sparse);
  std::string said;
  for (const auto& [what, how] : plan_lines(massless)) said += what + ": " + how + "\n";
  EXPECT_NE(said.find("has no inertia before its loops close"), std::string::npos) << said;
}

}  // namespace
}  // namespace momenta::dae_loop_sweeps
