#include <momenta/dae/kkt/axis_scale.h>
#include <momenta/dae/kkt/idle_forces.h>
#include <momenta/dae/kkt/singular_values.h>

#include <cmath>
#include <vector>

namespace momenta {

using Eigen::MatrixXd;
using Eigen::VectorXd;

ScaledJacobian scaled_jacobian(const Mechanism& mechanism, Evaluation<double>& e) {
  const int nv = mechanism.nv(), m = mechanism.m();
  const auto& pattern = mechanism.constraint_pattern();
  std::vector<double> values(pattern.size());
  e.constraint_entries(values.data());
  VectorXd mass(nv);
  e.mass_diagonal(mass.data());
  const std::vector<double> rows = row_scales(mechanism, e);
  ScaledJacobian scaled{MatrixXd::Zero(m, nv), VectorXd(m)};
  for (int i = 0; i < m; ++i) {
    const double scale = rows[static_cast<std::size_t>(i)];
    scaled.row_factor[i] = scale > 0 ? 1 / std::sqrt(scale) : 1;
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto [row, column] = pattern[i];
    if (mass[column] > 0)
      scaled.a(row, column) = values[i] * scaled.row_factor[row] / std::sqrt(mass[column]);
  }
  return scaled;
}

RankAndIdle rank_and_idle(const MatrixXd& a, double largest) {
  constexpr double counts = 1e-7;  // of the largest singular value
  RankAndIdle d;
  if (a.rows() == 0) return d;
  if (a.cols() == 0) {
    d.left = MatrixXd::Identity(a.rows(), a.rows());
    return d;
  }
  const Eigen::BDCSVD<MatrixXd> svd(a, Eigen::ComputeFullU);
  const VectorXd& s = svd.singularValues();
  if (largest == 0) largest = s[0];
  while (d.rank < s.size() && s[d.rank] > counts * largest) ++d.rank;
  if (d.rank > 0) d.kept = s[d.rank - 1];
  if (d.rank < s.size()) d.dropped = s[d.rank];
  d.left = svd.matrixU().rightCols(a.rows() - d.rank);
  return d;
}

MatrixXd idle_forces(const Mechanism& mechanism, double t, const VectorXd& q) {
  if (mechanism.m() == 0) return {};
  const auto e = mechanism.evaluation<double>();
  e->place(t, q.data());
  const ScaledJacobian scaled = scaled_jacobian(mechanism, *e);
  return scaled.row_factor.asDiagonal() * rank_and_idle(scaled.a).left;
}

}  // namespace momenta
