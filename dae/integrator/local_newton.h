#pragma once
// Newton's linear systems of a DaeSystem, (∂F/∂y + c ∂F/∂y') δ = F, without SUNDIALS: dense LU with
// rows of equal size, KLU on the system's pattern, or KLU on its local matrix (system.h).

#include <momenta/dae/integrator/newton_matrix.h>
#include <momenta/dae/integrator/sundials_handles.h>
#include <momenta/dae/integrator/system.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

namespace momenta {

class DaeNewton {
 public:
  enum class Made { yes, not_evaluated, not_finite, singular };

  /// Takes a system that has started.
  explicit DaeNewton(DaeSystem& system);

  const char* linear_solver() const;
  /// Makes and factorises the matrix at (t, y, y').
  Made make(double t, const double* y, const double* ydot, double c);
  /// b ← J⁻¹ b.
  void solve(double* b);

 private:
  void scale_rows();

  DaeSystem& system_;
  LocalJacobian* local_;
  std::size_t n_;
  int version_ = 0;  ///< version of the local pattern in matrix_
  std::unique_ptr<NewtonMatrix<double>> matrix_;
  std::vector<double> row_scale_, work_;
};

// Newton's linear systems for IDA by a matrix that is larger than J and local: J δ = b is solved as
//
//   ( A  B ) ( δ )   ( b )
//   ( C  T ) ( z ) = ( 0 ),     J = A − B T⁻¹ C
//
// by KLU, its ordering (COLAMD) once, pivots kept while they do not make entries grow more than
// others would. IDA sees a matrix and a linear solver of its own kinds.

class LocalNewton {
 public:
  /// `size`: that of J.
  LocalNewton(LocalJacobian& jacobian, int size, const sundials::Context& context);
  LocalNewton(const LocalNewton&) = delete;
  LocalNewton& operator=(const LocalNewton&) = delete;

  SUNMatrix matrix() { return matrix_.get(); }
  SUNLinearSolver solver() { return solver_.get(); }
  /// False when the system's evaluation failed.
  bool evaluate(double t, const double* y, const double* ydot, double c);

 private:
  bool factor();
  void solve(double* x, const double* b);

  LocalJacobian& jacobian_;
  std::size_t size_;
  int version_ = 0;  ///< version of the pattern in newton_
  std::unique_ptr<NewtonMatrix<double>> newton_;
  std::vector<double> work_;
  sundials::Matrix matrix_;
  sundials::LinearSolver solver_;
};

// The share of the tolerance that one step may spend.
//
// N steps add up N local errors. On most motions they cancel for the larger part, and a tolerance
// for each step serves; on an undamped oscillation they do not: a formula damps or excites it, each
// period alike, and what it does to the energy grows with the number of periods. A spring of 10⁸
// N m/rad in a four-bar takes 7·10⁵ steps for 10 s. So from N₀ = 10⁴ steps in a run on, counted as
// they would be at the present length, N local errors add up to no more than N₀ tolerances:
//
//   error of a step ≤ tol min(1, N₀ h̄/T),   T the span of the run, h̄ a mean of the last steps:
//
// error per step below, error per unit step above (Hairer, Nørsett, Wanner, Solving Ordinary
// Differential Equations I, II.4). h̄ forgets over a thousand steps, and begins at T/N₀: were it the
// step tried, each rejection would make the test harder, and a start at short steps impossible.
// Rounding is left alone: no share is less than 10³ ε/rtol.

class LocalShare {
 public:
  /// For a run over `span` [s] at a relative tolerance.
  LocalShare(double span, double rtol)
      : span_(span),
        least_(std::min(1.0, 1e3 * std::numeric_limits<double>::epsilon() / rtol)),
        mean_(span / steps) {}

  /// The share, between 0 and 1.
  double now() const { return std::clamp(steps * mean_ / span_, least_, 1.0); }
  /// Notes a step of h [s].
  void passed(double h) { mean_ += (std::min(h, span_ / steps) - mean_) / memory; }

 private:
  static constexpr double steps = 1e4, memory = 1e3;
  double span_, least_, mean_;
};

}  // namespace momenta
