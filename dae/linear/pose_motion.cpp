#include <momenta/dae/kkt/loop_units.h>
#include <momenta/dae/linear/pose_motion.h>

#include <algorithm>
#include <limits>

namespace momenta {

using Eigen::VectorXd;

PoseMotion::PoseMotion(const Mechanism& mechanism)
    : mechanism_(mechanism),
      e_(mechanism.evaluation<double>()),
      motion_(mechanism),
      phi_(mechanism.m()),
      delta_(mechanism.nv()),
      rest_(VectorXd::Zero(mechanism.nv())),
      closed_(1e-10 * std::max(1.0, length_of(mechanism.scene()))) {
  if (mechanism.m() > 0) solver_ = make_loop_solver(mechanism, *e_);
}

bool PoseMotion::move(double t, const VectorXd& from, const VectorXd& delta, VectorXd& q) {
  constexpr int most_corrections = 30;
  q.resize(from.size());
  if (!delta.allFinite()) return false;
  motion_.move(*e_, from.data(), delta.data(), q.data());
  if (!solver_) return q.allFinite();
  e_->place(t, from.data());
  e_->positions(phi_.data());
  const double open_before = phi_.cwiseAbs().maxCoeff();
  const double closed = open_before <= left_by_files * std::max(1.0, length_of(mechanism_.scene()))
                            ? std::max(closed_, 4 * open_before)  // what redundant equations leave
                            : closed_;
  VectorXd next(q.size());
  double before = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < most_corrections; ++pass) {
    e_->place(t, q.data());
    e_->positions(phi_.data());
    const double open = phi_.cwiseAbs().maxCoeff();
    if (!std::isfinite(open)) return false;
    if (open == 0 || (open <= closed && !(open < 0.5 * before))) return true;
    before = open;
    if (!solver_->position_correction(t, q.data(), delta_.data()) || !delta_.allFinite())
      return false;
    motion_.move(*e_, q.data(), delta_.data(), next.data());
    q.swap(next);
  }
  e_->place(t, q.data());
  e_->positions(phi_.data());
  return phi_.cwiseAbs().maxCoeff() <= closed;
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
  // p = M y + what drives prescribe.
  const bool ok =
      e_->open_momentum_rates(t, q.data(), none.data(), prescribed.data(), unused.data());
  y -= prescribed;
  return ok;
}

}  // namespace momenta
