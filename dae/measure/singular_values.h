#pragma once
// Singular values of dense matrices: Eigen's divide and conquer, which takes half a minute to
// compile, compiled once.

#include <Eigen/SVD>

extern template class Eigen::BDCSVD<Eigen::MatrixXd>;
