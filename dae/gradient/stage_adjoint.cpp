#include <momenta/dae/gradient/drive_slopes.h>
#include <momenta/dae/gradient/stage_adjoint.h>

#include <algorithm>

namespace momenta {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// L*_q less κ Φ_qᵀσ: ṗ without the forces that are differentiated by themselves.
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
  any_rows_ = std::any_of(others.begin(), others.end(), [](const OtherParameter& other) {
    return !other.evaluations.empty() && other.numbers.size() == 0;
  });
  if (at_once() == 0) return;
  placed_ = std::any_of(others.begin(), others.end(),
                        [](const OtherParameter& other) { return other.of_places; });
  moves_drives_ = std::any_of(others.begin(), others.end(),
                              [](const OtherParameter& other) { return !other.laws.empty(); });
  numbers_ = make_number_slopes(mechanism, placed_);
  slopes_.setZero(numbers_->size());
}

Index StageAdjoint::at_once() const {
  return std::count_if(others_.begin(), others_.end(),
                       [](const OtherParameter& other) { return other.numbers.size() > 0; });
}

/// What numbers have so far by f and ḟ of drives, which are those at t.
void StageAdjoint::take_drives(double t, VectorXd& by_parameters) {
  if (!moves_drives_) return;
  add_drive_slopes(*numbers_, others_, t, slopes_, by_parameters);
  slopes_.segment(numbers_->drives(), numbers_->guess() - numbers_->drives()).setZero();
}

void StageAdjoint::finish(VectorXd& by_parameters) const {
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
  plain_.resize(weights.size());
  for (std::size_t j = 0; j < others_.size(); ++j) {
    const OtherParameter& other = others_[j];
    if (other.numbers.size() > 0) continue;
    for (std::size_t k = 0; k < other.evaluations.size(); ++k) {
      rows(static_cast<EquationRows<double>&>(*other.evaluations[k]), x.data(), plain_.data());
      sum[static_cast<Index>(j)] += sixth_order::points[k].weight / other.h * weights.dot(plain_);
    }
  }
}

bool StageAdjoint::factor(double t, const VectorXd& q) {
  rows_.t = t;
  e_->place(t, q.data());
  matrix_.factor(*e_);
  return !matrix_.singular();
}

/// Φ_q u, at the place of the last factor().
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

/// By the sweeps: no matrix, and nothing is allocated unless a θ is taken from rows.
bool StageAdjoint::sweep(const AdjointState& at, const VectorXd& w, VectorXd& product,
                         VectorXd& by_parameters) {
  const auto a = w.head(nv_), b = w.tail(nv_);
  along_q_ = -b;
  along_p_ = a;
  if (forces_.any()) {
    still_ = b;
    forces_.transposed(at.t, at.q, at.u, still_, by_q_, by_u_);
    along_p_ += by_u_;
  }
  SweptTangent& f = *swept_;
  if (!f(at.t, at.q.data(), at.p.data(), along_q_.data(), along_p_.data())) return false;
  const Eigen::Map<const VectorXd> du(f.du.data(), nv_), dpdot(f.dpdot.data(), nv_);
  product.resize(2 * nv_);
  product.head(nv_) = -dpdot;
  product.tail(nv_) = du;
  if (forces_.any()) {
    // ṗ has Q in it: its derivative along the direction goes, its transposed product comes.
    still_ = du;
    forces_.along(at.t, at.q, at.u, along_q_, still_, by_u_);
    product.head(nv_) += by_q_ + by_u_;
  }
  if (numbers_) {
    numbers_->add(-1,
                  {at.t, at.q.data(), f.u.data(), f.sigma.data(), along_q_.data(), f.du.data(),
                   f.dsigma.data()},
                  slopes_);
    take_drives(at.t, by_parameters);
  }
  if (!any_rows_) return true;
  rows_.t = at.t;
  VectorXd weights(2 * nv_ + m_);
  weights << -du, -Eigen::Map<const VectorXd>(f.dsigma.data(), m_), b;
  add_by_parameters(rows_, joined(at.q, at.u, at.sigma), weights, by_parameters);
  return true;
}

bool StageAdjoint::rates(const AdjointState& at, const VectorXd& w, VectorXd& product,
                         VectorXd& by_parameters) {
  if (swept_ && sweep(at, w, product, by_parameters)) return true;
  if (at.u.size() == 0 || !factor(at.t, at.q)) return false;
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
        -1, {at.t, at.q.data(), at.u.data(), at.sigma.data(), along_q_.data(), mu.data(), dsigma},
        slopes_);
    if (placed_ && rows_.beta != 0)
      numbers_->add_loops(-rows_.beta, at.t, at.q.data(), dsigma, slopes_);
    if (placed_ && rows_.leak != 0)  // −κ bᵀΦ_qᵀσ of ṗ
      numbers_->add_loop_rates(
          -rows_.leak, {at.t, at.q.data(), nullptr, at.sigma.data(), nullptr, b.data(), nullptr},
          slopes_);
    take_drives(at.t, by_parameters);
  }
  add_by_parameters(rows_, x, joined(-mu.head(nv_), -mu.tail(m_), b), by_parameters);
  return true;
}

/// What numbers have of a gauge: c (D_μ L*_θ + β (μ_σᵀΦ)_θ − D_λp (σᵀΦ̇)_θ).
void StageAdjoint::add_gauge(double c, const NumberSweep::Motion& along_mu, const double* of_p,
                             VectorXd& by_parameters) {
  numbers_->add(c, along_mu, slopes_);
  if (!placed_) return;
  NumberSweep::Motion along_p = along_mu;
  along_p.du = of_p;
  along_p.dsigma = nullptr;
  numbers_->add_loop_rates(-c, along_p, slopes_);
  if (rows_.beta != 0)
    numbers_->add_loops(c * rows_.beta, along_mu.t, along_mu.q, along_mu.dsigma, slopes_);
  take_drives(along_mu.t, by_parameters);
}

/// p' = c M u − (c − 1) p by the sweeps.
bool StageAdjoint::sweep_gauge(const AdjointState& at, double c, VectorXd& lambda,
                               VectorXd& by_parameters) {
  const auto of_p = lambda.tail(nv_);
  along_q_ = of_p;
  e_->place(at.t, at.q.data());
  e_->move(along_q_.data());
  e_->momenta(nullptr, along_p_.data());
  if (driven_) {
    e_->move(nullptr);
    e_->momenta(nullptr, still_.data());
    along_p_ -= still_;
  }
  still_.setZero();
  SweptTangent& f = *swept_;
  if (!f(at.t, at.q.data(), at.p.data(), still_.data(), along_p_.data())) return false;
  const Eigen::Map<const VectorXd> u(f.u.data(), nv_), du(f.du.data(), nv_),
      dpdot(f.dpdot.data(), nv_);
  kinetic_->along(at.t, at.q.data(), u.data(), along_q_.data(), rates_.data());
  rates_ -= dpdot;
  if (forces_.any()) {
    along_p_ = du;
    forces_.along(at.t, at.q, at.u, still_, along_p_, by_u_);
    rates_ += by_u_;
  }
  along_p_ = of_p - du;
  if (numbers_) {
    for (double& x : f.dsigma) x = -x;
    add_gauge(
        c,
        {at.t, at.q.data(), f.u.data(), f.sigma.data(), nullptr, along_p_.data(), f.dsigma.data()},
        of_p.data(), by_parameters);
    for (double& x : f.dsigma) x = -x;
  }
  if (any_rows_) {
    rows_.t = at.t;
    VectorXd weights(2 * nv_ + m_);
    weights << c * along_p_, -c * Eigen::Map<const VectorXd>(f.dsigma.data(), m_), -c * of_p;
    add_by_parameters(MomentumAndLoopRows{rows_}, joined(at.q, at.u, at.sigma), weights,
                      by_parameters);
  }
  lambda.head(nv_) += c * rates_;
  lambda.tail(nv_) -= c * along_p_;
  return true;
}

bool StageAdjoint::gauge(const AdjointState& at, VectorXd& lambda, VectorXd& by_parameters) {
  if (m_ == 0) return true;
  const double c = gauge_.kind == Gauge::Kind::flip ? 2 : gauge_.kind == Gauge::Kind::reset ? 1 : 0;
  if (c == 0) return true;
  if (swept_ && sweep_gauge(at, c, lambda, by_parameters)) return true;
  if (at.u.size() == 0 || !factor(at.t, at.q)) return false;
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
  if (!factor(t, q)) return false;
  VectorXd right = VectorXd::Zero(nv_ + m_);
  e_->positions(right.data() + nv_);
  const VectorXd found = -matrix_.solve(right);
  right.setZero();
  right.head(nv_) = lambda.head(nv_);
  const VectorXd mu = matrix_.solve(right), impulses = mu.tail(m_);
  PotentialRates rates{rows_, forces_.any(), forces_.at_points()};
  rates.leak = 0;
  const VectorXd x = joined(q, found, VectorXd(0)),
                 dx = joined(VectorXd::Zero(nv_), mu, VectorXd(0));
  VectorXd by_q = along(rates, x, dx, nv_);
  if (driven_) {
    const VectorXd still = joined(q, VectorXd::Zero(nv_ + m_), VectorXd(0));
    by_q -= along(rates, still, dx, nv_);
  }
  VectorXd force(nv_);
  e_->constraint_forces(impulses.data(), force.data());
  lambda.head(nv_) -= by_q + force;
  still_.setZero();
  if (numbers_) {
    const double *du = mu.data(), *dsigma = mu.data() + nv_;
    numbers_->add(-1, {t, q.data(), found.data(), found.data() + nv_, nullptr, du, dsigma},
                  slopes_);
    if (placed_) numbers_->add_loops(-1, t, q.data(), dsigma, slopes_);
    if (driven_)
      numbers_->add(1, {t, q.data(), still_.data(), nullptr, nullptr, du, dsigma}, slopes_);
    take_drives(t, by_parameters);
  }
  CorrectionRows rows{rows_};
  add_by_parameters(rows, x, -mu, by_parameters);
  return true;
}

}  // namespace momenta
