#pragma once
// A form: one way to write the equations of motion of a mechanism for an integrator. This is what
// all forms share: options, the start they take, and how a state of theirs is read back as q, u and
// impulses for the measures.

#include <momenta/dae/mechanism.h>
#include <momenta/dae/solver/system.h>

#include <Eigen/Core>
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace momenta {

/// What is done about the free part of σ. (p, σ) → (p + Φ_qᵀc, σ + c) leaves q(t) unchanged for
/// constant c, so σ may be kept small at will; left alone it grows like t under a mean load, and
/// the local error with it.
struct Gauge {
  /// When, and how much of it goes.
  enum class Kind {
    none,   ///< nothing is done
    leak,   ///< σ decays at the rate κ all the time
    reset,  ///< σ = 0 after each step
    flip    ///< σ → −σ after each step
  };
  Kind kind = Kind::none;  ///< which
  /// Leak [1/s]: ṗ −= κ Φ_qᵀσ, λ = σ̇ + κσ; 0: chosen from the start (see default_leak).
  double kappa = 0;
  /// As parse_gauge reads it.
  std::string text() const;
};
/// "none", "leak", "leak:3", "reset", "flip". @throws std::invalid_argument with a sentence
Gauge parse_gauge(const std::string& text);

/// What a form may be told.
struct FormOptions {
  Gauge gauge;  ///< of momentum forms
  /// One mass-metric position correction after accepted steps (one-step methods).
  bool project = false;
  double baumgarte_alpha = 0;  ///< [1/s]; 0: chosen by the form
  double baumgarte_beta = 0;   ///< [1/s]
  double beta = 0;     ///< momentum forms: Φ̇ = −βΦ in the second row of (7) [1/s]; 0: none
  double penalty = 0;  ///< augmented Lagrangians: α in effective masses of the loops; 0: 1e7
};

/// A consistent start: Φ(q, t) = 0, Φ_q u + Φ_t = 0; of redundant equations whose numbers
/// contradict each other in the least-squares sense.
struct Start {
  double t = 0;             ///< [s]
  Eigen::VectorXd q;        ///< nq
  Eigen::VectorXd u;        ///< nv
  Eigen::VectorXd udot;     ///< accelerations there: nv
  Eigen::VectorXd lambda;   ///< force multipliers there: m
  Eigen::VectorXd residue;  ///< Φ that is left by contradictions (m); empty: none
};

/// q, u and the impulse (σ of momentum forms) or force (λ) multipliers read back from a form's
/// state.
struct Snapshot {
  Eigen::VectorXd q;            ///< nq
  Eigen::VectorXd u;            ///< nv
  Eigen::VectorXd multipliers;  ///< m
};

/// A form of the equations of one mechanism, made by make_form.
class Form {
 public:
  virtual ~Form() = default;
  virtual const std::string& name() const = 0;  ///< as form_names() has it
  virtual bool momentum_like() const = 0;       ///< multipliers are σ
  virtual bool is_dae() const = 0;              ///< dae() is there, else ode()
  /// The state the form starts from.
  virtual std::vector<double> initial(const Start& start) = 0;
  /// Reads a state back. Momentum forms recompute u from (7), so Φ̇ of theirs is that of an
  /// algebraic solve.
  virtual bool read(double t, const double* y, const double* ydot, Snapshot& out) = 0;
  /// q alone (nq): what Φ is evaluated at between steps, before any correction.
  virtual bool read_coordinates(double /*t*/, const double* y, Eigen::VectorXd& q) {
    std::copy_n(y, q.size(), q.begin());
    return true;
  }
  /// How often coordinates were chosen, the first time included; zero for forms that choose none.
  virtual long partitions() const { return 0; }
  /// The gauge in force, with its κ.
  virtual Gauge gauge() const { return {}; }
  /// α, β of Φ̈ + 2αΦ̇ + β²Φ = 0 [1/s]; zero for forms without feedback.
  virtual std::pair<double, double> baumgarte_gains() const { return {0, 0}; }
  /// β of Φ̇ = −βΦ in force [1/s]; zero for forms that do not take it.
  virtual double beta() const { return 0; }
  /// The penalty in force, in effective masses of the loops; zero for forms without one.
  virtual double penalty() const { return 0; }
  /// What an ODE method integrates, owned by the form; null for DAE forms.
  virtual OdeSystem* ode() { return nullptr; }
  /// What a DAE method integrates, owned by the form; null for ODE forms.
  virtual DaeSystem* dae() { return nullptr; }
};

/// Names, in the order tables list them.
const std::vector<std::string>& form_names();
/// Whether the named form has impulses σ, and so a gauge. @throws std::invalid_argument for an
/// unknown name.
bool takes_gauge(const std::string& name);
/// Whether the named form alters its state after each step, so that only one-step methods take it.
/// @throws std::invalid_argument for an unknown name.
bool needs_one_step_method(const std::string& name);
/// Whether the named form has Φ = 0 among its equations, or meets it after each step by its nature.
/// @throws std::invalid_argument for an unknown name.
bool holds_positions(const std::string& name);
/// Whether the named form is integrated as a DAE by IDA. @throws std::invalid_argument for an
/// unknown name.
bool is_dae_form(const std::string& name);
/// @throws std::invalid_argument with a sentence for an unknown name or an option the form does not
/// take.
std::unique_ptr<Form> make_form(const std::string& name, const Mechanism& mechanism,
                                const FormOptions& options, const Start& start);

/// How large each momentum is (nv) at the configuration placed in `e`: its own inertia M_ii times a
/// rate of 1 rad/s or 1 m/s. A joint that moves nothing heavy, a massless coupler's, has loops'
/// impulses alone for a momentum, and they are as large as those of others: then the largest M_ii.
void momentum_scales(Evaluation<double>& e, int nv, double* scale);

/// A leak rate that fits the mechanism: the root of the largest acceleration the loops cause at the
/// start, [1/s]. The optimum is flat over a decade on either side.
double default_leak(const Mechanism& mechanism, const Start& start);

}  // namespace momenta
