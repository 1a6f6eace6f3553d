#pragma once
// Corrections of Gauss stages by simplified Newton iteration,
//
//   (1 − h A ⊗ J) ΔZ = R = h A k − Z,      J = ∂f/∂y in the middle of a step.
//
// With A = T diag(μ_i) T⁻¹ the s systems that A couples come apart,
//
//   (1 − h μ_i J) W_i = (T⁻¹R)_i,      ΔZ = T W:
//
// for s = 2 a pair of conjugates, of which one is solved, ΔZ = 2 Re(T_1 W_1); for s = 3 a real one
// besides. Two factorisations of n unknowns at most in place of one of s n, and each may be sparse
// (ode_slopes.h). J is kept from step to step, its factors as long as h stays.
// Source: Hairer, Wanner, Solving Ordinary Differential Equations II, IV.8.

#include <momenta/dae/integrator/gauss_nodes.h>
#include <momenta/dae/integrator/ode_slopes.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <array>
#include <complex>
#include <vector>

namespace momenta::gauss {

template <int s>
class Newton {
  using Complex = std::complex<double>;
  static constexpr bool has_real = s % 2 == 1;

 public:
  Newton(OdeSystem& system, const Collocation<s>& tableau)
      : slopes_(system), n_(static_cast<std::size_t>(system.size())) {
    Eigen::Matrix<double, s, s> a;
    for (int i = 0; i < s; ++i)
      for (int j = 0; j < s; ++j) a(i, j) = tableau.a[at(i)][at(j)];
    const Eigen::EigenSolver<Eigen::Matrix<double, s, s>> solver(a);
    const Eigen::Matrix<Complex, s, s> t = solver.eigenvectors(), inverse = t.inverse();
    for (int i = 0; i < s; ++i) {
      const Complex mu = solver.eigenvalues()[i];
      if (mu.imag() < 0) continue;
      const bool real = mu.imag() == 0;
      if (real) real_mu_ = mu.real();
      if (!real) mu_ = mu;
      for (int j = 0; j < s; ++j) {
        if (real) left_[at(j)] = (inverse(i, j) * t(0, i)).real();
        if (real) right_[at(j)] = (t(j, i) / t(0, i)).real();
        if (!real) complex_left_[at(j)] = inverse(i, j);
        if (!real) complex_right_[at(j)] = 2.0 * t(j, i);
      }
    }
  }

  /// J at the middle of the step from (t, y), without factors. False: cause().
  bool differentiate(double t, double h, const double* y) {
    ++jacobians;
    factored_for_ = 0;
    known_ = slopes_.evaluate(t + 0.5 * h, y, 1 / h);
    return known_;
  }
  bool known() const { return known_; }  ///< whether there is a J
  void forget() { known_ = false; }
  /// Factorises for h, with the J at hand. False: singular.
  bool factor(double h) {
    if (factored_for_ == h) return true;
    factored_for_ = 0;
    factorizations += has_real ? 2 : 1;
    if (has_real && !real_.factor(slopes_, h * real_mu_)) return false;
    if (!complex_.factor(slopes_, h * mu_)) return false;
    real_part_.resize(has_real ? n_ : 0);
    complex_part_.resize(n_);
    factored_for_ = h;
    return true;
  }
  /// Turns R, n values a stage, into ΔZ. Allocates nothing.
  void solve(double* r) {
    for (std::size_t i = 0; i < n_; ++i) {
      Complex sum = 0;
      for (int j = 0; j < s; ++j) sum += complex_left_[at(j)] * r[at(j) * n_ + i];
      complex_part_[i] = sum;
      if constexpr (has_real) {
        real_part_[i] = 0;
        for (int j = 0; j < s; ++j) real_part_[i] += left_[at(j)] * r[at(j) * n_ + i];
      }
    }
    complex_.solve(complex_part_.data());
    if constexpr (has_real) real_.solve(real_part_.data());
    for (int j = 0; j < s; ++j)
      for (std::size_t i = 0; i < n_; ++i) {
        double& change = r[at(j) * n_ + i];
        change = (complex_right_[at(j)] * complex_part_[i]).real();
        if constexpr (has_real) change += right_[at(j)] * real_part_[i];
      }
  }

  const OdeSlopes& slopes() const { return slopes_; }
  long jacobians = 0, factorizations = 0;

 private:
  static constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

  OdeSlopes slopes_;
  std::size_t n_;
  bool known_ = false;
  double factored_for_ = 0;  ///< h of the factors
  double real_mu_ = 0;
  Complex mu_;
  std::array<double, s> left_{}, right_{};  ///< row of T⁻¹ and column of T
  std::array<Complex, s> complex_left_{}, complex_right_{};
  Resolvent<double> real_;
  Resolvent<Complex> complex_;
  std::vector<double> real_part_;
  std::vector<Complex> complex_part_;
};

}  // namespace momenta::gauss
