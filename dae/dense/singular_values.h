#pragma once
// Singular values of dense matrices: Eigen's divide and conquer, and the rotations it ends with,
// which take half a minute to compile, compiled once.

#include <Eigen/SVD>

extern template class Eigen::BDCSVD<Eigen::MatrixXd>;
extern template class Eigen::JacobiSVD<Eigen::MatrixXd>;
