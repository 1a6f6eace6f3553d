#include <momenta/dae/form/acceleration_form.h>
#include <momenta/dae/gradient/correction_adjoint.h>

#include <limits>

namespace momenta {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// K (v, ν) = (M u, −Φ_t) as rows at x = (q, u, v, ν): M v + Φ_qᵀν − M u, Φ_q v + Φ_t; nv + m.
struct VelocityRows : RowPlaces {
  template <class E, class S>
  void operator()(E& e, const S* x, S* out) const {
    std::vector<S> given(static_cast<std::size_t>(nv));
    e.place(t, x);
    e.move(x + nq);
    e.momenta(nullptr, given.data());
    e.move(x + nq + nv);
    e.momenta(x + nq + 2 * nv, out);
    e.velocities(out + nv);
    for (Index i = 0; i < nv; ++i) out[i] -= given[static_cast<std::size_t>(i)];
  }
};

}  // namespace

CorrectionAdjoint::CorrectionAdjoint(const Mechanism& mechanism,
                                     const std::vector<OtherParameter>& others,
                                     const TransposedForces& forces)
    : others_(others),
      system_(mechanism),
      rows_{{RowPlaces(mechanism)}, forces.any(), forces.at_points()},
      driven_(mechanism.plan().drives),
      e_(mechanism.evaluation<double>()),
      dual_(mechanism.evaluation<Dual8>()),
      x_(static_cast<std::size_t>(2 * rows_.nv + rows_.m)),
      out_(static_cast<std::size_t>(2 * rows_.nv)),
      slope_(rows_.nv),
      force_(rows_.nv),
      none_(VectorXd::Zero(rows_.m)),
      still_(VectorXd::Zero(rows_.nv)) {}

/// ∇_q of D_(a,b) L* at (q, u, σ).
const VectorXd& CorrectionAdjoint::along(double t, const VectorXd& q, const VectorXd& u,
                                         const VectorXd& sigma, const VectorXd& a,
                                         const VectorXd& b) {
  rows_.t = t;
  const Index n = rows_.nv;
  const auto put = [&](Index i, double value, double slope) {
    Dual8& x = x_[static_cast<std::size_t>(i)];
    x = Dual8(value);
    x.b[0] = slope;
  };
  for (Index i = 0; i < n; ++i) {
    put(i, q[i], 0);
    put(n + i, u[i], a[i]);
  }
  for (Index i = 0; i < rows_.m; ++i) put(2 * n + i, sigma[i], b[i]);
  rows_(static_cast<EquationRows<Dual8>&>(*dual_), x_.data(), out_.data());
  for (Index i = 0; i < n; ++i) slope_[i] = out_[static_cast<std::size_t>(n + i)].b[0];
  return slope_;
}

bool CorrectionAdjoint::positions(double t, const VectorXd& q, bool repeated,
                                  const Numbers& numbers, VectorXd& lambda,
                                  VectorXd& by_parameters) {
  if (!repeated) return position(t, q, numbers, lambda, by_parameters);
  // As the form does (dae/form/projected.cpp), then back.
  VectorXd at = q;
  double before = std::numeric_limits<double>::infinity();
  std::size_t passes = 0;
  for (int k = 0; k < most_corrections; ++k) {
    if (!system_.place(t, at) || !system_.correction(delta_, nu_)) return false;
    const double length = delta_.size() > 0 ? delta_.cwiseAbs().maxCoeff() : 0;
    if (k > 0 && !(length < 0.5 * before)) break;
    if (passed_.size() <= passes) passed_.emplace_back();
    passed_[passes++] = at;
    at += delta_;
    if (length <= last_correction) break;
    before = length;
  }
  while (passes-- > 0)
    if (!position(t, passed_[passes], numbers, lambda, by_parameters)) return false;
  return true;
}

bool CorrectionAdjoint::position(double t, const VectorXd& q, const Numbers& numbers,
                                 VectorXd& lambda, VectorXd& by_parameters) {
  const Index n = rows_.nv;
  if (!system_.place(t, q) || !system_.correction(delta_, nu_) ||
      !system_.solve(lambda.head(n), a_, b_))
    return false;
  e_->place(t, q.data());
  e_->constraint_forces(b_.data(), force_.data());
  lambda.head(n) -= force_ + along(t, q, delta_, nu_, a_, b_);
  if (driven_) lambda.head(n) += along(t, q, still_, none_, a_, b_);
  if (numbers.of) {
    numbers.of->add(-1, {t, q.data(), delta_.data(), nu_.data(), nullptr, a_.data(), b_.data()});
    if (numbers.placed) numbers.of->add_loops(-1, t, q.data(), b_.data());
    if (driven_)
      numbers.of->add(1, {t, q.data(), still_.data(), nullptr, nullptr, a_.data(), b_.data()});
  }
  CorrectionRows rows{rows_};
  rows.t = t;
  add_by_parameters(others_, rows, joined(q, delta_, nu_), -joined(a_, b_, VectorXd(0)),
                    by_parameters);
  return true;
}

bool CorrectionAdjoint::velocities(double t, const VectorXd& q, const VectorXd& u,
                                   const Numbers& numbers, VectorXd& lambda,
                                   VectorXd& by_parameters) {
  const Index n = rows_.nv;
  if (!system_.place(t, q) || !system_.solve(lambda.tail(n), a_, b_)) return false;
  // The same matrix: K (v − u, ν) = (0, −Φ̇(u)).
  VectorXd& v = delta_;
  if (!system_.nearest(u, v, nu_)) return false;
  e_->place(t, q.data());
  e_->constraint_forces(b_.data(), force_.data());
  lambda.tail(n) -= force_;  // M a = λ_u − Φ_qᵀ b
  lambda.head(n) += along(t, q, u, none_, a_, none_);
  lambda.head(n) -= along(t, q, v, nu_, a_, b_);
  if (numbers.of) {
    numbers.of->add(1, {t, q.data(), u.data(), nullptr, nullptr, a_.data(), nullptr});
    numbers.of->add(-1, {t, q.data(), v.data(), nu_.data(), nullptr, a_.data(), b_.data()});
  }
  VelocityRows rows{rows_};
  rows.t = t;
  VectorXd x(q.size() + 2 * n + rows_.m);
  x << q, u, v, nu_;
  add_by_parameters(others_, rows, x, -joined(a_, b_, VectorXd(0)), by_parameters);
  return true;
}

}  // namespace momenta
