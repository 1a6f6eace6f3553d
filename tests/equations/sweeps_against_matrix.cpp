#include "equations/sweeps_against_matrix.h"
#include "equations/decompositions.h"

#include "equations/kkt_blocks.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/kkt/sweeps/levels/loop_sweeps.h>

#include <Eigen/Dense>

namespace momenta::equations {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Condition of M and of Φ_q M^(−1/2) at one configuration.
struct Conditions {
  double of_mass = 1, of_loops = 1;
};
Conditions conditions(const Mechanism& mechanism, Evaluation<double>& e) {
  const auto [M, J] = KktBlocks(mechanism, e);
  const VectorXd masses = eigenvalues_of(M);
  const VectorXd loops = singular_values_in_mass(M, J);
  return {masses.maxCoeff() / masses.minCoeff(),
          loops.size() > 0 && loops.minCoeff() > 0 ? loops.maxCoeff() / loops.minCoeff() : 1e300};
}

}  // namespace

Result solved(LoopSolver& solver, const Mechanism& mechanism, const TreeState& s, const VectorXd& p,
              const VectorXd& centre) {
  const int nv = mechanism.nv(), m = mechanism.m();
  Result r{VectorXd(nv), VectorXd(m), VectorXd(nv), VectorXd(nv), VectorXd(m), VectorXd(nv)};
  EXPECT_TRUE(solver.momentum(s.t, s.q.data(), p.data(), centre.data(), fade_evaluation, 0.7,
                              r.u.data(), r.sigma.data(), r.pdot.data()));
  EXPECT_TRUE(solver.acceleration(s.t, s.q.data(), s.u.data(), centre.data(), 0.3, 0.4,
                                  r.udot.data(), r.lambda.data()));
  EXPECT_TRUE(solver.position_correction(s.t, s.q.data(), r.delta.data()));
  return r;
}

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
  if (mechanism.solver().kkt() != KktChoice::sweeps) return;
  ++worst.tried;
  worst.anew += mechanism.solver().pairs_anew();
  VectorXd p(twin.nv()), centre(twin.m());
  for (double& x : p) x = random.uniform(-2, 2);
  for (double& x : centre) x = random.uniform(-2, 2);
  const auto own = mechanism.evaluation<double>();
  const auto sweeps = make_sweep_solver(mechanism, *own);
  const auto assembled = make_assembled_solver(twin, *e);
  const Result a = solved(*sweeps, mechanism, s, p, centre),
               b = solved(*assembled, twin, s, p, centre);
  const double growth = std::sqrt(c.of_mass) * c.of_loops * c.of_loops;
  const auto note = [&](double& to, const VectorXd& x, const VectorXd& y) {
    to = larger(to, over_growth(relative_error(x, y), growth, 1e6));
  };
  note(worst.u, a.u, b.u);
  note(worst.sigma, a.sigma, b.sigma);
  note(worst.pdot, a.pdot, b.pdot);
  note(worst.udot, a.udot, b.udot);
  note(worst.lambda, a.lambda, b.lambda);
  note(worst.delta, a.delta, b.delta);
  MechanismOptions assembled_sparse = options;
  assembled_sparse.kkt = KktChoice::sparse;
  const Mechanism third(scene, assembled_sparse);
  const auto third_e = third.evaluation<double>();
  const Result f = solved(*make_assembled_solver(third, *third_e), third, s, p, centre);
  note(worst.sparse, f.u, a.u);
  note(worst.sparse, f.pdot, a.pdot);
  note(worst.sparse, f.udot, a.udot);
}

void expect_rounding(const Worst& w, int bodies) {
  const double tolerance = algebra_tol(bodies);
  EXPECT_LT(w.u, tolerance);
  EXPECT_LT(w.sigma, tolerance);
  EXPECT_LT(w.pdot, tolerance);
  EXPECT_LT(w.udot, tolerance);
  EXPECT_LT(w.lambda, tolerance);
  EXPECT_LT(w.delta, tolerance);
  EXPECT_LT(w.sparse, 1e-12);  // its block −ε is 1e-10 of the scale, refined once
}

int compare_batches(const Mechanism& mechanism, RandomTree& random, int count) {
  int compared = 0;
  const int nq = mechanism.nq(), nv = mechanism.nv(), m = mechanism.m();
  using States = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  States q(nq, count), p(nv, count), u(nv, count), pdot(nv, count), sigma(m, count);
  for (int i = 0; i < count; ++i) {
    q.col(i) = random.state(mechanism.tree()).q;
    for (int k = 0; k < nv; ++k) p(k, i) = random.uniform(-2, 2);
  }
  RightSide<double> right;
  right.fade = fade_evaluation;
  right.leak = 0.5;
  right.rates = true;
  for (const int level : {1, 3, 4}) {
    if (level_at_most(level) != level) continue;
    const auto sweeps = mechanism.solver().sweeps(level);
    EXPECT_TRUE(sweeps->momentum(0,
                                 {q.data(), p.data(), u.data(), sigma.data(), pdot.data(), count,
                                  static_cast<std::size_t>(count)},
                                 right.fade, right.leak));
    for (int i = 0; i < count; ++i) {
      const VectorXd qi = q.col(i), pi = p.col(i);
      VectorXd ui(nv), si(m), ri(nv);
      EXPECT_TRUE(
          sweeps->momentum(0, qi.data(), pi.data(), right, ui.data(), si.data(), ri.data()));
      std::vector<int> faded(static_cast<std::size_t>(m));
      if (sweeps->faded_rows(faded.data(), true) > 0) continue;  // which row gives way is open
      if (sweeps->pivots(true).weakest < 1e3) continue;  // fades by more than rounding: (τ/w)⁴
      ++compared;
      const double size = 1 + si.cwiseAbs().maxCoeff() + ui.cwiseAbs().maxCoeff();
      EXPECT_LT(relative_error(VectorXd(u.col(i)), ui), 1e-10 * size) << level;
      EXPECT_LT(relative_error(VectorXd(sigma.col(i)), si), 1e-9 * size) << level;
      EXPECT_LT(relative_error(VectorXd(pdot.col(i)), ri), 1e-9 * size) << level;
    }
  }
  return compared;
}

}  // namespace momenta::equations
