#include <momenta/dae/integrator/lagrange_basis.h>
#include <momenta/dae/integrator/past_values.h>

#include <algorithm>

namespace momenta {

PastValues::PastValues(int size, GaugeSymmetry* gauge)
    : size_(static_cast<std::size_t>(size)), gauge_(gauge) {
  for (Value& v : values_) {
    v.y.resize(size_);
    if (gauge_ != nullptr)
      v.directions.resize(static_cast<std::size_t>(gauge_->direction_entries()));
  }
  if (gauge_ != nullptr) c_.resize(static_cast<std::size_t>(gauge_->impulse_count()));
}

void PastValues::begin(double t, const double* y) {
  count_ = 0;
  put(0, t, y);
}

void PastValues::add(double t, const double* y) {
  newest_ = (newest_ + most - 1) % most;
  count_ = std::min(count_ + 1, most);
  put(0, t, y);
}

void PastValues::put(int k, double t, const double* y) {
  Value& v = at(k);
  v.t = t;
  std::copy_n(y, size_, v.y.data());
  if (gauge_ != nullptr) gauge_->gauge_directions(t, y, v.directions.data());
  count_ = std::max(count_, k + 1);
}

void PastValues::shift(const double* c) {
  if (gauge_ == nullptr) return;
  for (int k = 0; k < count_; ++k) gauge_->shift(at(k).directions.data(), c, at(k).y.data());
}

void PastValues::reset() {
  if (gauge_ == nullptr) return;
  const double* sigma = gauge_->impulses(value(0));
  std::transform(sigma, sigma + c_.size(), c_.begin(), [](double s) { return -s; });
  shift(c_.data());
}

/// ω = y_0 + Σ_{k>0} ℓ_k (y_k − y_0), ℓ_k Lagrange's polynomials, whose sum is one: roundings are
/// those of the differences.
void PastValues::interpolate(double t, int degree, double* y, double* ydot) const {
  const double* newest = value(0);
  std::copy_n(newest, size_, y);
  if (ydot != nullptr) std::fill_n(ydot, size_, 0.0);
  for (int k = 1; k <= degree; ++k) {
    const auto [part, slope] = lagrange_basis(degree + 1, k, t, [this](int j) { return time(j); });
    const double* from = value(k);
    if (ydot == nullptr) {
      for (std::size_t i = 0; i < size_; ++i) y[i] += part * (from[i] - newest[i]);
      continue;
    }
    for (std::size_t i = 0; i < size_; ++i) {
      const double apart = from[i] - newest[i];
      y[i] += part * apart;
      ydot[i] += slope * apart;
    }
  }
}

void PastValues::difference(double t, const double* y, int order, double* result) const {
  const auto last = static_cast<std::size_t>(order);
  std::array<double, most + 1> times{t};
  std::array<const double*, most + 1> from{y};
  for (int k = 0; k < order; ++k) {
    times[static_cast<std::size_t>(k) + 1] = time(k);
    from[static_cast<std::size_t>(k) + 1] = value(k);
  }
  // Lagrange's weights 1/Π (t_k − t_j).
  std::array<double, most + 1> weight{};
  for (std::size_t k = 0; k <= last; ++k) {
    double product = 1;
    for (std::size_t j = 0; j <= last; ++j)
      if (j != k) product *= times[k] - times[j];
    weight[k] = 1 / product;
  }
  std::fill_n(result, size_, 0.0);
  for (std::size_t k = 0; k <= last; ++k)
    for (std::size_t i = 0; i < size_; ++i) result[i] += weight[k] * from[k][i];
}

}  // namespace momenta
