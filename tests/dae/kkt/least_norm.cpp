// Least changes that meet linear equations: sparse QR against a dense orthogonal decomposition.

#include <gtest/gtest.h>
#include <momenta/dae/kkt/least_norm.h>
#include <momenta/dae/kkt/loop_rank.h>

#include <Eigen/QR>
#include <random>

namespace momenta::dae_least_norm {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct System {
  std::vector<KktPattern::Entry> pattern;
  std::vector<double> values;
  MatrixXd dense;
};

/// Rows with entries near the diagonal; the last `copies` are sums of two earlier ones.
System banded(int rows, int columns, int copies) {
  System s;
  s.dense = MatrixXd::Zero(rows, columns);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int i = 0; i < rows - copies; ++i)
    for (int k = 0; k < 5; ++k) s.dense(i, (i + k * k) % columns) = number(random);
  for (int i = rows - copies; i < rows; ++i)
    s.dense.row(i) = s.dense.row(i - 50) - 2 * s.dense.row(7);
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j)
      if (s.dense(i, j) != 0) {
        s.pattern.push_back({i, j});
        s.values.push_back(s.dense(i, j));
      }
  return s;
}

TEST(LeastNorm, SparseIsDense) {
  for (const int copies : {0, 20}) {
    const System s = banded(300, 420, copies);
    LeastNorm steps(s.pattern, 300, 420);
    ASSERT_FALSE(steps.is_dense());
    const VectorXd b = s.dense * VectorXd::LinSpaced(420, -1, 2);  // consistent
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> cod;
    cod.setThreshold(rank_tolerance);
    cod.compute(s.dense);
    steps.factor(s.values);
    const VectorXd x = steps.solve(b), expected = cod.solve(b);
    EXPECT_LT((x - expected).norm(), 1e-10 * expected.norm()) << copies;
    EXPECT_LT((steps.product(s.values, x) - b).norm(), 1e-11 * b.norm());

    steps.factor(s.values, 0.3);
    const MatrixXd normal = s.dense.transpose() * s.dense + 0.09 * MatrixXd::Identity(420, 420);
    const VectorXd damped = normal.ldlt().solve(s.dense.transpose() * b);
    EXPECT_LT((steps.solve(b) - damped).norm(), 1e-11 * damped.norm());
  }
}

/// Neither stale factors nor needless ones.
TEST(LeastNorm, FactorisesWhatIsNew) {
  System s = banded(300, 420, 0);
  const VectorXd b = VectorXd::LinSpaced(300, -1, 2);
  LeastNorm steps(s.pattern, 300, 420);
  steps.factor(s.values);
  const VectorXd first = steps.solve(b);
  steps.factor(s.values);
  EXPECT_EQ(steps.judge(s.values).rank, 300);
  EXPECT_EQ(steps.factorizations(), 1);
  EXPECT_EQ(steps.solve(b), first);
  steps.factor(s.values, 0.3);
  EXPECT_GT((steps.solve(b) - first).norm(), 1e-3 * first.norm());
  steps.factor(s.values);
  EXPECT_EQ(steps.factorizations(), 3);
  EXPECT_EQ(steps.solve(b), first);
  s.values[17] += 1;
  steps.factor(s.values);
  EXPECT_EQ(steps.factorizations(), 4);
  EXPECT_LT((steps.product(s.values, steps.solve(b)) - b).norm(), 1e-11 * b.norm());
}

TEST(LeastNorm, FindsDependentRows) {
  const System s = banded(300, 420, 20);
  LeastNorm steps(s.pattern, 300, 420);
  const LoopRank rows = steps.judge(s.values);
  EXPECT_EQ(rows.rank, 280);
  ASSERT_EQ(rows.dependent.size(), 20u);
  // Without them the others are independent.
  MatrixXd kept(280, 420);
  for (int i = 0, k = 0; i < 300; ++i)
    if (std::find(rows.dependent.begin(), rows.dependent.end(), i) == rows.dependent.end())
      kept.row(k++) = s.dense.row(i);
  EXPECT_EQ(Eigen::ColPivHouseholderQR<MatrixXd>(kept).rank(), 280);
  const System full = banded(300, 420, 0);
  EXPECT_EQ(LeastNorm(full.pattern, 300, 420).judge(full.values).rank, 300);
}

}  // namespace
}  // namespace momenta::dae_least_norm
