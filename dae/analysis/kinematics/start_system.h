#pragma once
// The start G(x) = 0 of a homotopy (homotopy.h): equations of the degrees of F, each a product of
// linear forms, one group of variables each, with random coefficients on the unit circle. A
// solution makes one factor of every equation zero, as many of each group as its dimension: it
// solves linear equations, group by group.

#include <momenta/dae/analysis/kinematics/polynomial_system.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace momenta {

/// Random numbers on the unit circle.
class UnitCircle {
 public:
  explicit UnitCircle(std::uint64_t seed) : seed_(seed) {}
  Complex next();

 private:
  std::uint64_t seed_, count_ = 0;
};

class StartSystem {
 public:
  /// G with the degrees of `f`, which must outlive it. O(Bézout number of f)
  StartSystem(const PolynomialSystem& f, UnitCircle& circle);
  /// Number of solutions, the Bézout number.
  std::size_t solutions() const { return choices_.size(); }
  /// A solution, each group of length one (variables).
  Eigen::VectorXcd solution(std::size_t number) const;
  /// G (n) and its derivatives (n × variables).
  void evaluate(const Eigen::VectorXcd& x, Eigen::VectorXcd& values,
                Eigen::MatrixXcd& slopes) const;

 private:
  struct Form {
    int group;
    Eigen::VectorXcd c;
  };

  void choose(std::size_t equation, const std::vector<int>& taken, std::vector<std::size_t> chosen);

  const PolynomialSystem& f_;
  std::vector<std::vector<Form>> forms_;
  std::vector<std::vector<std::size_t>> choices_;  ///< vanishing factors of each solution
};

}  // namespace momenta
