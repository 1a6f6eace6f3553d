#pragma once
// Systems of the linearised equations, by a sparse matrix that grows like the mechanism:
//
//   ( K + c C + a M   Φ_qᵀ ) ( δ )   ( f )
//   ( Φ_q             −E   ) ( ν ) = ( g )
//
// K, C and M of a chain are full, but KLU factorises the sparse matrix of the dual numbers of
// core/scalar/local_dual.h, evaluated at u = c δ, u̇ = a δ.

#include <momenta/dae/form/local_rows.h>
#include <momenta/dae/integrator/newton_matrix.h>
#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace momenta {

class LocalPencil {
 public:
  explicit LocalPencil(const Mechanism& mechanism);

  /// E (m), diagonal: loops give way, so that redundant ones do no harm. Empty: none.
  void soften(std::vector<double> compliance) { compliance_ = std::move(compliance); }
  /// Leaves out loop equations; their ν is zero.
  void leave_out(const std::vector<int>& rows);

  /// Factorises at (t, q) with λ (m). False where the matrix is singular or not finite. O(fill)
  bool factor(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& lambda, double a,
              double c);
  /// f (nv) becomes δ, g (m) becomes ν.
  void solve(Eigen::VectorXd& f, Eigen::VectorXd& g);

 private:
  const Mechanism& mechanism_;
  std::unique_ptr<Evaluation<LocalDual>> local_;
  std::vector<LocalDual> q_, u_, udot_, lambda_, qdot_, r_, phi_, of_rates_;
  std::vector<double> compliance_;
  std::vector<bool> out_;  ///< by loop equation
  Cuts cuts_;
  LocalRows rows_;
  int version_ = 0;  ///< version of the pattern in matrix_
  std::unique_ptr<NewtonMatrix<double>> matrix_;
  std::vector<double> work_;
};

}  // namespace momenta
