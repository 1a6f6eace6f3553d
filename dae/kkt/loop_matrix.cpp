#include <momenta/dae/kkt/factor/faded_pivot.h>
#include <momenta/dae/kkt/loop_matrix.h>

#include <algorithm>
#include <cmath>

namespace momenta {
LoopMatrix::LoopMatrix(const Mechanism& mechanism)
    : groups_(mechanism.row_groups()),
      m_(mechanism.m()),
      w_(idx(m_) * idx(m_)),
      inverse_(idx(m_)),
      tau_(idx(m_)),
      group_sum_(groups_.empty() ? 0 : idx(*std::max_element(groups_.begin(), groups_.end()) + 1)),
      order_(idx(m_)),
      group_rows_(group_sum_.size()) {
  for (const int group : groups_) ++group_rows_[idx(group)];
  faded_rows_.reserve(idx(m_));
}

bool LoopMatrix::eliminate(double fade, const double* natural, const double* compliance) {
  std::fill(group_sum_.begin(), group_sum_.end(), 0.0);
  for (int i = 0; i < m_; ++i) {
    for (int j = 0; j < i; ++j) at(j, i) = at(i, j);
    if (compliance) at(i, i) += compliance[i];
    group_sum_[idx(groups_[idx(i)])] += std::max(at(i, i), natural[i]);
    order_[idx(i)] = i;
  }
  for (int i = 0; i < m_; ++i) {
    const auto group = idx(groups_[idx(i)]);
    tau_[idx(i)] = fade * group_sum_[group] / group_rows_[group];
    if (!std::isfinite(tau_[idx(i)])) return false;
  }
  faded_rows_.clear();
  weakest_ = 1;
  for (int k = 0; k < m_; ++k) {
    int best = k;
    for (int i = k + 1; i < m_; ++i)
      if (at(order_[idx(i)], order_[idx(i)]) > at(order_[idx(best)], order_[idx(best)])) best = i;
    std::swap(order_[idx(k)], order_[idx(best)]);
    const int row = order_[idx(k)];
    const double d = at(row, row), tau = compliance ? 0 : tau_[idx(row)];
    inverse_[idx(k)] = faded_inverse(d, tau);
    if (!(d > 10 * tau))
      faded_rows_.push_back(row);
    else if (tau > 0)
      weakest_ = std::min(weakest_, d * fade / tau);
    for (int i = k + 1; i < m_; ++i) {
      const int a = order_[idx(i)];
      const double l = at(a, row) * inverse_[idx(k)];
      for (int j = k + 1; j <= i; ++j) {
        const int b = order_[idx(j)];
        at(a, b) -= l * at(b, row);
        at(b, a) = at(a, b);
      }
    }
  }
  return true;
}

void LoopMatrix::solve(double* d, double* sigma) const {
  for (int k = 0; k < m_; ++k) {
    const int row = order_[idx(k)];
    for (int i = k + 1; i < m_; ++i)
      d[order_[idx(i)]] -= w_[place(order_[idx(i)], row)] * inverse_[idx(k)] * d[row];
  }
  for (int k = m_; k-- > 0;) {
    const int row = order_[idx(k)];
    double s = d[row];
    for (int i = k + 1; i < m_; ++i) s -= w_[place(order_[idx(i)], row)] * sigma[order_[idx(i)]];
    sigma[row] = inverse_[idx(k)] * s;
  }
}

}  // namespace momenta
