// The solvers of (7) against dense factorisations in longer arithmetic: regular systems, redundant
// rows, nearly singular poses in every orientation.

#include "equations/decompositions.h"
#include "equations/kkt_blocks.h"
#include "equations/large_scenes.h"
#include "equations/linkages.h"
#include "equations/random_loops.h"
#include "equations/sweeps_against_matrix.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/dae/kkt/body_matrix.h>
#include <momenta/dae/kkt/kkt.h>
#include <momenta/dae/kkt/klu_solver.h>
#include <momenta/dae/kkt/solver_choice.h>

#include <Eigen/Dense>

namespace momenta::dae_kkt {
namespace {

using namespace equations;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Real = long double;
using RealMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using RealVector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

/// (7) as it stands at one configuration.
struct Assembled : KktBlocks {
  using KktBlocks::KktBlocks;
  MatrixXd matrix() const {
    const auto n = M.rows(), m = J.rows();
    MatrixXd a = MatrixXd::Zero(n + m, n + m);
    a.topLeftCorner(n, n) = M;
    a.bottomLeftCorner(m, n) = J;
    a.topRightCorner(n, m) = J.transpose();
    return a;
  }
  /// Singular values of Φ_q M^(−1/2).
  VectorXd singular_values() const { return singular_values_in_mass(M, J); }
};

struct Solution {
  VectorXd u, sigma;
  bool done = false;
  int faded = 0;
};
Solution solve(Kkt& kkt, Evaluation<double>& e, double t, const VectorXd& q, const VectorXd& r,
               const VectorXd& g, double fade, const VectorXd& centre = {}) {
  Solution s{VectorXd(r.size()), VectorXd(g.size())};
  s.done = kkt.factor(e, t, q.data(), fade) &&
           kkt.solve(r.data(), g.data(), centre.size() > 0 ? centre.data() : nullptr, s.u.data(),
                     s.sigma.data());
  s.faded = kkt.faded();
  return s;
}

VectorXd any(RandomTree& random, int size) {
  VectorXd v(size);
  for (double& x : v) x = random.uniform(-2, 2);
  return v;
}

TEST(Kkt, RegularSystemsAgreeWithDenseLu) {
  double worst_dense = 0, worst_sparse = 0, worst_fronts = 0, worst_klu = 0, worst_centre = 0;
  int tried = 0;
  for (unsigned seed = 0; seed < 150; ++seed) {
    RandomTree random(seed);
    Scene scene = random.scene({.bodies = 8});
    const auto kind = loop_kinds[seed % loop_kinds.size()];
    scene.loops.push_back(random_loop(random, scene, kind));
    scene.loops.push_back(random_loop(random, scene, LoopKind::point));
    if (seed % 3 == 0)
      if (const auto coupler = random_coupler(random, scene)) scene.loops.push_back(*coupler);
    const Mechanism mechanism(scene);
    if (mechanism.m() > mechanism.nv()) continue;
    const TreeState s = random.state(mechanism.tree());
    const auto e = mechanism.evaluation<double>();
    e->place(s.t, s.q.data());
    const Assembled a(mechanism, *e);
    const VectorXd values = a.singular_values();
    if (!(values.minCoeff() > 1e-2 * values.maxCoeff())) continue;  // none moves: all are zero
    ++tried;
    const VectorXd r = any(random, mechanism.nv()), g = any(random, mechanism.m());
    VectorXd b(r.size() + g.size());
    b << r, g;
    const RealVector exact = a.matrix().cast<Real>().fullPivLu().solve(b.cast<Real>());
    const VectorXd u = exact.head(r.size()).cast<double>(),
                   sigma = exact.tail(g.size()).cast<double>();
    // Rounding moves the answer by the condition of M and of Φ_q M^(−1/2), squared in σ.
    const VectorXd masses = eigenvalues_of(a.M);
    const double growth = std::sqrt(masses.maxCoeff() / masses.minCoeff()) *
                          std::pow(values.maxCoeff() / values.minCoeff(), 2);
    const double scale =
        std::max(1.0, std::max(u.cwiseAbs().maxCoeff(), sigma.cwiseAbs().maxCoeff()));
    const auto error = [&](const Solution& found) {
      EXPECT_TRUE(found.done);
      return over_growth(
          std::max(relative_error(found.u, u, scale), relative_error(found.sigma, sigma, scale)),
          growth, 1e6);
    };
    const auto dense = make_dense_kkt(mechanism), sparse = make_sparse_kkt(mechanism);
    const Solution plain = solve(*dense, *e, s.t, s.q, r, g, fade_evaluation);
    EXPECT_EQ(plain.faded, 0);
    worst_dense = equations::larger(worst_dense, error(plain));
    worst_sparse =
        std::max(worst_sparse, error(solve(*sparse, *e, s.t, s.q, r, g, fade_evaluation)));
    // Where nothing fades the centre is of no consequence.
    const VectorXd centre = any(random, mechanism.m());
    worst_centre =
        std::max(worst_centre, error(solve(*dense, *e, s.t, s.q, r, g, fade_evaluation, centre)));
    worst_sparse =
        std::max(worst_sparse, error(solve(*sparse, *e, s.t, s.q, r, g, fade_evaluation, centre)));
    const auto fronts = make_front_kkt(mechanism);
    for (const VectorXd& towards : {VectorXd(), centre}) {
      const Solution found = solve(*fronts, *e, s.t, s.q, r, g, fade_evaluation, towards);
      EXPECT_EQ(found.faded, 0);
      worst_fronts = equations::larger(worst_fronts, error(found));
    }
    // Pivots sought among all unknowns, of the joints or of the bodies.
    for (const auto& make : {make_klu_kkt, make_body_kkt}) {
      const auto kkt = make(mechanism);
      worst_klu =
          equations::larger(worst_klu, error(solve(*kkt, *e, s.t, s.q, r, g, fade_evaluation)));
      worst_klu =
          std::max(worst_klu, error(solve(*kkt, *e, s.t, s.q, r, g, fade_evaluation, centre)));
    }
  }
  EXPECT_GT(tried, 30);
  RecordProperty("dense", std::to_string(worst_dense * 1e16) + "e-16");
  RecordProperty("sparse", std::to_string(worst_sparse * 1e16) + "e-16");
  RecordProperty("klu", std::to_string(worst_klu * 1e16) + "e-16");
  EXPECT_LT(worst_dense, algebra_tol(8));
  EXPECT_LT(worst_centre, algebra_tol(8));
  // ε of the sparse form is 1e-12 of the scale of Φ_q M⁻¹ Φ_qᵀ.
  EXPECT_LT(worst_sparse, 1e-12);
  EXPECT_LT(worst_fronts, 1e-12);
  EXPECT_LT(worst_klu, 1e-12);
}

/// u of least squares, min |Φ_q u − g| then min ½ uᵀM u − rᵀu, and the smallest σ for it.
std::pair<VectorXd, VectorXd> least(const Assembled& a, const VectorXd& r, const VectorXd& g) {
  const RealMatrix l = RealMatrix(a.M.cast<Real>().llt().matrixL());
  const RealMatrix jt = l.triangularView<Eigen::Lower>().solve(a.J.cast<Real>().transpose());
  const RealVector y = l.triangularView<Eigen::Lower>().solve(r.cast<Real>());
  Eigen::JacobiSVD<RealMatrix> svd(jt, Eigen::ComputeThinU | Eigen::ComputeThinV);
  svd.setThreshold(1e-9L);
  RealVector z = RealVector::Zero(g.size());  // σ = V S⁻¹ (Uᵀ y − S⁻¹ Vᵀ g)
  const auto rank = svd.rank();
  const auto U = svd.matrixU().leftCols(rank);
  const auto V = svd.matrixV().leftCols(rank);
  const RealVector s = svd.singularValues().head(rank);
  const RealVector inner =
      (U.transpose() * y - (V.transpose() * g.cast<Real>()).cwiseQuotient(s)).cwiseQuotient(s);
  z = V * inner;
  const RealVector u = l.triangularView<Eigen::Lower>().transpose().solve(RealVector(y - jt * z));
  return {u.cast<double>(), z.cast<double>()};
}

void expect_least_squares(const Scene& scene, int rank, RandomTree& random) {
  const Mechanism mechanism(scene, {.algebra = Algebra::spatial});
  const auto e = mechanism.evaluation<double>();
  const VectorXd q = mechanism.tree().q0;
  e->place(0, q.data());
  const Assembled a(mechanism, *e);
  const VectorXd consistent = a.J * any(random, mechanism.nv());
  const VectorXd r = any(random, mechanism.nv()), centre = any(random, mechanism.m());
  const auto [u, sigma] = least(a, r, consistent);
  for (const auto& make :
       {make_dense_kkt, make_sparse_kkt, make_front_kkt, make_klu_kkt, make_body_kkt})
    for (const bool centred : {false, true}) {
      const bool is_dense = make == make_dense_kkt;
      const auto kkt = make(mechanism);
      const Solution found =
          solve(*kkt, *e, 0, q, r, consistent, fade_evaluation, centred ? centre : VectorXd());
      EXPECT_TRUE(found.done);
      EXPECT_LT(relative_error(found.u, u), is_dense ? 2e-14 : 1e-10)
          << (is_dense ? "dense" : "sparse") << (centred ? " centred" : "");
      EXPECT_TRUE(found.sigma.allFinite());
      EXPECT_LT(found.sigma.norm(), 100 * (1 + sigma.norm() + centre.norm()));
      // The same constraint force, whatever the share of each row.
      EXPECT_LT(relative_error(VectorXd(a.J.transpose() * found.sigma),
                               VectorXd(a.J.transpose() * sigma)),
                is_dense ? 1e-13 : 1e-10);
      if (is_dense || make == make_front_kkt) {
        EXPECT_EQ(found.faded, mechanism.m() - rank);
      }
    }
}

TEST(Kkt, RedundantRowsGiveLeastSquares) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    RandomTree random(seed);
    const Eigen::Quaterniond r = seed == 0 ? Eigen::Quaterniond::Identity() : random.turn();
    expect_least_squares(turned(row_of_four_bars(1, 1.1), r), 2, random);
    expect_least_squares(turned(row_of_four_bars(3, 0.8), r), 6, random);
    expect_least_squares(turned(bricard(), r), 4, random);
  }
}

/// Gauss with full pivoting in quad precision: the answer for these doubles.
std::vector<__float128> quad_solve(const MatrixXd& matrix, const VectorXd& b) {
  const auto n = static_cast<std::size_t>(b.size());
  std::vector<std::vector<__float128>> a(n, std::vector<__float128>(n + 1));
  std::vector<std::size_t> column(n);
  for (std::size_t i = 0; i < n; ++i) {
    column[i] = i;
    for (std::size_t j = 0; j < n; ++j)
      a[i][j] = matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    a[i][n] = b[static_cast<Eigen::Index>(i)];
  }
  const auto size = [](__float128 x) { return x < 0 ? -x : x; };
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t row = k, best = k;
    for (std::size_t i = k; i < n; ++i)
      for (std::size_t j = k; j < n; ++j)
        if (size(a[i][j]) > size(a[row][best])) {
          row = i;
          best = j;
        }
    std::swap(a[k], a[row]);
    std::swap(column[k], column[best]);
    for (auto& line : a) std::swap(line[k], line[best]);
    for (std::size_t i = k + 1; i < n; ++i) {
      const __float128 l = a[i][k] / a[k][k];
      for (std::size_t j = k; j <= n; ++j) a[i][j] -= l * a[k][j];
    }
  }
  std::vector<__float128> x(n);
  for (std::size_t k = n; k-- > 0;) {
    __float128 s = a[k][n];
    for (std::size_t j = k + 1; j < n; ++j) s -= a[k][j] * x[column[j]];
    x[column[k]] = s / a[k][k];
  }
  return x;
}

/// Error of u a rad away from the flat pose where a row of four-bars loses rank, σ of order one.
double error_near_flat(Scene scene, Algebra algebra, double fade, bool centred) {
  const Mechanism mechanism(std::move(scene), {.algebra = algebra});
  const auto e = mechanism.evaluation<double>();
  e->place(0, mechanism.tree().q0.data());
  const Assembled a(mechanism, *e);
  const VectorXd sigma = VectorXd::LinSpaced(mechanism.m(), 0.6, -0.9);
  const VectorXd r = a.M * mechanism.tree().u0 + a.J.transpose() * sigma;
  const VectorXd g = VectorXd::Zero(mechanism.m());
  VectorXd b(r.size() + g.size());
  b << r, g;
  const auto exact = quad_solve(a.matrix(), b);
  const auto kkt = make_dense_kkt(mechanism);
  const Solution found =
      solve(*kkt, *e, 0, mechanism.tree().q0, r, g, fade, centred ? sigma : VectorXd());
  EXPECT_TRUE(found.done);
  double worst = 0;
  for (Eigen::Index i = 0; i < found.u.size(); ++i)
    worst = std::max(
        worst, std::abs(static_cast<double>(found.u[i] - exact[static_cast<std::size_t>(i)])));
  return worst;
}

TEST(Kkt, NearlyFlatRowInEveryOrientation) {
  const double rounding = std::numeric_limits<double>::epsilon();
  for (double delta = 1e-2; delta > 5e-10; delta /= 10) {
    double worst = 0, worst_centred = 0;
    for (const double angle : orientations()) {
      const Eigen::Quaterniond r(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
      const Scene scene = turned(row_of_four_bars(2, delta, 1), r);
      worst = equations::larger(worst, error_near_flat(scene, Algebra::automatic, 1e-14, false));
      worst_centred = equations::larger(
          worst_centred, error_near_flat(scene, Algebra::automatic, fade_evaluation, true));
    }
    // The best any algorithm can do, ε/δ; where the row fades, what it would have carried: δ.
    const double fading = delta * std::pow(1e-14 / (delta * delta), 2);
    EXPECT_LT(worst, std::min(1e-6, 50 * rounding / delta + 50 * fading)) << delta;
    EXPECT_LT(worst_centred, std::min(1e-6, 50 * rounding / delta)) << delta;
    RecordProperty("delta_" + std::to_string(delta * 1e9), std::to_string(worst * 1e16));
  }
}

TEST(Kkt, NearlyFlatRowInSpace) {
  // Three times as many rows, redundant among themselves: the pivots near the filter see more
  // rounding, but u no more than a digit of it.
  const double rounding = std::numeric_limits<double>::epsilon();
  for (const double delta : {1e-2, 1e-4, 1e-6}) {
    for (unsigned seed = 0; seed < 8; ++seed) {
      RandomTree random(seed);
      const Mechanism mechanism(turned(row_of_four_bars(2, delta, 1), random.turn()),
                                {.algebra = Algebra::spatial});
      const auto e = mechanism.evaluation<double>();
      e->place(0, mechanism.tree().q0.data());
      const Assembled a(mechanism, *e);
      const VectorXd sigma = VectorXd::LinSpaced(mechanism.m(), 0.6, -0.9);
      const VectorXd r = a.M * mechanism.tree().u0 + a.J.transpose() * sigma;
      const VectorXd g = VectorXd::Zero(mechanism.m());
      const auto kkt = make_dense_kkt(mechanism);
      const Solution found = solve(*kkt, *e, 0, mechanism.tree().q0, r, g, fade_evaluation, sigma);
      EXPECT_LT((found.u - mechanism.tree().u0).cwiseAbs().maxCoeff(), 500 * rounding / delta)
          << delta;
      EXPECT_GE(found.faded, 6);
    }
  }
}

TEST(Kkt, LongRowsSparseAgreesWithDense) {
  for (const int n : {5, 20, 40}) {
    const Mechanism mechanism(row_of_four_bars(n, 1.1, 1));
    EXPECT_EQ(mechanism.solver().dense(), 4 * n + 1 <= 60);
    const auto e = mechanism.evaluation<double>();
    const auto dense = make_dense_kkt(mechanism), sparse = make_sparse_kkt(mechanism);
    RandomTree random(1);
    VectorXd q = mechanism.tree().q0;
    for (int pose = 0; pose < 3; ++pose) {  // refactorised at each
      e->place(0, q.data());
      const VectorXd r = any(random, mechanism.nv()), g = any(random, mechanism.m());
      const Solution a = solve(*dense, *e, 0, q, r, g, fade_evaluation),
                     b = solve(*sparse, *e, 0, q, r, g, fade_evaluation);
      EXPECT_TRUE(a.done && b.done);
      EXPECT_LT(relative_error(b.u, a.u), 1e-9) << n;
      q += 0.1 * any(random, mechanism.nv());
    }
  }
}

/// Deep trees: momenta, accelerations and corrections by the bodies' equations against the sweeps,
/// and the entries of the factors grow like the bodies.
TEST(Kkt, DeepTreesAreSolvedByTheirBodies) {
  for (const Scene& scene : {crossed_bars(60), arch(120)}) {
    const Mechanism by_sweeps(scene), by_bodies(scene, {.kkt = KktChoice::sparse}),
        in_space(scene, {.algebra = Algebra::spatial, .kkt = KktChoice::sparse});
    ASSERT_TRUE(solved_by_bodies(by_bodies));
    ASSERT_EQ(by_sweeps.solver().kkt(), KktChoice::sweeps);
    const auto e = by_sweeps.evaluation<double>(), f = by_bodies.evaluation<double>(),
               g = in_space.evaluation<double>();
    const auto sweeps = make_loop_solver(by_sweeps, *e), bodies = make_loop_solver(by_bodies, *f),
               spatial = make_loop_solver(in_space, *g);
    RandomTree random(3);
    TreeState s{0, by_sweeps.tree().q0, by_sweeps.tree().u0};
    for (int pose = 0; pose < 3; ++pose) {  // refactorised at each
      const VectorXd p = any(random, by_sweeps.nv()), centre = any(random, by_sweeps.m());
      const Result exact = solved(*sweeps, by_sweeps, s, p, centre),
                   found = solved(*bodies, by_bodies, s, p, centre);
      EXPECT_LT(relative_error(found.u, exact.u), 1e-9) << scene.name;
      EXPECT_LT(relative_error(found.pdot, exact.pdot), 1e-8) << scene.name;
      EXPECT_LT(relative_error(found.udot, exact.udot), 1e-8) << scene.name;
      EXPECT_LT(relative_error(found.delta, exact.delta), 1e-8) << scene.name;
      // In space rows across the plane are redundant; σ has other ones.
      VectorXd u(p.size()), sigma(in_space.m());
      ASSERT_TRUE(spatial->momentum(0, s.q.data(), p.data(), nullptr, fade_evaluation, 0, u.data(),
                                    sigma.data(), nullptr));
      EXPECT_EQ(spatial->pivots().faded, in_space.m() - by_sweeps.m()) << scene.name;
      const Result plain = solved(*sweeps, by_sweeps, s, p, VectorXd::Zero(by_sweeps.m()));
      EXPECT_LT(relative_error(u, plain.u), 1e-7) << scene.name;
      s.q += 1e-3 * any(random, by_sweeps.nv());
    }
  }
  const auto entries = [](int n) {
    const Mechanism mechanism(crossed_bars(n));
    return with_body_matrix(mechanism, [&](auto equations) {
      KluSolver solver(equations->size(), mechanism.m(), equations->entries(),
                       KluSolver::Order::columns);
      std::size_t i = 0;
      equations->each_entry([&](int, int, double x) { solver.matrix().set(i++, x); });
      const std::vector<double> epsilon(static_cast<std::size_t>(mechanism.m()), 1e-12);
      EXPECT_TRUE(solver.factor(epsilon));
      return static_cast<double>(solver.entries());
    });
  };
  EXPECT_LT(entries(400), 2.3 * entries(200));
  EXPECT_GT(entries(400), 1.7 * entries(200));
}

/// Pivots that have become bad are chosen anew, and what has no solution is told.
TEST(Kkt, PivotsThatNoLongerFitAreChosenAnew) {
  KluSolver solver(3, 0, {{0, 0}, {1, 0}, {1, 1}, {2, 1}, {2, 2}}, KluSolver::Order::blocks);
  const auto solve = [&](double a, double b, double c) {
    std::size_t i = 0;
    for (const double x : {a, 1.0, b, 1.0, c}) solver.matrix().set(i++, x);
    Eigen::Vector3d x(1, 2, 3);
    Eigen::Matrix3d A;
    A << a, 1, 0, 1, b, 1, 0, 1, c;
    const Eigen::Vector3d right = A * x;
    Eigen::Vector3d found = right;
    if (!solver.factor({})) return -1.0;
    return solver.solve(found.data(), nullptr, true) ? (found - x).norm() : -1.0;
  };
  EXPECT_LT(solve(4, 4, 4), 1e-14);
  EXPECT_EQ(solver.choices(), 1);
  EXPECT_LT(solve(5, 4, 3), 1e-14);
  EXPECT_EQ(solver.choices(), 1);
  EXPECT_LT(solve(1e-18, 1e-18, 4), 1e-12);
  EXPECT_EQ(solver.choices(), 2);
  EXPECT_EQ(solve(0, 0, 0), -1);  // rows 1 and 3 are the same
  EXPECT_EQ(solve(std::nan(""), 1, 1), -1);
  EXPECT_LT(solve(4, 4, 4), 1e-14);
}

TEST(Kkt, ReportsWhatCannotBeFactorised) {
  Scene scene = row_of_four_bars(1, 1);
  scene.bodies[0].mass = 0;  // the first upright and the level rod on it weigh nothing
  scene.bodies[0].inertia.setZero();
  scene.bodies[1].mass = 0;
  scene.bodies[1].inertia.setZero();
  const Mechanism mechanism(scene);
  const auto e = mechanism.evaluation<double>();
  const double* start = mechanism.tree().q0.data();
  EXPECT_FALSE(make_dense_kkt(mechanism)->factor(*e, 0, start, fade_evaluation));
  VectorXd q = Mechanism(row_of_four_bars(1, 1)).tree().q0;
  q[1] = std::numeric_limits<double>::quiet_NaN();
  const Mechanism heavy(row_of_four_bars(1, 1));
  const auto f = heavy.evaluation<double>();
  for (const auto& make :
       {make_dense_kkt, make_sparse_kkt, make_front_kkt, make_klu_kkt, make_body_kkt})
    EXPECT_FALSE(make(heavy)->factor(*f, 0, q.data(), fade_evaluation));
}

}  // namespace
}  // namespace momenta::dae_kkt
