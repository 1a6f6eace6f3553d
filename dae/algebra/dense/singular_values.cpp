#include <momenta/dae/algebra/dense/singular_values.h>

#include <Eigen/QR>
#include <algorithm>
#include <limits>

template class Eigen::BDCSVD<Eigen::MatrixXd>;
template class Eigen::JacobiSVD<Eigen::MatrixXd>;

namespace momenta {
namespace {

/// Largest size at which rotations take little time. They leave apart what the matrix does, also in
/// null spaces.
constexpr Eigen::Index most_rotated = 100;

/// Of the matrix with this QR, whose pivots from `rank` on are rounding.
SingularValues of_regular_part(const Eigen::ColPivHouseholderQR<Eigen::MatrixXd>& qr,
                               Eigen::Index rank) {
  SingularValues all;
  const Eigen::MatrixXd& r = qr.matrixQR();
  all.values.setZero(std::min(r.rows(), r.cols()));
  all.u.setIdentity(r.rows(), r.rows());
  all.v.setIdentity(r.cols(), r.cols());
  if (rank > 0) {
    const Eigen::MatrixXd upper = r.topRows(rank).triangularView<Eigen::Upper>();
    const Eigen::HouseholderQR<Eigen::MatrixXd> right(upper.transpose());
    const Eigen::MatrixXd lower =
        Eigen::MatrixXd(right.matrixQR().topRows(rank).triangularView<Eigen::Upper>()).transpose();
    const SingularValues inner(lower);
    all.values.head(rank) = inner.values;
    all.u.topLeftCorner(rank, rank) = inner.u;
    all.v.topLeftCorner(rank, rank) = inner.v;
    all.v.applyOnTheLeft(right.householderQ());
  }
  all.u.applyOnTheLeft(qr.householderQ());
  all.v = (qr.colsPermutation() * all.v).eval();
  return all;
}

}  // namespace

SingularValues::SingularValues(const Eigen::MatrixXd& a, unsigned options) {
  const auto take = [&](const auto& svd) {
    constexpr double rounding = 1e-10;
    values = svd.singularValues();
    u = svd.matrixU();
    v = svd.matrixV();
    const Eigen::MatrixXd product =
        u.leftCols(values.size()) * values.asDiagonal() * v.leftCols(values.size()).transpose();
    return (product - a).norm() <= rounding * a.norm() && u.isUnitary(rounding) &&
           v.isUnitary(rounding);
  };
  if (a.size() > 0 && a.allFinite()) {
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(a);
    const auto pivots = qr.matrixQR().diagonal().cwiseAbs();
    const Eigen::Index most = std::min(a.rows(), a.cols());
    const double none = std::numeric_limits<double>::epsilon() *
                        static_cast<double>(std::max(a.rows(), a.cols())) * pivots[0];
    const Eigen::Index rank = (pivots.array() > none).count();
    if (rank < most && std::max(a.rows(), a.cols()) <= most_rotated) {
      take(Eigen::JacobiSVD<Eigen::MatrixXd>(a, options));
      return;
    }
    if (rank < most) {
      *this = of_regular_part(qr, rank);
      if (options & Eigen::ComputeThinU) u = u.leftCols(most).eval();
      if (options & Eigen::ComputeThinV) v = v.leftCols(most).eval();
      return;
    }
  }
  if (!take(Eigen::BDCSVD<Eigen::MatrixXd>(a, options)))
    take(Eigen::JacobiSVD<Eigen::MatrixXd>(a, options));
}

Eigen::Index SingularValues::rank(double part) const {
  return values.size() > 0 ? (values.array() > part * values[0]).count() : 0;
}

Eigen::VectorXd SingularValues::solve(const Eigen::VectorXd& b, Eigen::Index rank) const {
  return v.leftCols(rank) * (u.leftCols(rank).transpose() * b).cwiseQuotient(values.head(rank));
}

}  // namespace momenta
