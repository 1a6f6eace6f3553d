#include <momenta/dae/algebra/dense/least_squares.h>
#include <momenta/dae/algebra/dense/singular_values.h>
#include <momenta/dae/kkt/least_norm.h>
#include <momenta/dae/kkt/loop_rank.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace momenta {

using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<double> scaled_entries(const Mechanism& mechanism, Evaluation<double>& e,
                                   const LoopUnits& units) {
  const auto& pattern = mechanism.constraint_pattern();
  std::vector<double> values(pattern.size());
  e.constraint_entries(values.data());
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] *= units.rates[pattern[i].column] / units.equations[pattern[i].row];
  constexpr double least = 1e-12;
  const bool says_nothing =
      std::all_of(values.begin(), values.end(), [](double a) { return std::abs(a) < least; });
  if (says_nothing) std::fill(values.begin(), values.end(), 0.0);
  return values;
}

ScaledJacobian scaled_jacobian(const Mechanism& mechanism, Evaluation<double>& e) {
  const LoopUnits units(mechanism);
  const auto& pattern = mechanism.constraint_pattern();
  const std::vector<double> values = scaled_entries(mechanism, e, units);
  ScaledJacobian scaled{MatrixXd::Zero(mechanism.m(), mechanism.nv()),
                        units.equations.cwiseInverse()};
  for (std::size_t i = 0; i < values.size(); ++i)
    scaled.a(pattern[i].row, pattern[i].column) = values[i];
  return scaled;
}

RankAndIdle rank_and_idle(const MatrixXd& a, double largest, int rank, double least) {
  RankAndIdle d;
  if (a.rows() == 0) return d;
  if (a.cols() == 0) {
    d.left = MatrixXd::Identity(a.rows(), a.rows());
    return d;
  }
  const SingularValues svd(a, Eigen::ComputeFullU | Eigen::ComputeThinV);
  d.singular_values = svd.values;
  const VectorXd& s = d.singular_values;
  if (largest == 0) largest = s[0];
  const double counts = std::max(rank_tolerance, least) * largest;
  while (d.rank < s.size() && s[d.rank] > counts) ++d.rank;
  if (rank >= 0) d.rank = rank;
  if (d.rank > 0) d.kept = s[d.rank - 1];
  if (d.rank < s.size()) d.dropped = s[d.rank];
  d.left = svd.u.rightCols(a.rows() - d.rank);
  return d;
}

std::vector<int> reduce(MatrixXd& n, const std::vector<int>& first) {
  std::vector<int> own;
  const auto part = [&](Eigen::Index row, Eigen::Index from) {
    return n.row(row).tail(n.cols() - from).norm();
  };
  for (Eigen::Index k = 0; k < n.cols(); ++k) {
    double largest = 0;
    for (Eigen::Index i = 0; i < n.rows(); ++i) largest = std::max(largest, part(i, k));
    int best = -1;
    const auto take = [&](int row) {
      if (best < 0 && part(row, k) > 0.2 * largest) best = row;
    };
    for (auto row = first.rbegin(); row != first.rend(); ++row) take(*row);
    for (auto row = static_cast<int>(n.rows()) - 1; row >= 0; --row) take(row);
    // One column of those left takes all of that row.
    const VectorXd direction = n.row(best).tail(n.cols() - k).transpose().normalized();
    MatrixXd rest = n.rightCols(n.cols() - k);
    const VectorXd column = rest * direction;
    const MatrixXd others = orthogonal_factor(direction).rightCols(rest.cols() - 1);
    n.rightCols(n.cols() - k - 1) = rest * others;
    n.col(k) = column / column[best];
    own.push_back(best);
    for (Eigen::Index j = 0; j < n.cols(); ++j)
      if (j != k) n.col(j) -= n(best, j) * n.col(k);
  }
  return own;
}

LoopRank loop_rank(const Mechanism& mechanism, Evaluation<double>& e, Judged judged, double least) {
  if (mechanism.m() == 0) return {};
  LeastNorm rows(mechanism.constraint_pattern(), mechanism.m(), mechanism.nv());
  return rows.judge(scaled_entries(mechanism, e, LoopUnits(mechanism)), judged, least);
}

MatrixXd idle_forces(const Mechanism& mechanism, double t, const VectorXd& q) {
  if (mechanism.m() == 0) return {};
  const auto e = mechanism.evaluation<double>();
  e->place(t, q.data());
  const ScaledJacobian scaled = scaled_jacobian(mechanism, *e);
  return scaled.row_factor.asDiagonal() * rank_and_idle(scaled.a).left;
}

}  // namespace momenta
