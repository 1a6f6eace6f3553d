#pragma once
// The gradient of a run: how a functional of a motion,
//
//   J = g(T, q(T), u(T); θ)   or   J = ∫ g(t, q, u; θ) dt,
//
// depends on parameters and start values θ. Forward: the run's own steps and stages are
// differentiated (tangent_system.h, form_tangents.h), and the assembly of its start
// (start_adjoint.h): the gradient is that of the numbers a run computes, whatever their accuracy.
// Adjoint: the same derivative, backwards over the steps of the run (adjoint_run.h; on momenta
// stage_adjoint.h, on accelerations acceleration_adjoint.h); one sweep serves all θ. Derivation:
// docs/theory/gradients.md.
//
// Held: step sizes and the gains of the form (κ, α, β), as they are at θ. Error control follows the
// tangents and the integral too; before a sweep back, the integral and one tangent. Formulas with
// corners are differentiated on their present piece: tangents turn there where the motion is
// smooth. A second run checks fixed steps and sweeps back there. Forces that jump at a moment which
// depends on θ are refused. The mechanism is integrated as written.

#include <momenta/dae/gradient/run_variable.h>
#include <momenta/dae/run/run_result.h>

#include <functional>
#include <string>
#include <vector>

namespace momenta {

/// Order of the chain rule.
enum class GradientMode {
  automatic,  ///< adjoint for more than most_forward θ where there is one, else forward
  forward,    ///< a tangent of the motion for each θ
  adjoint     ///< one sweep back over the steps
};
inline constexpr int most_forward = 8;  ///< θ that an automatic mode takes forward
/// Names in the order of the enumeration: "automatic", …
const std::vector<std::string>& gradient_modes();
/// @throws std::invalid_argument with the names
GradientMode gradient_mode(const std::string& name);

/// Request for gradient().
struct GradientRequest {
  std::string of;               ///< g, a formula of names of trajectory.csv; empty: `outputs` alone
  bool integral = false;        ///< ∫ g dt over the run; else g at its end
  std::vector<std::string> by;  ///< θ: parameters, "a"; start values, "O.q", "O.u"
  RunSettings settings;         ///< `samples`: of the derivatives of the trajectory
  bool trajectory = false;      ///< keeps its derivatives: forward alone
  /// Formulas like g, taken at `times` with their derivatives, in the place of the trajectory:
  /// forward alone.
  std::vector<std::string> outputs;
  std::vector<double> times;  ///< times for `outputs`, ascending from 0; the last ends the run [s]
  GradientMode mode = GradientMode::automatic;  ///< forward, or one sweep back
  double max_cpu_seconds = 0;                   ///< 0: none
  /// Called after each step at time t; false ends the run.
  std::function<bool(double t)> progress;
};

/// Result of gradient().
struct GradientResult {
  std::string scene;      ///< its name
  RunSettings settings;   ///< as run, with the gains in force
  std::string of;         ///< g, a formula of names of trajectory.csv; empty: `outputs` alone
  bool integral = false;  ///< ∫ g dt over the run; else g at its end
  double value = 0;       ///< J
  std::vector<RunVariable> variables;  ///< θ
  Eigen::VectorXd gradient;            ///< dJ/dθ, in the unit of J over that of θ
  /// Digits to which the formulas of sixth_order.h agree, by variable: where rows are differences
  /// of neighbouring scenes; else 16.
  std::vector<double> digits;
  std::vector<std::string> without_effect;  ///< names of θ with less than 1e-10 of J
  std::vector<std::string> remarks;         ///< sentences on parts that are not smooth
  bool adjoint = false;                     ///< by a sweep back
  long at_once = 0;                         ///< adjoint: θ taken together, at no cost for each
  long products = 0;    ///< adjoint: with transposed derivatives of the right-hand side
  long steps = 0;       ///< of the run
  double end_time = 0;  ///< T [s]
  std::vector<std::string> columns;  ///< "O.q", …: coordinates, then rates
  std::vector<double> times;         ///< times of `trajectory` [s]
  /// dq, du by θ at each time: columns × variables.
  std::vector<Eigen::MatrixXd> tangents;
  Eigen::MatrixXd outputs;                     ///< times × outputs, as asked
  std::vector<Eigen::MatrixXd> output_slopes;  ///< slopes at each time: outputs × variables
};

/// @throws std::invalid_argument for a wrong request; SceneError, one sentence, where the start or
/// the run has no derivatives, or the run ends before its time.
/// Cost beside that of a run, for each stage: forward, an evaluation of the sweeps in dual numbers
/// for eight θ, or where they do not carry the loops, and on accelerations, one or two of rows and
/// a factorisation of the matrix of (7); adjoint, for all θ, an evaluation of the sweeps in dual
/// numbers of one direction, or two of rows and that factorisation, and memory of a state
/// (recorded_run.h). Either takes six plain evaluations of rows, forward more where these are not
/// smooth, for each parameter that is no number of number_slopes.h.
GradientResult gradient(const SceneText& scene, const GradientRequest& request);

}  // namespace momenta
