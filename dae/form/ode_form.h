#pragma once
// Base of the ODE forms: the state y = (q, x) with x = p or u, the linear system of the loops, the
// position correction.

#include <momenta/dae/form/form.h>
#include <momenta/dae/form/natural_sizes.h>
#include <momenta/dae/kkt/bearing_friction.h>
#include <momenta/dae/kkt/loop_solver.h>

#include <functional>
#include <stdexcept>

namespace momenta {

/// Thrown where a form has no state at the start it is given: its run fails before the first
/// sample, others go on. what(): one sentence.
struct NoStateAtStart : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class OdeForm : public Form, public OdeSystem {
 public:
  /// Scales x as u; forms in p say otherwise.
  OdeForm(std::string name, const Mechanism& mechanism, const FormOptions& options,
          const Start& start);

  const std::string& name() const override { return name_; }
  bool is_dae() const override { return false; }
  OdeSystem* ode() override { return this; }
  int size() const override { return mechanism_.nq() + mechanism_.nv(); }
  double scale(int i) const override { return scale_[static_cast<std::size_t>(i)]; }
  double time_scale() const override { return 1 / sizes_.rate; }
  double horizon() const override { return sizes_.horizon(); }
  /// Solutions of the run, without those made for looking at samples.
  long factorizations() const { return solver_ ? solver_->solutions() - looked_ : 0; }
  /// Counts in `evaluations` (m), by row of Φ, the right-hand sides in which it faded, and in
  /// weak_evaluations() those in which more than `redundant` rows did; null: stops. KLU can't tell
  /// which rows fade.
  void watch_faded(std::vector<long>* evaluations, int redundant = 0) {
    watched_ = evaluations;
    redundant_ = redundant;
  }
  long weak_evaluations() const { return weak_evaluations_; }

  /// u (nv) and σ or λ (m) of the last evaluation or solution after a step, to differentiate about.
  /// Forms on accelerations have their u in the state.
  const std::vector<double>& rates() const { return u_; }
  const std::vector<double>& multipliers() const { return multipliers_; }
  /// Pivots of the last solution for loops.
  LoopSolver::Pivots pivots() const { return solver_ ? solver_->pivots() : LoopSolver::Pivots{}; }
  bool corrects_positions() const { return has_loops() && options_.project; }

  /// Sets σ or λ (m) that the next step keeps where rows fade.
  void centre_on(const double* multipliers) {
    std::copy_n(multipliers, multipliers_.size(), multipliers_.begin());
  }
  /// The local matrix; null unless the mechanism is large.
  LocalJacobian* local() override;
  /// The local matrix whatever the size; null: no DAE form is known to have these equations.
  LocalJacobian* local_jacobian() { return solved_.get(); }
  void begin_step(double t, const double* y) override;
  SingularityHandling wanted_handling() const override { return handling_; }
  void set_observing(bool looking) override;
  bool can_be_put_down() const override { return !solver_ || !solver_->remembers(); }
  void carry(Memory& memory) override;

 protected:
  /// Singularity handling: pivots go with the squared distance to the singular pose. f is taken at
  /// corrected positions where the weakest is below `near` of its scale, a hundredth of a radian
  /// away; errors are measured by the motion where it is below approaching_ of its largest value on
  /// the run.
  static constexpr double near = 1e-4;
  double approaching_ = 0.2;

  /// Sets the DAE form of index 1 whose solutions are right-hand sides; made at first use.
  void solves(std::function<std::unique_ptr<Form>()> equations);
  bool has_loops() const { return mechanism_.m() > 0; }
  /// q̇ of u: u itself unless there are quaternions.
  void coordinate_rates(const double* q, const double* u, double* qdot) const {
    if (mechanism_.plan().quasi_velocities)
      e_->coordinate_rates(q, u, qdot);
    else
      std::copy_n(u, mechanism_.nv(), qdot);
  }
  /// Finds the friction of bearings, if any, at (t, q, u).
  bool add_bearing_friction(double t, const double* q, const double* u) {
    return !friction_ || friction_->at(t, q, u) || fail_at(t, friction_->failure());
  }
  /// Adds the friction found, by reference, to solutions of (3).
  void push_friction() {
    if (!friction_) return;
    e_->push(friction_->forces());
    if (solver_) solver_->push(friction_->forces());
  }
  /// Names the cause where the solver failed to solve `what` at (t, q).
  bool solver_failed(double t, const double* q, const std::string& what);
  /// One Newton step on q in the mass metric: δ of M δ + Φ_qᵀν = 0, Φ_q δ = −Φ.
  bool correct_position(double t, double* q) {
    if (!solve_correction(t, q)) return false;
    take_correction(q);
    return true;
  }
  /// The halves of correct_position(): delta_ at q; q ← q + q̇(delta_).
  bool solve_correction(double t, const double* q);
  void take_correction(double* q);
  /// Mean square of errors e of q (nq), v of u (nv), each over atol · scale + rtol · size.
  double mean_square(const double* q, const double* e, const double* u, const double* v,
                     double rtol, double atol) const;
  /// Scales quaternions of q to unit length.
  void normalise(double* q) const;
  /// Notes which rows faded in a right-hand side, and whether others are about to.
  void note_pivots();
  /// Fails with the sentence "at t = …: why".
  bool fail_at(double t, const std::string& why);

  int looking_ = 0;  ///< depth of set_observing()
  long looked_ = 0, before_looking_ = 0;
  std::vector<double> kept_;                                  ///< multipliers before looking
  SingularityHandling handling_ = SingularityHandling::none;  ///< handling of the step under way
  double weakest_at_best_ = 0;  ///< largest value of the weakest pivot on the run
  int redundant_ = 0;           ///< redundant rows at the start
  long weak_evaluations_ = 0;
  int always_faded_ = 0;  ///< rows that are redundant wherever the mechanism has been
  std::vector<long>* watched_ = nullptr;
  std::string name_;
  const Mechanism& mechanism_;
  FormOptions options_;
  std::unique_ptr<Evaluation<double>> e_;
  std::unique_ptr<LoopSolver> solver_;  ///< null without loops
  bool solves_itself_ = false;          ///< solver_ is the form's, not the mechanism's plan's
  std::unique_ptr<BearingFriction> friction_;  ///< null without bearings
  std::unique_ptr<LocalJacobian> solved_;      ///< see local_jacobian
  std::vector<double> u_, multipliers_, centre_, delta_, work_, correction_;
  NaturalSizes sizes_;
  std::vector<double> scale_;
};

std::unique_ptr<OdeForm> make_momentum(const Mechanism&, const FormOptions&, const Start&);

}  // namespace momenta
