#include <momenta/dae/gradient/adjoint_run.h>

#include <cstdio>

namespace momenta {

using Eigen::Index;
using Eigen::Map;
using Eigen::MatrixXd;
using Eigen::VectorXd;

AdjointRun::AdjointRun(OdeForm& form, FormAdjoint& adjoint, FunctionalSlopes& g, bool integral,
                       const std::string& method, Index parameters)
    : form_(form),
      adjoint_(adjoint),
      g_(g),
      integral_(integral),
      tableau_(butcher_tableau(method)),
      lambda_(VectorXd::Zero(form.size())),
      by_parameters_(VectorXd::Zero(parameters)),
      k_(form.size(), static_cast<Index>(tableau_.b.size())),
      m_(k_.rows(), k_.cols()),
      stages_(tableau_.b.size()) {}

bool AdjointRun::fail_at(double t, const std::string& why) {
  char text[48];
  std::snprintf(text, sizeof text, "at t = %.9g s: ", t);
  failure_ = text + why;
  return false;
}

bool AdjointRun::rhs(double t, const double* y, double* ydot, AdjointState& at) {
  if (!form_.rhs(t, y, ydot)) {
    failure_ = form_.failure();
    return false;
  }
  at.t = t;
  at.q = Map<const VectorXd>(y, form_.size() / 2);
  at.p = Map<const VectorXd>(y + form_.size() / 2, form_.size() / 2);
  if (form_.momentum_like())
    at.u = Map<const VectorXd>(form_.rates().data(), form_.size() / 2);
  else
    at.u = at.p;
  at.slope = Map<const VectorXd>(ydot + form_.size() / 2, form_.size() / 2);
  at.sigma = Map<const VectorXd>(form_.multipliers().data(),
                                 static_cast<Index>(form_.multipliers().size()));
  return true;
}

/// λ of g at the end.
bool AdjointRun::end(double t, const double* y) {
  AdjointState& at = stages_.front();
  if (!rhs(t, y, k_.col(0).data(), at)) return false;
  value_ = g_.at(t, at.q, at.u, by_q_, by_u_, by_theta_);
  by_parameters_ += by_theta_;
  w_ = VectorXd::Zero(form_.size());
  w_.head(by_u_.size()) = by_u_;
  ++products_;
  if (!adjoint_.rates(at, w_, lambda_, by_parameters_)) return fail_at(t, dependent_loops);
  u_behind_ = at.u;
  lambda_.head(by_q_.size()) += by_q_;
  return true;
}

/// λ before the form's change after a step: the stages led to y, the form from there to `behind`
/// (null: not known).
bool AdjointRun::after_step(double t, const VectorXd& y, const double* behind) {
  const Index n = y.size() / 2;
  const auto corrected = [&] {
    return !form_.corrects_positions() ||
           adjoint_.correction(t, y.head(n), lambda_, by_parameters_);
  };
  if (behind) {
    const AdjointState at{t, Map<const VectorXd>(behind, n), y.tail(n), u_behind_, {}};
    if (adjoint_.gauge(at, lambda_, by_parameters_))
      return corrected() || fail_at(t, dependent_loops);
  }
  y_ = y;
  bool changed = false;
  if (!form_.after_step(t, y_.data(), changed)) {
    failure_ = form_.failure();
    return false;
  }
  AdjointState at{t, y_.head(n), y.tail(n), Map<const VectorXd>(form_.rates().data(), n),
                  Map<const VectorXd>(form_.multipliers().data(),
                                      static_cast<Index>(form_.multipliers().size()))};
  if (form_.gauge().kind == Gauge::Kind::flip) at.sigma = -at.sigma;  // the form has turned σ
  return (adjoint_.gauge(at, lambda_, by_parameters_) && corrected()) ||
         fail_at(t, dependent_loops);
}

/// The stages of a step and their slopes anew, from its start; f of the first at `first`.
bool AdjointRun::stages_again(const RecordedRun::Step& step, const double* start,
                              const double* first) {
  const Map<const VectorXd> y(start, form_.size());
  form_.begin_step(step.t0, start);
  for (Index i = 0; i < k_.cols(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    w_ = y;
    for (Index j = 0; j < i; ++j)
      if (const double a = tableau_.a[at][static_cast<std::size_t>(j)]; a != 0)
        w_ += step.h * a * k_.col(j);
    const double t = tableau_.c[at] == 1 ? step.t1 : step.t0 + tableau_.c[at] * step.h;
    if (!rhs(t, i == 0 ? first : w_.data(), k_.col(i).data(), stages_[at])) return false;
  }
  return true;
}

/// product_ = f_yᵀ w_ at a stage.
bool AdjointRun::times_slopes(std::size_t stage) {
  AdjointState& at = stages_[stage];
  ++products_;
  if (adjoint_.rates(at, w_, product_, by_parameters_)) {
    if (stage == 0)
      u_behind_ = at.u.size() > 0 ? at.u : Map<const VectorXd>(adjoint_.found_rates(), at.p.size());
    return true;
  }
  if (!adjoint_.solved(at)) {  // kept without its solution, which the sweeps did not need
    y_.resize(form_.size());
    y_ << at.q, at.p;
    if (!rhs(at.t, y_.data(), k_.col(0).data(), at)) return false;
    if (adjoint_.rates(at, w_, product_, by_parameters_)) return true;
  }
  return fail_at(at.t, dependent_loops);
}

bool AdjointRun::step(const RecordedRun& run, std::size_t number, const double* behind) {
  const RecordedRun::Step& step = run.steps()[number];
  // The state before a correction that is no change, if kept.
  const bool is_end = tableau_.first_is_end && form_.has_after_step() && number > 0 &&
                      !run.steps()[number - 1].altered && run.has_stages(number - 1);
  const double* first = is_end ? run.reached(number - 1) : run.start(number);
  const auto s = static_cast<Index>(stages_.size());
  const bool kept = run.has_stages(number) && !adjoint_.needs_solutions() &&
                    (run.rates(number, 0) || !(integral_ || adjoint_.needs_rates()));
  if (kept) {
    const Index n = form_.size() / 2;
    for (std::size_t i = 0; i < stages_.size(); ++i) {
      AdjointState& at = stages_[i];
      at.t = tableau_.c[i] == 1 ? step.t1 : step.t0 + tableau_.c[i] * step.h;
      const double* y = i == 0 ? first : run.stage(number, i);
      at.q = Map<const VectorXd>(y, n);
      at.p = Map<const VectorXd>(y + n, n);
      const double* u = run.rates(number, i);
      at.u = Map<const VectorXd>(u, u ? n : 0);
      at.sigma.resize(0);
    }
    if (form_.has_after_step()) {
      const Map<const VectorXd> reached(run.reached(number), form_.size());
      if (!after_step(step.t1, reached, behind)) return false;
    }
  } else {
    if (!stages_again(step, run.start(number), first)) return false;
    if (form_.has_after_step()) {
      VectorXd reached = Map<const VectorXd>(run.start(number), form_.size());
      for (Index j = 0; j < s; ++j)
        reached += step.h * tableau_.b[static_cast<std::size_t>(j)] * k_.col(j);
      if (!after_step(step.t1, reached, nullptr)) return false;
    }
  }
  if (ahead_.size() > 0) lambda_ += ahead_;
  ahead_.resize(0);
  for (Index i = s; i-- > 0;) {
    const auto at = static_cast<std::size_t>(i);
    w_ = step.h * tableau_.b[at] * lambda_;
    for (Index j = i + 1; j < s; ++j)
      if (const double a = tableau_.a[static_cast<std::size_t>(j)][at]; a != 0)
        w_ += step.h * a * m_.col(j);
    if (integral_) {
      const double weight = step.h * tableau_.b[at];
      value_ +=
          weight * g_.at(stages_[at].t, stages_[at].q, stages_[at].u, by_q_, by_u_, by_theta_);
      by_parameters_ += weight * by_theta_;
      w_.head(by_u_.size()) += weight * by_u_;
    }
    if (i == 0) u_behind_.resize(0);
    if (w_.isZero(0))  // a stage that serves the error alone
      product_.setZero(w_.size());
    else if (!times_slopes(at))
      return false;
    if (integral_) product_.head(by_q_.size()) += step.h * tableau_.b[at] * by_q_;
    m_.col(i) = product_;
  }
  if (is_end) {
    ahead_ = m_.col(0);
    m_.col(0).setZero();
  }
  for (Index i = 0; i < s; ++i) lambda_ += m_.col(i);
  return true;
}

bool AdjointRun::back(const RecordedRun& run, double t, const double* y,
                      const std::function<bool(double)>& going) {
  if (!integral_ && !end(t, y)) return false;
  for (std::size_t i = run.steps().size(); i-- > 0;) {
    const double* behind = i + 1 < run.steps().size() ? run.start(i + 1) : y;
    if (!step(run, i, behind)) return false;
    if (going && !going(run.steps()[i].t0)) {
      failure_ = "the observer ended the run";
      return false;
    }
  }
  return true;
}

}  // namespace momenta
