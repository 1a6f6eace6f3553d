#pragma once
// The signature matrix of a DAE: derivatives in each equation,
//
//   σ_ij = the highest order of a derivative of x_j in equation i; absent without x_j,
//
// the input of structural analysis. Source: Pryce, A simple structural analysis method for DAEs,
// BIT 41 (2001).

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace momenta::structure {

inline std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

class Signature {
 public:
  static constexpr int absent = std::numeric_limits<int>::min();

  explicit Signature(int size) : size_(size), order_(at(size) * at(size), absent) {}

  int size() const { return size_; }  ///< equations, and variables
  int& operator()(int equation, int variable) { return order_[place(equation, variable)]; }
  int operator()(int equation, int variable) const { return order_[place(equation, variable)]; }
  bool has(int equation, int variable) const { return (*this)(equation, variable) != absent; }

 private:
  std::size_t place(int equation, int variable) const {
    return at(equation) * at(size_) + at(variable);
  }
  int size_;
  std::vector<int> order_;
};

// The Σ-method: number of differentiations of each equation, from the signature alone.
//
// With T a highest-value transversal, the least offsets c_i, d_j ≥ 0 with
//
//   d_j − c_i ≥ σ_ij for all i, j,    d_j − c_i = σ_ij on T
//
// say: differentiate equation i c_i times; the equations f_i^(c_i) = 0 then give the derivatives
// x_j^(d_j), where their matrix
//
//   J_ij = ∂f_i / ∂x_j^(σ_ij) where d_j − c_i = σ_ij, else 0          (the system Jacobian)
//
// is regular. The structural index is max c_i, plus one where some d_j = 0; degrees of freedom are
// Σ d_j − Σ c_i. Where J is regular at a point the differentiation index is at most the structural
// one; a singular J leaves it open. Source: Pryce, A simple structural analysis method for DAEs,
// BIT 41 (2001).

struct Offsets {
  std::vector<int> transversal;  ///< the variable of each equation
  std::vector<int> equation;     ///< c_i, the least
  std::vector<int> variable;     ///< d_j
  int index = 0;                 ///< structural
  int freedom = 0;               ///< degrees of freedom, the value of the transversal

  /// Whether entry (i, j) is in the system Jacobian.
  bool tight(const Signature& s, int i, int j) const {
    return s.has(i, j) &&
           variable[static_cast<std::size_t>(j)] - equation[static_cast<std::size_t>(i)] == s(i, j);
  }
};

/// Nothing where the system is structurally singular. O(n³), and O(n²) for each differentiation.
std::optional<Offsets> sigma_method(const Signature& signature);

/// Number of differentiations of each equation in Pantelides' algorithm: until equations can be
/// assigned to the highest derivatives, it differentiates those with too few of these.
/// @pre σ_ij ≤ 1, and sigma_method() finds offsets: else it does not end. O(n³) for each
/// differentiation. Source: Pantelides, The consistent initialization of differential-algebraic
/// systems, SIAM J. Sci. Stat. Comput. 9 (1988).
std::vector<int> pantelides(const Signature& signature);

}  // namespace momenta::structure
