#pragma once
// Newton's linear systems for IDA by a matrix that is larger than J and local: J δ = b is solved as
//
//   ( A  B ) ( δ )   ( b )
//   ( C  T ) ( z ) = ( 0 ),     J = A − B T⁻¹ C
//
// by KLU, its ordering (COLAMD) once, pivots kept while they do not make entries grow more than
// others would. IDA sees a matrix and a linear solver of its own kinds.

#include <momenta/dae/solver/newton_matrix.h>
#include <momenta/dae/solver/sundials_handles.h>

namespace momenta {

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

}  // namespace momenta
