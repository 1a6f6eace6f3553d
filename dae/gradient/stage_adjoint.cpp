#include <momenta/dae/gradient/drive_slopes.h>
#include <momenta/dae/gradient/stage_adjoint.h>

#include <algorithm>

namespace momenta {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// L*_q less κ Φ_qᵀσ: ṗ without the forces that are differentiated apart.
struct PotentialRates : MomentumAndRateRows {
  bool forces = false, at_points = false;
  template <class E, class S>
  void operator()(E& e, const S* x, S* out) const {
    e.place(t, x);
    e.move(u(x));
    e.momenta(sigma(x), out);
    e.momentum_rates(x, u(x), sigma(x), leak, out);
    if (!forces) return;
    std::vector<S> tau(static_cast<std::size_t>(nv));
    e.applied_forces(t, x, u(x), tau.data(), at_points);
    for (Index i = 0; i < nv; ++i) out[i] -= tau[static_cast<std::size_t>(i)];
  }
};

/// Φ_qᵀσ
struct LoopForces : RowPlaces {
  template <class E, class S>
  void operator()(E& e, const S* x, S* out) const {
    e.place(t, x);
    e.constraint_forces(sigma(x), out);
  }
};

/// r1, r2 and Φ_qᵀσ.
struct MomentumAndLoopRows : MomentumRows {
  template <class E, class S>
  void operator()(E& e, const S* x, S* out) const {
    MomentumRows::operator()(e, x, out);
    e.constraint_forces(sigma(x), out + nv + m);
  }
};

}  // namespace

StageAdjoint::StageAdjoint(const Mechanism& mechanism, const OdeForm& form,
                           const std::vector<OtherParameter>& others)
    : mechanism_(mechanism),
      others_(others),
      e_(mechanism.evaluation<double>()),
      dual_(mechanism.evaluation<Dual8>()),
      matrix_(mechanism),
      forces_(mechanism),
      corrections_(mechanism, others, forces_),
      losses_(make_line_losses(mechanism)),
      gauge_(form.gauge()),
      rows_{{RowPlaces(mechanism)}},
      nv_(mechanism.nv()),
      m_(mechanism.m()),
      driven_(mechanism.plan().drives) {
  rows_.beta = form.beta();
  rows_.leak = gauge_.kind == Gauge::Kind::leak ? gauge_.kappa : 0;
  if (rows_.leak == 0 && rows_.beta == 0) swept_ = make_swept_tangent(mechanism);
  for (auto* x : {&by_q_, &by_u_, &along_q_, &along_p_, &still_, &rates_}) x->setZero(nv_);
  if (swept_ && m_ > 0) kinetic_ = make_kinetic_rates(mechanism);
  any_rows_ = std::any_of(others.begin(), others.end(),
                          [](const OtherParameter& other) { return other.by_rows(); });
  if (at_once() == 0) return;
  placed_ = std::any_of(others.begin(), others.end(),
                        [](const OtherParameter& other) { return other.of_places; });
  moves_drives_ = std::any_of(others.begin(), others.end(),
                              [](const OtherParameter& other) { return other.drives > 0; });
  numbers_ = make_number_slopes(mechanism, placed_);
  slopes_.setZero(numbers_->size());
}

Index StageAdjoint::at_once() const {
  return std::count_if(others_.begin(), others_.end(),
                       [](const OtherParameter& other) { return other.numbers.size() > 0; });
}

/// Adds slopes by f and ḟ of drives, all at t.
void StageAdjoint::take_drives(double t, VectorXd& by_parameters) {
  if (!moves_drives_) return;
  numbers_->finish(slopes_);
  add_drive_slopes(*numbers_, others_, t, slopes_, by_parameters);
  slopes_.segment(numbers_->drives(), numbers_->guess() - numbers_->drives()).setZero();
}

void StageAdjoint::finish(VectorXd& by_parameters) {
  if (numbers_) numbers_->finish(slopes_);
  for (std::size_t j = 0; j < others_.size(); ++j) {
    const OtherParameter& other = others_[j];
    if (other.numbers.size() > 0)
      by_parameters[static_cast<Index>(j)] += other.numbers.dot(slopes_);
  }
}

/// D rows along dx.
template <class Rows>
VectorXd StageAdjoint::along(const Rows& rows, const VectorXd& x, const VectorXd& dx, Index size) {
  x_.resize(static_cast<std::size_t>(x.size()));
  out_.resize(static_cast<std::size_t>(size));
  for (std::size_t i = 0; i < x_.size(); ++i) {
    x_[i] = Dual8(x[static_cast<Index>(i)]);
    x_[i].b[0] = dx[static_cast<Index>(i)];
  }
  rows(static_cast<EquationRows<Dual8>&>(*dual_), x_.data(), out_.data());
  VectorXd d(size);
  for (std::size_t i = 0; i < out_.size(); ++i) d[static_cast<Index>(i)] = out_[i].b[0];
  return d;
}

/// sum_j += weights · ∂rows/∂θ_j
template <class Rows>
void StageAdjoint::add_by_parameters(const Rows& rows, const VectorXd& x, const VectorXd& weights,
                                     VectorXd& sum) {
  momenta::add_by_parameters(others_, rows, x, weights, sum);
}

void StageAdjoint::add_by_rows(const AdjointState& at, const VectorXd& weights, bool of_gauge,
                               VectorXd& sum) {
  rows_.t = at.t;
  const VectorXd x = joined(at.q, at.u, at.sigma);
  if (of_gauge)
    add_by_parameters(MomentumAndLoopRows{rows_}, x, weights, sum);
  else
    add_by_parameters(rows_, x, weights, sum);
}

bool StageAdjoint::factor(double t, const VectorXd& q) {
  rows_.t = t;
  e_->place(t, q.data());
  matrix_.factor(*e_);
  return !matrix_.singular();
}

/// Φ_q u, at the pose of the last factor().
VectorXd StageAdjoint::loop_rates(const VectorXd& u) {
  VectorXd moved(m_), still = VectorXd::Zero(m_);
  if (driven_) {
    e_->move(nullptr);
    e_->velocities(still.data());
  }
  e_->move(u.data());
  e_->velocities(moved.data());
  return moved - still;
}

bool StageAdjoint::rates(const AdjointState& at, const VectorXd& w, VectorXd& product,
                         VectorXd& by_parameters) {
  if (swept_ && sweep(at, w, product, by_parameters)) return true;
  if (!solved(at) || !factor(at.t, at.q)) return false;
  const VectorXd b = w.tail(nv_), x = joined(at.q, at.u, at.sigma);
  VectorXd right = -along(static_cast<const MomentumRows&>(rows_), x,
                          joined(-b, VectorXd::Zero(nv_), VectorXd::Zero(m_)), nv_ + m_);
  right.head(nv_) += w.head(nv_);
  VectorXd by_q = VectorXd::Zero(nv_);
  if (forces_.any()) {
    VectorXd by_u(nv_);
    forces_.transposed(at.t, at.q, at.u, b, by_q, by_u);
    right.head(nv_) += by_u;
  }
  const double fed_back = rows_.leak + rows_.beta;
  if (m_ > 0 && fed_back != 0) right.tail(m_) -= fed_back * loop_rates(b);
  const VectorXd mu = matrix_.solve(right);
  const PotentialRates rates{rows_, forces_.any(), forces_.at_points()};
  product.resize(2 * nv_);
  product.head(nv_) = by_q - along(rates, x, joined(-b, mu.head(nv_), mu.tail(m_)), nv_);
  if (m_ > 0 && fed_back != 0) {
    const VectorXd impulses = mu.tail(m_);
    VectorXd force(nv_);
    e_->constraint_forces(impulses.data(), force.data());
    product.head(nv_) -= fed_back * force;
  }
  product.tail(nv_) = mu.head(nv_);
  if (numbers_) {
    along_q_ = -b;
    const double* dsigma = mu.data() + nv_;
    numbers_->add(
        -1, {at.t, at.q.data(), at.u.data(), at.sigma.data(), along_q_.data(), mu.data(), dsigma});
    if (placed_ && rows_.beta != 0) numbers_->add_loops(-rows_.beta, at.t, at.q.data(), dsigma);
    if (placed_ && rows_.leak != 0)  // −κ bᵀΦ_qᵀσ of ṗ
      numbers_->add_loop_rates(
          -rows_.leak, {at.t, at.q.data(), nullptr, at.sigma.data(), nullptr, b.data(), nullptr});
    take_drives(at.t, by_parameters);
  }
  add_by_parameters(rows_, x, joined(-mu.head(nv_), -mu.tail(m_), b), by_parameters);
  return true;
}

/// Slopes of a gauge by numbers: c (D_μ L*_θ + β (μ_σᵀΦ)_θ − D_λp (σᵀΦ̇)_θ).
void StageAdjoint::add_gauge(double c, const NumberSweep::Motion& along_mu, const double* of_p,
                             VectorXd& by_parameters) {
  numbers_->add(c, along_mu);
  if (!placed_) return;
  NumberSweep::Motion along_p = along_mu;
  along_p.du = of_p;
  along_p.dsigma = nullptr;
  numbers_->add_loop_rates(-c, along_p);
  if (rows_.beta != 0) numbers_->add_loops(c * rows_.beta, along_mu.t, along_mu.q, along_mu.dsigma);
  take_drives(along_mu.t, by_parameters);
}

bool StageAdjoint::gauge(const AdjointState& at, VectorXd& lambda, VectorXd& by_parameters) {
  if (m_ == 0) return true;
  const double c = gauge_.kind == Gauge::Kind::flip ? 2 : gauge_.kind == Gauge::Kind::reset ? 1 : 0;
  if (c == 0) return true;
  if (swept_ && sweep_gauge(at, c, lambda, by_parameters)) return true;
  if (!solved(at) || !factor(at.t, at.q)) return false;
  const VectorXd of_p = lambda.tail(nv_), x = joined(at.q, at.u, at.sigma);
  VectorXd right = VectorXd::Zero(nv_ + m_);
  right.tail(m_) = loop_rates(of_p);
  const VectorXd mu = matrix_.solve(right);
  LoopForces loops{rows_};
  PotentialRates rates{rows_, forces_.any(), forces_.at_points()};
  rates.leak = 0;
  const VectorXd impulses = mu.tail(m_), none = VectorXd::Zero(nv_ + m_);
  VectorXd by_q = along(loops, x, joined(of_p, none, VectorXd(0)), nv_) -
                  along(rates, x, joined(VectorXd::Zero(nv_), mu, VectorXd(0)), nv_);
  if (rows_.beta != 0) {
    VectorXd force(nv_);
    e_->constraint_forces(impulses.data(), force.data());
    by_q -= rows_.beta * force;
  }
  lambda.head(nv_) -= c * by_q;
  lambda.tail(nv_) -= c * mu.head(nv_);
  if (numbers_)
    add_gauge(
        c, {at.t, at.q.data(), at.u.data(), at.sigma.data(), nullptr, mu.data(), mu.data() + nv_},
        of_p.data(), by_parameters);
  add_by_parameters(MomentumAndLoopRows{rows_}, x, joined(c * mu, -c * of_p, VectorXd(0)),
                    by_parameters);
  return true;
}

bool StageAdjoint::correction(double t, const VectorXd& q, VectorXd& lambda,
                              VectorXd& by_parameters) {
  if (!corrections_.positions(t, q, false, {numbers_.get(), placed_}, lambda, by_parameters))
    return false;
  take_drives(t, by_parameters);
  return true;
}

}  // namespace momenta
