#pragma once
// The friction of bearings at a state, for what has no reactions among its unknowns
// (docs/theory/friction.md). u̇ and λ of (3), and so the forces F in the bearings, are affine in
// the joints' forces τ:
//
//   F(τ) = F(0) + Σ_j ΔF_j y_j,   τ_j = s_j y_j,   ΔF_j = F(s_j e_j) − F(0)
//
// by one solution of (3) for each bearing that slides and one without friction. With
// s_j = c_j N_max, c_j = r_j μ_j(r_j u_j), friction is the fixed point of
//
//   y_i = −N_i(F(0) + Σ_j ΔF_j y_j) / N_max
//
// whose Lipschitz constants are L_ij = (|Δf₁_ij| + |Δf₂_ij|) / N_max ≥ 0. Where the spectral radius
// of L is below 1 there is exactly one, and the iteration converges to it from any start (Banach,
// in the norm max |y_i|/x_i with (I − L) x = 1). ρ(L) < 1 if and only if that x is positive. Where
// it is not, friction may have no value or several (Painlevé), and at() refuses.

#include <momenta/dae/kkt/loop_solver.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <memory>
#include <string>
#include <vector>

namespace momenta {

class BearingFriction {
 public:
  explicit BearingFriction(const Mechanism& mechanism);

  /// Finds the friction at (t, q, u). False where there is none: failure(). Cost: a solution of (3)
  /// for each bearing that slides, and one more. No allocation.
  bool at(double t, const double* q, const double* u);
  /// τ (nv) of the last at(), zero before; the pointer stays valid.
  const double* forces() const { return forces_.data(); }
  /// τ·u ≤ 0 [W].
  double power(const double* u) const;
  /// Why at() failed, in one sentence.
  const std::string& failure() const { return failure_; }

  /// Name of a joint in whose bearing the force is not unique at (t, q, u), as loop equations
  /// depend on each other; empty: none.
  std::string undetermined(double t, const double* q, const double* u);

 private:
  struct Bearing {
    std::string name;
    int u;
    double arm;  ///< lever of N μ: r, or 1
    BearingSpec spec;
  };

  /// Finds u̇ and λ under the forces `tau`, and F.
  bool solve(double t, const double* q, const double* u, const double* tau, Eigen::VectorXd& F);
  /// F from `udot_` and `lambda`.
  void load(double t, const double* q, const double* u, const double* lambda, Eigen::VectorXd& F);
  /// The fixed point y of the bearings that slide.
  bool iterate();

  const Mechanism& mechanism_;
  std::unique_ptr<Evaluation<double>> e_;
  std::unique_ptr<LoopSolver> solver_;  ///< null without loops
  std::vector<Bearing> bearings_;
  std::vector<double> forces_, tried_, udot_, lambda_, unused_;
  Eigen::VectorXd F0_, F_, y_, next_, x_;
  Eigen::MatrixXd dF_, contraction_;
  Eigen::PartialPivLU<Eigen::MatrixXd> factors_;
  double largest_ = 0;  ///< N_max
  std::string failure_;
};

/// The friction of a mechanism's bearings; null where it has none.
std::unique_ptr<BearingFriction> bearing_friction(const Mechanism& mechanism);

/// u̇ (nv) and λ (m) of (3) with `friction`, which may be null; `solver` null without loops. The
/// cause of a failure is friction's, if it has one, or the solver's.
bool rubbed_accelerations(BearingFriction* friction, Evaluation<double>& e, LoopSolver* solver,
                          double t, const double* q, const double* u, double* udot, double* lambda);

}  // namespace momenta
