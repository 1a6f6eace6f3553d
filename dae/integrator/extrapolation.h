#pragma once
// Gragg's method: the midpoint rule with n = 2, 4, 6, … substeps, extrapolated to n = ∞. Column k
// is of order 2k; columns are added until two agree. Of any scalar, so that it serves references in
// quadruple precision, where tableaux end at 30 digits.
//
//   T_{j,1} = midpoint rule with n_j = 2j substeps
//   T_{j,k+1} = T_{j,k} + (T_{j,k} − T_{j−1,k}) / ((n_j / n_{j−k})² − 1)
//
// Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, II.9.

#include <array>
#include <cmath>
#include <vector>

namespace momenta {

template <class S>
class Extrapolation {
 public:
  static constexpr std::size_t columns = 14;

  explicit Extrapolation(std::size_t size)
      : size_(size), first_(size), before_(size), now_(size), rate_(size) {
    for (auto& row : row_) row.resize(size);
  }

  /// y at t + h from y at t, in place, with a local error below `tolerance` (1 + |y|) in every
  /// component; rhs(t, y, ydot) returns false where it fails. False, y untouched: h is too long.
  template <class Rhs>
  bool step(double t, double h, std::vector<S>& y, double tolerance, Rhs&& rhs) {
    if (!rhs(t, y.data(), first_.data())) return false;
    for (std::size_t j = 0; j < columns; ++j) {
      if (!midpoint(t, h, y, j + 1, rhs)) return false;
      // row_[k] is T_{j−1,k+1} before, T_{j,k+1} after.
      double error = 0;
      for (std::size_t i = 0; i < size_; ++i) {
        S newer = now_[i];
        for (std::size_t k = 0; k < j; ++k) {
          const S older = row_[k][i];
          row_[k][i] = newer;
          const S ratio = S(static_cast<double>(j + 1)) / S(static_cast<double>(j - k));
          newer += (newer - older) / (ratio * ratio - S(1.0));
        }
        row_[j][i] = newer;
        if (j == 0) continue;
        const double last = std::abs(value_of(newer - row_[j - 1][i])),
                     relative = last / (1 + std::abs(value_of(y[i])));
        if (!(relative <= error)) error = relative;
      }
      if (!std::isfinite(error)) return false;
      if (j >= 2 && error <= tolerance) {
        y = row_[j];
        return true;
      }
    }
    return false;
  }

 private:
  /// now_ = midpoint rule with 2 `pairs` substeps.
  template <class Rhs>
  bool midpoint(double t, double h, const std::vector<S>& y, std::size_t pairs, Rhs& rhs) {
    const double n = 2 * static_cast<double>(pairs);
    const S part = S(h) / S(n);
    before_ = y;
    for (std::size_t i = 0; i < size_; ++i) now_[i] = y[i] + part * first_[i];
    for (std::size_t k = 1; k < 2 * pairs; ++k) {
      if (!rhs(t + static_cast<double>(k) * h / n, now_.data(), rate_.data())) return false;
      for (std::size_t i = 0; i < size_; ++i) {
        const S next = before_[i] + S(2.0) * part * rate_[i];
        before_[i] = now_[i];
        now_[i] = next;
      }
    }
    return true;
  }

  std::size_t size_;
  std::vector<S> first_, before_, now_, rate_;
  std::array<std::vector<S>, columns> row_;
};

}  // namespace momenta
