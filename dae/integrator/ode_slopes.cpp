#include <momenta/core/scalar/all_finite.h>
#include <momenta/dae/integrator/ode_slopes.h>
#include <momenta/dae/integrator/stopping.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace momenta {

int OdeSlopes::unknowns() const {
  return local_ ? static_cast<int>(local_->pattern().column_start.size()) - 1 : size();
}
const JacobianPattern& OdeSlopes::pattern() const {
  return local_ ? local_->pattern() : dense_;
}
int OdeSlopes::version() const {
  return local_ ? local_->version() : 0;
}

bool OdeSlopes::evaluate(double t, const double* y, double rate) {
  if (!asked_) local_ = system_.local();
  asked_ = true;
  if (!rates(t, y, f_) || !(local_ ? of_equations(t, y, rate) : by_differences(t, y))) return false;
  if (all_finite(by_y_.data(), by_y_.size()) && all_finite(by_rate_.data(), by_rate_.size()))
    return true;
  cause_ = "the Jacobian is not finite";
  return false;
}

bool OdeSlopes::rates(double t, const double* y, std::vector<double>& f) {
  ++evaluations_;
  if (system_.rhs(t, y, f.data())) return true;
  cause_ = evaluation_cause(system_.failure());
  return false;
}

bool OdeSlopes::of_equations(double t, const double* y, double rate) {
  cause_ = "the Jacobian is not finite";
  if (!local_->evaluate(t, y, f_.data(), rate)) return false;
  by_rate_ = local_->values();
  const int version = local_->version();
  if (!local_->evaluate(t, y, f_.data(), 0)) return false;
  if (local_->version() != version)
    throw std::logic_error("the pattern of a local matrix depends on c");
  by_y_ = local_->values();
  for (std::size_t k = 0; k < by_y_.size(); ++k) by_rate_[k] = (by_rate_[k] - by_y_[k]) / rate;
  return true;
}

bool OdeSlopes::by_differences(double t, const double* y) {
  const std::size_t n = f_.size();
  by_y_.resize(n * n);
  moved_.resize(n);
  y_.assign(y, y + n);
  if (by_rate_.empty()) {
    by_rate_.assign(n * n, 0.0);
    for (std::size_t i = 0; i < n; ++i) by_rate_[i * n + i] = 1;
  }
  for (std::size_t column = 0; column < n; ++column) {
    const double kept = y_[column];
    y_[column] += std::sqrt(std::numeric_limits<double>::epsilon()) *
                  (system_.scale(static_cast<int>(column)) + std::abs(kept));
    const double step = y_[column] - kept;
    if (!rates(t, y_.data(), moved_)) return false;
    for (std::size_t i = 0; i < n; ++i) by_y_[column * n + i] = (f_[i] - moved_[i]) / step;
    y_[column] = kept;
  }
  return true;
}

template <class Scalar>
bool Resolvent<Scalar>::factor(const OdeSlopes& slopes, Scalar s) {
  slopes_ = &slopes;
  if (!matrix_ || version_ != slopes.version()) {
    matrix_.reset();
    version_ = slopes.version();
    matrix_ = slopes.pattern().column_start.empty()
                  ? make_newton_matrix<Scalar>(slopes.size(), slopes.pattern())
                  : make_local_matrix<Scalar>(slopes.pattern());
    work_.resize(static_cast<std::size_t>(slopes.unknowns()));
  }
  Scalar* values = matrix_->values();
  const std::vector<double>&by_y = slopes.by_y(), &by_rate = slopes.by_rate();
  for (std::size_t k = 0; k < by_y.size(); ++k) values[k] = by_rate[k] + s * by_y[k];
  return matrix_->factor();
}

template <class Scalar>
void Resolvent<Scalar>::solve(Scalar* r) {
  const JacobianPattern& pattern = slopes_->pattern();
  if (pattern.column_start.empty()) return matrix_->solve(r);  // G₁ = 1
  const auto n = static_cast<std::size_t>(slopes_->size());
  const std::vector<double>& by_rate = slopes_->by_rate();
  std::fill(work_.begin(), work_.end(), Scalar(0));
  for (std::size_t column = 0; column < n; ++column)
    for (auto k = static_cast<std::size_t>(pattern.column_start[column]);
         k < static_cast<std::size_t>(pattern.column_start[column + 1]); ++k)
      work_[static_cast<std::size_t>(pattern.row[k])] += by_rate[k] * r[column];
  matrix_->solve(work_.data());
  std::copy_n(work_.begin(), n, r);
}

template class Resolvent<double>;
template class Resolvent<std::complex<double>>;

}  // namespace momenta
