#pragma once
// The slow twin of a run: Φ, Φ̇, T + V and the power of all that acts, of a scene with loops at the
// states of a trajectory, from the positions of its bodies alone.
//
//   u̇       M u̇ = Q − bias − Φ_qᵀλ with Φ̈ = 0, in long double; of rows that are redundant,
//           or are but for the gaps of open loops, any λ
//   power   d/dt (T + V) along that u̇: dampers, drives, whatever there is
//
// A motion that obeys the equations changes T + V by the integral of that power; a wrong one does
// not, however well its loops are closed.

#include "equations/dense_loops.h"

namespace momenta::equations {

class LoopedMotion {
 public:
  /// Keeps both.
  LoopedMotion(const Scene& scene, const Tree& tree);

  /// |Φ|∞ and |Φ̇|∞, rows in m or rad.
  double open(double t, const Eigen::VectorXd& q) const;
  double opening(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u) const;
  double kinetic_energy(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u) const;
  double energy(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u) const;
  double power(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u) const;

 private:
  RealVector accelerations(Real t, const Eigen::VectorXd& q, const Eigen::VectorXd& u) const;

  DenseLagrangian motion_;
  DenseLoops loops_;
};

/// ∫ of equally spaced samples, by Boole's rule; their number is one more than a multiple of 4.
double integral(const std::vector<double>& samples, double spacing);

}  // namespace momenta::equations
