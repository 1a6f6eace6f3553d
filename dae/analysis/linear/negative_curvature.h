#pragma once
// Directions along which the potential curves downwards: eigenvectors of negative κ in
//
//   K y = κ M y,   Φ_q y = 0
//
// by a few steps of Lanczos' method in the metric M, on M⁻¹K for κ far below zero and, without any,
// on (K + μM)⁻¹M for κ near it. Where K is not symmetric, real κ < 0 by Arnoldi's method: no pair
// of complex κ leads straight away. Products with K by dual numbers, with M⁻¹ by the solver of the
// loops, O(bodies) each. Source: Parlett, The Symmetric Eigenvalue Problem, chapter 13.

#include <momenta/dae/analysis/linear/local_pencil.h>
#include <momenta/dae/analysis/linear/pose_motion.h>

namespace momenta {

class NegativeCurvature {
 public:
  /// `poses` must outlive it.
  NegativeCurvature(const Mechanism& mechanism, PoseMotion& poses);

  /// Sum of the directions, each with yᵀMy = 1 (nv), at (t, q) with λ; empty: none. `factored`: K +
  /// μM there, μ small. `symmetric`: K is, on Φ_q y = 0
  Eigen::VectorXd find(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& lambda,
                       LocalPencil& factored, bool symmetric);

 private:
  template <class Image>
  Eigen::MatrixXd negative(int steps, bool symmetric, Image&& image);
  /// Those of the ways y (columns) with yᵀKy < 0: rounding in M⁻¹ may turn the sign of a κ.
  Eigen::MatrixXd downward(const Eigen::MatrixXd& ways);
  Eigen::VectorXd stiffness(double t, const Eigen::VectorXd& y);

  const Mechanism& mechanism_;
  PoseMotion& poses_;
  std::unique_ptr<Evaluation<Dual8>> dual_;
  std::vector<Dual8> q_, u_, lambda_, r_;
  double now_ = 0;  ///< [s]
  Eigen::VectorXd place_, way_;
};

}  // namespace momenta
