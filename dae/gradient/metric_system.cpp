#include <momenta/dae/gradient/metric_system.h>
#include <momenta/dae/kkt/factor/faded_pivot.h>

namespace momenta {

using Eigen::VectorXd;

MetricSystem::MetricSystem(const Mechanism& mechanism)
    : nv_(mechanism.nv()),
      m_(mechanism.m()),
      driven_(mechanism.plan().drives),
      e_(mechanism.evaluation<double>()),
      solver_(m_ > 0 ? make_loop_solver(mechanism, *e_) : nullptr),
      matrix_(mechanism),
      p_(nv_),
      pdot_(nv_),
      none_(VectorXd::Zero(nv_)),
      right_(m_),
      x_still_(nv_),
      y_still_(m_) {}

bool MetricSystem::place(double t, const VectorXd& q) {
  t_ = t;
  q_ = q;
  factored_ = false;
  if (recursive_) return true;
  e_->place(t, q_.data());
  matrix_.factor(*e_);
  factored_ = true;
  return !matrix_.singular();
}

/// u, σ of (7) with Φ̇ + βΦ = 0. False where the matrix is needed.
bool MetricSystem::by_recursion(const double* p, double beta, VectorXd& x, VectorXd& y) {
  x.resize(nv_);
  y.resize(m_);
  if (!recursive_) return false;
  if (!solver_) return e_->open_momentum_rates(t_, q_.data(), p, x.data(), pdot_.data());
  solver_->stabilise(beta);
  return solver_->momentum(t_, q_.data(), p, nullptr, fade_evaluation, 0, x.data(), y.data(),
                           nullptr) &&
         solver_->pivots().faded == 0;
}

/// Prescribed part, p = 0.
bool MetricSystem::still() {
  return by_recursion(none_.data(), 0, x_still_, y_still_);
}

bool MetricSystem::by_factors(const VectorXd& r, const VectorXd& s, VectorXd& x, VectorXd& y) {
  if (!factored_) {
    e_->place(t_, q_.data());
    matrix_.factor(*e_);
    factored_ = true;
    if (matrix_.singular()) return false;
  }
  VectorXd all(nv_ + m_);
  all << r, s;
  all = matrix_.solve(all).eval();
  x = all.head(nv_);
  y = all.tail(m_);
  return true;
}

bool MetricSystem::solve(const VectorXd& r, VectorXd& x, VectorXd& y) {
  if (by_recursion(r.data(), 0, x, y) && (!driven_ || still())) {
    if (!driven_) return true;
    x -= x_still_;
    y -= y_still_;
    return true;
  }
  right_.setZero();
  return by_factors(r, right_, x, y);
}

bool MetricSystem::correction(VectorXd& delta, VectorXd& nu) {
  if (by_recursion(none_.data(), 1, delta, nu) && (!driven_ || still())) {
    if (!driven_) return true;
    delta -= x_still_;
    nu -= y_still_;
    return true;
  }
  e_->place(t_, q_.data());
  e_->positions(right_.data());
  right_ *= -1;
  return by_factors(none_, right_, delta, nu);
}

bool MetricSystem::nearest(const VectorXd& u, VectorXd& v, VectorXd& nu) {
  e_->place(t_, q_.data());
  e_->move(u.data());
  e_->momenta(nullptr, p_.data());
  if (by_recursion(p_.data(), 0, v, nu)) return true;
  e_->place(t_, q_.data());
  e_->move(nullptr);
  e_->momenta(nullptr, pdot_.data());
  e_->velocities(right_.data());
  right_ *= -1;
  return by_factors(p_ - pdot_, right_, v, nu);
}

}  // namespace momenta
