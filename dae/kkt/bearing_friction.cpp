#include <momenta/core/scene/bearings_refused.h>
#include <momenta/dae/kkt/bearing_friction.h>
#include <momenta/dae/kkt/multipliers.h>
#include <momenta/dae/kkt/unheld_joints.h>
#include <momenta/dae/mechanism/bearings.h>

#include <cmath>
#include <cstdio>
#include <limits>

namespace momenta {
namespace {

/// N of four numbers of F.
double load_of(const double* f) {
  return std::hypot(f[0], f[1]) + std::hypot(f[2], f[3]);
}

}  // namespace

BearingFriction::BearingFriction(const Mechanism& mechanism)
    : mechanism_(mechanism), e_(mechanism.evaluation<double>()) {
  const auto nv = static_cast<std::size_t>(mechanism.nv());
  if (mechanism.m() > 0) solver_ = make_loop_solver(mechanism, *e_);
  for (const JointSpec& joint : mechanism.scene().joints)
    if (joint.bearing) {
      const int k = mechanism.tree().part_of(joint.name, 0);
      bearings_.push_back({joint.name, mechanism.tree().bodies[static_cast<std::size_t>(k)].u,
                           joint.kind == JointKind::revolute ? joint.bearing->radius : 1.0,
                           *joint.bearing});
    }
  for (auto* v : {&forces_, &tried_, &udot_, &unused_}) v->assign(nv, 0.0);
  lambda_.assign(static_cast<std::size_t>(mechanism.m()), 0.0);
  const auto n = static_cast<Eigen::Index>(bearings_.size());
  for (auto* v : {&F0_, &F_}) v->setZero(4 * n);
  for (auto* v : {&y_, &next_, &x_}) v->setZero(n);
  dF_.setZero(4 * n, n);
  contraction_.setZero(n, n);
  factors_ = Eigen::PartialPivLU<Eigen::MatrixXd>(n);
}

void BearingFriction::load(double t, const double* q, const double* u, const double* lambda,
                           Eigen::VectorXd& F) {
  e_->place(t, q);
  e_->move(u);
  e_->joint_forces(q, u, udot_.data(), lambda_.empty() ? nullptr : lambda, unused_.data());
  e_->bearing_loads(F.data());
}

bool BearingFriction::solve(double t, const double* q, const double* u, const double* tau,
                            Eigen::VectorXd& F) {
  bool found = false;
  if (solver_) {
    solver_->push(tau);
    found = solver_->acceleration(t, q, u, nullptr, 0, 0, udot_.data(), lambda_.data());
  } else {
    e_->push(tau);
    found = e_->open_accelerations(t, q, u, udot_.data());
  }
  if (!found) {
    const int joint = solver_ ? solver_->singular_joint() : e_->singular_joint();
    failure_ = joint >= 0 ? no_inertia(mechanism_, joint, t, q)
                          : "the accelerations that load the bearings are not finite";
    return false;
  }
  load(t, q, u, lambda_.data(), F);
  if (F.allFinite()) return true;
  failure_ = "the forces in the bearings are not finite";
  return false;
}

bool BearingFriction::at(double t, const double* q, const double* u) {
  failure_.clear();
  std::fill(forces_.begin(), forces_.end(), 0.0);
  if (!solve(t, q, u, nullptr, F0_)) return false;
  largest_ = 0;
  for (Eigen::Index i = 0; i < y_.size(); ++i)
    largest_ = std::max(largest_, load_of(F0_.data() + 4 * i));
  if (largest_ == 0) return true;  // no friction where nothing presses: a fixed point
  bool slides = false;
  const auto scale = [&](const Bearing& b) {
    return b.arm * friction_coefficient(b.spec, b.arm * u[b.u]) * largest_;
  };
  for (Eigen::Index j = 0; j < y_.size(); ++j) {
    const Bearing& b = bearings_[static_cast<std::size_t>(j)];
    const double s = scale(b);
    dF_.col(j).setZero();
    if (s == 0) continue;
    slides = true;
    double& pushed = tried_[static_cast<std::size_t>(b.u)];
    pushed = s;
    const bool solved = solve(t, q, u, tried_.data(), F_);
    pushed = 0;
    if (!solved) return false;
    dF_.col(j) = F_ - F0_;
  }
  if (!slides) return true;
  if (!iterate()) return false;
  for (Eigen::Index j = 0; j < y_.size(); ++j) {
    const Bearing& b = bearings_[static_cast<std::size_t>(j)];
    forces_[static_cast<std::size_t>(b.u)] = scale(b) * y_[j];
  }
  return true;
}

bool BearingFriction::iterate() {
  const Eigen::Index n = y_.size();
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      contraction_(i, j) = -load_of(dF_.col(j).data() + 4 * i) / largest_;
  contraction_.diagonal().array() += 1;
  factors_.compute(contraction_);
  next_.setOnes();
  x_ = factors_.solve(next_);
  Eigen::Index worst = 0;
  if (!(x_.minCoeff(&worst) > 0)) {
    failure_ = "the friction of the bearing of joint '" +
               bearings_[static_cast<std::size_t>(worst)].name +
               "' changes the force in it as much as it follows from it, so that it may have no "
               "value, or several; expected less friction, or a longer lever against it";
    return false;
  }
  y_.setZero();
  double before = std::numeric_limits<double>::infinity();
  // In the norm of x changes shrink until they are rounding.
  for (;;) {
    F_ = F0_;
    F_.noalias() += dF_ * y_;
    for (Eigen::Index i = 0; i < n; ++i) next_[i] = -load_of(F_.data() + 4 * i) / largest_;
    const double change = ((next_ - y_).array().abs() / x_.array()).maxCoeff();
    y_.swap(next_);
    if (!(change < before)) return true;
    before = change;
  }
}

double BearingFriction::power(const double* u) const {
  double sum = 0;
  for (const Bearing& b : bearings_) sum += forces_[static_cast<std::size_t>(b.u)] * u[b.u];
  return sum;
}

std::string BearingFriction::undetermined(double t, const double* q, const double* u) {
  if (!solver_ || !solve(t, q, u, nullptr, F0_)) return "";
  const std::vector<double> lambda = lambda_;
  UniqueMultipliers unique(mechanism_, *e_, *solver_);
  unique.find(t, q, u, lambda.data());
  if (unique.idle().empty()) return "";
  std::vector<double> other = lambda;
  double largest = F0_.cwiseAbs().maxCoeff();
  for (std::size_t i = 0; i < other.size(); ++i) other[i] += unique.idle()[i];
  load(t, q, u, other.data(), F_);
  largest = std::max(largest, F_.cwiseAbs().maxCoeff());
  constexpr double rounding = 1e-6;  // magnified by weak pivots
  for (std::size_t i = 0; i < bearings_.size(); ++i)
    for (Eigen::Index k = 0; k < 4; ++k)
      if (const auto at = 4 * static_cast<Eigen::Index>(i) + k;
          std::abs(F_[at] - F0_[at]) > rounding * largest)
        return bearings_[i].name;
  return "";
}

std::unique_ptr<BearingFriction> bearing_friction(const Mechanism& mechanism) {
  return with_bearing(mechanism.scene()) ? std::make_unique<BearingFriction>(mechanism) : nullptr;
}

bool rubbed_accelerations(BearingFriction* friction, Evaluation<double>& e, LoopSolver* solver,
                          double t, const double* q, const double* u, double* udot,
                          double* lambda) {
  if (friction && !friction->at(t, q, u)) return false;
  const double* tau = friction ? friction->forces() : nullptr;
  if (solver) {
    solver->push(tau);
    return solver->acceleration(t, q, u, nullptr, 0, 0, udot, lambda);
  }
  e.push(tau);
  const bool found = e.open_accelerations(t, q, u, udot);
  e.push(nullptr);
  return found;
}

}  // namespace momenta
