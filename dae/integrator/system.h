#pragma once
// Interface of a form to integrators: an ODE y' = f(t, y), or a DAE F(t, y, y') = 0. Failures are
// values: a call returns false, and `failure()` then holds one sentence (which constraint, which
// time, which cause).

#include <momenta/dae/integrator/memory.h>

#include <limits>
#include <string>
#include <vector>

namespace momenta {

/// Handling of singular poses by a method with error control, in order of cost: `none`; `norm`:
/// errors are measured by their effect on the motion; `position`: f is also evaluated at the
/// corrected position.
enum class SingularityHandling { none, norm, position };

class LocalJacobian;

/// y' = f(t, y). One object serves one thread.
class OdeSystem {
 public:
  virtual ~OdeSystem() = default;
  virtual int size() const = 0;  ///< size of y

  /// y' at (t, y); both of size().
  virtual bool rhs(double t, const double* y, double* ydot) = 0;

  /// Called after every accepted step of a one-step method: gauge reset, position correction,
  /// quaternion normalisation. Sets `changed` when f(t, y) changes: by a gauge reset, not by a
  /// position correction of the size of the local error, after which the last stage may serve the
  /// next step.
  virtual bool after_step(double /*t*/, double* /*y*/, bool& /*changed*/) { return true; }
  /// Whether after_step() does anything.
  virtual bool has_after_step() const { return false; }

  /// Begins a step at (t, y): takes the centre of σ, towards which faded rows go, so that within
  /// the step f is a pure function of (t, y).
  virtual void begin_step(double /*t*/, const double* /*y*/) {}

  /// f at the state that after_step() left, where after_step() computed it; false: it is still to
  /// be evaluated.
  virtual bool first_derivative(double* /*ydot*/) { return false; }

  /// The singularity handling that evaluations since begin_step() require. Where loop equations
  /// become dependent, rates slightly off the manifold are far off. A method with error control
  /// repeats the step where the handling changes f.
  virtual SingularityHandling wanted_handling() const { return SingularityHandling::none; }
  /// Sets the handling. Of the three, only SingularityHandling::position changes f.
  virtual void set_handling(SingularityHandling /*singularity handling*/) {}
  /// Mean square of the local error at (t, y), of its part that changes the motion, not the gauge
  /// of σ. Weight of an unknown: atol · scale + rtol · size. Not finite where it cannot be
  /// computed. Used while singularity handling is on.
  virtual double motion_error_squared(double /*t*/, const double* /*y*/, const double* /*error*/,
                                      double /*rtol*/, double /*atol*/) {
    return std::numeric_limits<double>::quiet_NaN();
  }

  /// Evaluations between set_observing(true) and set_observing(false) are for an observer: they are
  /// not counted, and no later step depends on them. Pairs may be nested.
  virtual void set_observing(bool /*looking*/) {}

  /// Whether carry() lists everything on which later evaluations depend, so that a run can be saved
  /// and continued.
  virtual bool can_be_put_down() const { return false; }
  /// Writes or reads what the system carries from step to step. To be called between two steps.
  virtual void carry(Memory& /*memory*/) {}

  /// Typical size of y_i, for absolute tolerances: the error weight is atol · scale_i + rtol ·
  /// |y_i|.
  virtual double scale(int /*i*/) const { return 1.0; }

  /// The matrix of equations F(t, (y, x), f) = 0 that f and further unknowns x solve, in place of
  /// ∂f/∂y where that is large and full; null: none. evaluate() takes the y and f of the last
  /// rhs().
  virtual LocalJacobian* local() { return nullptr; }

  /// The time in which an unknown of its typical size typically changes by it [s].
  virtual double time_scale() const { return 1.0; }

  /// The longest span of a run [s] of which first steps, and the least steps near t = 0, are parts:
  /// a farther end is no scale of the motion.
  virtual double horizon() const { return 1e12; }

  /// One sentence on the last call that returned false.
  const std::string& failure() const { return failure_; }

 protected:
  /// Keeps the sentence and returns false.
  bool fail(std::string sentence) {
    failure_ = std::move(sentence);
    return false;
  }

 private:
  std::string failure_;
};

/// While this object lives, evaluations of the system are for an observer: set_observing().
class ObservationGuard {
 public:
  /// Calls set_observing(true).
  explicit ObservationGuard(OdeSystem& system) : system_(system) { system_.set_observing(true); }
  ~ObservationGuard() { system_.set_observing(false); }
  ObservationGuard(const ObservationGuard&) = delete;
  ObservationGuard& operator=(const ObservationGuard&) = delete;

 private:
  OdeSystem& system_;
};

/// Compressed columns of ∂F/∂y + c ∂F/∂y'; fixed once analysed. Empty column_start means dense.
struct JacobianPattern {
  std::vector<long> column_start;  ///< size() + 1
  std::vector<long> row;           ///< row of each stored entry, ascending in each column
};

/// A matrix with further unknowns z after y, and far fewer entries than J = ∂F/∂y + c ∂F/∂y'. Its
/// rows and columns of y come first, ( A B; C T ); eliminating z gives J = A − B T⁻¹ C.
class LocalJacobian {
 public:
  virtual ~LocalJacobian() = default;
  /// Computes the matrix, exactly, at the arguments of jacobian(); O(entries). False when it is not
  /// finite.
  virtual bool evaluate(double t, const double* y, const double* ydot, double c) = 0;
  /// The pattern of the last evaluation. version() changes when the pattern changes.
  virtual const JacobianPattern& pattern() const = 0;
  virtual const std::vector<double>& values() const = 0;  ///< in the order of pattern()
  virtual int version() const = 0;                        ///< version of the pattern, ascending
};

/// F(t, y, y') = 0. One object serves one thread.
class DaeSystem {
 public:
  virtual ~DaeSystem() = default;
  virtual int size() const = 0;  ///< size of y and of F

  /// r = F(t, y, y').
  virtual bool residual(double t, const double* y, const double* ydot, double* r) = 0;

  /// J = ∂F/∂y + c ∂F/∂y', exact. Dense: column-major size() × size(). Sparse: the values in the
  /// order of pattern().
  virtual bool jacobian(double t, const double* y, const double* ydot, double c,
                        double* values) = 0;
  /// Valid from start() on.
  virtual const JacobianPattern& pattern() const = 0;
  /// The matrix to factorise in place of J where J is large; else null. A method that takes it does
  /// not call pattern().
  virtual LocalJacobian* local() { return nullptr; }

  /// Consistent start: y and y' with F(t, y, y') = 0.
  virtual bool start(double t, double* y, double* ydot) = 0;

  /// Whether y_i takes part in the local error test, as the differential variables of the form's
  /// convergence theory do.
  virtual bool differential(int i) const = 0;
  /// Absolute tolerance of y_i is atol · scale(i); infinity keeps y_i out of the Newton norm too
  /// (multipliers).
  virtual double scale(int i) const = 0;

  /// The weight of y_i in norms of methods that know the index: error times h^power over atol ·
  /// scale + rtol |y_i|. A variable one power of the step worse, such as velocities of index-3
  /// forms, has power 1; power −1 keeps y_i out (multipliers).
  struct Weight {
    int power;     ///< power of h
    double scale;  ///< times atol
  };
  /// The weight of y_i.
  virtual Weight weight(int i) const { return {differential(i) ? 0 : -1, scale(i)}; }

  /// The part of the error estimate of y_i, as it is, that BDF of index 2 tests next to the
  /// filtered one (filtered_error.h).
  virtual double unfiltered_part(int /*i*/) const { return 0; }

  /// As OdeSystem::horizon().
  virtual double horizon() const { return 1e12; }

  /// Whether y, or a state of ode_restart(), which both begin with the coordinates, is near a pose
  /// where loop equations lose rank: the Newton matrix of a step across it may be singular.
  virtual bool near_singular(double /*t*/, const double* /*y*/) { return false; }
  /// The ODE that carries the motion past a singular pose, with singularity handling, and its
  /// `state` (of size ode_restart_size()) at (t, y); null: none.
  virtual OdeSystem* ode_restart(double /*t*/, const double* /*y*/, double* /*state*/) {
    return nullptr;
  }
  /// Size of the state of ode_restart(); 0: none.
  virtual int ode_restart_size() const { return 0; }
  /// Computes y and y' from a state of that ODE. On entry y holds the last known multipliers.
  virtual bool rejoin(double /*t*/, const double* /*state*/, double* /*y*/, double* /*ydot*/) {
    return false;
  }

  /// One sentence on the last call that returned false.
  const std::string& failure() const { return failure_; }

 protected:
  /// Keeps the sentence and returns false.
  bool fail(std::string sentence) {
    failure_ = std::move(sentence);
    return false;
  }

 private:
  std::string failure_;
};

// A DaeSystem of second order: y = (q, v, λ), rows in the same order: q' = E(q) v, M v' + … + Φ_qᵀλ
// = 0, Φ(q, t) = 0. There may be more coordinates than rates (quaternions).

/// The local matrix with a factor for each unknown in place of one c, ∂F/∂y + ∂F/∂y' diag(c):
/// LocalJacobian of such a system. c: n.
class LocalOfSecondOrder : public LocalJacobian {
 public:
  using LocalJacobian::evaluate;
  /// The matrix at (t, y, ẏ). False where it has no value.
  virtual bool evaluate(double t, const double* y, const double* ydot, const double* c) = 0;
};

/// A DaeSystem of second order.
class SecondOrder {
 public:
  virtual ~SecondOrder() = default;
  virtual int coordinates() const = 0;  ///< nq
  virtual int rates() const = 0;        ///< nv
  virtual int multipliers() const = 0;  ///< m
  /// E(q) v (nq) of v (nv).
  virtual void coordinate_rates(const double* q, const double* v, double* qdot) = 0;
  /// q ∘ exp δ: q after constant rates δ (nv) for a unit of time, to fourth order in δ (exact for
  /// joints with q' = v); quaternions of unit length.
  virtual void move(const double* q, const double* delta, double* moved) = 0;

  // For projections and penalties:
  /// Φ (m) at (t, q), Φ̇ of v, and Φ̈ of v and v̇.
  virtual void constraints(double t, const double* q, double* phi) = 0;
  /// Φ̇ (m).
  virtual void constraint_rates(double t, const double* q, const double* v, double* rate) = 0;
  /// Φ̈ (m).
  virtual void constraint_accelerations(double t, const double* q, const double* v,
                                        const double* vdot, double* rate) = 0;
  /// 1/(penalty × effective mass) by row of Φ (m).
  virtual const std::vector<double>& compliance() = 0;
};

// Structure of a DaeSystem: a mixin.

/// A DaeSystem that knows its structure.
class StructuredSystem {
 public:
  virtual ~StructuredSystem() = default;
  /// The differentiation index.
  virtual int index() const = 0;
  /// Whether the highest derivatives, each equation differentiated as often as the Σ-method says,
  /// are determined. J(c) is then regular as c grows, but for powers of c by rows and columns, in
  /// which changes of ∂F/∂y and ∂F/∂y' of order 1/c are of that order: simplified Newton iterations
  /// contract as steps shrink.
  virtual bool is_regular() const = 0;
};

}  // namespace momenta
