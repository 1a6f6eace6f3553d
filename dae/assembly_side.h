#pragma once
// Which assembly was reached. Where as many joints are free as there are independent equations, the
// poses that close the loops are isolated, and between two of them that mirror each other lies a
// pose at which the determinant of the equations vanishes. Its sign at the guess and at the pose
// reached therefore tells whether the way led across. Loops that do not depend on each other have
// signs of their own: those of the diagonal blocks to which the matrix can be permuted.

#include <Eigen/Core>
#include <string>
#include <vector>

namespace momenta {

/// Groups of rows whose block's determinant differs in sign between `from` and `to`, both m × n
/// Jacobians in which columns of held joints are zero. Empty where the free columns outnumber the
/// rank, or where a block is too near zero at `from` to have a sign. Cost O(m³)
std::vector<std::vector<int>> rows_that_changed_side(const Eigen::MatrixXd& from,
                                                     const Eigen::MatrixXd& to);

}  // namespace momenta
