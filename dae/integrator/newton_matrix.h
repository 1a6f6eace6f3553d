#pragma once
// A Newton matrix of the implicit Runge-Kutta and second-order methods, real or complex, dense or
// with the system's pattern: filled, factorised, solved with. IDA and CVODE have their own.

#include <momenta/dae/integrator/system.h>

#include <complex>
#include <memory>

namespace momenta {

template <class Scalar>  // double or std::complex<double>
class NewtonMatrix {
 public:
  virtual ~NewtonMatrix() = default;
  /// Values to fill. Dense: column-major n × n. Sparse: in the order of the pattern.
  virtual Scalar* values() = 0;
  /// False when the matrix is singular or not finite. Dense O(n³).
  virtual bool factor() = 0;
  /// b ← A⁻¹ b, n values. Allocates nothing.
  virtual void solve(Scalar* b) = 0;
  /// Factorisations with fresh pivots: all dense ones.
  virtual long choices() const = 0;
};

/// Partially pivoted LU where the pattern is empty, KLU where it is not. The pattern must outlive
/// the matrix.
template <class Scalar>
std::unique_ptr<NewtonMatrix<Scalar>> make_newton_matrix(int size, const JacobianPattern& pattern);

/// KLU with columns in COLAMD's order, best for a matrix of LocalJacobian: factors of a ladder of
/// crossed bars then grow like its bars. The pattern must outlive the matrix.
template <class Scalar = double>
std::unique_ptr<NewtonMatrix<Scalar>> make_local_matrix(const JacobianPattern& pattern);

/// Number of stored values.
inline std::size_t entry_count(int size, const JacobianPattern& pattern) {
  const auto n = static_cast<std::size_t>(size);
  return pattern.column_start.empty() ? n * n : pattern.row.size();
}

/// y += factor A x for the stored values of a matrix of this pattern.
inline void add_product(const JacobianPattern& pattern, const std::vector<double>& values,
                        double factor, const double* x, std::vector<double>& y) {
  const std::size_t n = y.size();
  for (std::size_t column = 0; column < n; ++column) {
    const double value = factor * x[column];
    if (pattern.column_start.empty()) {
      for (std::size_t row = 0; row < n; ++row) y[row] += values[column * n + row] * value;
      continue;
    }
    const auto end = static_cast<std::size_t>(pattern.column_start[column + 1]);
    for (auto k = static_cast<std::size_t>(pattern.column_start[column]); k < end; ++k)
      y[static_cast<std::size_t>(pattern.row[k])] += values[k] * value;
  }
}

/// Name of the solver in results.
inline const char* linear_solver_name(const JacobianPattern& pattern) {
  return pattern.column_start.empty() ? "dense LU" : "KLU";
}

}  // namespace momenta
