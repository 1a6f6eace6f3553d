#pragma once
// The signature matrix of a DAE: derivatives in each equation,
//
//   σ_ij = the highest order of a derivative of x_j in equation i; absent without x_j,
//
// the input of structural analysis. Source: Pryce, A simple structural analysis method for DAEs,
// BIT 41 (2001).

#include <cstddef>
#include <limits>
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

}  // namespace momenta::structure
