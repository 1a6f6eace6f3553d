#pragma once
// What an integrator sees of a form: an ODE y' = f(t, y), or a DAE F(t, y, y') = 0. Failures are
// values: a call returns false and `failure()` then holds one sentence (which constraint, which
// time, which cause).

#include <momenta/dae/solver/memory.h>

#include <limits>
#include <string>
#include <vector>

namespace momenta {

/// What a method with error control does about singular poses, in order of what it costs: nothing,
/// errors measured by what they change of the motion, f at the corrected position as well.
enum class SingularityHandling { none, norm, position };

/// y' = f(t, y). One object serves one thread.
class OdeSystem {
 public:
  virtual ~OdeSystem() = default;
  virtual int size() const = 0;  ///< of y

  /// y' at (t, y); both of size().
  virtual bool rhs(double t, const double* y, double* ydot) = 0;

  /// Called once after every accepted step of a one-step method, before the next: gauge reset,
  /// position correction, quaternion normalisation. Sets `changed` when y was altered in a way that
  /// makes f(t, y) a different number (a gauge reset does; a position correction of the size of the
  /// local error does not: the last stage may then still serve as the next first one).
  virtual bool after_step(double /*t*/, double* /*y*/, bool& /*changed*/) { return true; }
  /// Whether after_step() does anything.
  virtual bool has_after_step() const { return false; }

  /// Tells the system that a new step starts at (t, y): the σ_ref of recentred pivots is taken
  /// here, so that within a step f is a pure function of (t, y).
  virtual void begin_step(double /*t*/, const double* /*y*/) {}

  /// f at the state after_step() left, where it came along; false: still to be evaluated.
  virtual bool first_derivative(double* /*ydot*/) { return false; }

  /// What evaluations since begin_step() ask for: where loop equations become dependent, a stage a
  /// little off the manifold is far off in its rates. A method that controls its error repeats the
  /// step where f changes with it.
  virtual SingularityHandling wanted_handling() const { return SingularityHandling::none; }
  /// SingularityHandling::position alone changes f.
  virtual void set_handling(SingularityHandling /*singularity handling*/) {}
  /// Square of a norm of the local error at (t, y), root mean square over the unknowns, of what
  /// changes the motion alone: not of the gauge of σ. The weight of an unknown is atol · scale +
  /// rtol · size. Not finite when it cannot be had. In use while there is singularity handling.
  virtual double motion_error_squared(double /*t*/, const double* /*y*/, const double* /*error*/,
                                      double /*rtol*/, double /*atol*/) {
    return std::numeric_limits<double>::quiet_NaN();
  }

  /// Evaluations from true to false are an observer's: they count nowhere, and no later step
  /// depends on them. Pairs may stand within each other.
  virtual void look_on(bool /*looking*/) {}

  /// Whether carry() lists all that evaluations to come depend on.
  virtual bool can_be_put_down() const { return false; }
  /// Between two steps.
  virtual void carry(Memory& /*memory*/) {}

  /// Typical size of y_i, for absolute tolerances: the error weight is atol · scale_i + rtol ·
  /// |y_i|.
  virtual double scale(int /*i*/) const { return 1.0; }

  /// One sentence on the last call that returned false.
  const std::string& failure() const { return failure_; }

 protected:
  /// Keeps the sentence; false.
  bool fail(std::string sentence) {
    failure_ = std::move(sentence);
    return false;
  }

 private:
  std::string failure_;
};

/// While it lives the system is looked at, not run.
class Looking {
 public:
  /// From now on.
  explicit Looking(OdeSystem& system) : system_(system) { system_.look_on(true); }
  ~Looking() { system_.look_on(false); }
  Looking(const Looking&) = delete;
  Looking& operator=(const Looking&) = delete;

 private:
  OdeSystem& system_;
};

/// Compressed columns of ∂F/∂y + c ∂F/∂y'; fixed once analysed. Empty column_start means dense.
struct JacobianPattern {
  std::vector<long> column_start;  ///< size() + 1
  std::vector<long> row;           ///< row of each stored entry, ascending in each column
};

/// A matrix with unknowns z beside y that has J = ∂F/∂y + c ∂F/∂y' once they are eliminated, and
/// far fewer entries: rows and columns of y come first, ( A B; C T ), J = A − B T⁻¹ C.
class LocalJacobian {
 public:
  virtual ~LocalJacobian() = default;
  /// Exact, at the arguments of jacobian(); O(entries). False when it is not finite.
  virtual bool evaluate(double t, const double* y, const double* ydot, double c) = 0;
  /// Of the last evaluation. The version tells that the pattern is another than before.
  virtual const JacobianPattern& pattern() const = 0;
  virtual const std::vector<double>& values() const = 0;  ///< in the order of pattern()
  virtual int version() const = 0;                        ///< of the pattern, ascending
};

/// F(t, y, y') = 0. One object serves one thread.
class DaeSystem {
 public:
  virtual ~DaeSystem() = default;
  virtual int size() const = 0;  ///< of y and of F

  /// r = F(t, y, y').
  virtual bool residual(double t, const double* y, const double* ydot, double* r) = 0;

  /// J = ∂F/∂y + c ∂F/∂y', exact. Dense: column-major size() × size(). Sparse: the values in the
  /// order of pattern().
  virtual bool jacobian(double t, const double* y, const double* ydot, double c,
                        double* values) = 0;
  /// Valid from start() on.
  virtual const JacobianPattern& pattern() const = 0;
  /// What to factorise in place of J where that is large; else null. Whoever takes it asks for no
  /// pattern().
  virtual LocalJacobian* local() { return nullptr; }

  /// Consistent start: y and y' with F(t, y, y') = 0.
  virtual bool start(double t, double* y, double* ydot) = 0;

  /// Whether y_i takes part in the local error test (differential variables of the form's
  /// convergence theory).
  virtual bool differential(int i) const = 0;
  /// Absolute tolerance of y_i is atol · scale(i); infinity keeps y_i out of the Newton norm too
  /// (multipliers).
  virtual double scale(int i) const = 0;

  /// How methods that know the index weigh y_i in their norms: the error times h^power over atol ·
  /// scale + rtol |y_i|. A variable that loses a power of the step (the velocities of an index-3
  /// form) gets it back by power 1; power −1 keeps y_i out (multipliers).
  struct Weight {
    int power;     ///< of h
    double scale;  ///< times atol
  };
  /// Of y_i.
  virtual Weight weight(int i) const { return {differential(i) ? 0 : -1, scale(i)}; }

  /// Whether the coordinates that lead y, and the states below, are near a pose where loop
  /// equations lose rank: the Newton matrix of any method whose step spans it may be singular.
  virtual bool near_singular(double /*t*/, const double* /*y*/) { return false; }
  /// There: the same motion as an ODE whose steps are taken with singularity handling, and its
  /// `state` (ode_restart_size()) at (t, y).
  virtual OdeSystem* ode_restart(double /*t*/, const double* /*y*/, double* /*state*/) {
    return nullptr;
  }
  /// Size of that state; 0: there is none.
  virtual int ode_restart_size() const { return 0; }
  /// y and y' from a state of that ODE; y comes with the multipliers of a moment ago.
  virtual bool rejoin(double /*t*/, const double* /*state*/, double* /*y*/, double* /*ydot*/) {
    return false;
  }

  /// One sentence on the last call that returned false.
  const std::string& failure() const { return failure_; }

 protected:
  /// Keeps the sentence; false.
  bool fail(std::string sentence) {
    failure_ = std::move(sentence);
    return false;
  }

 private:
  std::string failure_;
};

}  // namespace momenta
