#include <momenta/dae/integrator/filtered_error.h>

#include <algorithm>
#include <cmath>

namespace momenta {

FilteredError::FilteredError(DaeSystem& system)
    : system_(system),
      n_(static_cast<std::size_t>(system.size())),
      matrix_(make_newton_matrix<double>(system.size(), system.pattern())),
      by_y_(entry_count(system.size(), system.pattern())),
      by_rate_(by_y_.size()),
      filtered_(n_) {}

bool FilteredError::at(double t, const double* y, const double* ydot, double c) {
  c_ = 0;
  if (!system_.jacobian(t, y, ydot, 0, by_y_.data()) ||
      !system_.jacobian(t, y, ydot, c, matrix_->values()))
    return false;
  for (std::size_t i = 0; i < by_y_.size(); ++i)
    by_rate_[i] = (matrix_->values()[i] - by_y_[i]) / c;
  if (!matrix_->factor()) return false;
  c_ = c;
  return true;
}

double FilteredError::norm(const double* e, const double* weights, double h) {
  if (c_ > 0) {
    std::fill(filtered_.begin(), filtered_.end(), 0.0);
    add_product(system_.pattern(), by_rate_, c_, e, filtered_);
    matrix_->solve(filtered_.data());
  } else {
    std::copy_n(e, n_, filtered_.begin());
  }
  double sum = 0;
  for (std::size_t i = 0; i < n_; ++i) {
    if (!system_.differential(static_cast<int>(i))) continue;
    const int power = system_.weight(static_cast<int>(i)).power;
    const double part = system_.unfiltered_part(static_cast<int>(i));
    const double error =
        weights[i] * std::pow(h, power) * std::max(std::abs(filtered_[i]), std::abs(part * e[i]));
    sum += error * error;
  }
  return std::sqrt(sum / static_cast<double>(n_));
}

}  // namespace momenta
