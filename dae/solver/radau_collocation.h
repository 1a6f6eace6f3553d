#pragma once
// Collocation at the s nodes of Radau IIA, of order 2s − 1, for stiff motions to more digits than
// doubles have: values of any scalar, Newton's matrix in doubles. With Z_i = y(t + c_i h) − y
//
//   Z_i = h Σ_j a_ij f(t + c_j h, y + Z_j),                      y(t + h) = y + Z_s, c_s = 1
//   (1 − h A ⊗ J) ΔZ = h (A ⊗ 1) F(Z) − Z,                       J = ∂f/∂y at the start
//
// Residuals have the scalar's digits, the matrix has those of a double: each iteration takes away
// what J has not changed by, whatever the digits asked for. The estimate is that of the polynomial
// p through f at the nodes, carried back to the start,
//
//   e = h γ (1 − h γ J)⁻¹ (f(t, y) − p(0)),   γ = a_ss,
//
// of order s, so that errors are well below it, and filtered so that stiff components do not make
// it larger than it is. Source: Hairer, Wanner, Solving Ordinary Differential Equations II, IV.5,
// IV.8.

#include <momenta/core/scalar/dual.h>
#include <momenta/dae/solver/newton_matrix.h>

#include <algorithm>
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

template <class S>
class RadauCollocation {
 public:
  static constexpr std::size_t stages = 9;

  explicit RadauCollocation(std::size_t size)
      : n_(size),
        increment_(half_of_the_digits()),
        first_(size),
        at_(size),
        jacobian_(size * size),
        right_(stages * size),
        z_(stages, std::vector<S>(size)),
        f_(stages, std::vector<S>(size)),
        newton_(make_newton_matrix<double>(static_cast<int>(stages * size), none_)),
        filter_(make_newton_matrix<double>(static_cast<int>(size), none_)) {}

  RadauCollocation(const RadauCollocation&) = delete;
  RadauCollocation& operator=(const RadauCollocation&) = delete;

  /// y at t + h from y at t, in place, with an estimate below `tolerance` (1 + |y|) in every
  /// component; rhs(t, y, ydot) returns false where it fails. False, y untouched: h is too long.
  /// O((s size)³)
  template <class Rhs>
  bool step(double t, double h, std::vector<S>& y, double tolerance, Rhs&& rhs) {
    if (!differentiate(t, y, rhs) || !factor(h)) return false;
    for (auto& z : z_) std::fill(z.begin(), z.end(), S(0.0));
    if (!iterate(t, h, y, 1e-3 * tolerance, rhs) || !(estimate(h, y) <= tolerance)) return false;
    for (std::size_t i = 0; i < n_; ++i) y[i] += z_[stages - 1][i];
    return true;
  }

 private:
  static constexpr int most_iterations = 40;

  static double half_of_the_digits() {
    double epsilon = 1;
    while (value_of((S(1.0) + S(epsilon / 2)) - S(1.0)) > 0) epsilon /= 2;
    return std::sqrt(epsilon);
  }

  /// f and J at the start, J by columns.
  template <class Rhs>
  bool differentiate(double t, const std::vector<S>& y, Rhs& rhs) {
    if (!rhs(t, y.data(), first_.data())) return false;
    at_ = y;
    auto& moved = f_[0];
    for (std::size_t k = 0; k < n_; ++k) {
      const S width = S(increment_ * (1 + std::abs(value_of(y[k]))));
      at_[k] = y[k] + width;
      if (!rhs(t, at_.data(), moved.data())) return false;
      for (std::size_t i = 0; i < n_; ++i)
        jacobian_[k * n_ + i] = value_of((moved[i] - first_[i]) / width);
      at_[k] = y[k];
    }
    return true;
  }

  bool factor(double h) {
    const std::size_t size = stages * n_;
    double *newton = newton_->values(), *filter = filter_->values();
    for (std::size_t j = 0; j < stages; ++j)
      for (std::size_t k = 0; k < n_; ++k)
        for (std::size_t i = 0; i < stages; ++i) {
          const double weight = h * value_of(nodes_.a[i][j]);
          for (std::size_t l = 0; l < n_; ++l)
            newton[(j * n_ + k) * size + i * n_ + l] =
                (i == j && k == l ? 1.0 : 0.0) - weight * jacobian_[k * n_ + l];
        }
    for (std::size_t k = 0; k < n_; ++k)
      for (std::size_t l = 0; l < n_; ++l)
        filter[k * n_ + l] = (k == l ? 1.0 : 0.0) - h * gamma() * jacobian_[k * n_ + l];
    return newton_->factor() && filter_->factor();
  }
  double gamma() const { return value_of(nodes_.a[stages - 1][stages - 1]); }

  /// Z to a last change below `tolerance`.
  template <class Rhs>
  bool iterate(double t, double h, const std::vector<S>& y, double tolerance, Rhs& rhs) {
    double before = 0;
    for (int count = 0; count < most_iterations; ++count) {
      for (std::size_t j = 0; j < stages; ++j) {
        for (std::size_t i = 0; i < n_; ++i) at_[i] = y[i] + z_[j][i];
        if (!rhs(t + h * value_of(nodes_.c[j]), at_.data(), f_[j].data())) return false;
      }
      for (std::size_t i = 0; i < stages; ++i)
        for (std::size_t l = 0; l < n_; ++l) {
          S sum = S(0.0);
          for (std::size_t j = 0; j < stages; ++j) sum += nodes_.a[i][j] * f_[j][l];
          right_[i * n_ + l] = value_of(S(h) * sum - z_[i][l]);
        }
      newton_->solve(right_.data());
      double change = 0;
      for (std::size_t i = 0; i < stages; ++i)
        for (std::size_t l = 0; l < n_; ++l) {
          const double dz = right_[i * n_ + l];
          z_[i][l] += S(dz);
          const double relative = std::abs(dz) / (1 + std::abs(value_of(y[l])));
          if (!std::isfinite(relative)) return false;
          change = std::max(change, relative);
        }
      if (change <= tolerance) return true;
      if (count > 1 && change > 0.5 * before) return false;
      before = change;
    }
    return false;
  }

  double estimate(double h, const std::vector<S>& y) {
    for (std::size_t l = 0; l < n_; ++l) {
      S sum = first_[l];
      for (std::size_t j = 0; j < stages; ++j) sum -= nodes_.at_start[j] * f_[j][l];
      right_[l] = h * gamma() * value_of(sum);
    }
    filter_->solve(right_.data());
    double largest = 0;
    for (std::size_t l = 0; l < n_; ++l) {
      const double relative = std::abs(right_[l]) / (1 + std::abs(value_of(y[l])));
      if (!std::isfinite(relative)) return relative;
      largest = std::max(largest, relative);
    }
    return largest;
  }

  std::size_t n_;
  double increment_;  ///< of J's differences, over 1 + |y|
  RadauNodes<S> nodes_{stages};
  std::vector<S> first_, at_;
  std::vector<double> jacobian_, right_;
  std::vector<std::vector<S>> z_, f_;  ///< stage by stage
  JacobianPattern none_;               ///< dense
  std::unique_ptr<NewtonMatrix<double>> newton_, filter_;
};

}  // namespace momenta
