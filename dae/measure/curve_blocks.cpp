#include <momenta/dae/measure/curve_blocks.h>

#include <cmath>

namespace momenta {
namespace {

constexpr double rounding_only = 1e-9;  // relative; smaller rows and columns are not scaled
}  // namespace

/// Unknown by unknown, direction 0 along y, direction 1 along y'.
CurveBlocks::CurveBlocks(const CurveSystem& system, double t, const Eigen::MatrixXd& curve) {
  const int n = system.size;
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  std::vector<Jet> y(at(n)), ydot(at(n)), r(at(n));
  for (int i = 0; i < n; ++i)
    for (int k = 0; k <= jet_order; ++k) {
      y[at(i)].a.c[at(k)] = curve(i, k);
      if (k > 0) ydot[at(i)].a.c[at(k - 1)] = k * curve(i, k);
    }
  f = Eigen::MatrixXd::Zero(n, jet_order);
  a.assign(at(jet_order), Eigen::MatrixXd::Zero(n, n));
  b.assign(at(jet_order), Eigen::MatrixXd::Zero(n, n));
  for (int j = 0; j < n; ++j) {
    y[at(j)].b[0] = PowerSeries<jet_order>(1.0);
    ydot[at(j)].b[1] = PowerSeries<jet_order>(1.0);
    system.equations(t, y.data(), ydot.data(), r.data());
    y[at(j)].b[0] = ydot[at(j)].b[1] = PowerSeries<jet_order>(0.0);
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < jet_order; ++k) {
        a[at(k)](i, j) = r[at(i)].b[0].c[at(k)];
        b[at(k)](i, j) = r[at(i)].b[1].c[at(k)];
        if (j == 0) f(i, k) = r[at(i)].a.c[at(k)];
      }
  }
}

Eigen::MatrixXd CurveBlocks::by(int i, int j) const {
  if (j > i + 1) return Eigen::MatrixXd::Zero(f.rows(), f.rows());
  const auto at = [](int k) { return static_cast<std::size_t>(k); };
  if (j == 0) return a[at(i)];
  Eigen::MatrixXd block = j * b[at(i - j + 1)];
  if (i >= j) block += a[at(i - j)];
  return block;
}

Eigen::VectorXd equilibrate(Eigen::MatrixXd& matrix, Eigen::VectorXd& right) {
  Eigen::VectorXd columns = Eigen::VectorXd::Ones(matrix.cols());
  for (int pass = 0; pass < 12; ++pass) {
    const Eigen::VectorXd row = matrix.rowwise().lpNorm<Eigen::Infinity>();
    const Eigen::VectorXd column = matrix.colwise().lpNorm<Eigen::Infinity>().transpose();
    const double largest = row.maxCoeff();
    for (Eigen::Index i = 0; i < matrix.rows(); ++i)
      if (row[i] > rounding_only * largest) {
        matrix.row(i) /= std::sqrt(row[i]);
        right[i] /= std::sqrt(row[i]);
      }
    for (Eigen::Index j = 0; j < matrix.cols(); ++j)
      if (column[j] > rounding_only * largest) {
        matrix.col(j) /= std::sqrt(column[j]);
        columns[j] /= std::sqrt(column[j]);
      }
  }
  return columns;
}

}  // namespace momenta
