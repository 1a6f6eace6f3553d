#include <momenta/core/scalar/all_finite.h>
#include <momenta/dae/integrator/bdf_step.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace momenta {
namespace {

GaugeSymmetry* gauge_of(DaeSystem& system) {
  auto* gauge = dynamic_cast<GaugeSymmetry*>(&system);
  return gauge != nullptr && gauge->impulse_count() > 0 ? gauge : nullptr;
}

}  // namespace

BdfStep::BdfStep(DaeSystem& system, double rtol, double atol)
    : system_(system),
      gauge_(gauge_of(system)),
      newton_(system),
      past_(system.size(), gauge_ != nullptr && gauge_->resets() ? gauge_ : nullptr),
      rtol_(rtol),
      atol_(atol),
      n_(static_cast<std::size_t>(system.size())) {
  for (auto* v :
       {&y_, &ydot_, &predicted_, &change_, &delta_, &weight_, &begin_ydot_, &rate_, &rest_})
    v->resize(n_);
}

void BdfStep::begin(double t, double* y, double* ydot) {
  if (gauge_ != nullptr && gauge_->resets()) gauge_->reset(t, y, ydot);
  past_.begin(t, y);
  std::copy_n(y, n_, y_.begin());
  std::copy_n(ydot, n_, ydot_.begin());
  begin_ydot_ = ydot_;
  straight_ = true;
  made_for_ = 0;
}

BdfStep::Outcome BdfStep::attempt(double t1, int order, bool renew, Test test) {
  past_.reset();
  t1_ = t1;
  h_ = t1 - past_.time(0);
  if (straight_) {
    for (std::size_t i = 0; i < n_; ++i) y_[i] = past_.value(0)[i] - h_ * begin_ydot_[i];
    past_.put(1, past_.time(0) - h_, y_.data());
  }
  past_.interpolate(t1, order, y_.data(), ydot_.data());
  predicted_ = y_;
  std::fill(change_.begin(), change_.end(), 0.0);
  weigh(t1, test.share);
  double alpha = 0, sum = 0;
  for (int i = 1; i <= order; ++i) {
    alpha += 1.0 / i;
    sum += h_ / (t1 - past_.time(i - 1));
  }
  const double c = alpha / h_;
  renewed_ = renew || !(std::max(c, made_for_) <= most_change * std::min(c, made_for_));
  if (renewed_) {
    ++counters_.jacobians;
    ++counters_.factorizations;
    made_for_ = 0;
    switch (newton_.make(t1, y_.data(), ydot_.data(), c)) {
      case DaeNewton::Made::not_evaluated:
        return Outcome::not_evaluated;
      case DaeNewton::Made::not_finite:
        return Outcome::not_finite;
      case DaeNewton::Made::singular:
        return Outcome::singular;
      case DaeNewton::Made::yes:
        break;
    }
    made_for_ = c;
    contraction_ = 20;
  }
  const Outcome outcome = correct(t1, c);
  if (outcome != Outcome::solved) return outcome;
  const double next = h_ / (t1 - past_.time(order)), change = norm(change_.data());
  error_ = std::max(next, std::abs(next - alpha + sum)) * change;
  left_ = error_ > 1 ? left(test.filters) / change : 1;
  if (!(left_ < stiff)) left_ = 1;
  error_ *= left_;
  terms_.fill(-1);
  if (gauge_ != nullptr) {
    const double coordinates = std::sqrt(gauge_->coordinate_squares(change_.data()));
    term_ratio_ = coordinates > 0 ? change / coordinates : 0;
  }
  double factor = 1;
  for (int i = 0; i <= order; ++i) factor *= (i + 1) * h_ / (t1 - past_.time(i));
  terms_[static_cast<std::size_t>(order)] = factor * left_ * change;
  return std::isfinite(error_) ? outcome : Outcome::not_finite;
}

BdfStep::Outcome BdfStep::correct(double t1, double c) {
  // Rows of F with c and rows without want different corrections of an old matrix; this is the
  // mean.
  const double damping = 2 / (1 + c / made_for_);
  double first = 0, last = 0;
  for (int count = 0; count < most_corrections; ++count) {
    ++counters_.evaluations;
    ++counters_.newton_iterations;
    if (!system_.residual(t1, y_.data(), ydot_.data(), delta_.data()))
      return Outcome::not_evaluated;
    newton_.solve(delta_.data());
    for (std::size_t i = 0; i < n_; ++i) {
      const double d = damping * delta_[i];
      delta_[i] = d;
      change_[i] -= d;
      y_[i] = predicted_[i] + change_[i];
      ydot_[i] -= c * d;
    }
    const double size = by_component(delta_.data());
    if (!std::isfinite(size)) return Outcome::not_finite;
    if (count == 0) {
      first = size;
      if (size <= 1e-4 * newton_fraction) return Outcome::solved;
    } else {
      const double rate = std::pow(size / first, 1.0 / count);
      if (size > slowest * last) break;
      contraction_ = std::max(rate / (1 - rate), fastest);
    }
    if (contraction_ * size <= newton_fraction) return Outcome::solved;
    last = size;
  }
  // The rest may be rounding, mostly a change of gauge.
  return norm(delta_.data()) <= rounding ? Outcome::solved : Outcome::not_converged;
}

double BdfStep::left(int filters) {
  counters_.evaluations += 1 + filters;
  const double unknown = std::numeric_limits<double>::infinity();
  if (!system_.residual(t1_, y_.data(), ydot_.data(), rest_.data())) return unknown;
  delta_ = change_;
  for (int k = 0; k < filters; ++k) {
    for (std::size_t i = 0; i < n_; ++i) rate_[i] = ydot_[i] + made_for_ * delta_[i];
    if (!system_.residual(t1_, y_.data(), rate_.data(), delta_.data())) return unknown;
    for (std::size_t i = 0; i < n_; ++i) delta_[i] -= rest_[i];
    newton_.solve(delta_.data());
  }
  return norm(delta_.data());
}

double BdfStep::term(int j) {
  double& known = terms_[static_cast<std::size_t>(j)];
  if (known >= 0) return known;
  double factor = 1;
  for (int i = 1; i <= j + 1; ++i) factor *= i * h_;
  factor *= left_;
  past_.difference(t1_, y_.data(), j + 1, delta_.data());
  if (gauge_ == nullptr) return known = factor * norm(delta_.data());
  return known = factor * term_ratio_ * std::sqrt(gauge_->coordinate_squares(delta_.data()));
}

void BdfStep::accept() {
  past_.add(t1_, y_.data());
  straight_ = false;
}

void BdfStep::weigh(double t, double share) {
  const double rtol = share * rtol_, atol = share * atol_;
  if (gauge_ != nullptr) gauge_->measure_at(t, y_.data(), ydot_.data(), rtol, atol);
  for (std::size_t i = 0; i < n_; ++i) {
    const int at = static_cast<int>(i);
    weight_[i] = system_.differential(at)
                     ? 1 / (atol * system_.scale(at) + rtol * std::abs(past_.value(0)[i]))
                     : 0;
  }
}

double BdfStep::norm(const double* e) {
  return gauge_ != nullptr ? std::sqrt(gauge_->motion_squares(e)) : by_component(e);
}

double BdfStep::by_component(const double* e) const {
  double sum = 0;
  int kept = 0;
  for (std::size_t i = 0; i < n_; ++i) {
    if (weight_[i] == 0) continue;
    const double x = weight_[i] * e[i];
    sum += x * x;
    ++kept;
  }
  return std::sqrt(sum / std::max(kept, 1));
}

}  // namespace momenta
