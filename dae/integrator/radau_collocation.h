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
// not in the estimate, as ∂F/∂y' has no column for it. Order on y, on variables of index 2, of
// index 3: (2s − 1, s) in index-2 systems, (2s − 2, s, s − 1) in those of index 3.
// Source: Hairer, Lubich, Roche, The Numerical Solution of Differential-Algebraic Systems by
// Runge-Kutta Methods; Hairer, Wanner, Solving Ordinary Differential Equations II, IV.8.

#include <momenta/core/scalar/dual.h>
#include <momenta/dae/integrator/newton_matrix.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

namespace momenta {

/// c, A and the weights of p(0), from the nodes: roots of P_s − P_{s−1} on [−1, 1].
template <class S>
struct RadauNodes {
  explicit RadauNodes(std::size_t s) : c(s), at_start(s), a(s, std::vector<S>(s)) {
    std::size_t found = 0;
    constexpr int grid = 2000;
    for (int k = 0; k < grid && found + 1 < s; ++k) {
      const double from = -1 + 2.0 * k / grid, to = -1 + 2.0 * (k + 1) / grid;
      if ((value_of(difference(S(from), s)) > 0) == (value_of(difference(S(to), s)) > 0)) continue;
      S low = S(from), high = S(to);
      for (int half = 0; half < 120; ++half) {
        const S middle = S(0.5) * (low + high);
        const bool same =
            (value_of(difference(middle, s)) > 0) == (value_of(difference(low, s)) > 0);
        (same ? low : high) = middle;
      }
      c[found++] = S(0.5) * (S(1.0) + low);
    }
    c[s - 1] = S(1.0);
    for (std::size_t j = 0; j < s; ++j) {
      // ℓ_j by its coefficients, one linear factor at a time.
      std::vector<S> l(s + 1, S(0.0));
      l[0] = S(1.0);
      std::size_t degree = 0;
      for (std::size_t i = 0; i < s; ++i) {
        if (i == j) continue;
        const S scale = S(1.0) / (c[j] - c[i]);
        ++degree;
        for (std::size_t k = degree + 1; k-- > 0;)
          l[k] = scale * ((k > 0 ? l[k - 1] : S(0.0)) - c[i] * l[k]);
      }
      at_start[j] = l[0];
      for (std::size_t i = 0; i < s; ++i) {
        S integral = S(0.0);
        for (std::size_t k = s; k-- > 0;)
          integral = c[i] * (integral + l[k] / S(static_cast<double>(k + 1)));
        a[i][j] = integral;
      }
    }
  }

  std::vector<S> c, at_start;
  std::vector<std::vector<S>> a;

 private:
  /// P_s − P_{s−1} by the recursion of Legendre polynomials.
  static S difference(const S& x, std::size_t s) {
    S before = S(1.0), now = x;
    for (std::size_t k = 1; k < s; ++k) {
      const auto n = static_cast<double>(k);
      const S next = (S(2 * n + 1) * x * now - S(n) * before) / S(n + 1);
      before = now;
      now = next;
    }
    return now - before;
  }
};

/// `System` has residual(t, y, ydot, r) in S, of S t; slopes(t, y, ydot, by_y, by_rate) in doubles,
/// dense by columns; each false where it fails.
template <class S>
class RadauCollocation {
 public:
  /// `index` of each variable, from 1; `estimated`: whether it is in the estimate.
  RadauCollocation(std::vector<int> index, std::vector<char> estimated, std::size_t stages = 9)
      : RadauCollocation(index.size(), stages) {
    index_ = std::move(index);
    estimated_ = std::move(estimated);
  }

  RadauCollocation(const RadauCollocation&) = delete;
  RadauCollocation& operator=(const RadauCollocation&) = delete;

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
  /// Estimate of the last step that converged.
  double last_estimate() const { return estimate_; }

 private:
  RadauCollocation(std::size_t size, std::size_t stages)
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

  /// Iterates K to a last change of h K below `tolerance`.
  template <class System>
  bool iterate(const S& t, const S& h, const std::vector<S>& y, const std::vector<double>& scale,
               double tolerance, System& system) {
    // At index k the iteration takes up to k turns to gain: the error passes from one unknown to
    // the next.
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

/// y' = f(t, y) as F = y' − f, with ∂f/∂y by differences of half the digits.
template <class S>
class OdeRadauCollocation {
 public:
  explicit OdeRadauCollocation(std::size_t size)
      : scale_(size, 1.0),
        rate_(size),
        at_(size),
        f_(size),
        moved_(size),
        radau_(std::vector<int>(size, 1), std::vector<char>(size, 1)) {}

  /// y at t + h from y at t, in place, with an estimate below `tolerance` (1 + |y|) in every
  /// component; rhs(t, y, ydot) returns false where it fails. False, y untouched: h is too long.
  /// O((s size)³)
  template <class Rhs>
  bool step(double t, double h, std::vector<S>& y, double tolerance, Rhs&& rhs) {
    Residual<Rhs> f{*this, rhs};
    return rhs(t, y.data(), rate_.data()) &&
           radau_.step(S(t), S(h), y, rate_, scale_, tolerance, f);
  }

 private:
  template <class Rhs>
  struct Residual {
    OdeRadauCollocation& room;
    Rhs& rhs;

    bool residual(const S& t, const S* y, const S* ydot, S* r) {
      if (!rhs(value_of(t), y, r)) return false;
      for (std::size_t i = 0; i < room.f_.size(); ++i) r[i] = ydot[i] - r[i];
      return true;
    }
    bool slopes(double t, const double* y, const double*, double* by_y, double* by_rate) {
      const std::size_t n = room.f_.size();
      std::copy_n(y, n, room.at_.begin());
      std::fill_n(by_rate, n * n, 0.0);
      if (!rhs(t, room.at_.data(), room.f_.data())) return false;
      for (std::size_t k = 0; k < n; ++k) {
        const S width = S(room.increment_ * (1 + std::abs(y[k])));
        room.at_[k] = S(y[k]) + width;
        if (!rhs(t, room.at_.data(), room.moved_.data())) return false;
        for (std::size_t i = 0; i < n; ++i)
          by_y[k * n + i] = value_of((room.f_[i] - room.moved_[i]) / width);
        by_rate[k * n + k] = 1;
        room.at_[k] = S(y[k]);
      }
      return true;
    }
  };

  static double half_of_the_digits() {
    double epsilon = 1;
    while (value_of((S(1.0) + S(epsilon / 2)) - S(1.0)) > 0) epsilon /= 2;
    return std::sqrt(epsilon);
  }

  double increment_ = half_of_the_digits();  ///< relative to 1 + |y|
  std::vector<double> scale_;
  std::vector<S> rate_, at_, f_, moved_;
  RadauCollocation<S> radau_;
};

}  // namespace momenta
