// Eigen under the definitions the library hands on to its users: blocked algorithms pack operands
// into buffers of their own, which must be aligned for the instructions in use.
#include <gtest/gtest.h>
#include <momenta/core/open_chain/open_chain.h>

#include <Eigen/Dense>

namespace momenta::core_eigen {
namespace {

TEST(Eigen, BlockedAlgorithmsOfAnySize) {
  for (const Eigen::Index n : {50, 300, 500}) {
    const Eigen::MatrixXd a =
        Eigen::MatrixXd::Random(n, n) + static_cast<double>(n) * Eigen::MatrixXd::Identity(n, n);
    const Eigen::MatrixXd square = a * a;
    EXPECT_LT((a.partialPivLu().solve(square) - a).norm(), 1e-11 * a.norm());
    EXPECT_LT((a.householderQr().solve(square) - a).norm(), 1e-11 * a.norm());
    EXPECT_EQ(Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(a).rank(), n);
  }
}

}  // namespace
}  // namespace momenta::core_eigen
