#pragma once
// A form: one way to write the equations of motion of a mechanism for an integrator. Here is what
// all forms share: their options, the start they take, and how their state is read back as q, u and
// multipliers for the measures.

#include <momenta/dae/integrator/system.h>
#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/mechanism/start.h>

#include <Eigen/Core>
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace momenta {

/// The rule that chooses the free part of σ. (p, σ) → (p + Φ_qᵀc, σ + c) leaves q(t) unchanged for
/// constant c, so a gauge can keep σ small. Without one σ grows like t under a mean load, and the
/// local error with it.
struct Gauge {
  /// Rules of gauges.
  enum class Kind {
    none,   ///< nothing is done
    leak,   ///< σ decays at the rate κ all the time
    reset,  ///< σ = 0 after each step
    flip    ///< σ → −σ after each step
  };
  Kind kind = Kind::none;  ///< the rule
  /// Leak [1/s]: ṗ −= κ Φ_qᵀσ, λ = σ̇ + κσ; 0: chosen from the start (see default_leak).
  double kappa = 0;
  /// The text that parse_gauge reads.
  std::string text() const;
};
/// Reads "none", "leak", "leak:3", "reset", "flip". @throws std::invalid_argument with one
/// sentence.
Gauge parse_gauge(const std::string& text);

/// Options of a form.
struct FormOptions {
  Gauge gauge;  ///< for momentum forms
  /// One position correction in the mass metric after each accepted step (one-step methods).
  bool project = false;
  double baumgarte_alpha = 0;  ///< [1/s]; 0: chosen by the form
  double baumgarte_beta = 0;   ///< [1/s]
  double beta = 0;     ///< momentum forms: Φ̇ = −βΦ in the second row of (7) [1/s]; 0: none
  double penalty = 0;  ///< augmented Lagrangians: α in effective masses of the loops; 0: 1e7
};

/// q, u and multipliers read back from a form's state: σ of momentum forms, λ of the others.
struct Snapshot {
  Eigen::VectorXd q;            ///< nq
  Eigen::VectorXd u;            ///< nv
  Eigen::VectorXd multipliers;  ///< m
};

/// A form of the equations of one mechanism, made by make_form.
class Form {
 public:
  virtual ~Form() = default;
  virtual const std::string& name() const = 0;  ///< as in form_names()
  virtual bool momentum_like() const = 0;       ///< whether the multipliers are σ
  virtual bool is_dae() const = 0;              ///< whether it has dae(); else it has ode()
  /// The state the form starts from.
  virtual std::vector<double> initial(const Start& start) = 0;
  /// Reads a state back. Momentum forms recompute u from (7), so their Φ̇ is that of an algebraic
  /// solve.
  virtual bool read(double t, const double* y, const double* ydot, Snapshot& out) = 0;
  /// Reads q alone (nq), at which Φ is evaluated between steps, before any correction.
  virtual bool read_coordinates(double /*t*/, const double* y, Eigen::VectorXd& q) {
    std::copy_n(y, q.size(), q.begin());
    return true;
  }
  /// Number of choices of independent coordinates, the first included; zero for forms without.
  virtual long partitions() const { return 0; }
  /// The gauge in force, with its κ.
  virtual Gauge gauge() const { return {}; }
  /// The gains α, β of Φ̈ + 2αΦ̇ + β²Φ = 0 [1/s]; zero for forms without feedback.
  virtual std::pair<double, double> baumgarte_gains() const { return {0, 0}; }
  /// The β in force of Φ̇ = −βΦ [1/s]; zero for forms that do not take it.
  virtual double beta() const { return 0; }
  /// The penalty in force, in effective masses of the loops; zero for forms without one.
  virtual double penalty() const { return 0; }
  /// The system that an ODE method integrates, owned by the form; null for DAE forms.
  virtual OdeSystem* ode() { return nullptr; }
  /// The system that a DAE method integrates, owned by the form; null for ODE forms.
  virtual DaeSystem* dae() { return nullptr; }
};

/// The names of all forms, in the order of the tables.
const std::vector<std::string>& form_names();
/// Whether the named form has impulse multipliers σ, and so takes a gauge. @throws
/// std::invalid_argument for an unknown name.
bool takes_gauge(const std::string& name);
/// Whether the named form alters its state after each step, so that only one-step methods can
/// integrate it. @throws std::invalid_argument for an unknown name.
bool needs_one_step_method(const std::string& name);
/// Whether the named form has Φ = 0 among its equations, or meets it after each step by
/// construction. @throws std::invalid_argument for an unknown name.
bool holds_positions(const std::string& name);
/// Whether the named form is integrated as a DAE by IDA. @throws std::invalid_argument for an
/// unknown name.
bool is_dae_form(const std::string& name);
/// Makes the named form. @throws std::invalid_argument with one sentence for an unknown name or an
/// option that the form does not take.
std::unique_ptr<Form> make_form(const std::string& name, const Mechanism& mechanism,
                                const FormOptions& options, const Start& start);

/// A leak rate that fits the mechanism [1/s]: the square root of the largest acceleration that
/// loops cause at the start, slides in lengths of the scene, or the fastest rate if that is more;
/// where both are zero ten per run. The optimum is flat over a decade on either side.
double default_leak(const Mechanism& mechanism, const Start& start);

}  // namespace momenta
