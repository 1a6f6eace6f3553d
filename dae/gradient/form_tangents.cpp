#include <momenta/dae/form/acceleration_form.h>
#include <momenta/dae/gradient/form_tangents.h>
#include <momenta/dae/gradient/momentum_rows.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace momenta {
namespace {

using Eigen::Index;
using Eigen::Map;
using Eigen::MatrixXd;
using Eigen::VectorXd;

template <class S>
using Of = std::remove_cvref_t<S>;

}  // namespace

const std::vector<std::string>& differentiable_forms() {
  static const std::vector<std::string> names{"momentum", "acceleration", "projected", "baumgarte"};
  return names;
}

FormTangents::FormTangents(const Mechanism& mechanism, const OdeForm& form,
                           const std::vector<OtherParameter>& others)
    : mechanism_(mechanism),
      form_(form),
      derivatives_(mechanism, others),
      matrix_(mechanism),
      e_(mechanism.evaluation<double>()),
      nq_(mechanism.nq()),
      nv_(mechanism.nv()),
      m_(mechanism.m()),
      momenta_(form.momentum_like()),
      projects_(m_ > 0 && form.corrects_positions()),
      repeats_(form.name() == "projected"),
      gauge_(form.gauge()),
      leak_(gauge_.kind == Gauge::Kind::leak ? gauge_.kappa : 0),
      beta_(momenta_ ? form.beta() : form.baumgarte_gains().second),
      alpha_(form.baumgarte_gains().first),
      sigma_(VectorXd::Zero(m_)),
      dsigma_(MatrixXd::Zero(m_, derivatives_.directions())) {
  if (!momenta_) return;
  swept_ = make_swept_tangent(mechanism, leak_, beta_);
  tables_ = make_table_tangents(mechanism, others);
  if (tables_) derivatives_.leave_out(tables_->taken);
}

bool FormTangents::place(double t, const VectorXd& q) {
  e_->place(t, q.data());
  matrix_.factor(*e_);
  return !matrix_.singular();
}

MatrixXd FormTangents::joined(const MatrixXd& a, const MatrixXd& b, const MatrixXd& c) const {
  MatrixXd all(a.rows() + b.rows() + c.rows(), derivatives_.directions());
  all << a, b, c;
  return all;
}

/// du, dσ, dṗ by the sweeps, dṗ without ∂ṗ/∂θ. False where they do not carry the state: where rows
/// fade, here or in the first stage, the matrix decides.
bool FormTangents::sweep(double t, const VectorXd& q, const double* p, const MatrixXd& dq,
                         const MatrixXd& dp) {
  if (!swept_) return false;
  const int faded = form_.pivots().faded;
  if (faded_ < 0 && faded == 0) matrix_.independent();
  if (faded_ < 0) faded_ = faded;
  if (faded_ > 0 || faded > 0) return false;
  along_p_ = dp - explicit_.topRows(nv_);
  if (derivatives_.any_parameters() || (tables_ && tables_->any_loops))
    besides_ = explicit_.middleRows(nv_, m_);
  return swept_->along(t, q.data(), p, dq, along_p_, besides_, du_, dpdot_, dsigma_);
}

/// du, dσ of (7) at u_, σ_, and dṗ where the sweeps find it; `of_rates`: explicit_ with rows of (8)
/// below.
bool FormTangents::momentum(double t, const VectorXd& q, const double* p, const MatrixXd& dq,
                            const MatrixXd& dp, bool of_rates) {
  MomentumAndRateRows with_rates{{RowPlaces(mechanism_)}};
  with_rates.t = t;
  with_rates.beta = beta_;
  with_rates.leak = leak_;
  const MomentumRows& rows = with_rates;
  const Index k = derivatives_.directions();
  const VectorXd x = momenta::joined(q, u_, sigma_);
  const Index size = of_rates ? 2 * nv_ + m_ : nv_ + m_;
  if (!derivatives_.any_parameters())
    explicit_.setZero(size, k);
  else
    explicit_ = of_rates ? derivatives_.by_parameters(with_rates, x, size)
                         : derivatives_.by_parameters(rows, x, size);
  if (tables_) {
    tables_->at(t, q, u_, sigma_.data(), {leak_, beta_});
    explicit_.topRows(nv_) += tables_->r1;
    explicit_.middleRows(nv_, m_) += tables_->r2;
    if (of_rates) explicit_.bottomRows(nv_) += tables_->r3;
  }
  if (sweep(t, q, p, dq, dp)) return true;
  dpdot_.resize(0, 0);
  if (!place(t, q)) return false;
  MatrixXd right =
      -derivatives_.along(rows, x, joined(dq, MatrixXd::Zero(nv_, k), MatrixXd::Zero(m_, k)),
                          nv_ + m_) -
      explicit_.topRows(nv_ + m_);
  right.topRows(nv_) += dp;
  const MatrixXd found = matrix_.solve(right);
  du_ = found.topRows(nv_);
  dsigma_ = found.bottomRows(m_);
  return true;
}

bool FormTangents::rates(double t, const double* y, const double* ydot, const MatrixXd& Y,
                         MatrixXd& Ydot) {
  const VectorXd q = Map<const VectorXd>(y, nq_);
  dq_ = Y.topRows(nq_);
  dx_ = Y.bottomRows(nv_);
  const MatrixXd &dq = dq_, &dx = dx_;
  sigma_ = Map<const VectorXd>(form_.multipliers().data(), m_);
  const Index k = derivatives_.directions();
  const bool quasi = mechanism_.plan().quasi_velocities;
  Ydot.resize(nq_ + nv_, k);
  if (momenta_) {
    u_ = Map<const VectorXd>(form_.rates().data(), nv_);
    if (!momentum(t, q, y + nq_, dq, dx, true)) return false;
    if (dpdot_.size() > 0) {
      Ydot.topRows(nq_) = du_;
      Ydot.bottomRows(nv_) = dpdot_ + explicit_.bottomRows(nv_);
      return true;
    }
    const auto rows = [&](auto& e, const auto* x, auto* out) {
      const auto *u = x + nq_, *sigma = m_ > 0 ? x + nq_ + nv_ : nullptr;
      e.place(t, x);
      e.move(u);
      e.momenta(sigma, out + nq_);
      e.momentum_rates(x, u, sigma, leak_, out + nq_);
      if (quasi)
        e.coordinate_rates(x, u, out);
      else
        std::copy_n(u, nq_, out);
    };
    // q̇ = H(q) u has no θ in it.
    Ydot = derivatives_.along(rows, momenta::joined(q, u_, sigma_), joined(dq, du_, dsigma_),
                              nq_ + nv_);
    Ydot.bottomRows(nv_) += explicit_.bottomRows(nv_);
    return true;
  }
  u_ = Map<const VectorXd>(y + nq_, nv_);
  du_ = dx;
  if (!place(t, q)) return false;
  const VectorXd udot = Map<const VectorXd>(ydot + nq_, nv_);
  const auto rows = [&](auto& e, const auto* x, auto* out) {
    using S = Of<decltype(*out)>;
    const auto* u = x + nq_;
    const std::vector<S> a(udot.begin(), udot.end()), lambda(sigma_.begin(), sigma_.end());
    e.place(t, x);
    e.move(u);
    e.joint_forces(x, u, a.data(), m_ > 0 ? lambda.data() : nullptr, out);
    if (m_ > 0) {
      std::vector<S> more(static_cast<std::size_t>(m_));
      e.accelerations(out + nv_);
      if (alpha_ != 0) {
        e.velocities(more.data());
        for (Index i = 0; i < m_; ++i)
          out[nv_ + i] += (2 * alpha_) * more[static_cast<std::size_t>(i)];
      }
      if (beta_ != 0) {
        e.positions(more.data());
        for (Index i = 0; i < m_; ++i)
          out[nv_ + i] += (beta_ * beta_) * more[static_cast<std::size_t>(i)];
      }
    }
    if (quasi)
      e.coordinate_rates(x, u, out + nv_ + m_);
    else
      std::copy_n(u, nq_, out + nv_ + m_);
  };
  const MatrixXd d = derivatives_(rows, momenta::joined(q, u_, VectorXd(0)),
                                  joined(dq, dx, MatrixXd(0, k)), nv_ + m_ + nq_);
  Ydot.topRows(nq_) = d.bottomRows(nq_);
  Ydot.bottomRows(nv_) = -matrix_.solve(d.topRows(nv_ + m_)).topRows(nv_);
  return true;
}

bool FormTangents::correct_position(double t, VectorXd& q, MatrixXd& dq) {
  const Index k = derivatives_.directions();
  double before = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < (repeats_ ? most_corrections : 1); ++pass) {
    if (!place(t, q)) return false;
    VectorXd right = VectorXd::Zero(nv_ + m_);
    e_->positions(right.data() + nv_);
    const VectorXd found = -matrix_.solve(right);
    const double length = nv_ > 0 ? found.head(nv_).cwiseAbs().maxCoeff() : 0;
    if (pass > 0 && !(length < 0.5 * before)) break;
    CorrectionRows rows{RowPlaces(mechanism_)};
    rows.t = t;
    MatrixXd d = derivatives_(rows, momenta::joined(q, found, VectorXd(0)),
                              joined(dq, MatrixXd::Zero(nv_ + m_, k), MatrixXd(0, k)), nv_ + m_);
    if (tables_) {  // M δ + Φ_qᵀν, Φ_q δ + Φ, without drives
      tables_->at(t, q, found.head(nv_), found.data() + nv_, {0, 1});
      d.topRows(nv_) += tables_->r1;
      d.bottomRows(m_) += tables_->r2;
      if (mechanism_.plan().drives) {
        tables_->at(t, q, VectorXd::Zero(nv_), nullptr, {});
        d.topRows(nv_) -= tables_->r1;
        d.bottomRows(m_) -= tables_->r2;
      }
    }
    const MatrixXd ddelta = -matrix_.solve(d).topRows(nv_);
    // q + H(q) δ
    const auto moved = [&](auto& e, const auto* x, auto* out) {
      e.place(t, x);
      e.coordinate_rates(x, x + nq_, out);
    };
    const VectorXd x = momenta::joined(q, found.head(nv_), VectorXd(0));
    const MatrixXd step = derivatives_(moved, x, joined(dq, ddelta, MatrixXd(0, k)), nq_);
    VectorXd qdot(nq_);
    e_->coordinate_rates(x.data(), x.data() + nq_, qdot.data());
    q += qdot;
    dq += step;
    if (length <= last_correction) break;
    before = length;
  }
  return true;
}

bool FormTangents::correct_velocity(double t, const VectorXd& q, const VectorXd& u,
                                    const MatrixXd& dq, MatrixXd& du) {
  if (!place(t, q)) return false;
  const Index k = derivatives_.directions();
  VectorXd right(nv_ + m_), still(nv_);
  e_->move(u.data());
  e_->momenta(nullptr, right.data());
  e_->move(nullptr);
  e_->momenta(nullptr, still.data());
  e_->velocities(right.data() + nv_);
  right.head(nv_) -= still;
  right.tail(m_) *= -1;
  const VectorXd found = matrix_.solve(right);  // v, ν
  const auto rows = [&](auto& e, const auto* x, auto* out) {
    using S = Of<decltype(*out)>;
    std::vector<S> given(static_cast<std::size_t>(nv_));
    e.place(t, x);
    e.move(x + nq_);
    e.momenta(nullptr, given.data());
    e.move(x + nq_ + nv_);
    e.momenta(x + nq_ + 2 * nv_, out);
    e.velocities(out + nv_);
    for (Index i = 0; i < nv_; ++i) out[i] -= given[static_cast<std::size_t>(i)];
  };
  const MatrixXd d = derivatives_(rows, momenta::joined(q, u, found),
                                  joined(dq, du, MatrixXd::Zero(nv_ + m_, k)), nv_ + m_);
  du = -matrix_.solve(d).topRows(nv_);
  return true;
}

void FormTangents::normalise(VectorXd& q, MatrixXd& dq) const {
  if (!mechanism_.plan().quasi_velocities) return;
  for (const auto& b : mechanism_.tree().bodies) {
    if (!b.has_quaternion()) continue;
    const Index first = b.q + b.nq - 4;
    const double norm = q.segment<4>(first).norm();
    const Eigen::Vector4d unit = q.segment<4>(first) / norm;
    q.segment<4>(first) = unit;
    const MatrixXd d = dq.middleRows(first, 4);
    dq.middleRows(first, 4) = (d - unit * (unit.transpose() * d)) / norm;
  }
}

bool FormTangents::after_step(double t, const double* before, const double* after, MatrixXd& Y) {
  VectorXd q = Map<const VectorXd>(before, nq_);
  MatrixXd dq = Y.topRows(nq_), dx = Y.bottomRows(nv_);
  if (projects_ && !correct_position(t, q, dq)) return false;
  if (!momenta_ && projects_) {
    const VectorXd u = Map<const VectorXd>(before + nq_, nv_);
    if (!correct_velocity(t, q, u, dq, dx)) return false;
  }
  normalise(q, dq);
  if (momenta_ && m_ > 0 &&
      (gauge_.kind == Gauge::Kind::reset || gauge_.kind == Gauge::Kind::flip)) {
    const double kept = gauge_.kind == Gauge::Kind::flip ? -1 : 0;  // factor of σ
    u_ = Map<const VectorXd>(form_.rates().data(), nv_);
    sigma_ = Map<const VectorXd>(form_.multipliers().data(), m_);
    if (kept != 0) sigma_ *= kept;  // turned by the form
    q = Map<const VectorXd>(after, nq_);
    if (!momentum(t, q, before + nq_, dq, dx, false)) return false;
    const auto rows = [&](auto& e, const auto* x, auto* out) {
      e.place(t, x);
      e.move(x + nq_);
      e.momenta(kept != 0 ? x + nq_ + nv_ : nullptr, out);
    };
    dx = derivatives_(rows, momenta::joined(q, u_, kept * sigma_), joined(dq, du_, kept * dsigma_),
                      nv_);
    if (tables_) {
      sigma_ *= kept;
      tables_->at(t, q, u_, sigma_.data(), {});
      dx += tables_->r1;
    }
  }
  Y.topRows(nq_) = dq;
  Y.bottomRows(nv_) = dx;
  return true;
}

}  // namespace momenta
