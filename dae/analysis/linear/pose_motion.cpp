#include <momenta/dae/analysis/linear/pose_motion.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace momenta {

using Eigen::VectorXd;

namespace {

constexpr int most_corrections = 30;
constexpr double least_open = 1e-10;  // contradiction in units: below it Φ = 0 is met
constexpr double settled = 1e-12;     // last correction, in units

}  // namespace

PoseMotion::PoseMotion(const Mechanism& mechanism)
    : mechanism_(mechanism),
      e_(mechanism.evaluation<double>()),
      motion_(mechanism),
      phi_(mechanism.m()),
      delta_(mechanism.nv()),
      rest_(VectorXd::Zero(mechanism.nv())),
      closed_(1e-10 * std::max(1.0, length_of(mechanism.scene()))),
      loops_(mechanism) {
  if (mechanism.m() > 0) solver_ = make_loop_solver(mechanism, *e_);
}

bool PoseMotion::move(double t, const VectorXd& from, const VectorXd& delta, VectorXd& q) {
  q.resize(from.size());
  if (!delta.allFinite()) return false;
  motion_.move(*e_, from.data(), delta.data(), q.data());
  if (!solver_) return q.allFinite();
  if (!contradiction_) contradiction_ = contradiction(loops_, t, from, 0);
  return contradiction_->left > least_open ? close_least(t, q) : close(t, q);
}

/// Back to Φ = 0.
bool PoseMotion::close(double t, VectorXd& q) {
  VectorXd next(q.size());
  double before = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < most_corrections; ++pass) {
    e_->place(t, q.data());
    e_->positions(phi_.data());
    const double open = phi_.cwiseAbs().maxCoeff();
    if (!std::isfinite(open)) return false;
    if (open == 0 || (open <= closed_ && !(open < 0.5 * before))) return true;
    before = open;
    if (!solver_->position_correction(t, q.data(), delta_.data()) || !delta_.allFinite())
      return false;
    motion_.move(*e_, q.data(), delta_.data(), next.data());
    q.swap(next);
  }
  e_->place(t, q.data());
  e_->positions(phi_.data());
  return phi_.cwiseAbs().maxCoeff() <= closed_;
}

/// Back to the least |Φ| that contradictions leave.
bool PoseMotion::close_least(double t, VectorXd& q) {
  const VectorXd& unit = loops_.units().rates;
  LeastNorm steps(loops_.pattern(), mechanism_.m(), mechanism_.nv());
  VectorXd next(q.size()), free(mechanism_.nv());
  double before = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < most_corrections; ++pass) {
    const VectorXd gap = loops_.gap(t, q) - contradiction_->open;
    if (!gap.allFinite()) return false;
    const std::vector<double> j = loops_.jacobian();
    double largest = 0;
    for (const double x : j) largest = std::max(largest, std::abs(x));
    steps.factor(j, std::max(contradiction_->pivot, rank_tolerance) * largest);
    delta_ = -steps.solve(gap).cwiseProduct(unit);
    e_->place(t, q.data());
    if (!delta_.allFinite() || !free_velocity(t, q, momentum(delta_), free)) return false;
    delta_ -= free;
    const double size = delta_.cwiseQuotient(unit).cwiseAbs().maxCoeff();
    if (size <= settled && !(size < 0.5 * before))
      return gap.cwiseAbs().maxCoeff() <= contradiction_->left;
    before = size;
    motion_.move(*e_, q.data(), delta_.data(), next.data());
    q.swap(next);
  }
  return false;
}

bool PoseMotion::let_go(double t, const VectorXd& q, VectorXd& udot, VectorXd& lambda) {
  udot.setZero(mechanism_.nv());
  lambda.setZero(mechanism_.m());
  const bool ok = solver_ ? solver_->acceleration(t, q.data(), rest_.data(), nullptr, 0, 0,
                                                  udot.data(), lambda.data())
                          : e_->open_accelerations(t, q.data(), rest_.data(), udot.data());
  return ok && udot.allFinite() && lambda.allFinite();
}

VectorXd PoseMotion::momentum(const VectorXd& y) {
  VectorXd p(mechanism_.nv());
  e_->move(y.data());
  e_->momenta(nullptr, p.data());
  if (!mechanism_.plan().drives) return p;
  VectorXd prescribed(mechanism_.nv());
  e_->move(rest_.data());
  e_->momenta(nullptr, prescribed.data());
  return p - prescribed;
}

bool PoseMotion::free_velocity(double t, const VectorXd& q, const VectorXd& p, VectorXd& y) {
  y.setZero(mechanism_.nv());
  if (solver_) return solver_->free_velocity(t, q.data(), p.data(), y.data());
  VectorXd unused(mechanism_.nv()), none = VectorXd::Zero(mechanism_.nv()), prescribed = none;
  if (!e_->open_momentum_rates(t, q.data(), p.data(), y.data(), unused.data())) return false;
  if (!mechanism_.plan().drives) return true;
  // p = M y + prescribed momenta.
  const bool ok =
      e_->open_momentum_rates(t, q.data(), none.data(), prescribed.data(), unused.data());
  y -= prescribed;
  return ok;
}

}  // namespace momenta
