#pragma once
// What a step back over a run asks of a form: products with the transposed derivative of its
// right-hand side and of what it does after steps, and what these have of all θ. On momenta:
// stage_adjoint.h; on accelerations: acceleration_adjoint.h.

#include <Eigen/Core>
#include <vector>

namespace momenta {

/// A state at which f is differentiated: its time [s], q (nq), the second half p of y (nv; of forms
/// on accelerations that is u), u (nv), σ or λ (m), and the second half of ẏ (nv). Each of the last
/// three is empty where it is not known.
struct AdjointState {
  double t = 0;
  Eigen::VectorXd q, p, u, sigma;
  Eigen::VectorXd slope{};
};

/// Derivatives are by y = (q, p), nq + nv; `by_parameters` (θ) += what there is of those that are
/// not taken at once. False where the matrix of (7) is singular.
class FormAdjoint {
 public:
  virtual ~FormAdjoint() = default;

  /// product = f_yᵀ w.
  virtual bool rates(const AdjointState& at, const Eigen::VectorXd& w, Eigen::VectorXd& product,
                     Eigen::VectorXd& by_parameters) = 0;
  /// λ behind what is done to p after a step (reset, flip) or to u (the correction of velocities)
  /// to λ before it. Of forms on accelerations the state has q behind it, and u before it as p.
  virtual bool gauge(const AdjointState& at, Eigen::VectorXd& lambda,
                     Eigen::VectorXd& by_parameters) = 0;
  /// λ behind the correction of positions to λ before it; q (nq) before it.
  virtual bool correction(double t, const Eigen::VectorXd& q, Eigen::VectorXd& lambda,
                          Eigen::VectorXd& by_parameters) = 0;
  /// What numbers have had so far is added, once, when the way back is over.
  virtual void finish(Eigen::VectorXd& by_parameters) = 0;

  /// How many parameters are taken by number_slopes.h.
  virtual Eigen::Index at_once() const = 0;
  /// Whether states must have their u, multipliers and slopes, or u alone; else the sweeps find
  /// them, and where they do not carry a state, products without u and multipliers are false.
  virtual bool needs_solutions() const = 0;
  /// Whether they must have u, if nothing else.
  virtual bool needs_rates() const = 0;
  /// Whether a state has all that may be asked for.
  virtual bool solved(const AdjointState& at) const = 0;
  /// u (nv) at the state of the last rates(), where that had none; null: not found.
  virtual const double* found_rates() const { return nullptr; }
  /// By matrices alone from now on: where rows of Φ are redundant the only way.
  virtual void by_rows() = 0;
};

}  // namespace momenta
