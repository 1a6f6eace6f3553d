#include <momenta/core/text/quoting.h>
#include <momenta/dae/gradient/drive_slopes.h>
#include <momenta/dae/gradient/stage_matrix.h>
#include <momenta/dae/gradient/start_adjoint.h>
#include <momenta/dae/kkt/least_norm.h>
#include <momenta/dae/kkt/loop_units.h>
#include <momenta/dae/topology/assembly/assembly.h>
#include <momenta/dae/topology/assembly/scaled_loops.h>

#include <algorithm>
#include <cmath>

namespace momenta {

namespace {

using Eigen::VectorXd;

/// The start of this guess, loops closed to rounding.
Start closed_start(const Mechanism& mechanism, const VectorXd& q, const VectorXd& u) {
  Assembly a = assemble(mechanism, 0, q, u);
  if (mechanism.m() == 0 || a.start.residue.size() > 0) return a.start;
  ScaledLoops loops(mechanism);
  loops.hold_joints();
  LeastNorm steps(loops.pattern(), mechanism.m(), mechanism.nv());
  VectorXd pose = a.start.q;
  for (int pass = 0; pass < 2; ++pass) {
    const VectorXd gap = loops.gap(0, pose);
    steps.factor(loops.jacobian());
    pose = loops.moved(pose, -steps.solve(gap));
  }
  return assemble(mechanism, 0, pose, u).start;
}

}  // namespace

StartTangents start_tangents(const Mechanism& mechanism, const std::string& form,
                             const FormOptions& options, const std::vector<RunVariable>& variables,
                             const std::vector<OtherParameter>& others) {
  StartTangents tangents;
  tangents.of_state.setZero(mechanism.nq() + mechanism.nv(),
                            static_cast<Eigen::Index>(variables.size()));
  for (std::size_t j = 0; j < variables.size(); ++j) {
    const RunVariable& v = variables[j];
    const OtherParameter& other = others[j];
    if (other.starts_at_once) continue;
    double size = 1;
    const double widest = other.by_mechanisms ? other.near->h() : other.h;
    const sixth_order::Slope slope = sixth_order::slope_of(
        widest, sixth_order::iterated, [&](std::size_t k, double h) -> VectorXd {
          const Mechanism& made = other.by_mechanisms ? other.near->mechanism(k, h) : mechanism;
          VectorXd q = made.tree().q0, u = made.tree().u0;
          const double change = sixth_order::k_of(k) * h;
          if (v.kind == RunVariable::Kind::position) q[v.place] += change;
          if (v.kind == RunVariable::Kind::rate) u[v.place] += change;
          const Start start = closed_start(made, q, u);
          const std::vector<double> y = make_form(form, made, options, start)->initial(start);
          const Eigen::Map<const VectorXd> state(y.data(), tangents.of_state.rows());
          size = std::max(size, state.cwiseAbs().maxCoeff());
          return state;
        });
    tangents.of_state.col(static_cast<Eigen::Index>(j)) = slope.by;
    // For a smooth start the formulas differ by h⁴, else by about 1/h.
    if (!(slope.apart <= 1e-3 * (size / v.size + slope.by.cwiseAbs().maxCoeff())))
      tangents.broken.push_back("the start changes too abruptly with " +
                                reading::in_quotes(v.name) + " for a derivative: within " +
                                reading::digits(3 * widest) +
                                " of its value the scene is assembled otherwise");
  }
  return tangents;
}

Eigen::MatrixXd any_start_change(const Mechanism& mechanism, const Start& start, bool momenta) {
  const int nq = mechanism.nq(), nv = mechanism.nv(), m = mechanism.m();
  const auto e = mechanism.evaluation<double>();
  e->place(start.t, start.q.data());
  StageMatrix matrix(mechanism);
  matrix.factor(*e);
  using Eigen::MatrixXd, Eigen::VectorXd;
  const VectorXd units = LoopUnits(mechanism).rates;
  VectorXd change(nv), right = VectorXd::Zero(nv + m), still(m), momentum(nv), resting(nv);
  for (int i = 0; i < nv; ++i) change[i] = units[i] * (i % 3 == 1 ? -1 : 1);
  e->move(nullptr);
  if (m > 0) e->velocities(still.data());
  e->momenta(nullptr, resting.data());
  e->move(change.data());
  if (m > 0) e->velocities(right.data() + nv);
  right.tail(m) = still - right.tail(m);
  change += matrix.solve(right).col(0).head(nv);
  MatrixXd dy(nq + nv, 1);
  e->coordinate_rates(start.q.data(), change.data(), dy.data());
  e->move(change.data());
  e->momenta(nullptr, momentum.data());
  dy.bottomRows(nv) = momenta ? momentum - resting : change;
  return dy;
}

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The terms of (10): D⁻¹w, D⁻¹y (m), C v, C x (nv).
struct StartAdjoint::Pulled {
  VectorXd w, y, v, x;
};

StartAdjoint::StartAdjoint(const Mechanism& mechanism, Start start)
    : mechanism_(mechanism),
      start_(std::move(start)),
      nv_(mechanism.nv()),
      m_(mechanism.m()),
      loops_(mechanism),
      numbers_(make_number_slopes(mechanism, false)),
      dual_(mechanism.evaluation<Dual8>()),
      kinetic_(make_kinetic_rates(mechanism)),
      driven_(mechanism.plan().drives) {
  for (const auto& body : mechanism.tree().bodies)
    for (int i = 0; i < body.nv; ++i) slides_.push_back(body.is_length(i));
  loops_.hold_joints();
  follows_ = m_ == 0 || (start_.residue.size() == 0 && follow());
  placed_ = follows_ && numbers_->of_places();
  if (placed_) numbers_ = make_number_slopes(mechanism, true);
}

/// Whether Newton's steps, all at poses with independent rows, lead to the start.
bool StartAdjoint::follow() {
  constexpr double same = 1e-9;  // [rad or lengths]: between two ways of closing to rounding
  LeastNorm steps(loops_.pattern(), mechanism_.m(), mechanism_.nv());
  Closing closing(loops_, steps, 0);
  const Closing::Pose pose = closing.close(mechanism_.tree().q0);
  if (!pose.is_closed || pose.is_least || !closing.newton_steps() ||
      !(loops_.apart(pose.q, start_.q) <= same))
    return false;
  std::vector<Closing::NewtonStep> all = *closing.newton_steps();
  // One more step closes the rest, for derivatives too.
  all.push_back({start_.q, VectorXd::Zero(nv_), 1, false});
  for (Closing::NewtonStep& taken : all) {
    loops_.gap(0, taken.q);
    const std::vector<double> entries = loops_.jacobian();
    if (steps.judge(entries, Judged::dependence).rank != mechanism_.m()) return false;
    Step& step = steps_.emplace_back();
    static_cast<Closing::NewtonStep&>(step) = std::move(taken);
    step.transposed.setZero(nv_, m_);
    for (std::size_t k = 0; k < entries.size(); ++k)
      step.transposed(loops_.pattern()[k].column, loops_.pattern()[k].row) += entries[k];
    step.factors.compute_full_rank(step.transposed);
  }
  return true;
}

StartAdjoint::Pulled StartAdjoint::pull(const Step& at, const VectorXd& x, VectorXd x_bar) {
  const VectorXd& unit = loops_.units().rates;
  for (Index i = 0; i < nv_; ++i)
    if (!loops_.columns[static_cast<std::size_t>(i)]) x_bar[i] = 0;
  const VectorXd w = at.factors.solve(x_bar), y = at.factors.solve(x), of_rows = at.transposed * w,
                 v = x_bar - of_rows;
  for (Index i = 0; i < nv_; ++i)
    if (slides_[static_cast<std::size_t>(i)])
      by_length_ += (x[i] * v[i] - of_rows[i] * x[i]) / unit[i];
  const VectorXd& row = loops_.units().equations;
  return {w.cwiseQuotient(row), y.cwiseQuotient(row), v.cwiseProduct(unit), x.cwiseProduct(unit)};
}

/// D_along(Φ_qᵀσ) at q.
VectorXd StartAdjoint::turned(const VectorXd& q, const VectorXd& along, const VectorXd& sigma) {
  x_.resize(static_cast<std::size_t>(nv_ + m_));
  out_.resize(static_cast<std::size_t>(nv_));
  for (Index i = 0; i < nv_; ++i) {
    Dual8& x = x_[static_cast<std::size_t>(i)];
    x = Dual8(q[i]);
    x.b[0] = along[i];
  }
  for (Index i = 0; i < m_; ++i) x_[static_cast<std::size_t>(nv_ + i)] = Dual8(sigma[i]);
  dual_->place(0, x_.data());
  dual_->constraint_forces(x_.data() + nv_, out_.data());
  VectorXd d(nv_);
  for (Index i = 0; i < nv_; ++i) d[i] = out_[static_cast<std::size_t>(i)].b[0];
  return d;
}

/// Back through u = u₀ + C x at the pose.
void StartAdjoint::through_rates(VectorXd& of_q, VectorXd& of_u) {
  const VectorXd &unit = loops_.units().rates, &q = start_.q, &u = start_.u;
  const VectorXd x = (u - mechanism_.tree().u0).cwiseQuotient(unit);
  loops_.gap(0, q);
  for (Index i = 0; i < nv_; ++i)
    if (slides_[static_cast<std::size_t>(i)]) by_length_ += of_u[i] * x[i];
  const Pulled by = pull(steps_.back(), x, of_u.cwiseProduct(unit));
  const VectorXd w = -by.w;
  if (placed_)
    numbers_->add_loop_rates(1,
                             {0, q.data(), u.data(), by.y.data(), nullptr, by.v.data(), w.data()});
  of_q += turned(q, by.v, by.y);
  // ∂(wᵀΦ̇)/∂q = Φ̇_qᵀw, drives included: by ṗ, which is linear in w.
  x_.resize(static_cast<std::size_t>(2 * nv_ + m_));
  out_.resize(static_cast<std::size_t>(nv_));
  for (Index i = 0; i < nv_; ++i) {
    x_[static_cast<std::size_t>(i)] = Dual8(q[i]);
    x_[static_cast<std::size_t>(nv_ + i)] = Dual8(u[i]);
  }
  for (Index i = 0; i < m_; ++i) {
    Dual8& sigma = x_[static_cast<std::size_t>(2 * nv_ + i)];
    sigma = Dual8(0.0);
    sigma.b[0] = w[i];
  }
  const Dual8 *at_q = x_.data(), *at_u = at_q + nv_, *sigma = at_u + nv_;
  dual_->place(0, at_q);
  dual_->move(at_u);
  dual_->momenta(sigma, out_.data());
  dual_->momentum_rates(at_q, at_u, sigma, 0, out_.data());
  for (Index i = 0; i < nv_; ++i) of_q[i] += out_[static_cast<std::size_t>(i)].b[0];
  VectorXd force(nv_);
  loops_.evaluation().constraint_forces(w.data(), force.data());
  of_u += force;
}

/// Back through q + C s x.
void StartAdjoint::through_step(const Step& step, VectorXd& of_q) {
  const VectorXd &unit = loops_.units().rates, &x = step.whole;
  loops_.gap(0, step.q);
  const VectorXd of_taken = of_q.cwiseProduct(unit);
  Index longest = 0;
  const double length = step.is_cut ? x.cwiseAbs().maxCoeff(&longest) : 1, s = step.part / length;
  for (Index i = 0; i < nv_; ++i)
    if (slides_[static_cast<std::size_t>(i)]) by_length_ += of_q[i] * s * x[i];
  VectorXd x_bar = s * of_taken;
  if (step.is_cut) x_bar[longest] -= s / x[longest] * of_taken.dot(x);
  const Pulled by = pull(step, x, x_bar);
  const VectorXd w = -by.w;
  if (placed_) {
    numbers_->add_loops(1, 0, step.q.data(), w.data());
    numbers_->add_loop_rates(
        1, {0, step.q.data(), by.x.data(), by.y.data(), nullptr, by.v.data(), w.data()});
    if (driven_)  // a step is no motion: no drives in wᵀΦ̇
      numbers_->add_loop_rates(-1,
                               {0, step.q.data(), nullptr, nullptr, nullptr, nullptr, w.data()});
  }
  VectorXd force(nv_);
  loops_.evaluation().constraint_forces(w.data(), force.data());
  of_q += force + turned(step.q, by.x, w) + turned(step.q, by.v, by.y);
}

/// Back through p = M u.
void StartAdjoint::through_momenta(const VectorXd& of_p, VectorXd& of_q, VectorXd& of_u) {
  const VectorXd &q = start_.q, &u = start_.u;
  numbers_->add(1, {0, q.data(), u.data(), nullptr, nullptr, of_p.data(), nullptr});
  VectorXd change(nv_);
  kinetic_->along(0, q.data(), u.data(), of_p.data(), change.data(), of_u.data());
  of_q += change;
}

VectorXd StartAdjoint::back(const VectorXd& lambda, bool of_momenta) {
  slopes_.setZero(numbers_->size());
  by_length_ = 0;
  VectorXd of_q = lambda.head(nv_), of_u = lambda.tail(nv_);
  if (of_momenta) through_momenta(lambda.tail(nv_), of_q, of_u);
  if (follows_ && m_ > 0) {
    through_rates(of_q, of_u);
    for (std::size_t i = steps_.size(); i-- > 0;) through_step(steps_[i], of_q);
  }
  numbers_->finish(slopes_);
  if (!follows_) return slopes_;
  slopes_.segment(numbers_->guess(), nv_) += of_q;
  slopes_.segment(numbers_->guess() + nv_, nv_) += of_u;
  slopes_[slopes_.size() - 1] += by_length_;
  return slopes_;
}

MatrixXd StartAdjoint::rows(bool of_momenta) {
  MatrixXd all(2 * nv_, numbers_->size());
  for (Index i = 0; i < all.rows(); ++i)
    all.row(i) = back(VectorXd::Unit(all.rows(), i), of_momenta).transpose();
  return all;
}

VectorXd StartAdjoint::by(const RunVariable& variable, const OtherParameter& other,
                          const MatrixXd& slopes) const {
  if (variable.kind == RunVariable::Kind::parameter)
    return slopes * (other.numbers.size() > 0 ? other.numbers : other.at_start) +
           by_laws(*numbers_, other, start_.t, slopes);
  const bool is_rate = variable.kind == RunVariable::Kind::rate;
  return slopes.col(numbers_->guess() + variable.place + (is_rate ? nv_ : 0));
}

}  // namespace momenta
