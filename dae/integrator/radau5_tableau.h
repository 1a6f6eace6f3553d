#pragma once
// Radau IIA of order 5: nodes c, A, and A⁻¹ = T Λ T⁻¹ with Λ = γ ⊕ (α, −β; β, α); the collocation
// cubic of a step. Source: Hairer, Wanner, Solving Ordinary Differential Equations II, IV.5, IV.8.

#include <Eigen/Core>
#include <Eigen/LU>
#include <array>
#include <complex>
#include <cstddef>
#include <vector>

namespace momenta::radau5 {

inline constexpr double root6 = 2.4494897427831780982;
inline constexpr std::array<double, 3> c{(4 - root6) / 10, (4 + root6) / 10, 1.0};

/// Runge-Kutta matrix.
inline Eigen::Matrix3d coefficients() {
  Eigen::Matrix3d a;
  a << (88 - 7 * root6) / 360, (296 - 169 * root6) / 1800, (-2 + 3 * root6) / 225,
      (296 + 169 * root6) / 1800, (88 + 7 * root6) / 360, (-2 - 3 * root6) / 225, (16 - root6) / 36,
      (16 + root6) / 36, 1.0 / 9;
  return a;
}

/// Eigenvalues of A⁻¹: γ and α ± iβ, in terms of ∛9.
inline constexpr double root9 = 2.0800838230519041145;
inline constexpr double gamma0 = (6 + root9 * (root9 - 1)) / 30;  ///< 1/γ
inline constexpr double inverse_alpha = (12 - root9 * (root9 - 1)) / 60;
inline constexpr double inverse_beta = root9 * (root9 + 1) * 1.7320508075688772935 / 60;
inline constexpr double modulus = inverse_alpha * inverse_alpha + inverse_beta * inverse_beta;
inline constexpr double gamma = 1 / gamma0, alpha = inverse_alpha / modulus,
                        beta = inverse_beta / modulus;

/// T: the real eigenvector of A⁻¹, then real and (negative) imaginary part of a complex one, scaled
/// to T_32 = 1, T_33 = 0. An eigenvector of A = integration has the values at c of a cubic x(θ),
/// x(0) = 0, whose derivative is μ x up to a multiple of the nodes' polynomial.
inline Eigen::Matrix3d transformation() {
  const Eigen::Matrix3d inverse = coefficients().inverse();
  Eigen::Matrix3d t;
  // (A⁻¹ − μ) x = 0 with x_3 = 1, from the first two rows; real and imaginary parts for α + iβ.
  const Eigen::Matrix2d block = inverse.topLeftCorner<2, 2>();
  const Eigen::Vector2d right = -inverse.topRightCorner<2, 1>();
  t.col(0) << (block - gamma * Eigen::Matrix2d::Identity()).inverse() * right, 1.0;
  using C = std::complex<double>;
  const Eigen::Matrix2cd shifted = block.cast<C>() - C(alpha, beta) * Eigen::Matrix2cd::Identity();
  const Eigen::Vector2cd x = shifted.inverse() * right.cast<C>();
  t.col(1) << x.real(), 1.0;
  t.col(2) << -x.imag(), 0.0;
  return t;
}

/// Z_1, Z_2, Z_3, n values each.
using StageValues = std::array<std::vector<double>, 3>;

/// The collocation polynomial of a step less its start, component k, at a fraction x of the step:
/// the cubic through 0 at 0 and Z_i at c_i.
inline double polynomial(const StageValues& z, std::size_t k, double x) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, l = (i + 2) % 3;
    sum += z[i][k] * (x * (x - c[j]) * (x - c[l])) / (c[i] * (c[i] - c[j]) * (c[i] - c[l]));
  }
  return sum;
}

/// Its derivative by that fraction.
inline double slope(const StageValues& z, std::size_t k, double x) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double b = c[(i + 1) % 3], d = c[(i + 2) % 3];
    sum += z[i][k] * (3 * x * x - 2 * (b + d) * x + b * d) / (c[i] * (c[i] - b) * (c[i] - d));
  }
  return sum;
}

}  // namespace momenta::radau5
