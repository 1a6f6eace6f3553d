#pragma once
// Collocation on [0, 1]: everything from the nodes c. With ℓ_j the Lagrange polynomials of the
// nodes
//
//   W_j(θ) = ∫_0^θ ℓ_j,  a_ij = W_j(c_i),  b_j = W_j(1),  y(t + θh) = y + h Σ_j W_j(θ) k_j.
//
// The nodes of Gauss give order 2s at the end of a step, s inside it. Source: Hairer, Norsett,
// Wanner, Solving Ordinary Differential Equations I, II.7.

#include <array>
#include <cmath>

namespace momenta::gauss {

template <int s>
std::array<double, s> nodes() {
  if constexpr (s == 2)
    return {0.5 - std::sqrt(3.0) / 6, 0.5 + std::sqrt(3.0) / 6};
  else
    return {0.5 - std::sqrt(15.0) / 10, 0.5, 0.5 + std::sqrt(15.0) / 10};
}

template <int s>
class Collocation {
 public:
  Collocation() : c(nodes<s>()) {
    for (int j = 0; j < s; ++j) {
      // ℓ_j by its coefficients, one linear factor at a time, then integrated.
      std::array<double, s + 1> l{1};
      int degree = 0;
      for (int i = 0; i < s; ++i) {
        if (i == j) continue;
        const double scale = 1 / (c[at(j)] - c[at(i)]);
        ++degree;
        for (int k = degree; k >= 0; --k)
          l[at(k)] = scale * ((k > 0 ? l[at(k - 1)] : 0.0) - c[at(i)] * l[at(k)]);
      }
      for (int k = 0; k < s; ++k) integral_[at(j)][at(k)] = l[at(k)] / (k + 1);
    }
    for (int i = 0; i < s; ++i)
      for (int j = 0; j < s; ++j) a[at(i)][at(j)] = weight(j, c[at(i)]);
    for (int j = 0; j < s; ++j) b[at(j)] = weight(j, 1);
  }

  /// W_j(θ).
  double weight(int j, double theta) const {
    double sum = 0;
    for (int k = s - 1; k >= 0; --k) sum = theta * (sum + integral_[at(j)][at(k)]);
    return sum;
  }

  std::array<double, s> c{}, b{};
  std::array<std::array<double, s>, s> a{};

 private:
  static constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }
  std::array<std::array<double, s>, s> integral_{};
};

}  // namespace momenta::gauss
