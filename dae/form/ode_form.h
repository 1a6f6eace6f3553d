#pragma once
// What the ODE forms share: the state y = (q, x) with x = p or u, the linear system of the loops,
// the position correction.

#include <momenta/dae/form/form.h>
#include <momenta/dae/form/natural_sizes.h>
#include <momenta/dae/kkt/bearing_friction.h>
#include <momenta/dae/kkt/loop_solver.h>

#include <functional>
#include <stdexcept>

namespace momenta {

/// A form has no state at the start it is given: a run of it that fails before its first sample,
/// while others go on. what(): one sentence.
struct NoStateAtStart : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class OdeForm : public Form, public OdeSystem {
 public:
  /// Of u until a form says otherwise.
  OdeForm(std::string name, const Mechanism& mechanism, const FormOptions& options,
          const Start& start);

  const std::string& name() const override { return name_; }
  bool is_dae() const override { return false; }
  OdeSystem* ode() override { return this; }
  int size() const override { return mechanism_.nq() + mechanism_.nv(); }
  double scale(int i) const override { return scale_[static_cast<std::size_t>(i)]; }
  double time_scale() const override { return 1 / sizes_.rate; }
  double horizon() const override { return sizes_.horizon(); }
  /// Of the run itself; those made for looking at samples are not counted.
  long factorizations() const { return solver_ ? solver_->solutions() - looked_ : 0; }
  /// Counts in `evaluations` (m), row of Φ by row, the right-hand sides in which it faded, and in
  /// weak_evaluations() those in which more than `redundant` did; null: counts no longer. KLU can't
  /// tell which rows fade.
  void watch_faded(std::vector<long>* evaluations, int redundant = 0) {
    watched_ = evaluations;
    redundant_ = redundant;
  }
  long weak_evaluations() const { return weak_evaluations_; }

  /// u (nv) and σ or λ (m) of the last evaluation or solution after a step: about what it can be
  /// differentiated. Forms on accelerations have their u in the state.
  const std::vector<double>& rates() const { return u_; }
  const std::vector<double>& multipliers() const { return multipliers_; }
  /// Of the last solution for loops.
  LoopSolver::Pivots pivots() const { return solver_ ? solver_->pivots() : LoopSolver::Pivots{}; }
  /// Whether positions are corrected after each step.
  bool corrects_positions() const { return has_loops() && options_.project; }

  /// The σ or λ (m) of a moment ago, which the next step keeps where rows fade.
  void centre_on(const double* multipliers) {
    std::copy_n(multipliers, multipliers_.size(), multipliers_.begin());
  }
  /// Of large mechanisms.
  LocalJacobian* local() override;
  /// The same whatever the size; null: the form is not known to solve a DAE form's equations.
  LocalJacobian* local_jacobian() { return solved_.get(); }
  void begin_step(double t, const double* y) override;
  SingularityHandling wanted_handling() const override { return handling_; }
  void look_on(bool looking) override;
  bool can_be_put_down() const override { return !solver_ || !solver_->remembers(); }
  void carry(Memory& memory) override;

 protected:
  /// Where singularity handling begins: a pivot goes with the square of the distance to the
  /// singular pose. f is taken at corrected positions where the weakest is below `near` of its
  /// scale, a hundredth of a radian away; errors are measured by the motion where it is below that
  /// part of the largest it has been: loops that are weak throughout approach nothing.
  static constexpr double near = 1e-4;
  double approaching_ = 0.2;

  /// Right-hand sides are the solutions of that DAE form of index 1, made when first asked for.
  void solves(std::function<std::unique_ptr<Form>()> equations);
  bool has_loops() const { return mechanism_.m() > 0; }
  /// q̇ of u: u itself unless there are quaternions.
  void coordinate_rates(const double* q, const double* u, double* qdot) const {
    if (mechanism_.plan().quasi_velocities)
      e_->coordinate_rates(q, u, qdot);
    else
      std::copy_n(u, mechanism_.nv(), qdot);
  }
  /// Finds the friction of bearings at (t, q, u), where the mechanism has such.
  bool rub(double t, const double* q, const double* u) {
    return !friction_ || friction_->at(t, q, u) || fail_at(t, friction_->failure());
  }
  /// From now on solutions of (3) have that friction.
  void push_friction() {
    if (!friction_) return;
    e_->push(friction_->forces());
    if (solver_) solver_->push(friction_->forces());
  }
  /// The cause by name when the solver failed to solve `what` at (t, q).
  bool solver_failed(double t, const double* q, const std::string& what);
  /// One Newton step on q in the mass metric: δ of M δ + Φ_qᵀν = 0, Φ_q δ = −Φ.
  bool correct_position(double t, double* q) {
    if (!solve_correction(t, q)) return false;
    take_correction(q);
    return true;
  }
  /// Its two halves: delta_ at q, q ← q + q̇(delta_).
  bool solve_correction(double t, const double* q);
  void take_correction(double* q);
  /// Of errors e of q (nq) and v of u (nv), each over atol times its scale + rtol times its size.
  double mean_square(const double* q, const double* e, const double* u, const double* v,
                     double rtol, double atol) const;
  /// Quaternions of q back to unit length.
  void normalise(double* q) const;
  /// After the solution of a right-hand side: which rows faded, and whether others are about to.
  void note_pivots();
  /// The sentence "at t = …: why".
  bool fail_at(double t, const std::string& why);

  int looking_ = 0;  ///< depth
  long looked_ = 0, before_looking_ = 0;
  std::vector<double> kept_;                                  ///< multipliers, while looking
  SingularityHandling handling_ = SingularityHandling::none;  ///< of the step under way
  double weakest_at_best_ = 0;  ///< largest that the weakest pivot has been on the run
  int redundant_ = 0;           ///< rows at the start
  long weak_evaluations_ = 0;
  int always_faded_ = 0;  ///< rows that are redundant wherever the mechanism has been
  std::vector<long>* watched_ = nullptr;
  std::string name_;
  const Mechanism& mechanism_;
  FormOptions options_;
  std::unique_ptr<Evaluation<double>> e_;
  std::unique_ptr<LoopSolver> solver_;         ///< null without loops
  std::unique_ptr<BearingFriction> friction_;  ///< null without bearings
  std::unique_ptr<LocalJacobian> solved_;      ///< see local_jacobian
  std::vector<double> u_, multipliers_, centre_, delta_, work_, correction_;
  NaturalSizes sizes_;
  std::vector<double> scale_;  ///< of y
};

std::unique_ptr<OdeForm> make_momentum(const Mechanism&, const FormOptions&, const Start&);
std::unique_ptr<OdeForm> make_acceleration(const Mechanism&, const FormOptions&, const Start&);
std::unique_ptr<OdeForm> make_projected(const Mechanism&, const FormOptions&, const Start&);
std::unique_ptr<OdeForm> make_partitioned(const Mechanism&, const FormOptions&, const Start&);
std::unique_ptr<OdeForm> make_baumgarte(const Mechanism&, const FormOptions&, const Start&);
std::unique_ptr<OdeForm> make_maximal_coordinates(const Mechanism&, const FormOptions&,
                                                  const Start&);
std::unique_ptr<OdeForm> make_augmented_lagrangian(const Mechanism&, const FormOptions&,
                                                   const Start&);
std::unique_ptr<OdeForm> make_augmented_lagrangian_canonical(const Mechanism&, const FormOptions&,
                                                             const Start&);

}  // namespace momenta
