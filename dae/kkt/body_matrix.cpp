#include <momenta/dae/kkt/body_matrix.h>

namespace momenta {

Eigen::MatrixXd dense_mass(const Mechanism& mechanism, Evaluation<double>& e) {
  const auto& pattern = mechanism.kkt_pattern().mass;
  std::vector<double> values(pattern.size());
  e.mass_entries(values.data());
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(mechanism.nv(), mechanism.nv());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto [row, column] = pattern[i];
    M(row, column) = M(column, row) = values[i];
  }
  return M;
}

Eigen::MatrixXd dense_constraints(const Mechanism& mechanism, Evaluation<double>& e) {
  const auto& pattern = mechanism.constraint_pattern();
  std::vector<double> values(pattern.size());
  e.constraint_entries(values.data());
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(mechanism.m(), mechanism.nv());
  for (std::size_t i = 0; i < values.size(); ++i) J(pattern[i].row, pattern[i].column) = values[i];
  return J;
}

}  // namespace momenta
