#pragma once
// Symmetric forms F_i(y) = yᵀF_i y of a few unknowns: directions in which all of them vanish, and
// sums of them that are positive. Where there is such a sum there is no such direction.

#include <Eigen/Core>
#include <random>
#include <vector>

namespace momenta {

/// Unit vectors of n numbers; the same every time.
class RandomDirections {
 public:
  Eigen::VectorXd next(Eigen::Index n);

 private:
  std::mt19937 random_{1};
};

struct QuadraticForms {
  std::vector<Eigen::MatrixXd> all;  ///< at least one, each about 1 or less in size

  Eigen::Index size() const { return all.front().rows(); }  ///< unknowns
  Eigen::VectorXd at(const Eigen::VectorXd& y) const;
  /// Σ c_i F_i
  Eigen::MatrixXd sum(const Eigen::VectorXd& c) const;
  /// The forms in x, y = basis x.
  QuadraticForms in(const Eigen::MatrixXd& basis) const;
};

/// Orthonormal columns that span the y found with F_i(y) = 0, by Gauss-Newton from some 4 starts an
/// unknown.
Eigen::MatrixXd common_zeros(const QuadraticForms& forms);

/// c of a Σ c_i F_i that is positive definite, by the rule of perceptrons: each y where it is not
/// adds its F_i(y). Empty where none was found.
Eigen::VectorXd positive_sum(const QuadraticForms& forms);

}  // namespace momenta
