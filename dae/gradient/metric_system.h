#pragma once
// The symmetric system of the corrections after a step, and of the adjoint on accelerations,
//
//   K (x, y) = (r, s),   K = ( M    Φ_qᵀ )
//                            ( Φ_q  0    ),
//
// by the solvers of (7): with p = r it is (7) without prescribed motion, and with β = 1 that of a
// correction of positions. The solution is affine in p: a difference with p = 0 removes the
// prescribed part. O(bodies + m) by the sweeps that carry loops; where rows of Φ are redundant, or
// no recursion takes a joint, by StageMatrix, with the shortest y.

#include <momenta/dae/gradient/stage_matrix.h>
#include <momenta/dae/kkt/loop_solver.h>

namespace momenta {

class MetricSystem {
 public:
  /// The mechanism must outlive it.
  explicit MetricSystem(const Mechanism& mechanism);

  /// The matrix alone from now on.
  void by_matrix() { recursive_ = false; }
  /// Goes to (t, q). False where the matrix is singular.
  bool place(double t, const Eigen::VectorXd& q);
  // False where the matrix is singular; x of nv numbers, y of m:
  /// r as given (nv), s = 0.
  bool solve(const Eigen::VectorXd& r, Eigen::VectorXd& x, Eigen::VectorXd& y);
  /// r = 0, s = −Φ: the correction δ of q, and ν.
  bool correction(Eigen::VectorXd& delta, Eigen::VectorXd& nu);
  /// r = M u, s = −Φ_t: the rates next to u (nv) that the loops allow, and ν.
  bool nearest(const Eigen::VectorXd& u, Eigen::VectorXd& v, Eigen::VectorXd& nu);

 private:
  bool by_recursion(const double* p, double beta, Eigen::VectorXd& x, Eigen::VectorXd& y);
  bool still();
  bool by_factors(const Eigen::VectorXd& r, const Eigen::VectorXd& s, Eigen::VectorXd& x,
                  Eigen::VectorXd& y);

  Eigen::Index nv_, m_;
  bool driven_, recursive_ = true, factored_ = false;
  std::unique_ptr<Evaluation<double>> e_;
  std::unique_ptr<LoopSolver> solver_;  ///< null without loops
  StageMatrix matrix_;
  double t_ = 0;
  Eigen::VectorXd q_, p_, pdot_, none_, right_, x_still_, y_still_;
};

}  // namespace momenta
