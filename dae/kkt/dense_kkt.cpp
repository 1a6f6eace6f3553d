// Small systems. u is eliminated before σ: M = Lᵀ D L along the tree, G = L⁻ᵀΦ_qᵀ, W = Gᵀ D⁻¹ G =
// Φ_q M⁻¹ Φ_qᵀ, then W = Σ l_k d_k l_kᵀ by scalar eliminations, largest remaining diagonal first.
// In this order and form the error of u is about ε/δ near a pose where a singular value δ of Φ_q
// M^(−1/2) vanishes, as small as any algorithm can make it: W squares the condition of σ, not of u.
//
// Each pivot is inverted as f(d) = d³/(d⁴ + τ⁴), zero for d ≤ 0: exact to (τ/d)⁴ above τ, fading to
// zero below. With σ = centre + σ' only σ' fades, so a faded row keeps the impulse it had at the
// step's start.

#include <momenta/dae/kkt/axis_scale.h>
#include <momenta/dae/kkt/kkt.h>
#include <momenta/dae/kkt/tree_factor.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

class DenseKkt final : public Kkt {
 public:
  explicit DenseKkt(const Mechanism& mechanism)
      : pattern_(mechanism.kkt_pattern()),
        groups_(mechanism.row_groups()),
        axis_scale_(mechanism),
        n_(mechanism.nv()),
        m_(mechanism.m()),
        mass_(pattern_.mass.size()),
        constraint_(pattern_.constraint.size()),
        factor_(pattern_, n_),
        g_(size(m_, n_)),
        scaled_(size(m_, n_)),
        w_(size(m_, m_)),
        inverse_(size(m_, 1)),
        order_(size(m_, 1)),
        y_(size(n_, 1)),
        d_(size(m_, 1)),
        tau_(size(m_, 1)),
        natural_(size(m_, 1)),
        group_sum_(groups_.empty() ? 0
                                   : static_cast<std::size_t>(
                                         *std::max_element(groups_.begin(), groups_.end()) + 1)),
        group_rows_(group_sum_.size()) {
    for (int group : groups_) ++group_rows_[static_cast<std::size_t>(group)];
    faded_rows_.reserve(static_cast<std::size_t>(m_));
  }

  bool factor(Evaluation<double>& e, double fade) override {
    ++factorizations_;
    e.mass_entries(mass_.data());
    e.constraint_entries(constraint_.data());
    stuck_ = factor_.factor(mass_);
    if (stuck_ >= 0) return false;
    std::fill(g_.begin(), g_.end(), 0.0);
    for (std::size_t i = 0; i < constraint_.size(); ++i)
      g_[at(pattern_.constraint[i].row, pattern_.constraint[i].column, n_)] = constraint_[i];
    const double* inverse_pivot = factor_.inverse_pivots().data();
    for (int i = 0; i < m_; ++i) {
      double *g = &g_[at(i, 0, n_)], *scaled = &scaled_[at(i, 0, n_)];
      factor_.inward(g);
      for (int j = 0; j < n_; ++j) scaled[j] = inverse_pivot[j] * g[j];
    }
    return eliminate_loops(fade);
  }

  bool solve(const double* r, const double* g, const double* centre, double* u,
             double* sigma) override {
    std::copy(r, r + n_, y_.begin());
    factor_.inward(y_.data());
    if (centre)
      for (int i = 0; i < m_; ++i)
        for (int j = 0; j < n_; ++j) y_[idx(j)] -= g_[at(i, j, n_)] * centre[i];
    for (int i = 0; i < m_; ++i) {
      double d = -g[i];
      for (int j = 0; j < n_; ++j) d += scaled_[at(i, j, n_)] * y_[idx(j)];
      d_[idx(i)] = d;
    }
    for (int k = 0; k < m_; ++k) {
      const int row = order_[idx(k)];
      for (int i = k + 1; i < m_; ++i)
        d_[idx(order_[idx(i)])] -=
            w_[at(order_[idx(i)], row, m_)] * inverse_[idx(k)] * d_[idx(row)];
    }
    for (int k = m_; k-- > 0;) {
      const int row = order_[idx(k)];
      double s = d_[idx(row)];
      for (int i = k + 1; i < m_; ++i) s -= w_[at(order_[idx(i)], row, m_)] * sigma[order_[idx(i)]];
      sigma[row] = inverse_[idx(k)] * s;
    }
    for (int i = 0; i < m_; ++i)
      for (int j = 0; j < n_; ++j) y_[idx(j)] -= g_[at(i, j, n_)] * sigma[i];
    for (int j = 0; j < n_; ++j) u[j] = factor_.inverse_pivots()[idx(j)] * y_[idx(j)];
    factor_.outward(u);
    bool finite = true;
    for (int j = 0; j < n_; ++j) finite &= std::isfinite(u[j]);
    for (int i = 0; i < m_; ++i) {
      if (centre) sigma[i] += centre[i];
      finite &= std::isfinite(sigma[i]);
    }
    return finite;
  }

 private:
  static std::size_t size(int a, int b) {
    return static_cast<std::size_t>(a) * static_cast<std::size_t>(b);
  }
  static std::size_t idx(int i) { return static_cast<std::size_t>(i); }
  static std::size_t at(int i, int j, int columns) { return size(i, columns) + idx(j); }

  bool eliminate_loops(double fade) {
    std::fill(group_sum_.begin(), group_sum_.end(), 0.0);
    axis_scale_.measure(mass_, natural_);
    for (int i = 0; i < m_; ++i) {
      for (int j = 0; j <= i; ++j) {
        double s = 0;
        for (int k = 0; k < n_; ++k) s += g_[at(i, k, n_)] * scaled_[at(j, k, n_)];
        w_[at(i, j, m_)] = w_[at(j, i, m_)] = s;
      }
      if (compliance_) w_[at(i, i, m_)] += compliance_[idx(i)];
      group_sum_[idx(groups_[idx(i)])] += std::max(w_[at(i, i, m_)], natural_[idx(i)]);
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
        if (w_[at(order_[idx(i)], order_[idx(i)], m_)] >
            w_[at(order_[idx(best)], order_[idx(best)], m_)])
          best = i;
      std::swap(order_[idx(k)], order_[idx(best)]);
      const int row = order_[idx(k)];
      const double d = w_[at(row, row, m_)], tau = compliance_ ? 0 : tau_[idx(row)];
      inverse_[idx(k)] = d > 0 ? inverse_faded(d, tau) : 0;
      if (!(d > 10 * tau))
        faded_rows_.push_back(row);
      else if (tau > 0)
        weakest_ = std::min(weakest_, d * fade / tau);
      for (int i = k + 1; i < m_; ++i) {
        const int a = order_[idx(i)];
        const double l = w_[at(a, row, m_)] * inverse_[idx(k)];
        for (int j = k + 1; j <= i; ++j) {
          const int b = order_[idx(j)];
          w_[at(a, b, m_)] -= l * w_[at(b, row, m_)];
          w_[at(b, a, m_)] = w_[at(a, b, m_)];
        }
      }
    }
    return true;
  }
  /// d³/(d⁴ + τ⁴), written so that no power under- or overflows.
  static double inverse_faded(double d, double tau) {
    const double ratio = tau / d;
    const double squared = ratio * ratio;
    return 1 / (d * (1 + squared * squared));
  }

  const KktPattern& pattern_;
  const std::vector<int>& groups_;
  AxisScale axis_scale_;
  int n_, m_;
  std::vector<double> mass_, constraint_;
  TreeFactor factor_;
  std::vector<double> g_;       ///< m × n: row i is L⁻ᵀ times column i of Φ_qᵀ
  std::vector<double> scaled_;  ///< m × n: the same times D⁻¹
  std::vector<double> w_;       ///< m × m: W, its columns as they stood when eliminated
  std::vector<double> inverse_;
  std::vector<int> order_;
  std::vector<double> y_, d_, tau_, natural_, group_sum_;
  std::vector<int> group_rows_;
};

}  // namespace

std::unique_ptr<Kkt> make_dense_kkt(const Mechanism& mechanism) {
  return std::make_unique<DenseKkt>(mechanism);
}

std::unique_ptr<Kkt> make_kkt(const Mechanism& mechanism) {
  if (mechanism.dense_kkt()) return make_dense_kkt(mechanism);
  return mechanism.tips_first() ? make_sparse_kkt(mechanism) : make_klu_kkt(mechanism);
}

}  // namespace momenta
