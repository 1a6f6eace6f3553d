#include <momenta/dae/topology/assembly/quadratic_forms.h>

#include <Eigen/Eigenvalues>

namespace momenta {

using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd RandomDirections::next(Eigen::Index n) {
  VectorXd y(n);
  for (double& x : y)
    x = 2 * static_cast<double>(random_()) / static_cast<double>(std::mt19937::max()) - 1;
  return y.normalized();
}

VectorXd QuadraticForms::at(const VectorXd& y) const {
  VectorXd values(static_cast<Eigen::Index>(all.size()));
  for (std::size_t i = 0; i < all.size(); ++i)
    values[static_cast<Eigen::Index>(i)] = y.dot(all[i] * y);
  return values;
}

MatrixXd QuadraticForms::sum(const VectorXd& c) const {
  MatrixXd m = MatrixXd::Zero(size(), size());
  for (std::size_t i = 0; i < all.size(); ++i) m += c[static_cast<Eigen::Index>(i)] * all[i];
  return m;
}

QuadraticForms QuadraticForms::in(const MatrixXd& basis) const {
  QuadraticForms forms;
  for (const MatrixXd& form : all) forms.all.push_back(basis.transpose() * form * basis);
  return forms;
}

MatrixXd common_zeros(const QuadraticForms& f) {
  constexpr int iterations = 80;
  constexpr double reached = 1e-18, zero = 1e-13, another = 1e-3;
  const Eigen::Index n = f.size();
  RandomDirections random;
  MatrixXd span(n, 0);
  const int starts = 20 + 4 * static_cast<int>(n);
  for (int start = 0; start < starts && span.cols() < n; ++start) {
    VectorXd y = random.next(n);
    VectorXd values = f.at(y);
    for (int i = 0; i < iterations && values.norm() > reached; ++i) {
      MatrixXd slopes(values.size(), n);
      for (std::size_t k = 0; k < f.all.size(); ++k)
        slopes.row(static_cast<Eigen::Index>(k)) = 2 * (f.all[k] * y).transpose();
      MatrixXd normal = slopes * slopes.transpose();
      normal.diagonal().array() += 1e-3 * values.squaredNorm() + 1e-300;
      y = (y - slopes.transpose() * normal.ldlt().solve(values)).normalized();
      if (!y.allFinite()) break;
      values = f.at(y);
    }
    if (!(values.norm() <= zero)) continue;
    y -= span * (span.transpose() * y);
    if (!(y.norm() > another)) continue;
    span.conservativeResize(n, span.cols() + 1);
    span.rightCols(1) = y.normalized();
  }
  return span;
}

VectorXd positive_sum(const QuadraticForms& f) {
  constexpr int most = 500;
  constexpr double positive = 1e-6;
  VectorXd c = f.at(VectorXd::Ones(f.size()).normalized());
  for (int i = 0; i < most; ++i) {
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(f.sum(c));
    const VectorXd& values = eigen.eigenvalues();
    if (values[0] > positive * values.cwiseAbs().maxCoeff()) return c;
    const VectorXd there = f.at(eigen.eigenvectors().col(0));
    if (!(there.norm() > 0)) break;
    c += there.normalized();
  }
  return {};
}

}  // namespace momenta
