// The solvers of (7) against dense factorisations in longer arithmetic: regular systems, redundant
// rows, nearly singular poses in every orientation.

#include "equations/kkt_blocks.h"
#include "equations/linkages.h"
#include "equations/random_loops.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/scene/read_scene.h>
#include <momenta/dae/kkt/kkt.h>

#include <Eigen/Dense>

namespace momenta {
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
  VectorXd singular_values() const {
    const MatrixXd g = M.llt().matrixL().solve(J.transpose());
    return g.jacobiSvd().singularValues();
  }
};

struct Solution {
  VectorXd u, sigma;
  bool done = false;
  int faded = 0;
};
Solution solve(Kkt& kkt, Evaluation<double>& e, const VectorXd& r, const VectorXd& g, double fade,
               const VectorXd& centre = {}) {
  Solution s{VectorXd(r.size()), VectorXd(g.size())};
  s.done = kkt.factor(e, fade) &&
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
  double worst_dense = 0, worst_sparse = 0, worst_centre = 0;
  int tried = 0;
  for (unsigned seed = 0; seed < 150; ++seed) {
    RandomTree random(seed);
    Scene scene = random.scene({.bodies = 8});
    const auto kind = loop_kinds[seed % loop_kinds.size()];
    scene.loops.push_back(random_loop(random, scene, kind));
    scene.loops.push_back(random_loop(random, scene, LoopKind::point));
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
    const VectorXd masses = a.M.selfadjointView<Eigen::Lower>().eigenvalues();
    const double growth = std::sqrt(masses.maxCoeff() / masses.minCoeff()) *
                          std::pow(values.maxCoeff() / values.minCoeff(), 2);
    const double scale =
        std::max(1.0, std::max(u.cwiseAbs().maxCoeff(), sigma.cwiseAbs().maxCoeff()));
    const auto error = [&](const Solution& found) {
      EXPECT_TRUE(found.done);
      return std::max((found.u - u).cwiseAbs().maxCoeff(),
                      (found.sigma - sigma).cwiseAbs().maxCoeff()) /
             scale / growth;
    };
    const auto dense = make_dense_kkt(mechanism), sparse = make_sparse_kkt(mechanism);
    const Solution plain = solve(*dense, *e, r, g, fade_evaluation);
    EXPECT_EQ(plain.faded, 0);
    worst_dense = std::max(worst_dense, error(plain));
    worst_sparse = std::max(worst_sparse, error(solve(*sparse, *e, r, g, fade_evaluation)));
    // Where nothing fades the centre is of no consequence.
    const VectorXd centre = any(random, mechanism.m());
    worst_centre = std::max(worst_centre, error(solve(*dense, *e, r, g, fade_evaluation, centre)));
    worst_sparse = std::max(worst_sparse, error(solve(*sparse, *e, r, g, fade_evaluation, centre)));
  }
  EXPECT_GT(tried, 30);
  RecordProperty("dense", std::to_string(worst_dense * 1e16) + "e-16");
  RecordProperty("sparse", std::to_string(worst_sparse * 1e16) + "e-16");
  EXPECT_LT(worst_dense, algebra_tol(8));
  EXPECT_LT(worst_centre, algebra_tol(8));
  // ε of the sparse form is 1e-12 of the scale of Φ_q M⁻¹ Φ_qᵀ.
  EXPECT_LT(worst_sparse, 1e-12);
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
  for (const bool is_dense : {true, false})
    for (const bool centred : {false, true}) {
      const auto kkt = is_dense ? make_dense_kkt(mechanism) : make_sparse_kkt(mechanism);
      const Solution found =
          solve(*kkt, *e, r, consistent, fade_evaluation, centred ? centre : VectorXd());
      EXPECT_TRUE(found.done);
      EXPECT_LT(relative_error(found.u, u), is_dense ? 2e-14 : 1e-10)
          << (is_dense ? "dense" : "sparse") << (centred ? " centred" : "");
      EXPECT_TRUE(found.sigma.allFinite());
      EXPECT_LT(found.sigma.norm(), 100 * (1 + sigma.norm() + centre.norm()));
      // The same constraint force, whatever the share of each row.
      EXPECT_LT(relative_error(VectorXd(a.J.transpose() * found.sigma),
                               VectorXd(a.J.transpose() * sigma)),
                is_dense ? 1e-13 : 1e-10);
      if (is_dense) {
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
  const Solution found = solve(*kkt, *e, r, g, fade, centred ? sigma : VectorXd());
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
      worst = std::max(worst, error_near_flat(scene, Algebra::automatic, 1e-14, false));
      worst_centred = std::max(worst_centred,
                               error_near_flat(scene, Algebra::automatic, fade_evaluation, true));
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
      const Solution found = solve(*kkt, *e, r, g, fade_evaluation, sigma);
      EXPECT_LT((found.u - mechanism.tree().u0).cwiseAbs().maxCoeff(), 500 * rounding / delta)
          << delta;
      EXPECT_GE(found.faded, 6);
    }
  }
}

TEST(Kkt, LongRowsSparseAgreesWithDense) {
  for (const int n : {5, 20, 40}) {
    const Mechanism mechanism(row_of_four_bars(n, 1.1, 1));
    EXPECT_EQ(mechanism.dense_kkt(), 4 * n + 1 <= 60);
    const auto e = mechanism.evaluation<double>();
    const auto dense = make_dense_kkt(mechanism), sparse = make_sparse_kkt(mechanism);
    RandomTree random(1);
    VectorXd q = mechanism.tree().q0;
    for (int pose = 0; pose < 3; ++pose) {  // refactorised at each
      e->place(0, q.data());
      const VectorXd r = any(random, mechanism.nv()), g = any(random, mechanism.m());
      const Solution a = solve(*dense, *e, r, g, fade_evaluation),
                     b = solve(*sparse, *e, r, g, fade_evaluation);
      EXPECT_TRUE(a.done && b.done);
      EXPECT_LT(relative_error(b.u, a.u), 1e-9) << n;
      q += 0.1 * any(random, mechanism.nv());
    }
  }
}

TEST(Kkt, ReportsWhatCannotBeFactorised) {
  Scene scene = row_of_four_bars(1, 1);
  scene.bodies[0].mass = 0;  // the first upright and the level rod on it weigh nothing
  scene.bodies[0].inertia.setZero();
  scene.bodies[1].mass = 0;
  scene.bodies[1].inertia.setZero();
  const Mechanism mechanism(scene);
  const auto e = mechanism.evaluation<double>();
  e->place(0, mechanism.tree().q0.data());
  EXPECT_FALSE(make_dense_kkt(mechanism)->factor(*e, fade_evaluation));
  VectorXd q = Mechanism(row_of_four_bars(1, 1)).tree().q0;
  q[1] = std::numeric_limits<double>::quiet_NaN();
  const Mechanism heavy(row_of_four_bars(1, 1));
  const auto f = heavy.evaluation<double>();
  f->place(0, q.data());
  EXPECT_FALSE(make_dense_kkt(heavy)->factor(*f, fade_evaluation));
  EXPECT_FALSE(make_sparse_kkt(heavy)->factor(*f, fade_evaluation));
}

}  // namespace
}  // namespace momenta
