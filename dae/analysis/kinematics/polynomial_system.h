#pragma once
// Polynomial equations in a product of projective spaces, and their derivatives.
//
// The variables fall into groups; each equation is homogeneous in each group g, of degree d_ig. A
// group of n_g + 1 variables is a projective space of dimension n_g; there are as many equations as
// dimensions, n = Σ n_g. A group of affine equations has a variable `one` that makes it
// homogeneous, zero for solutions at infinity. A group without it is projective by nature; its
// solutions are at infinity where all variables of a set of `proper` vanish.
//
// The number of isolated solutions is at most the multihomogeneous Bézout number: the coefficient
// of Π α_g^{n_g} in Π_i Σ_g d_ig α_g. Source: A. P. Morgan, A. J. Sommese, Appl. Math. Comput. 24
// (1987) 101-113.

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace momenta {

using Complex = std::complex<double>;

struct Monomial {
  Complex factor;
  std::vector<int> variables;  ///< repeated, in any order
};
using Polynomial = std::vector<Monomial>;

Polynomial operator+(Polynomial a, const Polynomial& b);
Polynomial operator*(const Polynomial& a, const Polynomial& b);
/// c a
Polynomial scaled(Polynomial a, Complex c);

/// Sums monomials of the same variables, over the largest factor; leaves out rounding.
Polynomial gathered(const Polynomial& p);

struct VariableGroup {
  std::vector<int> variables;            ///< all variables, `one` included
  std::vector<std::vector<int>> proper;  ///< sets of variables; in a finite solution one of each is
                                         ///< not zero
};

class PolynomialSystem {
 public:
  /// Affine equations: variable x is in group `of[x]`; variables `one` follow the others. @pre as
  /// many equations as variables
  PolynomialSystem(std::vector<Polynomial> equations, const std::vector<int>& of);
  /// Homogeneous equations in these groups.
  PolynomialSystem(std::vector<Polynomial> equations, std::vector<VariableGroup> groups);

  int variables() const { return variables_; }
  int equations() const { return static_cast<int>(equations_.size()); }
  const std::vector<VariableGroup>& groups() const { return groups_; }
  int degree(int equation, int group) const {
    return degrees_[static_cast<std::size_t>(equation)][static_cast<std::size_t>(group)];
  }
  /// The multihomogeneous Bézout number, or `most` + 1 where it is larger.
  long bezout(long most) const;

  /// Values (n) and derivatives (n × variables), each equation over its largest factor.
  void evaluate(const Eigen::VectorXcd& x, Eigen::VectorXcd& values,
                Eigen::MatrixXcd& slopes) const;

 private:
  void find_degrees();

  std::vector<Polynomial> equations_;
  std::vector<VariableGroup> groups_;
  std::vector<std::vector<int>> degrees_;
  int variables_ = 0;
};

}  // namespace momenta
