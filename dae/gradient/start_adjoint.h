#pragma once
// How a form's start depends on the numbers of a run: y(0) = (q, p) or (q, u) of the assembled
// scene, with its choice of the nearest pose and rates, and p = M u + Φ_qᵀσ with the gauge's first
// σ. Differences of sixth order (sixth_order.h); loops are closed to rounding on both sides, which
// leaves 12 digits.

#include <momenta/dae/algebra/dense/least_squares.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/gradient/mixed_rates.h>
#include <momenta/dae/gradient/number_slopes.h>
#include <momenta/dae/gradient/other_parameters.h>
#include <momenta/dae/gradient/row_derivatives.h>
#include <momenta/dae/gradient/run_variable.h>
#include <momenta/dae/topology/assembly/closing.h>

#include <deque>

namespace momenta {

struct StartTangents {
  Eigen::MatrixXd of_state;         ///< dy(0), size of y × variables
  std::vector<std::string> broken;  ///< sentences on variables by which the start has no derivative
};

/// Tangents of the form of this name; the gains of `options` are held. Columns stay zero for
/// variables whose start is taken at once (start_adjoint.h). @throws SceneError. Cost: six to
/// twelve assemblies for each other variable
StartTangents start_tangents(const Mechanism& mechanism, const std::string& form,
                             const FormOptions& options, const std::vector<RunVariable>& variables,
                             const std::vector<OtherParameter>& others);

/// A change of y(0) that loops allow, by displacements and rates of ±1 in all joints: what a run
/// amplifies shows in its tangent. Size of y × 1. One factorisation
Eigen::MatrixXd any_start_change(const Mechanism& mechanism, const Start& start, bool momenta);

// The transposed derivative of the start y(0) = (q, p) of the momentum form, σ(0) = 0: from λ at
// the start to λᵀ dy(0)/dn by all numbers n on which it depends (number_slopes.h), its guess among
// them. Backwards through the assembly:
//
//   p = M u (7)                   λ_q + D_λp T_q,  ū = M λ_p
//   u = u₀ + C x,  A x = −D⁻¹Φ̇(q, u₀)                 rates: the least change that the loops allow
//   q_{k+1} = q_k + C s x,  A x = −φ,  φ = D⁻¹Φ       Newton's steps from the guess, s cut or not
//
// with A = D⁻¹Φ_q C of full rank, and x = Aᵀy the shortest. Differentiated, A dx = −dφ − dA x and
// dx = Aᵀdy + dAᵀ y. Of the adjoint x̄ of x, w the solution of least |x̄ − Aᵀw| and v = x̄ − Aᵀw,
//
//   x̄ᵀ dx = −wᵀ(dφ + dA x) + yᵀ dA v,                                                       (10)
//
// since A v = 0: one derivative of wᵀΦ, wᵀΦ̇ and yᵀΦ̇ by q and by all numbers at once. By q these are
// symmetric: ∂(σᵀΦ_q d)/∂q = D_d(Φ_qᵀσ). D drops out, and C is the length of the scene where joints
// slide. The pose is a limit: behind the last step loops are closed to rounding, and one more step
// of x = 0 closes dq. The part v of the guess is not a projection at the pose alone: each step is
// the shortest at its own.
//
// Where the assembly went another way, or equations are redundant, there is no such derivative:
// start_adjoint.h.

class StartAdjoint {
 public:
  /// Takes the assembled start at t = 0. @pre neither quaternions nor nonholonomic rows, bodies.
  /// The mechanism must outlive it. Cost: the assembly again, and a QR factorisation of A for each
  /// of its steps, O(nv m²)
  StartAdjoint(const Mechanism& mechanism, Start start);
  const NumberSlopes& numbers() const { return *numbers_; }
  /// Whether the assembly is differentiated; else back() takes (q, u) as given.
  bool follows_assembly() const { return follows_; }
  /// λᵀ dy(0)/dn by the numbers of NumberSlopes; λ (2 nv) of y = (q, p), or else of (q, u). Cost
  /// for each step of the assembly: two sweeps and a solution by kept factors, O(nv m).
  Eigen::VectorXd back(const Eigen::VectorXd& lambda, bool of_momenta = true);
  /// dy(0)/dn, 2 nv × numbers: back() of unit vectors λ.
  Eigen::MatrixXd rows(bool of_momenta);
  /// dy(0) by a variable, from back() or rows(): columns of `slopes` are numbers. @pre
  /// other.starts_at_once
  Eigen::VectorXd by(const RunVariable& variable, const OtherParameter& other,
                     const Eigen::MatrixXd& slopes) const;

 private:
  struct Step : Closing::NewtonStep {
    Eigen::MatrixXd transposed;  ///< Aᵀ at the step's q
    DenseLeastSquares factors;   ///< factors of Aᵀ
  };
  struct Pulled;
  bool follow();
  Pulled pull(const Step& at, const Eigen::VectorXd& x, Eigen::VectorXd x_bar);
  void through_momenta(const Eigen::VectorXd& of_p, Eigen::VectorXd& of_q, Eigen::VectorXd& of_u);
  void through_rates(Eigen::VectorXd& of_q, Eigen::VectorXd& of_u);
  void through_step(const Step& step, Eigen::VectorXd& of_q);
  Eigen::VectorXd turned(const Eigen::VectorXd& q, const Eigen::VectorXd& along,
                         const Eigen::VectorXd& sigma);

  const Mechanism& mechanism_;
  Start start_;
  Eigen::Index nv_, m_;
  ScaledLoops loops_;
  std::deque<Step> steps_;  ///< the last with x = 0, at the pose
  std::unique_ptr<NumberSlopes> numbers_;
  std::unique_ptr<Evaluation<Dual8>> dual_;
  std::unique_ptr<KineticRates> kinetic_;
  bool follows_ = false, placed_ = false, driven_;
  std::vector<bool> slides_;  ///< by rate
  Eigen::VectorXd slopes_;
  double by_length_ = 0;
  std::vector<Dual8> x_, out_;
};

}  // namespace momenta
