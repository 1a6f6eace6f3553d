#pragma once
// The least κ of K y = κ M y on Φ_q y = 0, by a few steps of Lanczos' method in the metric M:
// products with K by dual numbers, with M⁻¹ by the solver of the loops, O(bodies) each. Extreme
// eigenvalues come first, so what it gives tells after a few steps whether the potential curves
// downwards strongly, and roughly how much; it is never below the true one.
// Source: Parlett, The Symmetric Eigenvalue Problem, chapter 13.

#include <momenta/dae/linear/pose_motion.h>

namespace momenta {

struct Curvature {
  double least = 0, largest = 0;  ///< κ [1/s²]
  /// The sum of the y, yᵀMy = 1, of the κ found that are below a part of −1e-6 of the largest (nv);
  /// empty where none is.
  Eigen::VectorXd downwards;
};

class LeastCurvature {
 public:
  /// `poses` must outlive it.
  LeastCurvature(const Mechanism& mechanism, PoseMotion& poses);

  /// At (t, q) with λ. @pre K is symmetric there on Φ_q y = 0
  Curvature find(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& lambda, int steps);

 private:
  Eigen::VectorXd stiffness(double t, const Eigen::VectorXd& y);

  const Mechanism& mechanism_;
  PoseMotion& poses_;
  std::unique_ptr<Evaluation<Dual8>> dual_;
  std::vector<Dual8> q_, u_, lambda_, r_;
  Eigen::VectorXd place_, way_;
};

}  // namespace momenta
