#pragma once
// What tests and slow twins ask Eigen for of dense matrices and takes long to compile, compiled
// once.

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

extern template class Eigen::EigenSolver<Eigen::MatrixXd>;
extern template Eigen::EigenSolver<Eigen::MatrixXd>& Eigen::EigenSolver<Eigen::MatrixXd>::compute(
    const Eigen::EigenBase<Eigen::MatrixXd>&, bool);
extern template class Eigen::JacobiSVD<Eigen::MatrixXd>;
extern template class Eigen::ColPivHouseholderQR<Eigen::MatrixXd>;
extern template class Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>;
extern template void Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>::_solve_impl<
    Eigen::VectorXd, Eigen::VectorXd>(const Eigen::VectorXd&, Eigen::VectorXd&) const;
extern template class Eigen::PartialPivLU<Eigen::MatrixXd>;
extern template class Eigen::LLT<Eigen::MatrixXd>;
extern template Eigen::LLT<Eigen::MatrixXd>& Eigen::LLT<Eigen::MatrixXd>::compute(
    const Eigen::EigenBase<Eigen::MatrixXd>&);
extern template class Eigen::LDLT<Eigen::MatrixXd>;
extern template Eigen::LDLT<Eigen::MatrixXd>& Eigen::LDLT<Eigen::MatrixXd>::compute(
    const Eigen::EigenBase<Eigen::MatrixXd>&);

namespace momenta::equations {

using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using LongVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

/// |M⁻¹| |x| (n), entry by entry: how far rounding in forces or momenta of size x moves the rates
/// of a mass matrix M (n × n).
LongVector spread_by_inverse(const LongMatrix& m, const LongVector& x);
/// ‖|M⁻¹| |M|‖∞: what a solution with M may lose. 1 of an empty M.
double condition(const LongMatrix& m);
double condition(const Eigen::MatrixXd& m);
/// Of a symmetric matrix, ascending; its lower triangle counts.
Eigen::VectorXd eigenvalues_of(const Eigen::MatrixXd& symmetric);
/// Singular values of Φ_q in the metric of M, those of L⁻¹ Φ_qᵀ with M = L Lᵀ, descending.
Eigen::VectorXd singular_values_in_mass(const Eigen::MatrixXd& mass,
                                        const Eigen::MatrixXd& constraints);

}  // namespace momenta::equations
