#pragma once
// The gradient of a run: how a functional of a motion,
//
//   J = g(T, q(T), u(T); θ)   or   J = ∫ g(t, q, u; θ) dt,
//
// depends on parameters and start values θ. Forward: the run's own steps and stages are
// differentiated (tangent_system.h, form_tangents.h), the assembly of its start too
// (start_tangents.h), so that the gradient is that of the numbers a run computes, whatever the
// accuracy of the run. Adjoint: the same derivative, backwards over the steps of the run
// (adjoint_run.h; of forms on momenta stage_adjoint.h, on accelerations acceleration_adjoint.h), of
// which one sweep serves all θ. Derivation: docs/theory/gradients.md.
//
// Held: the sizes of steps, and the gains of the form (κ, α, β), as they are at θ. Steps of a
// method with error control follow the tangents and the integral too; before a sweep back, the
// integral and one tangent. Formulas with corners are differentiated on the piece they are on:
// tangents turn there where the motion is smooth. Fixed steps and sweeps back are checked there by
// others. Forces that jump at a moment which depends on θ are refused. The mechanism is integrated
// as it is written.

#include <momenta/dae/gradient/run_variable.h>
#include <momenta/dae/study/run_result.h>

#include <functional>
#include <string>
#include <vector>

namespace momenta {

/// In which order the chain rule is taken.
enum class GradientMode {
  automatic,  ///< adjoint for more than most_forward θ where there is one, else forward
  forward,    ///< a tangent of the motion for each θ
  adjoint     ///< one sweep back over the steps
};
inline constexpr int most_forward = 8;  ///< θ that an automatic mode takes forward
/// "automatic", …: in the order of the enumeration.
const std::vector<std::string>& gradient_modes();
/// @throws std::invalid_argument with the names
GradientMode gradient_mode(const std::string& name);

/// What is asked.
struct GradientRequest {
  std::string of;               ///< g, a formula of names of trajectory.csv; empty: `outputs` alone
  bool integral = false;        ///< ∫ g dt over the run; else g at its end
  std::vector<std::string> by;  ///< θ: parameters, "a"; start values, "O.q", "O.u"
  RunSettings settings;         ///< `samples`: of the derivatives of the trajectory
  bool trajectory = false;      ///< they are kept: forward alone has them
  /// Formulas like g, to be taken at `times` with their derivatives: forward alone, in the place of
  /// the trajectory.
  std::vector<std::string> outputs;
  std::vector<double> times;  ///< of `outputs`, ascending from 0 on; the last ends the run [s]
  GradientMode mode = GradientMode::automatic;  ///< forward, or one sweep back
  double max_cpu_seconds = 0;                   ///< 0: none
  /// Called after each step with the time reached; false ends it.
  std::function<bool(double t)> progress;
};

/// What came out.
struct GradientResult {
  std::string scene;                   ///< its name
  RunSettings settings;                ///< as run, with the gains in force
  std::string of;                      ///< as asked
  bool integral = false;               ///< as asked
  double value = 0;                    ///< J
  std::vector<RunVariable> variables;  ///< θ
  Eigen::VectorXd gradient;            ///< dJ/dθ, in the unit of J over that of θ
  /// Of θ by which rows of equations are differences of neighbouring scenes: to how many digits the
  /// formulas of sixth_order.h agree; of others 16.
  std::vector<double> digits;
  std::vector<std::string> without_effect;  ///< names of θ whose part of J is below 1e-10 of it
  std::vector<std::string> remarks;         ///< sentences on what is not smooth
  bool adjoint = false;                     ///< by a sweep back
  long at_once = 0;     ///< of it: θ of numbers taken together, whose count costs nothing
  long products = 0;    ///< of it: with transposed derivatives of the right-hand side
  long steps = 0;       ///< of the run
  double end_time = 0;  ///< T [s]
  std::vector<std::string> columns;  ///< "O.q", …: coordinates, then rates
  std::vector<double> times;         ///< [s]; of `trajectory`
  /// At each time dq, du by θ: columns × variables.
  std::vector<Eigen::MatrixXd> tangents;
  Eigen::MatrixXd outputs;                     ///< times × outputs, as asked
  std::vector<Eigen::MatrixXd> output_slopes;  ///< at each time: outputs × variables
};

/// @throws std::invalid_argument for what is asked; SceneError where the start or the run has no
/// derivatives, or the run ends before its time, one sentence.
/// Cost beside that of a run, forward: a stage takes an evaluation of the sweeps in dual numbers
/// for eight θ, or where they do not carry the loops, and on accelerations, one or two of rows and
/// the factorisation of the matrix of (7); and of parameters that are no numbers of number_slopes.h
/// six plain evaluations of rows each, or more where these are not smooth. Adjoint: an evaluation
/// of the sweeps in dual numbers of one direction, or where they do not carry the loops two of rows
/// and that factorisation, for all θ; six plain evaluations for each parameter that is no number of
/// number_slopes.h; a state of memory a stage (recorded_run.h).
GradientResult gradient(const SceneText& scene, const GradientRequest& request);

}  // namespace momenta
