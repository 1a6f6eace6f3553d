// Augmented Lagrangians and position stabilisation in the solvers of (7) and (3), against what the
// literature writes: (M + Φ_qᵀ α Φ_q) assembled and solved in longer arithmetic, two iterations;
// and the choice of independent coordinates against its definition.

#include "equations/decompositions.h"
#include "equations/linkages.h"
#include "equations/random_loops.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/kernel/model.h>
#include <momenta/dae/kkt/coordinate_split.h>
#include <momenta/dae/kkt/loop_solver.h>

#include <Eigen/Dense>

namespace momenta::dae_softened_loops {
namespace {

using namespace equations;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Real = long double;
using RealMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using RealVector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

VectorXd any(RandomTree& random, int size) {
  VectorXd v(size);
  for (double& x : v) x = random.uniform(-2, 2);
  return v;
}

/// One mechanism at one state, everything assembled.
struct Assembled {
  RealMatrix M, J;
  RealVector phi, phi_rate, prescribed, force, bias;  ///< prescribed: of M u; force: −(bias − Q)
  RealVector drift_rate;                              ///< Φ_t

  Assembled(const Mechanism& mechanism, Evaluation<double>& e, const TreeState& s)
      : M(RealMatrix::Zero(mechanism.nv(), mechanism.nv())),
        J(RealMatrix::Zero(mechanism.m(), mechanism.nv())) {
    const auto& pattern = mechanism.kkt_pattern();
    std::vector<double> values(std::max(pattern.mass.size(), pattern.constraint.size()));
    e.place(s.t, s.q.data());
    e.mass_entries(values.data());
    for (std::size_t i = 0; i < pattern.mass.size(); ++i)
      M(pattern.mass[i].row, pattern.mass[i].column) =
          M(pattern.mass[i].column, pattern.mass[i].row) = values[i];
    e.constraint_entries(values.data());
    for (std::size_t i = 0; i < pattern.constraint.size(); ++i)
      J(pattern.constraint[i].row, pattern.constraint[i].column) = values[i];
    VectorXd rows(mechanism.m()), joints(mechanism.nv());
    e.positions(rows.data());
    phi = rows.cast<Real>();
    e.move(nullptr);
    e.momenta(nullptr, joints.data());
    prescribed = joints.cast<Real>();
    e.velocities(rows.data());
    drift_rate = rows.cast<Real>();
    e.move(s.u.data());
    e.velocities(rows.data());
    phi_rate = rows.cast<Real>();
    e.joint_forces(s.q.data(), s.u.data(), nullptr, nullptr, joints.data());
    force = -joints.cast<Real>();
    e.accelerations(rows.data());
    bias = rows.cast<Real>();
  }
};

Scene looped(RandomTree& random, unsigned seed, bool planar) {
  Scene scene = planar ? random.planar_scene({.bodies = 8}) : random.scene({.bodies = 7});
  if (!planar) {
    scene.loops.push_back(random_loop(random, scene, loop_kinds[seed % loop_kinds.size()]));
    scene.loops.push_back(random_loop(random, scene, LoopKind::point));
    return scene;
  }
  const Tree tree = build_tree(scene);
  const auto plane = find_plane(tree, scene);
  const Eigen::Vector3d normal = plane.basis->col(2);
  for (unsigned i = 0; i < 2; ++i) {
    LoopSpec l = into_plane(
        random, scene,
        random_loop(random, scene, planar_loop_kinds[(seed + i) % planar_loop_kinds.size()]),
        normal);
    level(l, scene, tree, normal);
    scene.loops.push_back(l);
  }
  return scene;
}

TEST(SoftenedLoops, AreThePenaltyEquationsOfTheLiterature) {
  double worst_u = 0, worst_udot = 0, worst_sigma = 0;
  int tried = 0;
  for (unsigned seed = 0; seed < 160; ++seed)
    for (const auto kkt : {KktChoice::automatic, KktChoice::dense, KktChoice::sparse}) {
      RandomTree random(seed);
      const Scene scene = looped(random, seed, seed % 2 == 1);
      const Mechanism mechanism(scene, {.kkt = kkt});
      if (mechanism.m() > mechanism.nv()) continue;
      const TreeState s = random.state(mechanism.tree());
      const auto e = mechanism.evaluation<double>();
      const Assembled a(mechanism, *e, s);
      const int n = mechanism.nv(), m = mechanism.m();
      const VectorXd p = any(random, n), centre = any(random, m);
      VectorXd compliance(m);
      for (int i = 0; i < m; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const bool begins = i == 0 || mechanism.row_groups()[at] != mechanism.row_groups()[at - 1];
        compliance[i] = begins ? std::pow(10.0, random.uniform(-3, 0)) : compliance[i - 1];
      }
      const double beta = 0.7, alpha = 0.3, omega = 0.4;
      const auto solver = make_loop_solver(mechanism, *e);
      solver->stabilise(beta);
      solver->soften({compliance.begin(), compliance.end()});

      const RealVector penalty = compliance.cast<Real>().cwiseInverse();
      const RealMatrix K = a.M + a.J.transpose() * penalty.asDiagonal() * a.J;
      const auto factor = K.llt();
      // Canonical form: K u = p − prescribed − Φ_qᵀ(σ₀ + α (Φ_t + βΦ)).
      const RealVector gap = a.drift_rate + Real(beta) * a.phi;
      const RealVector weighed = penalty.cwiseProduct(gap);
      const RealVector rates = factor.solve(p.cast<Real>() - a.prescribed -
                                            a.J.transpose() * (centre.cast<Real>() + weighed));
      const RealVector impulses =
          centre.cast<Real>() + penalty.cwiseProduct(RealVector(a.J * rates + gap));
      // Acceleration form: K u̇ = force − Φ_qᵀ(λ₀ + α (bias + 2αΦ̇ + ω²Φ)).
      const RealVector feedback =
          a.bias + Real(2 * alpha) * a.phi_rate + Real(omega * omega) * a.phi;
      const RealVector forced = penalty.cwiseProduct(feedback);
      const RealVector accelerations =
          factor.solve(a.force - a.J.transpose() * (centre.cast<Real>() + forced));

      VectorXd u(n), sigma(m), pdot(n), udot(n), lambda(m);
      ASSERT_TRUE(solver->momentum(s.t, s.q.data(), p.data(), centre.data(), fade_evaluation, 0.5,
                                   u.data(), sigma.data(), pdot.data()));
      ASSERT_TRUE(solver->acceleration(s.t, s.q.data(), s.u.data(), centre.data(), alpha, omega,
                                       udot.data(), lambda.data()));
      ++tried;
      const VectorXd masses = eigenvalues_of(K.cast<double>());
      const double growth = masses.maxCoeff() / masses.minCoeff();
      const auto note = [&](double& to, const VectorXd& found, const RealVector& exact) {
        to = equations::larger(
            to, over_growth(relative_error(found, VectorXd(exact.cast<double>())), growth, 1e6));
      };
      note(worst_u, u, rates);
      // Along what no joint moves σ is the centre's: it acts on nothing.
      const MatrixXd J = a.J.cast<double>();
      if (Eigen::FullPivLU<MatrixXd>(J).rank() == m)
        note(worst_sigma, sigma, impulses);
      else
        note(worst_sigma, J.transpose() * sigma, RealVector(a.J.transpose() * impulses));
      note(worst_udot, udot, accelerations);
      EXPECT_TRUE(solver->faded_rows().empty());
    }
  EXPECT_GT(tried, 300);
  EXPECT_LT(worst_u, algebra_tol(8));
  EXPECT_LT(worst_sigma, algebra_tol(8));
  EXPECT_LT(worst_udot, algebra_tol(8));
}

TEST(SoftenedLoops, IterationsContractAsOneOverThePenalty) {
  // What an iteration leaves of Φ_q u + Φ_t is (σₖ₊₁ − σₖ)/α; each takes 1/(1 + αW) of the last.
  const Mechanism mechanism(row_of_four_bars(3, 1.1, 1));
  const auto e = mechanism.evaluation<double>();
  const auto solver = make_loop_solver(mechanism, *e);
  const double c = 1e-3;
  solver->soften(std::vector<double>(static_cast<std::size_t>(mechanism.m()), c));
  RandomTree random(3);
  const VectorXd q = mechanism.tree().q0, p = any(random, mechanism.nv());
  VectorXd sigma = VectorXd::Zero(mechanism.m()), next(mechanism.m()), u(mechanism.nv()),
           rate(mechanism.m());
  const Assembled a(mechanism, *e, {0, q, mechanism.tree().u0});
  const RealMatrix W = a.J * a.M.llt().solve(RealMatrix(a.J.transpose()));
  const double slowest = c / (c + eigenvalues_of(W.cast<double>()).minCoeff());
  double before = 0;
  for (int k = 0; k < 4; ++k) {
    ASSERT_TRUE(solver->momentum(0, q.data(), p.data(), sigma.data(), 0, 0, u.data(), next.data(),
                                 nullptr));
    e->place(0, q.data());
    e->move(u.data());
    e->velocities(rate.data());
    EXPECT_LT((rate - c * (next - sigma)).cwiseAbs().maxCoeff(), 1e-13);
    if (k > 0 && before > 1e-10) {
      EXPECT_LT(rate.norm(), 1.0001 * slowest * before);
    }
    before = rate.norm();
    sigma = next;
  }
  EXPECT_LT(before, 1e-4);
}

TEST(StabilisedRows, FallBackToTheManifold) {
  // Φ_q u = −Φ_t − βΦ by every solver, and the same u.
  for (unsigned seed = 0; seed < 60; ++seed) {
    RandomTree random(seed);
    const Scene scene = looped(random, seed, seed % 2 == 1);
    const TreeState s = random.state(build_tree(scene));
    VectorXd first;
    for (const auto kkt : {KktChoice::automatic, KktChoice::dense, KktChoice::sparse}) {
      const Mechanism mechanism(scene, {.kkt = kkt});
      if (mechanism.m() > mechanism.nv()) break;
      const auto e = mechanism.evaluation<double>();
      const Assembled a(mechanism, *e, s);
      const VectorXd values =
          MatrixXd(a.M.llt().matrixL().solve(RealMatrix(a.J.transpose())).cast<double>())
              .jacobiSvd()
              .singularValues();
      if (!(values.minCoeff() > 1e-2 * values.maxCoeff())) break;
      const auto solver = make_loop_solver(mechanism, *e);
      solver->stabilise(3);
      RandomTree same(seed + 1000);
      const VectorXd p = any(same, mechanism.nv());
      VectorXd u(mechanism.nv()), sigma(mechanism.m()), rate(mechanism.m()), phi(mechanism.m());
      ASSERT_TRUE(solver->momentum(s.t, s.q.data(), p.data(), nullptr, fade_evaluation, 0, u.data(),
                                   sigma.data(), nullptr));
      e->place(s.t, s.q.data());
      e->positions(phi.data());
      e->move(u.data());
      e->velocities(rate.data());
      const double scale = 1 + 3 * phi.cwiseAbs().maxCoeff() + u.cwiseAbs().maxCoeff();
      EXPECT_LT((rate + 3 * phi).cwiseAbs().maxCoeff(), 1e-10 * scale) << seed;
      if (first.size() == 0) first = u;
      EXPECT_LT(relative_error(u, first), 1e-9) << seed;
    }
  }
}

/// A random matrix of given rank as entries in full.
std::vector<double> of_rank(RandomTree& random, int rows, int columns, int rank) {
  MatrixXd left(rows, rank), right(rank, columns);
  for (double& x : left.reshaped()) x = random.uniform(-1, 1);
  for (double& x : right.reshaped()) x = random.uniform(-1, 1);
  const MatrixXd a = left * right;
  std::vector<double> values;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) values.push_back(a(i, j));
  return values;
}

TEST(CoordinateSplit, SolvesForDependentColumnsWhateverTheRank) {
  for (const auto& [rows, columns, rank] :
       {std::tuple{5, 7, 5}, std::tuple{6, 9, 4}, std::tuple{3, 3, 3}, std::tuple{60, 63, 55},
        std::tuple{4, 6, 0}}) {
    RandomTree random(static_cast<unsigned>(rows));
    std::vector<KktPattern::Entry> pattern;
    for (int i = 0; i < rows; ++i)
      for (int j = 0; j < columns; ++j) pattern.push_back({i, j});
    CoordinateSplit split(pattern, rows, VectorXd::LinSpaced(columns, 0.5, 2));
    const auto values = of_rank(random, rows, columns, rank);
    ASSERT_TRUE(split.choose(values));
    EXPECT_EQ(split.rank(), rank);
    EXPECT_EQ(split.independent().size(), static_cast<std::size_t>(columns - rank));
    EXPECT_FALSE(split.choose(values, rank + 1));
    ASSERT_TRUE(split.choose(values, rank));
    SplitFactor factor(split);
    ASSERT_TRUE(factor.factor(values));
    // A x = 0 with any independent part.
    const MatrixXd a =
        Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
            values.data(), rows, columns);
    VectorXd x = VectorXd::Zero(columns), dependent(rank);
    for (const int j : split.independent()) x[j] = random.uniform(-1, 1);
    factor.solve(a * x, dependent);
    for (int k = 0; k < rank; ++k)
      x[split.dependent()[static_cast<std::size_t>(k)]] -= dependent[k];
    EXPECT_LT((a * x).cwiseAbs().maxCoeff(), 1e-11 * columns) << rows;
    // Full pivoting leaves no slope large.
    EXPECT_LT(factor.growth(values), 20) << rows;
  }
}

}  // namespace
}  // namespace momenta::dae_softened_loops
