#pragma once
// Products of a form for a step back over a run: with the transposed derivatives of its right-hand
// side and of its changes after steps, by y and all θ. On momenta: stage_adjoint.h; on
// accelerations: acceleration_adjoint.h.

#include <Eigen/Core>
#include <vector>

namespace momenta {

/// A state at which f is differentiated: time [s], q (nq), the second half p of y (nv; on
/// accelerations u), u (nv), σ or λ (m), and the second half of ẏ (nv). The last three are empty if
/// not known.
struct AdjointState {
  double t = 0;
  Eigen::VectorXd q, p, u, sigma;
  Eigen::VectorXd slope{};
};

/// Derivatives are by y = (q, p), nq + nv; `by_parameters` (θ) += slopes by θ not taken at once.
/// False where the matrix of (7) is singular.
class FormAdjoint {
 public:
  virtual ~FormAdjoint() = default;

  /// product = f_yᵀ w.
  virtual bool rates(const AdjointState& at, const Eigen::VectorXd& w, Eigen::VectorXd& product,
                     Eigen::VectorXd& by_parameters) = 0;
  /// λ before the change of p after a step (reset, flip), or of u (correction of velocities), from
  /// λ behind it. On accelerations the state has q behind the step, and u before it as p.
  virtual bool gauge(const AdjointState& at, Eigen::VectorXd& lambda,
                     Eigen::VectorXd& by_parameters) = 0;
  /// λ before the correction of positions, from λ behind it; q (nq) before it.
  virtual bool correction(double t, const Eigen::VectorXd& q, Eigen::VectorXd& lambda,
                          Eigen::VectorXd& by_parameters) = 0;
  /// Adds the slopes by numbers, once, when the way back is over.
  virtual void finish(Eigen::VectorXd& by_parameters) = 0;

  /// Number of parameters taken by number_slopes.h.
  virtual Eigen::Index at_once() const = 0;
  /// Whether states need u, multipliers and slopes. Else the sweeps find them, and where they do
  /// not carry a state, products without u and multipliers are false.
  virtual bool needs_solutions() const = 0;
  /// Whether states need u, if nothing else.
  virtual bool needs_rates() const = 0;
  /// Whether a state has u and multipliers.
  virtual bool solved(const AdjointState& at) const = 0;
  /// u (nv) at the state of the last rates(), where that had none; null: not found.
  virtual const double* found_rates() const { return nullptr; }
  /// Matrices alone from now on: the only way where rows of Φ are redundant.
  virtual void by_rows() = 0;
};

}  // namespace momenta
