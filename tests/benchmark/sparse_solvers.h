#pragma once
// The sparse direct solvers of SuiteSparse behind one face, to be measured against each other on
// (7). Symbolic analysis once, then factorisations and solutions.

#include <momenta/dae/kkt/symmetric_matrix.h>

#include <memory>
#include <string>
#include <vector>

namespace momenta::benchmark_solvers {

class SparseSolver {
 public:
  virtual ~SparseSolver() = default;
  virtual std::string name() const = 0;
  /// Of the pattern.
  virtual bool analyse(const SymmetricMatrix& a) = 0;
  /// From the values, after analyse(). False where it is singular, or refused.
  virtual bool factor(const SymmetricMatrix& a) = 0;
  /// x ← A⁻¹ x, without refinement.
  virtual void solve(std::vector<double>& x) = 0;
  /// Of the factors: L + U, L, or R.
  virtual double entries() const = 0;
  /// The library's own estimate: reciprocal condition of the pivots; 0: it has none.
  virtual double quality() const = 0;
};

/// KLU by the two orders of KluSolver.
std::unique_ptr<SparseSolver> make_klu(bool by_columns);
std::unique_ptr<SparseSolver> make_umfpack();
/// CHOLMOD's simplicial LDLᵀ in the order of AMD, no pivoting: of a quasi-definite matrix alone.
std::unique_ptr<SparseSolver> make_cholmod();
/// SuiteSparseQR; its symbolic and numeric parts apart.
std::unique_ptr<SparseSolver> make_spqr();

}  // namespace momenta::benchmark_solvers
