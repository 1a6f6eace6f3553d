// Loops carried by the sweeps against the assembled matrix: momentum and acceleration form, position
// correction, every joint and loop kind, open and closed loops, in the plane and in space, at every
// instruction level.

#include "equations/linkages.h"
#include "equations/random_loops.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/dae/kkt/assembled_solver.h>
#include <momenta/dae/sweeps/sweep_solver.h>

#include <Eigen/Dense>

namespace momenta {
namespace {

using namespace equations;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Condition of M and of Φ_q M^(−1/2) at one configuration.
struct Conditions {
  double of_mass = 1, of_loops = 1;
};
Conditions conditions(const Mechanism& mechanism, Evaluation<double>& e) {
  const auto& pattern = mechanism.kkt_pattern();
  std::vector<double> values(std::max(pattern.mass.size(), pattern.constraint.size()));
  MatrixXd M = MatrixXd::Zero(mechanism.nv(), mechanism.nv()),
           J = MatrixXd::Zero(mechanism.m(), mechanism.nv());
  e.mass_entries(values.data());
  for (std::size_t i = 0; i < pattern.mass.size(); ++i)
    M(pattern.mass[i].row, pattern.mass[i].column) =
        M(pattern.mass[i].column, pattern.mass[i].row) = values[i];
  e.constraint_entries(values.data());
  for (std::size_t i = 0; i < pattern.constraint.size(); ++i)
    J(pattern.constraint[i].row, pattern.constraint[i].column) = values[i];
  const VectorXd masses = M.selfadjointView<Eigen::Lower>().eigenvalues();
  const VectorXd loops = MatrixXd(M.llt().matrixL().solve(J.transpose())).jacobiSvd().singularValues();
  return {masses.maxCoeff() / masses.minCoeff(),
          loops.size() > 0 && loops.minCoeff() > 0 ? loops.maxCoeff() / loops.minCoeff() : 1e300};
}

struct Result {
  VectorXd u, sigma, pdot, udot, lambda, delta;
};
Result solved(LoopSolver& solver, const Mechanism& mechanism, const TreeState& s,
              const VectorXd& p, const VectorXd& centre) {
  const int nv = mechanism.nv(), m = mechanism.m();
  Result r{VectorXd(nv), VectorXd(m), VectorXd(nv), VectorXd(nv), VectorXd(m), VectorXd(nv)};
  EXPECT_TRUE(solver.momentum(s.t, s.q.data(), p.data(), centre.data(), fade_evaluation, 0.7,
                              r.u.data(), r.sigma.data(), r.pdot.data()));
  EXPECT_TRUE(solver.acceleration(s.t, s.q.data(), s.u.data(), centre.data(), 0.3, 0.4,
                                  r.udot.data(), r.lambda.data()));
  EXPECT_TRUE(solver.position_correction(s.t, s.q.data(), r.delta.data()));
  return r;
}

/// Largest differences over the growth that rounding must have, by what differs.
struct Worst {
  double u = 0, sigma = 0, pdot = 0, udot = 0, lambda = 0, delta = 0;
  int tried = 0;
};
void compare(const Scene& scene, RandomTree& random, const MechanismOptions& options,
             Worst& worst) {
  MechanismOptions dense = options;
  dense.kkt = KktChoice::dense;
  const Mechanism twin(scene, dense);
  if (twin.m() > twin.nv()) return;
  const TreeState s = random.state(twin.tree());
  const auto e = twin.evaluation<double>();
  e->place(s.t, s.q.data());
  const Conditions c = conditions(twin, *e);
  if (!(c.of_loops < 100)) return;
  const Mechanism mechanism(scene, options);
  if (mechanism.kkt() != KktChoice::sweeps) return;
  ++worst.tried;
  VectorXd p(twin.nv()), centre(twin.m());
  for (double& x : p) x = random.uniform(-2, 2);
  for (double& x : centre) x = random.uniform(-2, 2);
  const auto own = mechanism.evaluation<double>();
  const auto sweeps = make_sweep_solver(mechanism, *own);
  const auto assembled = make_assembled_solver(twin, *e);
  const Result a = solved(*sweeps, mechanism, s, p, centre), b = solved(*assembled, twin, s, p, centre);
  const double growth = std::sqrt(c.of_mass) * c.of_loops * c.of_loops;
  const auto note = [&](double& to, const VectorXd& x, const VectorXd& y) {
    to = std::max(to, relative_error(x, y) / growth);
  };
  note(worst.u, a.u, b.u);
  note(worst.sigma, a.sigma, b.sigma);
  note(worst.pdot, a.pdot, b.pdot);
  note(worst.udot, a.udot, b.udot);
  note(worst.lambda, a.lambda, b.lambda);
  note(worst.delta, a.delta, b.delta);
}

void expect_rounding(const Worst& w, int bodies) {
  const double tolerance = algebra_tol(bodies);
  std::cerr << w.tried << " " << w.u << " " << w.sigma << " " << w.pdot << " " << w.udot << " " << w.lambda << " " << w.delta << "\n";
  EXPECT_LT(w.u, tolerance);
  EXPECT_LT(w.sigma, tolerance);
  EXPECT_LT(w.pdot, tolerance);
  EXPECT_LT(w.udot, tolerance);
  EXPECT_LT(w.lambda, tolerance);
  EXPECT_LT(w.delta, tolerance);
}

TEST(LoopSweeps, AgreeWithTheAssembledMatrixInSpace) {
  Worst worst;
  for (unsigned seed = 0; seed < 300; ++seed) {
    RandomTree random(seed);
    Scene scene = random.scene({.bodies = 8});
    scene.loops.push_back(random_loop(random, scene, loop_kinds[seed % loop_kinds.size()]));
    if (seed % 3 > 0) scene.loops.push_back(random_loop(random, scene, LoopKind::point));
    if (seed % 3 > 1) scene.loops.push_back(random_loop(random, scene, LoopKind::distance));
    compare(scene, random, {.algebra = Algebra::spatial}, worst);
  }
  EXPECT_GT(worst.tried, 80);
  expect_rounding(worst, 8);
}

TEST(LoopSweeps, AgreeWithTheAssembledMatrixInThePlane) {
  Worst worst;
  for (unsigned seed = 0; seed < 300; ++seed) {
    RandomTree random(seed);
    Scene scene = random.planar_scene({.bodies = 10});
    const Tree tree = build_tree(scene);
    const auto plane = find_plane(tree, scene);
    ASSERT_TRUE(plane.basis) << seed << ": " << plane.why;
    const Eigen::Vector3d normal = plane.basis->col(2);
    for (unsigned i = 0; i < 1 + seed % 3; ++i) {
      LoopSpec l = into_plane(
          random, scene, random_loop(random, scene, loop_kinds[(seed + i) % loop_kinds.size()]),
          normal);
      level(l, scene, tree, normal);
      scene.loops.push_back(l);
    }
    compare(scene, random, {.algebra = Algebra::planar}, worst);
  }
  EXPECT_GT(worst.tried, 80);
  expect_rounding(worst, 10);
}

}  // namespace
}  // namespace momenta
