#pragma once
// Ways along which the potential curves downwards: eigenvectors of negative κ in
//
//   K y = κ M y,   Φ_q y = 0
//
// by a few steps of Lanczos' method in the metric M, on M⁻¹K, which brings out κ far below zero,
// and, where there are none, on (K + μM)⁻¹M, which brings out those near it. Where K is not
// symmetric, real κ < 0 by Arnoldi's method: no pair of complex κ leads straight away. Products
// with K by dual numbers, with M⁻¹ by the solver of the loops, O(bodies) each. Source: Parlett, The
// Symmetric Eigenvalue Problem, chapter 13.

#include <momenta/dae/linear/local_pencil.h>
#include <momenta/dae/linear/pose_motion.h>

namespace momenta {

class DownwardWays {
 public:
  /// `poses` must outlive it.
  DownwardWays(const Mechanism& mechanism, PoseMotion& poses);

  /// Their sum, each with yᵀMy = 1 (nv), at (t, q) with λ; empty where none is found. `factored`:
  /// K + μM there, with a μ that is small. `symmetric`: K is, there on Φ_q y = 0
  Eigen::VectorXd find(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& lambda,
                       LocalPencil& factored, bool symmetric);

 private:
  template <class Image>
  Eigen::VectorXd negative(int steps, bool symmetric, Image&& image);
  Eigen::VectorXd stiffness(double t, const Eigen::VectorXd& y);

  const Mechanism& mechanism_;
  PoseMotion& poses_;
  std::unique_ptr<Evaluation<Dual8>> dual_;
  std::vector<Dual8> q_, u_, lambda_, r_;
  double now_ = 0;  ///< [s]
  Eigen::VectorXd place_, way_;
};

}  // namespace momenta
