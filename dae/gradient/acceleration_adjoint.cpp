#include <momenta/dae/gradient/acceleration_adjoint.h>

#include <algorithm>

namespace momenta {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// r1, r2 at x = (q, u, u̇, λ): nv + m.
struct AccelerationRows : RowPlaces {
  double alpha = 0;  ///< α of r2 [1/s]; β: RowPlaces
  template <class E, class S>
  void operator()(E& e, const S* x, S* out) const {
    const S *u = x + nq, *udot = u + nv, *lambda = m > 0 ? udot + nv : nullptr;
    e.place(t, x);
    e.move(u);
    e.joint_forces(x, u, udot, lambda, out);
    if (m == 0) return;
    e.accelerations(out + nv);
    if (alpha == 0 && beta == 0) return;
    std::vector<S> rate(static_cast<std::size_t>(m)), phi(rate.size());
    e.velocities(rate.data());
    e.positions(phi.data());
    for (Index i = 0; i < m; ++i)
      out[nv + i] += (2 * alpha) * rate[static_cast<std::size_t>(i)] +
                     (beta * beta) * phi[static_cast<std::size_t>(i)];
  }
};

}  // namespace

AccelerationAdjoint::AccelerationAdjoint(const Mechanism& mechanism, const OdeForm& form,
                                         const std::vector<OtherParameter>& others)
    : mechanism_(mechanism),
      others_(others),
      nv_(mechanism.nv()),
      m_(mechanism.m()),
      alpha_(form.baumgarte_gains().first),
      beta_(form.baumgarte_gains().second),
      projects_(form.corrects_positions()),
      repeats_(form.name() == "projected"),
      forces_(mechanism),
      mixed_(mechanism, alpha_, beta_, forces_.any(), forces_.at_points()),
      corrections_(mechanism, others, forces_),
      by_q_(VectorXd::Zero(nv_)),
      by_u_(by_q_) {
  any_rows_ = std::any_of(others.begin(), others.end(),
                          [](const OtherParameter& other) { return other.by_rows(); });
  placed_ = std::any_of(others.begin(), others.end(),
                        [](const OtherParameter& other) { return other.of_places; });
  if (at_once() == 0) return;
  numbers_ = make_number_slopes(mechanism, placed_);
  mixed_numbers_ = make_number_slopes(mechanism, placed_);
}

Index AccelerationAdjoint::at_once() const {
  return std::count_if(others_.begin(), others_.end(),
                       [](const OtherParameter& other) { return other.numbers.size() > 0; });
}

void AccelerationAdjoint::finish(VectorXd& by_parameters) {
  if (!numbers_) return;
  // Q_θ of dampers times its direction of q is in D_c L*_θ, but not in S.
  VectorXd all = VectorXd::Zero(numbers_->size());
  mixed_numbers_->finish(all);
  for (const Index i : numbers_->without_potential()) all[i] = 0;
  numbers_->finish(all);
  for (std::size_t j = 0; j < others_.size(); ++j)
    if (const VectorXd& numbers = others_[j].numbers; numbers.size() > 0)
      by_parameters[static_cast<Index>(j)] += numbers.dot(all);
}

/// −S_θ of all numbers; of forces without potential νᵀQ_θ alone.
void AccelerationAdjoint::add_numbers(const AdjointState& at) {
  const double *q = at.q.data(), *u = at.p.data(), *udot = at.slope.data(),
               *lambda = at.sigma.data();
  const double s = MixedRates::reach({at.t, at.q, at.p, at.slope, at.sigma}, nu_);
  for (const double sign : {1.0, -1.0}) {
    shifted_ = at.p + sign * s * nu_;
    sigma_ = sign * s * mu_;
    mixed_numbers_->add(-sign / (2 * s),
                        {at.t, q, shifted_.data(), sigma_.data(), u, udot, lambda});
  }
  numbers_->add(1, {at.t, q, u, nullptr, nu_.data(), nullptr, nullptr});
  if (!placed_) return;
  if (alpha_ != 0)
    numbers_->add_loop_rates(-2 * alpha_, {at.t, q, u, nullptr, nullptr, nullptr, mu_.data()});
  if (beta_ != 0) numbers_->add_loops(-beta_ * beta_, at.t, q, mu_.data());
}

bool AccelerationAdjoint::rates(const AdjointState& at, const VectorXd& w, VectorXd& product,
                                VectorXd& by_parameters) {
  const VectorXd& u = at.p;
  MetricSystem& system = corrections_.system();
  if (!system.place(at.t, at.q) || !system.solve(w.tail(nv_), nu_, mu_)) return false;
  mixed_({at.t, at.q, u, at.slope, at.sigma}, nu_, mu_);
  product.resize(2 * nv_);
  product.head(nv_) = -mixed_.by_q;
  product.tail(nv_) = w.head(nv_) - mixed_.by_u;
  if (forces_.any()) {
    forces_.transposed(at.t, at.q, u, nu_, by_q_, by_u_);
    product.head(nv_) += by_q_;
    product.tail(nv_) += by_u_;
  }
  if (numbers_) add_numbers(at);
  if (!any_rows_) return true;
  AccelerationRows rows{RowPlaces(mechanism_)};
  rows.t = at.t;
  rows.alpha = alpha_;
  rows.beta = beta_;
  x_.resize(3 * nv_ + m_);
  x_ << at.q, u, at.slope, at.sigma;
  weights_.resize(nv_ + m_);
  weights_ << -nu_, -mu_;
  add_by_parameters(others_, rows, x_, weights_, by_parameters);
  return true;
}

bool AccelerationAdjoint::gauge(const AdjointState& at, VectorXd& lambda, VectorXd& by_parameters) {
  return !projects_ || corrections_.velocities(at.t, at.q, at.p, numbers(), lambda, by_parameters);
}

bool AccelerationAdjoint::correction(double t, const VectorXd& q, VectorXd& lambda,
                                     VectorXd& by_parameters) {
  return corrections_.positions(t, q, repeats_, numbers(), lambda, by_parameters);
}

}  // namespace momenta
