#pragma once
// Base of the DAE forms: the layout of their unknowns, the rows every form has, exact Jacobians by
// dual numbers.
//
//   y = ( q | x | v | s | μ ),  x = p or v; v, s, μ only where the form has them; s = σ or λ
// Rows: nv kinematic or momentum rows; one row q·q̇ + ρ (|q|² − 1)/2 = 0 per quaternion; nv dynamic
// rows; then the form's other rows. A form writes its equations once, as a template on the scalar:
// with double they are the residual, with dual numbers eight columns of ∂F/∂y + c ∂F/∂y' at a time,
// with sparse dual numbers the entries of a local matrix in its place (local_rows.h), with series
// (Jet) their total derivatives, from which the index is found.

#include <momenta/dae/form/form.h>
#include <momenta/dae/form/local_rows.h>
#include <momenta/dae/form/ode_form.h>
#include <momenta/dae/kkt/kkt.h>
#include <momenta/dae/kkt/loop_solver.h>

#include <algorithm>

namespace momenta {

struct DaeLayout {
  int nq = 0, nv = 0, m = 0;
  bool explicit_velocity = false;    ///< v beside p
  bool position_multiplier = false;  ///< μ
  int below = 0;  ///< derivatives between the rows that determine s and Φ̇ of σ, Φ̈ of λ
  int x() const { return nq; }
  int v() const { return explicit_velocity ? nq + nv : nq; }
  int s() const { return nq + nv + (explicit_velocity ? nv : 0); }
  int mu() const { return s() + m; }
  int size() const { return s() + m + (position_multiplier ? m : 0); }
};

/// x and s: v with λ; p of (4) with λ; p of (7), with Φ_qᵀσ in it, with σ.
enum class Unknowns { velocities, momenta, impulses };

/// Buffers of one scalar type.
template <class S>
struct DaeScratch {
  std::unique_ptr<Evaluation<S>> e;
  std::vector<S> u, a, b, y, ydot, r;

  DaeScratch() = default;
  DaeScratch(const Mechanism& mechanism, int size) : e(mechanism.evaluation<S>()) {
    const auto nv = static_cast<std::size_t>(mechanism.nv());
    u.resize(nv);
    a.resize(std::max(nv, static_cast<std::size_t>(mechanism.m())));
    b.resize(nv);
    for (auto* v : {&y, &ydot, &r}) v->resize(static_cast<std::size_t>(size));
  }
};

class DaeForm : public Form, public DaeSystem {
 public:
  DaeForm(std::string name, const Mechanism& mechanism, DaeLayout layout,
          const FormOptions& options, const Start& start, Unknowns unknowns);

  const std::string& name() const override { return name_; }
  bool is_dae() const override { return true; }
  bool momentum_like() const override { return unknowns_ == Unknowns::impulses; }
  DaeSystem* dae() override { return this; }
  Gauge gauge() const override { return gauge_; }
  std::vector<double> initial(const Start& start) override;
  bool read(double t, const double* y, const double* ydot, Snapshot& out) override;

  int size() const override { return layout_.size(); }
  bool residual(double t, const double* y, const double* ydot, double* r) override;
  bool jacobian(double t, const double* y, const double* ydot, double c, double* values) override;
  /// Analysed at the first call.
  const JacobianPattern& pattern() const override;
  LocalJacobian* local() override;
  /// The local matrix, whatever the size.
  LocalJacobian& local_jacobian();
  bool start(double t, double* y, double* ydot) override;
  bool differential(int i) const override;
  double scale(int i) const override;
  double horizon() const override { return sizes_.horizon(); }
  Weight weight(int i) const override;
  bool near_singular(double t, const double* y) override;
  OdeSystem* ode_restart(double t, const double* y, double* state) override;
  int ode_restart_size() const override { return layout_.nq + layout_.nv; }
  bool rejoin(double t, const double* state, double* y, double* ydot) override;

  /// F along a curve, y and y' given as series, with its derivatives along their two directions.
  /// Without the regularisation of redundant loops: the equations as the form's head has them.
  void along(double t, const Jet* y, const Jet* ydot, Jet* r);
  const DaeLayout& layout() const { return layout_; }

 protected:
  virtual void equations(DaeScratch<double>& s, double t, const double* y, const double* ydot,
                         double* r) = 0;
  virtual void equations(DaeScratch<Dual8>& s, double t, const Dual8* y, const Dual8* ydot,
                         Dual8* r) = 0;
  virtual void equations(DaeScratch<LocalDual>& s, double t, const LocalDual* y,
                         const LocalDual* ydot, LocalDual* r) = 0;
  virtual void equations(DaeScratch<Jet>& s, double t, const Jet* y, const Jet* ydot, Jet* r) = 0;
  /// Whether x takes part in the error test: not at index 3, where x is one derivative rougher than
  /// q.
  virtual bool rate_is_tested() const { return true; }

  double leak() const { return gauge_.kappa; }
  /// ε by row of Φ (m), empty when the loops are independent at the start.
  const std::vector<double>& regularisation() const { return epsilon_; }

  DaeLayout layout_;
  const Mechanism& mechanism_;
  NaturalSizes sizes_;

 private:
  /// Where loops are redundant or singular at the start: adds −ε (s − s₀) to the rows that
  /// determine s (and −10⁻³ ε μ, by units of mass and time), which keeps the Newton matrix regular.
  /// s₀ is s at the start: ε s₀ would open Φ there, and a first step h answer by u ~ ε s₀/h. The
  /// gauge keeps the bias of u, ε (s − s₀), small.
  template <class S>
  void regularise(const S* y, S* r) const {
    if (epsilon_.empty()) return;
    const int rows = layout_.position_multiplier ? 2 * layout_.m : layout_.m;
    for (int i = 0; i < layout_.m; ++i) {
      const double epsilon = epsilon_[static_cast<std::size_t>(i)];
      r[layout_.size() - rows + i] -=
          epsilon * (y[layout_.s() + i] - softened_about_[static_cast<std::size_t>(i)]);
      if (layout_.position_multiplier)
        r[layout_.size() - layout_.m + i] -= (softness_of_mu_ * epsilon) * y[layout_.mu() + i];
    }
  }
  bool evaluate_columns(double t, const double* y, const double* ydot, double c,
                        const std::vector<int>& direction_of);
  class Local;
  /// u of M u + prescribed part = p (4).
  bool open_rates(double t, const double* y, double* u);
  /// Fills y and y' from u, u̇, λ; q, s, and p where σ is in it, are in y already.
  void complete(double t, const double* u, const double* udot, const double* lambda, double* y,
                double* ydot);
  void find_redundancy(const Start& start);
  /// Pivots of the loops at a pose, in the solver of ode_restart_; false: there are none.
  bool find_pivots(double t, const double* q);
  /// The ODE form of restarts, with loops closed.
  OdeForm& restart_form();
  /// Finds the rows without a pivot everywhere, where some have none at the start.
  void look_beside_start();
  /// Sets pattern_ (empty: dense) and the columns that share a direction.
  void analyse_pattern();

  std::string name_;
  Unknowns unknowns_;
  Gauge gauge_;
  Start start_;
  std::vector<double> scale_;
  double softness_of_mu_ = 0;    ///< ε of μ over that of s [kg, or kg s]
  std::vector<double> inertia_;  ///< diagonal of M at the start
  DaeScratch<double> plain_;
  DaeScratch<Dual8> dual_;  ///< filled at first use, as all that follow
  DaeScratch<Jet> jet_;
  std::unique_ptr<LocalJacobian> local_;
  std::vector<double>
      epsilon_;  ///< per row of Φ; empty when the loops are independent at the start
  std::vector<double> softened_about_;  ///< s₀ (m)
  std::unique_ptr<Kkt> kkt_;            ///< for reading momentum states back
  std::unique_ptr<LoopSolver> reader_;  ///< the same for large mechanisms
  FormOptions options_;
  /// The momentum form that passes singular poses, and a solver of (7) that foresees them.
  struct OdeRestart {
    std::unique_ptr<OdeForm> form;
    std::unique_ptr<LoopSolver> solver;
    std::unique_ptr<BearingFriction> friction;
    std::vector<double> u, udot, sigma, lambda;
    double strongest = 0;  ///< largest of the weakest pivots so far
    int always_faded = 0;
  } ode_restart_;
  JacobianPattern pattern_;  ///< known once batches_ is not empty
  std::vector<std::vector<int>>
      batches_;  ///< per dual evaluation: the direction of each column, −1: none
  std::vector<std::vector<std::vector<int>>>
      groups_;  ///< per dual evaluation and direction: its columns
};

/// Writes the equations of `Derived::rows<S>` for all scalars.
template <class Derived>
class DaeFormOf : public DaeForm {
 public:
  using DaeForm::DaeForm;

 protected:
  void equations(DaeScratch<double>& s, double t, const double* y, const double* ydot,
                 double* r) override {
    static_cast<Derived*>(this)->rows(s, t, y, ydot, r);
  }
  void equations(DaeScratch<Dual8>& s, double t, const Dual8* y, const Dual8* ydot,
                 Dual8* r) override {
    static_cast<Derived*>(this)->rows(s, t, y, ydot, r);
  }
  void equations(DaeScratch<LocalDual>& s, double t, const LocalDual* y, const LocalDual* ydot,
                 LocalDual* r) override {
    static_cast<Derived*>(this)->rows(s, t, y, ydot, r);
  }
  void equations(DaeScratch<Jet>& s, double t, const Jet* y, const Jet* ydot, Jet* r) override {
    static_cast<Derived*>(this)->rows(s, t, y, ydot, r);
  }

  /// Φ = 0 (m), and of nonholonomic rows A u − b = 0. The evaluation is moved.
  template <class S>
  void position_rows(DaeScratch<S>& s, S* r) const {
    s.e->positions(r);
    if (!mechanism_.has_nonholonomic()) return;
    s.e->velocities(s.a.data());
    for (std::size_t i = 0; i < mechanism_.nonholonomic().size(); ++i)
      if (mechanism_.nonholonomic()[i]) r[i] = s.a[i];
  }
  /// The rows of Φ̇ = 0 and Φ = 0 (2m); of nonholonomic rows, which have one level, μ = 0 in place
  /// of the second. The evaluation is moved.
  template <class S>
  void both_levels(DaeScratch<S>& s, const S* y, S* r) const {
    s.e->velocities(r);
    s.e->positions(r + layout_.m);
    for (int i = 0; i < layout_.m; ++i)
      if (mechanism_.nonholonomic()[static_cast<std::size_t>(i)])
        r[layout_.m + i] = y[layout_.mu() + i];
  }

  /// The rows of (7) and (8) with u the rates of q̇, for forms in q, p; σ. Returns the place of the
  /// loops' rows; the evaluation is moved at u.
  template <class S>
  S* momentum_rows(DaeScratch<S>& s, double t, const S* y, const S* ydot, S* r) const {
    const S *q = y, *p = y + layout_.x(), *sigma = y + layout_.s(), *pdot = ydot + layout_.x();
    s.e->place(t, q);
    s.e->joint_rates(q, ydot, s.u.data());
    s.e->move(s.u.data());
    s.e->momenta(sigma, r);
    for (int i = 0; i < layout_.nv; ++i) *r++ -= p[i];
    r = quaternion_rows(q, ydot, r);
    s.e->momentum_rates(q, s.u.data(), sigma, leak(), s.b.data());
    for (int i = 0; i < layout_.nv; ++i) *r++ = pdot[i] - s.b[static_cast<std::size_t>(i)];
    return r;
  }

  /// M u = p with u the rates of q̇ (5a), (5b): −∂H/∂q = L_q at u, for the form in q, p; λ. Returns
  /// the place of the loops' rows.
  template <class S>
  S* hamilton_rows(DaeScratch<S>& s, double t, const S* y, const S* ydot, S* r) const {
    const S *q = y, *p = y + layout_.x(), *lambda = y + layout_.s(), *pdot = ydot + layout_.x();
    s.e->place(t, q);
    s.e->joint_rates(q, ydot, s.u.data());
    s.e->move(s.u.data());
    s.e->momenta(nullptr, r);
    for (int i = 0; i < layout_.nv; ++i) *r++ -= p[i];
    r = quaternion_rows(q, ydot, r);
    s.e->momentum_rates(q, s.u.data(), nullptr, 0, s.b.data());
    s.e->constraint_forces(lambda, s.a.data());
    for (std::size_t i = 0; i < s.b.size(); ++i) *r++ = pdot[i] - s.b[i] + s.a[i];
    return r;
  }

  /// q̇ = v − Φ_qᵀμ, μ where the form has it. The evaluation is placed, and moved at v.
  template <class S>
  S* kinematic_rows(DaeScratch<S>& s, double t, const S* y, const S* ydot, S* r) const {
    const S *q = y, *v = y + layout_.v();
    s.e->place(t, q);
    s.e->joint_rates(q, ydot, s.u.data());
    for (int i = 0; i < layout_.nv; ++i) r[i] = s.u[static_cast<std::size_t>(i)] - v[i];
    if (layout_.position_multiplier) {
      s.e->constraint_forces(y + layout_.mu(), s.a.data());
      for (int i = 0; i < layout_.nv; ++i) r[i] += s.a[static_cast<std::size_t>(i)];
    }
    r = quaternion_rows(q, ydot, r + layout_.nv);
    s.e->move(v);
    return r;
  }

  /// The kinematic rows and (1a), for forms in q, v; λ. Returns the place of the loops' rows.
  template <class S>
  S* acceleration_rows(DaeScratch<S>& s, double t, const S* y, const S* ydot, S* r) const {
    r = kinematic_rows(s, t, y, ydot, r);
    s.e->joint_forces(y, y + layout_.v(), ydot + layout_.v(), y + layout_.s(), r);
    s.e->bearing_friction(y + layout_.v(), r);
    return r + layout_.nv;
  }

 private:
  /// One row per quaternion: its length returns to 1 within the motion's time scale, without an
  /// effect on the motion.
  template <class S>
  S* quaternion_rows(const S* q, const S* qdot, S* r) const {
    if (!mechanism_.plan().quasi_velocities) return r;
    for (const auto& b : mechanism_.tree().bodies) {
      if (!b.has_quaternion()) continue;
      const int first = b.q + b.nq - 4;
      const double half = 0.5 * sizes_.rate;
      S row = S(-half);
      for (int i = first; i < first + 4; ++i) row += q[i] * qdot[i] + half * (q[i] * q[i]);
      *r++ = row;
    }
    return r;
  }
};

/// `momentum-index1`, also where the scene has bearings.
std::unique_ptr<Form> make_momentum_index1(const Mechanism&, const FormOptions&, const Start&);

}  // namespace momenta
