#include "equations/decompositions.h"

template class Eigen::EigenSolver<Eigen::MatrixXd>;
template Eigen::EigenSolver<Eigen::MatrixXd>& Eigen::EigenSolver<Eigen::MatrixXd>::compute(
    const Eigen::EigenBase<Eigen::MatrixXd>&, bool);
template class Eigen::JacobiSVD<Eigen::MatrixXd>;
template class Eigen::ColPivHouseholderQR<Eigen::MatrixXd>;
template class Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>;
template void Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>::_solve_impl<
    Eigen::VectorXd, Eigen::VectorXd>(const Eigen::VectorXd&, Eigen::VectorXd&) const;
template class Eigen::PartialPivLU<Eigen::MatrixXd>;
template class Eigen::LLT<Eigen::MatrixXd>;
template Eigen::LLT<Eigen::MatrixXd>& Eigen::LLT<Eigen::MatrixXd>::compute(
    const Eigen::EigenBase<Eigen::MatrixXd>&);
template class Eigen::LDLT<Eigen::MatrixXd>;
template Eigen::LDLT<Eigen::MatrixXd>& Eigen::LDLT<Eigen::MatrixXd>::compute(
    const Eigen::EigenBase<Eigen::MatrixXd>&);

namespace momenta::equations {

LongVector spread_by_inverse(const LongMatrix& m, const LongVector& x) {
  if (m.size() == 0) return LongVector::Zero(x.size());
  return LongMatrix(m.inverse()).cwiseAbs() * x.cwiseAbs();
}

double condition(const LongMatrix& m) {
  if (m.size() == 0) return 1;
  const LongVector row_sums = m.cwiseAbs().rowwise().sum();
  return static_cast<double>(spread_by_inverse(m, row_sums).maxCoeff());
}

double condition(const Eigen::MatrixXd& m) {
  return condition(LongMatrix(m.cast<long double>()));
}

Eigen::VectorXd eigenvalues_of(const Eigen::MatrixXd& symmetric) {
  return symmetric.selfadjointView<Eigen::Lower>().eigenvalues();
}

Eigen::VectorXd singular_values_in_mass(const Eigen::MatrixXd& mass,
                                        const Eigen::MatrixXd& constraints) {
  const Eigen::MatrixXd scaled =
      Eigen::LLT<Eigen::MatrixXd>(mass).matrixL().solve(constraints.transpose().eval());
  return Eigen::JacobiSVD<Eigen::MatrixXd>(scaled).singularValues();
}

}  // namespace momenta::equations
