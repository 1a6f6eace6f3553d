// partitioned
//
// Unknowns      independent q_i, u_i: as many of each as the mechanism has degrees of freedom
// Equations     q̇_i = u_i and u̇_i of (3), at the whole state that belongs to them:
//                 Φ(q_i, q_d, t) = 0 for q_d,  Φ_d u_d = −Φ_t − Φ_i u_i for u_d,
//               Φ_d is a square block of Φ_q, of the size of its rank. With spherical and free
//               joints q_i and u_i are chosen separately; q_i may be components of quaternions,
//               whose unit lengths are further equations.
// Index         an ODE, of the smallest possible size
// Hidden        none: Φ = 0 and Φ̇ = 0 at every evaluation
// Multipliers   λ, a force
// Drifts        nothing: Φ at the Newton tolerance, Φ̇ at rounding
// Partition     by LU with full pivoting of Φ_q, columns weighed by their inertia. Each step ends
//               with a check of |∂q_d/∂q_i| and |∂u_d/∂u_i|, weighed likewise: where one is above
//               1.5 (or 1.5 times its value at the best choice) the partition is chosen anew, with
//               the same q, u. Only one-step methods allow that. A later choice costs accuracy:
//               q_d magnifies the errors of q_i, steeply so near dead points.
// Newton        begins at the state of the start of the step, with the block factorised there, so
//               that the first correction is the tangent. The step is too long where the second
//               correction is not small or the corrections do not shrink; a method with step
//               control then tries a shorter step.
// Driven whole  with no independent coordinate no error is estimated. A stage whose rates are not
//               reached from the step's start by the accelerations at both ends is too far: beyond
//               a singular pose Newton's method would find the way back, at once.
// Fails         where no block is regular: a partition cannot pass a singular pose
// Source        Wehage, Haug, J. Mech. Design 104 (1982); Nikravesh, Computer-Aided Analysis of
//               Mechanical Systems (1988), with Euler parameters.

#include <momenta/dae/form/form_entry.h>
#include <momenta/dae/form/ode_form.h>
#include <momenta/dae/kkt/coordinate_jacobian.h>
#include <momenta/dae/kkt/coordinate_split.h>
#include <momenta/dae/kkt/loop_rank.h>
#include <momenta/dae/kkt/loop_units.h>
#include <momenta/dae/kkt/unheld_joints.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace momenta {
namespace {

constexpr int most_corrections = 12;
constexpr double last_correction = 1e-8;  // [rad or lengths]: its square is rounding
constexpr double off_tangent = 0.3;       // [rad or lengths]: the second correction, at most
constexpr double worst_growth = 1.5;      // dependent coordinates over independent ones
constexpr double least_turn = 1e-6;       // least change of rates, in their sizes
constexpr double opened = 1e-6;  // Φ of rows that ought to follow from the others, in units

class Partitioned final : public OdeForm {
 public:
  Partitioned(const Mechanism& mechanism, const FormOptions& options, const Start& start)
      : OdeForm("partitioned", mechanism, options, start),
        jacobian_(mechanism),
        start_q_(start.q),
        before_q_(start.q),
        q_(start.q),
        u_(start.u),
        qdot_(mechanism.nq()),
        udot_(mechanism.nv()),
        rate_(mechanism.m()) {
    expect_positions(mechanism);
    push_friction();
    rate_values_.resize(jacobian_.rate_pattern().size());
    values_.resize(jacobian_.pattern().size());
    phi_.resize(jacobian_.rows());
    unit_.setOnes(phi_.size());
    unit_.head(mechanism.m()) = LoopUnits(mechanism).equations;
    e_->place(start.t, q_.data());
    Eigen::VectorXd weights(mechanism.nv());
    e_->mass_diagonal(weights.data());
    for (double& w : weights) w = w > 0 ? std::sqrt(w) : 1;
    rates_ = std::make_unique<CoordinateSplit>(jacobian_.rate_pattern(), mechanism.m(), weights);
    if (jacobian_.has_balls())
      positions_ = std::make_unique<CoordinateSplit>(jacobian_.pattern(), jacobian_.rows(),
                                                     jacobian_.weights(weights));
    if (!choose(start.t))
      throw NoStateAtStart(
          "form 'partitioned': the loops leave no regular partition of the coordinates at the "
          "start");
  }

  bool momentum_like() const override { return false; }
  long partitions() const override { return partitions_; }
  /// At least one number, which stays zero where drives move everything.
  int size() const override { return std::max(1, 2 * freedom()); }
  double scale(int i) const override {
    const int n = freedom();
    if (n == 0) return 1;
    return i < n ? sizes_.q[static_cast<std::size_t>(independent_q(i))]
                 : sizes_.u[static_cast<std::size_t>(independent_u(i - n))];
  }

  std::vector<double> initial(const Start& start) override {
    before_q_ = start_q_ = q_ = start.q;
    before_t_ = start_t_ = start.t;
    u_ = start.u;
    std::copy(start.lambda.begin(), start.lambda.end(), multipliers_.begin());
    centre_ = multipliers_;
    e_->place(start.t, q_.data());
    choose(start.t);
    partitions_ = 1;
    if (freedom() == 0) note_start(start.t);
    std::vector<double> y(static_cast<std::size_t>(size()));
    load(y.data());
    return y;
  }

  bool rhs(double t, const double* y, double* ydot) override {
    if (!close(t, y) || !accelerate(t)) return false;
    if (turned_round(t)) return too_long(t);
    if (has_loops()) note_pivots();
    e_->coordinate_rates(q_.data(), u_.data(), qdot_.data());
    ydot[0] = 0;
    for (int k = 0; k < freedom(); ++k) {
      ydot[k] = qdot_[independent_q(k)];
      ydot[freedom() + k] = udot_[independent_u(k)];
    }
    return true;
  }

  bool has_after_step() const override { return true; }
  bool after_step(double t, double* y, bool& changed) override {
    if (!close(t, y)) return false;
    // Rows that were not chosen follow from the others, unless the loops tie more than they did.
    if (phi_.size() > 0 && !(phi_.cwiseQuotient(unit_).cwiseAbs().maxCoeff() < opened))
      return fail_at(t, "the loops tie more coordinates than at the start");
    before_q_ = start_q_;
    before_t_ = start_t_;
    start_q_ = q_;
    start_t_ = t;
    evaluate_jacobian();
    if (freedom() == 0 && !note_start(t)) return false;
    if (at_start_->factor(values_) && growth() <= bound_) return true;
    if (!choose(t))
      return fail_at(t,
                     "no partition of the coordinates is regular: the loops are "
                     "singular here");
    load(y);
    changed = true;
    return true;
  }
  void begin_step(double t, const double* y) override {
    OdeForm::begin_step(t, y);
    centre_ = multipliers_;
  }
  SingularityHandling wanted_handling() const override { return SingularityHandling::none; }
  /// Partition and factors are not saved.
  bool can_be_put_down() const override { return false; }

  bool read_coordinates(double t, const double* y, Eigen::VectorXd& q) override {
    if (!close(t, y, true)) return false;
    q = q_;
    return true;
  }
  bool read(double t, const double* y, const double*, Snapshot& out) override {
    const ObservationGuard looking(*this);
    if (!close(t, y, true) || !accelerate(t)) return false;
    out.q = q_;
    out.u = u_;
    out.multipliers = Eigen::Map<const Eigen::VectorXd>(multipliers_.data(), mechanism_.m());
    return true;
  }

 private:
  /// Refuses equations of rates alone: independent coordinates are as many as rates.
  static void expect_positions(const Mechanism& mechanism) {
    for (std::size_t i = 0; i < mechanism.nonholonomic().size(); ++i)
      if (mechanism.nonholonomic()[i])
        throw NoStateAtStart("form 'partitioned': loop '" + mechanism.rows()[i].loop + "' (" +
                             mechanism.rows()[i].what +
                             ") ties rates and no coordinates, so that no coordinate follows from "
                             "the others for it; expected another form");
  }
  /// Split of coordinates; that of rates where there are no balls.
  CoordinateSplit& positions() const { return positions_ ? *positions_ : *rates_; }
  int freedom() const { return static_cast<int>(rates_->independent().size()); }
  int independent_q(int k) const { return positions().independent()[static_cast<std::size_t>(k)]; }
  int independent_u(int k) const { return rates_->independent()[static_cast<std::size_t>(k)]; }
  void load(double* y) const {
    y[0] = 0;
    for (int k = 0; k < freedom(); ++k) {
      y[k] = q_[independent_q(k)];
      y[freedom() + k] = u_[independent_u(k)];
    }
  }

  /// Chooses the partition at the placed q_, and factorises there.
  bool choose(double t) {
    e_->place(t, q_.data());
    evaluate_jacobian();
    if (rank_ < 0) rank_ = loop_rank(mechanism_, *e_, Judged::dependence).rank;
    if (!rates_->choose(rate_values_, rank_)) return false;
    if (positions_ && !positions_->choose(values_, rank_ + jacobian_.balls())) return false;
    at_start_ = std::make_unique<SplitFactor>(positions());
    inside_ = std::make_unique<SplitFactor>(positions());
    if (positions_) of_rates_ = std::make_unique<SplitFactor>(*rates_);
    if (!at_start_->factor(values_)) return false;
    const double best = growth();
    if (!std::isfinite(best)) return false;
    bound_ = worst_growth * std::max(1.0, best);
    correction_q_.resize(positions().rank());
    correction_u_.resize(rank_);
    ++partitions_;
    return true;
  }

  /// Growth of dependent coordinates and rates, at the last evaluate_jacobian().
  double growth() {
    const double of_positions = at_start_->growth(values_);
    if (!of_rates_) return of_positions;
    if (!of_rates_->factor(rate_values_)) return std::numeric_limits<double>::infinity();
    const double of_rates = of_rates_->growth(rate_values_);
    return of_rates <= of_positions ? of_positions : of_rates;
  }

  /// Finds q_ and u_ of the state from the step's start, whatever was evaluated before: a rejected
  /// step leaves no trace. A time before it, of a late stage, lies within the last step: if that
  /// one's end is too far, it is reached from that step's start. There, and for samples, the way
  /// may be taken in parts; a stage of the step under way that is too far asks for a shorter step.
  bool close(double t, const double* y, bool is_sample = false) {
    if (close_from(start_q_, *at_start_, t, y)) return true;
    const bool within_last = t < start_t_;
    if (!within_last && !is_sample) return false;
    const Eigen::VectorXd& first = within_last ? before_q_ : start_q_;
    const double first_t = within_last ? before_t_ : start_t_;
    Eigen::VectorXd from;
    for (const int parts : {1, 2, 4, 8, 16}) {
      from = first;
      for (int k = 1; k <= parts; ++k) {
        const double at = k == parts ? t : first_t + (t - first_t) * k / parts;
        q_ = from;
        e_->place(at, q_.data());
        evaluate_jacobian();
        if (!inside_->factor(values_) || !close_from(from, *inside_, at, y)) break;
        if (k == parts) return true;
        from = q_;
      }
    }
    return false;
  }
  bool close_from(const Eigen::VectorXd& q, SplitFactor& first, double t, const double* y) {
    q_ = q;
    for (int k = 0; k < freedom(); ++k) q_[independent_q(k)] = y[k];
    double before = 0;
    for (int k = 0;; ++k) {
      e_->place(t, q_.data());
      jacobian_.residual(*e_, q_, phi_);
      if (k > 0) {
        evaluate_jacobian();
        if (!inside_->factor(values_)) return too_long(t);
      }
      (k == 0 ? first : *inside_).solve(phi_, correction_q_);
      double length = 0;
      for (int i = 0; i < positions().rank(); ++i) {
        const int at = positions().dependent()[static_cast<std::size_t>(i)];
        q_[at] -= correction_q_[i];
        const double way = std::abs(correction_q_[i]) / sizes_.q[static_cast<std::size_t>(at)];
        if (!(way <= length)) length = way;
      }
      if (k > 0 && length <= last_correction) break;
      const bool shrinks = k == 0 || (k == 1 ? length < off_tangent : length < 0.5 * before);
      if (!std::isfinite(length) || !shrinks || k == most_corrections) return too_long(t);
      before = length;
    }
    e_->place(t, q_.data());
    SplitFactor* factor = inside_.get();  // factorised within last_correction of q_
    if (of_rates_) {
      e_->constraint_entries(rate_values_.data());
      factor = of_rates_.get();
      if (!factor->factor(rate_values_)) return too_long(t);
    }
    u_.setZero();
    for (int k = 0; k < freedom(); ++k) u_[independent_u(k)] = y[freedom() + k];
    for (int pass = 0; pass < 2; ++pass) {  // the second corrects for the factor's distance
      e_->move(u_.data());
      e_->velocities(rate_.data());
      factor->solve(rate_, correction_u_);
      for (int i = 0; i < rank_; ++i)
        u_[rates_->dependent()[static_cast<std::size_t>(i)]] -= correction_u_[i];
    }
    return u_.allFinite() || too_long(t);
  }
  bool too_long(double t) {
    return fail_at(t,
                   "the dependent coordinates cannot be followed: the step is too long, or the "
                   "loops are singular near");
  }

  /// Rates and accelerations at the start of a step; none where there are no accelerations.
  bool note_start(double t) {
    start_u_.resize(0);
    if (!accelerate(t)) return false;
    start_u_ = u_;
    start_udot_ = udot_;
    return true;
  }
  /// Whether u_ is off, by half its size, where accelerations lead from the step's start.
  bool turned_round(double t) const {
    if (freedom() > 0 || start_u_.size() == 0 || !(t > start_t_)) return false;
    double off = 0, size = 0;
    for (Eigen::Index i = 0; i < u_.size(); ++i) {
      const double led = start_u_[i] + (t - start_t_) * (start_udot_[i] + udot_[i]) / 2,
                   unit = sizes_.u[static_cast<std::size_t>(i)];
      off = std::max(off, std::abs(u_[i] - led) / unit);
      size = std::max({size, std::abs(u_[i]) / unit, std::abs(start_u_[i]) / unit});
    }
    return off > std::max(0.5 * size, least_turn);
  }

  bool accelerate(double t) {
    if (!add_bearing_friction(t, q_.data(), u_.data())) return false;
    if (!has_loops())
      return e_->open_accelerations(t, q_.data(), u_.data(), udot_.data()) ||
             fail_at(t, no_inertia(mechanism_, e_->singular_joint(), t, q_.data()));
    return solver_->acceleration(t, q_.data(), u_.data(), centre_.data(), 0, 0, udot_.data(),
                                 multipliers_.data()) ||
           solver_failed(t, q_.data(), "the solution of (3)");
  }

  /// Evaluates at the placed q_.
  void evaluate_jacobian() { jacobian_.evaluate(*e_, q_, rate_values_, values_); }

  CoordinateJacobian jacobian_;
  std::unique_ptr<CoordinateSplit> rates_, positions_;
  std::unique_ptr<SplitFactor> at_start_, inside_, of_rates_;
  int rank_ = -1;  ///< rank of Φ_q at the start
  double bound_ = worst_growth;
  long partitions_ = 0;
  Eigen::VectorXd start_q_, before_q_;  ///< at the step's start, and at the start of the one before
  double start_t_ = 0, before_t_ = 0;   ///< their times [s]
  Eigen::VectorXd start_u_, start_udot_;  ///< at the step's start, where nothing is independent
  Eigen::VectorXd q_, u_, qdot_, udot_;
  Eigen::VectorXd phi_, rate_, correction_q_, correction_u_;
  Eigen::VectorXd unit_;  ///< units of phi_
  std::vector<double> rate_values_, values_;
};

}  // namespace

FormEntry partitioned_entry() {
  return {.name = "partitioned",
          .kind = FormEntry::Kind::ode_one_step,
          .positions = true,
          .bearings = true,
          .colour = 2,
          .place = 10,
          .words = {.x = "u",
                    .solved = "(3) for u̇, with independent q and u for unknowns",
                    .constraints = {given(equation::positions, "dependent q"),
                                    given(equation::rates, "dependent u")}},
          .make = made<Partitioned>};
}

}  // namespace momenta
