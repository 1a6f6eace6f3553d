#pragma once
// Newton's linear systems of a DaeSystem, (∂F/∂y + c ∂F/∂y') δ = F, without SUNDIALS: dense LU with
// rows of equal size, KLU on the system's pattern, or KLU on its local matrix (system.h).

#include <momenta/dae/solver/newton_matrix.h>
#include <momenta/dae/solver/system.h>

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

}  // namespace momenta
