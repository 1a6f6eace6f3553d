// Maximal coordinates against joint coordinates: every call of the loop solver on random
// mechanisms, the same as from the assembled matrix; trees as from the recursion; the cost of a
// chain.

#include "equations/decompositions.h"
#include "equations/ensemble.h"
#include "equations/linkages.h"
#include "equations/random_loops.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/kkt/unheld_joints.h>
#include <momenta/dae/run/run_form.h>

#include <chrono>

namespace momenta::dae_maximal {
namespace {

using namespace equations;
using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd any(RandomTree& random, int size) {
  VectorXd v(size);
  for (double& x : v) x = random.uniform(-2, 2);
  return v;
}

/// How far rounding may carry a solution: the condition of M and, squared, of Φ_q M^(−1/2).
double growth(const Mechanism& mechanism, Evaluation<double>& e) {
  const auto& pattern = mechanism.kkt_pattern();
  MatrixXd m = MatrixXd::Zero(mechanism.nv(), mechanism.nv()),
           j = MatrixXd::Zero(mechanism.m(), mechanism.nv());
  std::vector<double> values(std::max(pattern.mass.size(), pattern.constraint.size()));
  e.mass_entries(values.data());
  for (std::size_t i = 0; i < pattern.mass.size(); ++i)
    m(pattern.mass[i].row, pattern.mass[i].column) =
        m(pattern.mass[i].column, pattern.mass[i].row) = values[i];
  e.constraint_entries(values.data());
  for (std::size_t i = 0; i < pattern.constraint.size(); ++i)
    j(pattern.constraint[i].row, pattern.constraint[i].column) = values[i];
  const VectorXd masses = eigenvalues_of(m);
  const double of_mass = masses.maxCoeff() / masses.minCoeff();
  if (mechanism.m() == 0) return of_mass;
  const VectorXd s = singular_values_in_mass(m, j);
  return of_mass * std::pow(s.maxCoeff() / s.minCoeff(), 2);
}

struct Worst {
  double error = 0;
  int tried = 0;
};

/// Every call of both solvers at one random state, errors over what rounding may do.
void compare(const Mechanism& mechanism, RandomTree& random, Worst& worst) {
  const TreeState s = random.state(mechanism.tree());
  const auto e = mechanism.evaluation<double>(), other = mechanism.evaluation<double>();
  e->place(s.t, s.q.data());
  const double allowed = growth(mechanism, *e);
  if (!(allowed < 1e9)) return;
  ++worst.tried;
  const int nv = mechanism.nv(), m = mechanism.m();
  const auto exact = make_assembled_solver(mechanism, *e);
  const auto found = make_maximal_solver(mechanism, *other);
  const VectorXd p = any(random, nv), centre = any(random, m);
  const auto expect_same = [&](const char* what, auto&& call) {
    VectorXd a = VectorXd::Zero(nv), b = a, sa = VectorXd::Zero(m), sb = sa, ra = a, rb = a;
    ASSERT_TRUE(call(*exact, a, sa, ra)) << what;
    ASSERT_TRUE(call(*found, b, sb, rb)) << what;
    const double scale = std::max(
        {1.0, a.cwiseAbs().maxCoeff(), sa.cwiseAbs().size() ? sa.cwiseAbs().maxCoeff() : 0});
    double error = (a - b).cwiseAbs().maxCoeff();
    if (m > 0) error = equations::larger(error, (sa - sb).cwiseAbs().maxCoeff());
    const double rates = (ra - rb).cwiseAbs().maxCoeff() / (1 + ra.cwiseAbs().maxCoeff());
    error = std::max(error / scale, rates) / allowed;
    EXPECT_LT(error, 1e-12) << what;
    worst.error = std::max(worst.error, error);
  };
  for (const bool soft : {false, true}) {
    if (soft && m == 0) break;
    if (soft) {
      const VectorXd c = any(random, m).cwiseAbs();
      exact->soften({c.begin(), c.end()});
      found->soften({c.begin(), c.end()});
    }
    for (LoopSolver* solver : {exact.get(), found.get()}) solver->stabilise(soft ? 0.7 : 0);
    for (const double* around : {static_cast<const double*>(nullptr), centre.data()}) {
      expect_same("momentum", [&](LoopSolver& l, VectorXd& u, VectorXd& sigma, VectorXd& pdot) {
        return l.momentum(s.t, s.q.data(), p.data(), around, fade_evaluation, 0.3, u.data(),
                          sigma.data(), pdot.data());
      });
      expect_same("acceleration", [&](LoopSolver& l, VectorXd& udot, VectorXd& lambda, VectorXd&) {
        return l.acceleration(s.t, s.q.data(), s.u.data(), around, 1.1, 0.4, udot.data(),
                              lambda.data());
      });
    }
  }
  expect_same("position", [&](LoopSolver& l, VectorXd& delta, VectorXd&, VectorXd&) {
    return l.position_correction(s.t, s.q.data(), delta.data());
  });
}

TEST(Maximal, SolvesAsTheAssembledMatrixInSpace) {
  Worst worst;
  for (unsigned seed = 0; seed < 150; ++seed) {
    RandomTree random(seed);
    Scene scene = random.scene({.bodies = 6});
    const LoopSpec first = random_loop(random, scene, loop_kinds[seed % loop_kinds.size()]);
    scene.loops.push_back(first);
    if (seed % 3 == 0) drive_loop(random, scene, first, 1, seed % 2 ? 1 : 0);
    if (seed % 2 == 0) scene.loops.push_back(random_loop(random, scene, LoopKind::distance));
    if (const auto coupler = random_coupler(random, scene); coupler && seed % 5 == 0)
      scene.loops.push_back(*coupler);
    const Mechanism mechanism(scene, {.algebra = Algebra::spatial, .kkt = KktChoice::dense});
    if (mechanism.m() > mechanism.nv()) continue;
    SCOPED_TRACE(seed);
    compare(mechanism, random, worst);
  }
  EXPECT_GT(worst.tried, 40);
  RecordProperty("error", std::to_string(worst.error * 1e16) + "e-16");
}

TEST(Maximal, SolvesAsTheAssembledMatrixInThePlane) {
  Worst worst;
  for (unsigned seed = 0; seed < 150; ++seed) {
    RandomTree random(seed + 1000);
    const TreeRecipe recipe{.bodies = 6};
    Scene scene = random.planar_scene(recipe);
    const Mechanism open(scene);
    ASSERT_TRUE(open.plan().planar);
    for (int i = 0; i < 2; ++i) {
      LoopSpec loop = into_plane(
          random, scene,
          random_loop(
              random, scene,
              planar_loop_kinds[(seed + static_cast<unsigned>(i)) % planar_loop_kinds.size()]),
          open.plan().basis.col(2));
      loop.name += std::to_string(i);
      level(loop, scene, open.tree(), open.plan().basis.col(2));
      scene.loops.push_back(loop);
    }
    const Mechanism mechanism(scene, {.kkt = KktChoice::dense});
    if (mechanism.m() > mechanism.nv()) continue;
    EXPECT_TRUE(mechanism.plan().planar);
    SCOPED_TRACE(seed);
    compare(mechanism, random, worst);
  }
  EXPECT_GT(worst.tried, 30);
  RecordProperty("error", std::to_string(worst.error * 1e16) + "e-16");
}

TEST(Maximal, SolvesTreesAsTheRecursion) {
  double worst = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    RandomTree random(seed + 2000);
    const Mechanism mechanism(seed % 2 ? random.scene({.bodies = 12})
                                       : random.planar_scene({.bodies = 12}));
    if (mechanism.nv() == 0) continue;
    const TreeState s = random.state(mechanism.tree());
    const auto e = mechanism.evaluation<double>();
    VectorXd exact(mechanism.nv()), found(mechanism.nv());
    ASSERT_TRUE(e->open_accelerations(s.t, s.q.data(), s.u.data(), exact.data()));
    e->place(s.t, s.q.data());
    const double allowed = growth(mechanism, *e);
    const auto solver = make_maximal_solver(mechanism, *e);
    ASSERT_TRUE(
        solver->acceleration(s.t, s.q.data(), s.u.data(), nullptr, 0, 0, found.data(), nullptr))
        << seed;
    const double error = relative_error(found, exact) / allowed;
    EXPECT_LT(error, 1e-13) << seed;
    worst = equations::larger(worst, error);
  }
  RecordProperty("error", std::to_string(worst * 1e16) + "e-16");
}

TEST(Maximal, RedundantRowsFadeAsInTheAssembledMatrix) {
  for (const Scene& scene : {bricard(), row_of_four_bars(3, 0.8)}) {
    const Mechanism mechanism(scene, {.algebra = Algebra::spatial, .kkt = KktChoice::dense});
    const Start start = equations::start_of(mechanism);
    const auto e = mechanism.evaluation<double>(), other = mechanism.evaluation<double>();
    const auto exact = make_assembled_solver(mechanism, *e),
               found = make_maximal_solver(mechanism, *other);
    VectorXd a(mechanism.nv()), b(mechanism.nv()), lambda(mechanism.m());
    ASSERT_TRUE(exact->acceleration(0, start.q.data(), start.u.data(), nullptr, 0, 0, a.data(),
                                    lambda.data()));
    ASSERT_TRUE(found->acceleration(0, start.q.data(), start.u.data(), nullptr, 0, 0, b.data(),
                                    lambda.data()));
    EXPECT_GT(exact->faded_rows().size(), 0u);
    EXPECT_EQ(found->faded_rows().size(), exact->faded_rows().size());
    EXPECT_LT(relative_error(b, a), 1e-10);
  }
}

/// A weld of a loop between bodies that slides carry in a plane, whose angle no joint moves; and
/// one between bodies that are welded already. What is left of such rows is rounding.
TEST(Maximal, RowsThatNoJointMovesAreLeftOut) {
  const char* bodies = R"(
gravity = [1.3, -9.81, 0]
[[body]]
name = "a"
mass = 0.7
com = [0.31, 0.17, 0.05]
inertia = [0.021, 0.034, 0.047]
[[body]]
name = "b"
mass = 1.3
com = [-0.23, 0.11, 0.07]
inertia = [0.052, 0.061, 0.073]
[[body]]
name = "c"
mass = 0.9
com = [0.41, -0.13, 0.03]
inertia = [0.013, 0.027, 0.033]
)";
  const char* slides = R"(
[[joint]]
name = "A"
kind = "prismatic"
child = "a"
axis = [0.83, 0.57, 0]
[[joint]]
name = "B"
kind = "prismatic"
child = "b"
axis = [0.83, 0.57, 0]
origin = { parent = [0.9, -0.7, 0] }
[[joint]]
name = "C"
kind = "revolute"
parent = "b"
child = "c"
axis = [0, 0, 1]
origin = { parent = [0.37, 0.29, 0] }
velocity = 1.7
[[loop]]
name = "L"
kind = "weld"
parent = "a"
child = "b"
origin = { parent = [0.9, -0.7, 0] }
)";
  const char* welds = R"(
[[joint]]
name = "A"
kind = "universal"
child = "a"
axis = [0.36, 0.92, 0.14]
axis2 = [0.93, 0.04, -0.34]
velocity = [0.9, -0.4]
[[joint]]
name = "B"
kind = "weld"
parent = "a"
child = "b"
origin = { parent = [0.17, -0.53, 0.29] }
[[joint]]
name = "C"
kind = "revolute"
parent = "b"
child = "c"
axis = [0.73, 0.17, -0.66]
origin = { parent = [-0.21, 0.38, 0.4] }
velocity = 1.7
[[loop]]
name = "L"
kind = "weld"
parent = "a"
child = "b"
origin = { parent = [0.54, -0.14, 0.71], child = [0.37, 0.39, 0.42] }
)";
  for (const char* rest : {slides, welds}) {
    const Mechanism mechanism(parse_scene(std::string(bodies) + rest));
    const auto e = mechanism.evaluation<double>(), other = mechanism.evaluation<double>();
    const auto exact = make_assembled_solver(mechanism, *e);
    const auto found = make_maximal_solver(mechanism, *other);
    const VectorXd q = mechanism.tree().q0, u = mechanism.tree().u0;
    VectorXd expected(mechanism.nv()), udot(mechanism.nv()), lambda(mechanism.m());
    ASSERT_TRUE(
        exact->acceleration(0, q.data(), u.data(), nullptr, 0, 0, expected.data(), lambda.data()));
    ASSERT_TRUE(
        found->acceleration(0, q.data(), u.data(), nullptr, 0, 0, udot.data(), lambda.data()));
    EXPECT_GT(expected.cwiseAbs().maxCoeff(), 1);
    EXPECT_LT(relative_error(udot, expected), 1e-11) << rest;
    EXPECT_LT(lambda.cwiseAbs().maxCoeff(), 1e3) << rest;
    EXPECT_EQ(found->faded_rows().size(), exact->faded_rows().size()) << rest;
  }
}

TEST(Maximal, SaysWhichJointHasNothingToMove) {
  Scene scene = row_of_four_bars(1, 1.1);
  scene.bodies.push_back(scene.bodies.front());
  scene.bodies.back().name = "ghost";
  scene.bodies.back().mass = 0;
  scene.bodies.back().inertia.setZero();
  scene.joints.push_back(hinge("G", "level0", "ghost", {1, 0, 0}, 0.2));
  try {
    const Mechanism mechanism(scene, {.kkt = KktChoice::dense});
    const auto e = mechanism.evaluation<double>();
    const auto solver = make_maximal_solver(mechanism, *e);
    VectorXd udot(mechanism.nv()), lambda(mechanism.m());
    const VectorXd u = VectorXd::Zero(mechanism.nv());
    EXPECT_FALSE(solver->acceleration(0, mechanism.tree().q0.data(), u.data(), nullptr, 0, 0,
                                      udot.data(), lambda.data()));
    ASSERT_GE(solver->singular_joint(), 0);
    EXPECT_NE(
        momenta::no_inertia(mechanism, solver->singular_joint(), 0, mechanism.tree().q0.data())
            .find("ghost"),
        std::string::npos);
  } catch (const SceneError& e) {
    EXPECT_NE(std::string(e.what()).find("ghost"), std::string::npos) << e.what();
  }
}

TEST(Maximal, CostOfAChainGrowsWithItsLength) {
  const auto best_of = [](int n) {
    Scene scene;
    scene.gravity = {0, -9.81, 0};
    for (int i = 0; i < n; ++i) {
      scene.bodies.push_back(rod("b" + std::to_string(i), 0.1));
      JointSpec j = hinge("j" + std::to_string(i), i == 0 ? "ground" : "b" + std::to_string(i - 1),
                          "b" + std::to_string(i), {i == 0 ? 0.0 : 1.0, 0, 0}, 0.3);
      j.axis = i % 2 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ();
      scene.joints.push_back(j);
    }
    const Mechanism mechanism(scene);
    const auto e = mechanism.evaluation<double>();
    const auto solver = make_maximal_solver(mechanism, *e);
    const VectorXd u = VectorXd::Zero(n);
    VectorXd udot(n);
    double best = 1e9;
    for (int repeat = 0; repeat < 40; ++repeat) {
      const auto begin = std::chrono::steady_clock::now();
      solver->acceleration(0, mechanism.tree().q0.data(), u.data(), nullptr, 0, 0, udot.data(),
                           nullptr);
      best = std::min(
          best, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    }
    EXPECT_TRUE(udot.allFinite());
    return best;
  };
  // Eightfold for eight times the bodies; the dense matrix of M alone would be 512-fold. Clocks of
  // machines with other work to do are asked for no more than less than the square.
  EXPECT_LT(best_of(800), 64 * best_of(100));
}

}  // namespace
}  // namespace momenta::dae_maximal
