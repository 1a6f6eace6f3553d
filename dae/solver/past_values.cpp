#include <momenta/dae/solver/past_values.h>

#include <algorithm>

namespace momenta {

PastValues::PastValues(int size, GaugeSymmetry* gauge)
    : size_(static_cast<std::size_t>(size)), gauge_(gauge) {
  for (Value& v : values_) {
    v.y.resize(size_);
    if (gauge_ != nullptr) v.directions.resize(static_cast<std::size_t>(gauge_->direction_entries()));
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

void PastValues::interpolate(double t, int degree, double* y, double* ydot) const {
  std::array<double, most> apart{};  // t − t_k
  for (int k = 0; k <= degree; ++k) apart[static_cast<std::size_t>(k)] = t - time(k);
  std::array<const double*, most> from{};
  for (int k = 0; k <= degree; ++k) from[static_cast<std::size_t>(k)] = value(k);
  const auto last = static_cast<std::size_t>(degree);
  std::array<std::array<double, most>, most> over{};  // 1/(t_k − t_{k+j})
  for (std::size_t j = 1; j <= last; ++j)
    for (std::size_t k = 0; k + j <= last; ++k) over[j][k] = 1 / (apart[k + j] - apart[k]);
  for (std::size_t i = 0; i < size_; ++i) {
    std::array<double, most> d;
    for (std::size_t k = 0; k <= last; ++k) d[k] = from[k][i];
    for (std::size_t j = 1; j <= last; ++j)
      for (std::size_t k = last; k >= j; --k) d[k] = (d[k - 1] - d[k]) * over[j][k - j];
    // d[j] is the difference of order j at the newest; Horner's rule, and its derivative.
    double sum = d[last], slope = 0;
    for (std::size_t j = last; j-- > 0;) {
      slope = slope * apart[j] + sum;
      sum = sum * apart[j] + d[j];
    }
    y[i] = sum;
    if (ydot != nullptr) ydot[i] = slope;
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
