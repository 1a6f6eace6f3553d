#include <momenta/dae/algebra/dense/singular_values.h>

template class Eigen::BDCSVD<Eigen::MatrixXd>;
template class Eigen::JacobiSVD<Eigen::MatrixXd>;

namespace momenta {

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
