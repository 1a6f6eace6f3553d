#include <momenta/core/scene/bearings_refused.h>
#include <momenta/dae/kkt/body_matrix.h>
#include <momenta/dae/kkt/kkt.h>
#include <momenta/dae/kkt/unheld_joints.h>
#include <momenta/dae/mechanism/tree_factor.h>
#include <momenta/dae/run/measure/rank.h>
#include <momenta/dae/run/state_values.h>

#include <cmath>
#include <limits>

namespace momenta {
namespace {

using Eigen::VectorXd;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

class StateEvaluator {
 public:
  StateEvaluator(const Mechanism& mechanism, const GivenState& given)
      : mechanism_(mechanism), given_(given), e_(mechanism.evaluation<double>()) {}

  StateValues run() {
    refuse_bearings(mechanism_.scene(), "an evaluation at one state");
    const int nv = mechanism_.nv(), m = mechanism_.m();
    for (VectorXd* x : {&s_.v, &s_.p, &s_.pdot, &s_.bias, &s_.free}) x->setZero(nv);
    for (VectorXd* x : {&s_.phi, &s_.phidot, &s_.sigma, &s_.lambda}) x->setZero(m);
    s_.qdot.setZero(mechanism_.nq());
    if (m > 0) {
      kkt_ = make_kkt(mechanism_);
      e_->place(given_.t, given_.q.data());
      solvable_ = nv == 0 || kkt_->factor(*e_, given_.t, given_.q.data(), fade_evaluation);
      s_.faded = kkt_->faded();
      if (!solvable_)
        leave_out(kkt_->singular_joint());
      else
        solvable_ = !only_rounding_holds();
    }
    if (m == 0 && nv > 0) solvable_ = !only_rounding_holds();
    rates_and_momenta();
    forces();
    free_acceleration();
    if (m > 0) constrained_acceleration();
    if (!mechanism_.scene().lagrangian)
      s_.centroidal = centroidal(mechanism_.tree(), mechanism_.scene(), given_.t, given_.q, s_.v);
    s_.reactions = reactions(mechanism_, given_.t, given_.q, s_.v, m > 0 ? s_.constrained : s_.free,
                             s_.lambda);
    if (s_.not_there.empty() && !all_finite()) refuse();
    // Unheld motions take no forces: reactions exist without their u̇.
    blank(m > 0 ? unheld_free_ : unheld_, s_.free);
    blank(unheld_, s_.constrained);
    if (nv + m <= dense_state_limit) dense_parts();
    return std::move(s_);
  }

 private:
  [[noreturn]] void refuse() const {
    throw SceneError(mechanism_.scene().where({}) +
                     "the mechanism cannot move at this state: its equations overflow; expected "
                     "smaller numbers");
  }

  bool all_finite() const {
    for (const VectorXd* x : {&s_.v, &s_.p, &s_.qdot, &s_.pdot, &s_.bias, &s_.free, &s_.constrained,
                              &s_.phi, &s_.phidot})
      if (!x->allFinite()) return false;
    return std::isfinite(s_.kinetic) && std::isfinite(s_.potential) &&
           std::isfinite(s_.hamiltonian);
  }

  /// Notes joints without inertia that leave (45), (7) or (3) without a solution; if there are
  /// none, loops hold the joint that a solver stopped at, `rate`.
  void leave_out(int rate) {
    unheld_ = unheld_joints(mechanism_, *e_, given_.t, given_.q.data(), true, rate);
    if (!unheld_.joints.empty())
      s_.not_there = mechanism_.scene().lagrangian
                         ? momenta::no_inertia(mechanism_, unheld_.joints.front().rate, given_.t,
                                               given_.q.data())
                         : in_words(mechanism_, unheld_);
    else if (rate < 0)
      refuse();
  }

  /// Whether solvers take rounding for inertia.
  bool only_rounding_holds() {
    const UnheldJoints unheld = unheld_by_rounding(mechanism_, *e_, given_.t, given_.q.data());
    if (unheld.joints.empty()) return false;
    leave_out(unheld.joints.front().rate);
    return true;
  }

  /// Finds v, p, σ; places and moves the evaluation there.
  void rates_and_momenta() {
    const double* q = given_.q.data();
    e_->place(given_.t, q);
    s_.v = given_.v;
    if (given_.of_momenta) {
      e_->move(given_.v.data());
      e_->momenta(nullptr, s_.p.data());
      for (int i = 0; i < mechanism_.nv(); ++i)
        if (given_.p_given[static_cast<std::size_t>(i)]) s_.p[i] = given_.p[i];
      solve_for_rates();
    }
    e_->place(given_.t, q);
    e_->move(s_.v.data());
    if (!given_.of_momenta) e_->momenta(nullptr, s_.p.data());
    e_->coordinate_rates(q, s_.v.data(), s_.qdot.data());
  }
  void solve_for_rates() {
    if (mechanism_.nv() == 0) return;
    if (mechanism_.m() == 0) {
      if (!solvable_ || !e_->open_momentum_rates(given_.t, given_.q.data(), s_.p.data(),
                                                 s_.v.data(), s_.pdot.data()))
        no_rates(e_->singular_joint());
      return;
    }
    // Prescribed parts of M u and Φ̇ go to the right.
    VectorXd r(mechanism_.nv()), g(mechanism_.m());
    e_->move(nullptr);
    e_->momenta(nullptr, r.data());
    e_->velocities(g.data());
    r = s_.p - r;
    g = -g;
    if (solvable_ && kkt_->solve(r.data(), g.data(), nullptr, s_.v.data(), s_.sigma.data())) return;
    if (solvable_) leave_out(-1);
    solvable_ = false;
    beside(unheld_, r, g, s_.v, s_.sigma);
    if (!unheld_.joints.empty()) no_rates(-1);
  }
  void no_rates(int rate) {
    if (s_.not_there.empty()) leave_out(rate);
    s_.v.setConstant(not_a_number);
    s_.sigma.setConstant(not_a_number);
  }

  /// Values of poses and velocities alone, and ṗ.
  void forces() {
    const double *q = given_.q.data(), *v = s_.v.data();
    const bool loops = mechanism_.m() > 0;
    if (loops) {
      e_->positions(s_.phi.data());
      e_->velocities(s_.phidot.data());
    }
    s_.kinetic = e_->kinetic();
    s_.potential = e_->potential(q);
    // A Lagrangian's p·v - L is Jacobi's T + V, whatever is linear in the rates.
    s_.hamiltonian =
        (mechanism_.scene().lagrangian ? s_.kinetic : s_.p.dot(s_.v) - s_.kinetic) + s_.potential;
    s_.markers.resize(6 * mechanism_.scene().markers.size());
    e_->markers(s_.markers.data());
    const double* sigma = loops ? s_.sigma.data() : nullptr;
    VectorXd again(mechanism_.nv());
    e_->momenta(sigma, again.data());
    e_->momentum_rates(q, v, sigma, 0, s_.pdot.data());
    s_.pdot += given_.tau;
    e_->joint_forces(q, v, nullptr, nullptr, s_.bias.data());
    s_.bias -= given_.tau;
  }

  void constrained_acceleration() {
    e_->place(given_.t, given_.q.data());
    e_->move(s_.v.data());
    VectorXd r(mechanism_.nv()), g(mechanism_.m());
    e_->joint_forces(given_.q.data(), s_.v.data(), nullptr, nullptr, r.data());
    e_->accelerations(g.data());
    r = given_.tau - r;
    g = -g;
    s_.constrained.setZero(mechanism_.nv());
    if (mechanism_.nv() == 0) return;
    if (solvable_ &&
        kkt_->solve(r.data(), g.data(), nullptr, s_.constrained.data(), s_.lambda.data()))
      return;
    if (solvable_) leave_out(-1);
    solvable_ = false;
    beside(unheld_, r, g, s_.constrained, s_.lambda);
  }

  /// x and λ where joints without inertia leave motions free; NaN without a solution.
  void beside(const UnheldJoints& unheld, const VectorXd& r, const VectorXd& g, VectorXd& x,
              VectorXd& lambda) {
    e_->place(given_.t, given_.q.data());
    if (solve_beside(unheld, mechanism_, *e_, r, g, x, lambda)) return;
    x.setConstant(mechanism_.nv(), not_a_number);
    lambda.setConstant(g.size(), not_a_number);
  }

  /// u̇ without loops, by the recursion; M⁻¹τ: rates of the momentum τ less those of zero momentum.
  void free_acceleration() {
    if (mechanism_.nv() == 0) return;
    if (mechanism_.m() > 0) return free_of_loops();
    const double *q = given_.q.data(), t = given_.t;
    if (!solvable_ || !e_->open_accelerations(t, q, s_.v.data(), s_.free.data()))
      return no_inertia(e_->singular_joint());
    if (given_.tau.isZero(0)) return;
    VectorXd with(mechanism_.nv()), without = VectorXd::Zero(mechanism_.nv());
    VectorXd unused(mechanism_.nv());
    if (!e_->open_momentum_rates(t, q, given_.tau.data(), with.data(), unused.data()))
      return no_inertia(e_->singular_joint());
    if (mechanism_.plan().drives) {
      const VectorXd zero = VectorXd::Zero(mechanism_.nv());
      e_->open_momentum_rates(t, q, zero.data(), without.data(), unused.data());
    }
    s_.free += with - without;
  }
  void no_inertia(int rate) {
    if (s_.not_there.empty()) leave_out(rate);
    VectorXd nothing;
    beside(unheld_, -s_.bias, {}, s_.free, nothing);
  }

  /// M = Lᵀ D L along the tree.
  void free_of_loops() {
    const auto& pattern = mechanism_.kkt_pattern();
    std::vector<double> values(pattern.mass.size());
    e_->place(given_.t, given_.q.data());
    e_->mass_entries(values.data());
    TreeFactor factor(pattern, mechanism_.nv());
    const int rate = factor.factor(values);
    unheld_free_ = rate >= 0
                       ? unheld_joints(mechanism_, *e_, given_.t, given_.q.data(), false, rate)
                       : unheld_by_rounding(mechanism_, *e_, given_.t, given_.q.data(), false);
    if (rate >= 0 || !unheld_free_.joints.empty()) {
      if (s_.not_there.empty())
        s_.not_there =
            without_loops_in_words(mechanism_, unheld_free_.joints) + ": no acceleration.free";
      VectorXd nothing;
      beside(unheld_free_, -s_.bias, {}, s_.free, nothing);
      return;
    }
    s_.free = -s_.bias;
    factor.inward(s_.free.data());
    for (int i = 0; i < mechanism_.nv(); ++i)
      s_.free[i] *= factor.inverse_pivots()[static_cast<std::size_t>(i)];
    factor.outward(s_.free.data());
  }

  void dense_parts() {
    s_.dense = true;
    e_->place(given_.t, given_.q.data());
    s_.mass = dense_mass(mechanism_, *e_);
    if (mechanism_.m() == 0 || mechanism_.nv() == 0) return;
    if (!dense_constraints(mechanism_, *e_).allFinite()) refuse();
    s_.loops = loop_rank(mechanism_, *e_);
    mark_undetermined(s_.reactions, mechanism_, given_.t, given_.q,
                      idle_forces(mechanism_, given_.t, given_.q));
  }

  const Mechanism& mechanism_;
  const GivenState& given_;
  std::unique_ptr<Evaluation<double>> e_;
  std::unique_ptr<Kkt> kkt_;
  bool solvable_ = true;               ///< whether kkt_ solves (7) and (3)
  UnheldJoints unheld_, unheld_free_;  ///< with the loops, and without them
  StateValues s_;
};

}  // namespace

StateValues evaluate_state(const Mechanism& mechanism, const GivenState& given) {
  return StateEvaluator(mechanism, given).run();
}

}  // namespace momenta
