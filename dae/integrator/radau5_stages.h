#pragma once
// The nonlinear system of one step of Radau IIA, order 5, for F(t, y, y') = 0:
//
//   F(t + c_i h, y + Z_i, Y'_i) = 0,  Y' = A⁻¹ Z / h,  i = 1, 2, 3;  y_new = y + Z_3,
//
// by simplified Newton iterations. With A⁻¹ = T Λ T⁻¹, Λ = γ ⊕ (α, −β; β, α), W = T⁻¹ Z and
// J(c) = ∂F/∂y + c ∂F/∂y' the three coupled systems of n equations become a real and a complex one:
//
//   J(γ/h) ΔW_1 = −R_1,   J((α + iβ)/h) (ΔW_2 + i ΔW_3) = −(R_2 + i R_3),   R = T⁻¹ F.
//
// J(0) and ∂F/∂y' are kept, so that another h needs another factorisation and no new derivatives.
// Source: Hairer, Wanner, Solving Ordinary Differential Equations II, IV.5, IV.8; for F(t, y, y')
// the same with M replaced by ∂F/∂y' and −J by ∂F/∂y.

#include <momenta/dae/integrator/newton_matrix.h>
#include <momenta/dae/integrator/radau5_tableau.h>
#include <momenta/dae/integrator/sundials_handles.h>
#include <momenta/dae/integrator/weighted_norm.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace momenta::radau5 {

/// J(γ/h) and J((α + iβ)/h), factorised.
struct Factors {
  Factors(int size, const JacobianPattern& pattern)
      : real(make_newton_matrix<double>(size, pattern)),
        complex(make_newton_matrix<std::complex<double>>(size, pattern)) {}
  std::unique_ptr<NewtonMatrix<double>> real;
  std::unique_ptr<NewtonMatrix<std::complex<double>>> complex;
};

/// Newton iterations where no shorter step can be tried.
inline constexpr int patient_iterations = 40;

enum class Outcome { converged, slow, diverged, evaluation_failed, not_finite };

class Stages {
 public:
  Stages(DaeSystem& system)
      : system_(system),
        n_(static_cast<std::size_t>(system.size())),
        entries_(entry_count(system.size(), system.pattern())),
        inverse_(coefficients().inverse()),
        t_(transformation()),
        t_inverse_(t_.inverse()) {
    for (auto* v : {&argument_, &rate_, &r_[0], &r_[1], &r_[2], &w_[0], &w_[1], &w_[2]})
      v->resize(n_);
    by_y_.resize(entries_);
    by_rate_.resize(entries_);
    complex_.resize(n_);
  }

  long evaluations = 0, iterations = 0;
  /// Last solve: the contraction, its last factor θ/(1 − θ), iterations.
  double theta = 0, contraction = 1;
  int count = 0;

  /// ∂F/∂y and ∂F/∂y'; `rate_scale` [1/s] only balances the two in one evaluation.
  bool differentiate(double t, const double* y, const double* ydot, double rate_scale) {
    if (!system_.jacobian(t, y, ydot, 0, by_y_.data()) ||
        !system_.jacobian(t, y, ydot, rate_scale, by_rate_.data()))
      return false;
    for (std::size_t i = 0; i < entries_; ++i) by_rate_[i] = (by_rate_[i] - by_y_[i]) / rate_scale;
    return true;
  }

  /// False: a matrix is singular.
  bool factor(Factors& f, double h) const {
    for (std::size_t i = 0; i < entries_; ++i) {
      f.real->values()[i] = by_y_[i] + gamma / h * by_rate_[i];
      f.complex->values()[i] = {by_y_[i] + alpha / h * by_rate_[i], beta / h * by_rate_[i]};
    }
    return f.real->factor() && f.complex->factor();
  }

  /// Newton iterations on z (3 of n values each, a guess on entry). They stop at `fraction` of the
  /// tolerance, or when `most` would not be enough.
  Outcome solve(const Factors& f, double t, double h, const double* y, const WeightedNorm& norm,
                double fraction, int most, StageValues& z);

  /// After solve(): the last correction of Z_3.
  void last_correction(double* z) const {
    for (std::size_t k = 0; k < n_; ++k)
      z[k] = t_(2, 0) * r_[0][k] + t_(2, 1) * r_[1][k] + t_(2, 2) * r_[2][k];
  }

  /// Y'_i = Σ_j (A⁻¹)_ij Z_j / h.
  void rate(int i, double h, const StageValues& z, double* ydot) const {
    for (std::size_t k = 0; k < n_; ++k)
      ydot[k] =
          (inverse_(i, 0) * z[0][k] + inverse_(i, 1) * z[1][k] + inverse_(i, 2) * z[2][k]) / h;
  }

  /// x ← J(γ/h)⁻¹ (γ/h) ∂F/∂y' x: x after an implicit Euler step of h/γ.
  void filter(const Factors& f, double h, double* x);

 private:
  DaeSystem& system_;
  std::size_t n_, entries_;
  Eigen::Matrix3d inverse_, t_, t_inverse_;
  std::vector<double> by_y_, by_rate_, argument_, rate_;
  StageValues r_, w_;
  std::vector<std::complex<double>> complex_;
};

// The nonlinear system of radau5_stages.h by Newton's method with derivatives of each stage, in one
// matrix of 3n rows,
//
//   δ_ij ∂F/∂y|_i + (A⁻¹)_ij / h ∂F/∂y'|_i,
//
// for equations whose structure is not regular (system.h): the simplified iteration need
// not converge on them, however short the step. What it misses of ∂F/∂y' at the stages, of order h,
// comes c times with c/h: with a + η t b = f, a' + η t b' + (1 + η) b = g it contracts by
// 2η/(1 + η), whatever h is.

class WholeStages {
 public:
  explicit WholeStages(DaeSystem& system);

  /// As Stages::solve(); `rate_scale` as in Stages::differentiate().
  Outcome solve(double t, double h, double rate_scale, const double* y, const WeightedNorm& norm,
                double fraction, StageValues& z);

  long evaluations = 0, iterations = 0, jacobians = 0;

 private:
  bool differentiate(double t, double h, double rate_scale, const double* y, const StageValues& z);
  static JacobianPattern pattern_of(const JacobianPattern& one, long n);
  void place(double h, const double* y, const StageValues& z, std::size_t i);

  DaeSystem& system_;
  std::size_t n_;
  Eigen::Matrix3d inverse_;
  JacobianPattern pattern_;
  std::unique_ptr<NewtonMatrix<double>> matrix_;
  std::vector<double> by_y_, by_rate_, argument_, rate_, r_;
};

}  // namespace momenta::radau5
