#pragma once
// Collocation at the s nodes of Radau IIA for F(t, y, y') = 0, to more digits than doubles have:
// values of any scalar, Newton's matrix in doubles. The unknowns are the rates K_i at the nodes,
//
//   F(t + c_i h, Y_i, K_i) = 0,   Y_i = y + h Σ_j a_ij K_j,            y(t + h) = Y_s, c_s = 1
//   (1 ⊗ ∂F/∂y' + h A ⊗ ∂F/∂y) ΔK = −F,                          matrices of the start
//
// so that the end of a step meets F to the last digit, algebraic equations with it. The estimate is
// that of the polynomial p through the K_i, carried back to the start,
//
//   e = h γ (∂F/∂y' + h γ ∂F/∂y)⁻¹ ∂F/∂y' (y' − p(0)),   γ = a_ss,
//
// of order s. Errors of a variable of index k are one power of h worse for each index above 1: in
// the norms of estimate and iteration they count h^(k−1) times, and where it has no rate in F it is
// not in the estimate, as ∂F/∂y' has no column for it. Order on y, on variables
// of index 2, of index 3: 2s − 1, s in index-2 systems, 2s − 2, s, s − 1 in those of index 3.
// Source: Hairer, Lubich, Roche, The Numerical Solution of Differential-Algebraic Systems by
// Runge-Kutta Methods; Hairer, Wanner, Solving Ordinary Differential Equations II, IV.8.

#include <momenta/dae/solver/radau_collocation.h>

#include <array>

namespace momenta {

/// `System` has size(); residual(t, y, ydot, r) in S, of S t; and slopes(t, y, ydot, by_y, by_rate)
/// in doubles, dense by columns; each false where it fails.
template <class S>
class RadauDaeCollocation {
 public:
  /// `index` of each variable, from 1; `estimated`: whether it is in the estimate.
  RadauDaeCollocation(std::vector<int> index, std::vector<char> estimated, std::size_t stages = 9)
      : RadauDaeCollocation(index.size(), stages) {
    index_ = std::move(index);
    estimated_ = std::move(estimated);
  }

  RadauDaeCollocation(const RadauDaeCollocation&) = delete;
  RadauDaeCollocation& operator=(const RadauDaeCollocation&) = delete;

  /// (y, y') at t + h from that at t, in place, with an estimate below `tolerance` in units of
  /// scale + |y|. False, both untouched: h is too long. O((s size)³)
  template <class System>
  bool step(const S& t, const S& h, std::vector<S>& y, std::vector<S>& ydot,
            const std::vector<double>& scale, double tolerance, System& system) {
    if (!factor(t, h, y, ydot, system)) return false;
    for (auto& k : k_) k = ydot;
    if (!iterate(t, h, y, scale, 1e-4 * tolerance, system)) return false;
    estimate_ = estimate(h, y, ydot, scale);
    if (!(estimate_ <= tolerance)) return false;
    place(s_ - 1, h, y);
    y = at_;
    ydot = k_[s_ - 1];
    return true;
  }
  /// Of the last step that converged.
  double last_estimate() const { return estimate_; }

 private:
  RadauDaeCollocation(std::size_t size, std::size_t stages)
      : n_(size),
        s_(stages),
        nodes_(stages),
        by_y_(size * size),
        by_rate_(size * size),
        right_(stages * size),
        row_(stages * size),
        at_(size),
        r_(size),
        k_(stages, std::vector<S>(size)),
        newton_(make_newton_matrix<double>(static_cast<int>(stages * size), none_)),
        filter_(make_newton_matrix<double>(static_cast<int>(size), none_)) {}

  static constexpr int most_iterations = 60;
  /// h^(k−1) of variable l of index k.
  double weight(std::size_t l, double h) const { return std::pow(h, index_[l] - 1); }
  double gamma() const { return value_of(nodes_.a[s_ - 1][s_ - 1]); }

  template <class System>
  bool factor(const S& t, const S& h, const std::vector<S>& y, const std::vector<S>& ydot,
              System& system) {
    std::vector<double> point(n_), rate(n_);
    for (std::size_t i = 0; i < n_; ++i) point[i] = value_of(y[i]), rate[i] = value_of(ydot[i]);
    if (!system.slopes(value_of(t), point.data(), rate.data(), by_y_.data(), by_rate_.data()))
      return false;
    const double length = value_of(h);
    const std::size_t size = s_ * n_;
    double *newton = newton_->values(), *filter = filter_->values();
    std::fill(row_.begin(), row_.end(), 0.0);
    for (std::size_t j = 0; j < s_; ++j)
      for (std::size_t c = 0; c < n_; ++c)
        for (std::size_t i = 0; i < s_; ++i)
          for (std::size_t l = 0; l < n_; ++l) {
            double& entry = newton[(j * n_ + c) * size + i * n_ + l];
            entry = ((i == j ? by_rate_[c * n_ + l] : 0.0) +
                     length * value_of(nodes_.a[i][j]) * by_y_[c * n_ + l]) /
                    weight(c, length);
            row_[i * n_ + l] = std::max(row_[i * n_ + l], std::abs(entry));
          }
    // With rates of index k in units of h^(1−k), and rows brought to one size, the matrix stays
    // regular for short steps.
    for (double& largest : row_) largest = largest > 0 ? largest : 1.0;
    for (std::size_t c = 0; c < size; ++c)
      for (std::size_t l = 0; l < size; ++l) newton[c * size + l] /= row_[l];
    for (std::size_t c = 0; c < n_; ++c)
      for (std::size_t l = 0; l < n_; ++l)
        filter[c * n_ + l] = by_rate_[c * n_ + l] + length * gamma() * by_y_[c * n_ + l];
    return newton_->factor() && filter_->factor();
  }

  /// at_ = Y_i.
  void place(std::size_t i, const S& h, const std::vector<S>& y) {
    for (std::size_t l = 0; l < n_; ++l) {
      S sum = S(0.0);
      for (std::size_t j = 0; j < s_; ++j) sum += nodes_.a[i][j] * k_[j][l];
      at_[l] = y[l] + h * sum;
    }
  }

  /// K to a last change of h K below `tolerance`.
  template <class System>
  bool iterate(const S& t, const S& h, const std::vector<S>& y, const std::vector<double>& scale,
               double tolerance, System& system) {
    // Of index k the iteration takes up to k turns to gain: what one unknown misses the next one
    // takes over.
    std::array<double, 3> before{};
    const double length = value_of(h);
    for (int count = 0; count < most_iterations; ++count) {
      for (std::size_t i = 0; i < s_; ++i) {
        place(i, h, y);
        if (!system.residual(t + h * nodes_.c[i], at_.data(), k_[i].data(), r_.data()))
          return false;
        for (std::size_t l = 0; l < n_; ++l)
          right_[i * n_ + l] = -value_of(r_[l]) / row_[i * n_ + l];
      }
      newton_->solve(right_.data());
      double change = 0;
      for (std::size_t i = 0; i < s_; ++i)
        for (std::size_t l = 0; l < n_; ++l) {
          const double weighed = right_[i * n_ + l];
          k_[i][l] += S(weighed / weight(l, length));
          const double relative =
              std::abs(length * weighed) / (scale[l] + std::abs(value_of(y[l])));
          if (!std::isfinite(relative)) return false;
          change = std::max(change, relative);
        }
      if (change <= tolerance) return true;
      double& earlier = before[static_cast<std::size_t>(count) % before.size()];
      if (count > 3 && change > 0.5 * earlier) return false;
      earlier = change;
    }
    return false;
  }

  double estimate(const S& h, const std::vector<S>& y, const std::vector<S>& ydot,
                  const std::vector<double>& scale) {
    std::vector<double> apart(n_), filtered(n_, 0.0);
    for (std::size_t l = 0; l < n_; ++l) {
      S sum = ydot[l];
      for (std::size_t j = 0; j < s_; ++j) sum -= nodes_.at_start[j] * k_[j][l];
      apart[l] = value_of(h) * gamma() * value_of(sum);
    }
    for (std::size_t c = 0; c < n_; ++c)
      for (std::size_t l = 0; l < n_; ++l) filtered[l] += by_rate_[c * n_ + l] * apart[c];
    filter_->solve(filtered.data());
    double largest = 0;
    for (std::size_t l = 0; l < n_; ++l) {
      if (!estimated_[l]) continue;
      const double relative =
          std::abs(filtered[l]) * weight(l, value_of(h)) / (scale[l] + std::abs(value_of(y[l])));
      if (!std::isfinite(relative)) return relative;
      largest = std::max(largest, relative);
    }
    return largest;
  }

  std::size_t n_, s_;
  RadauNodes<S> nodes_;
  std::vector<int> index_;
  std::vector<char> estimated_;
  std::vector<double> by_y_, by_rate_, right_, row_;
  std::vector<S> at_, r_;
  std::vector<std::vector<S>> k_;  ///< stage by stage
  JacobianPattern none_;           ///< dense
  std::unique_ptr<NewtonMatrix<double>> newton_, filter_;
  double estimate_ = 0;
};

}  // namespace momenta
