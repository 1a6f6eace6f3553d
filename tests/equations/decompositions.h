#pragma once
// The decompositions of dense matrices that take longest to compile, of those that tests and slow
// twins ask Eigen for, compiled once.

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

extern template class Eigen::EigenSolver<Eigen::MatrixXd>;
extern template Eigen::EigenSolver<Eigen::MatrixXd>& Eigen::EigenSolver<Eigen::MatrixXd>::compute(
    const Eigen::EigenBase<Eigen::MatrixXd>&, bool);
extern template class Eigen::JacobiSVD<Eigen::MatrixXd>;
