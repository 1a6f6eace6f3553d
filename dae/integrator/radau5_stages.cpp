#include <momenta/core/scalar/all_finite.h>
#include <momenta/dae/integrator/radau5_stages.h>

namespace momenta::radau5 {

Outcome Stages::solve(const Factors& f, double t, double h, const double* y,
                      const WeightedNorm& norm, double fraction, int most, StageValues& z) {
  for (std::size_t k = 0; k < n_; ++k)
    for (int i = 0; i < 3; ++i)
      w_[static_cast<std::size_t>(i)][k] =
          t_inverse_(i, 0) * z[0][k] + t_inverse_(i, 1) * z[1][k] + t_inverse_(i, 2) * z[2][k];
  contraction = std::pow(std::max(contraction, 1e-16), 0.8);
  double last = 0, last_ratio = 0;
  for (count = 1;; ++count) {
    ++iterations;
    for (int i = 0; i < 3; ++i) {
      const auto at = static_cast<std::size_t>(i);
      for (std::size_t k = 0; k < n_; ++k) argument_[k] = y[k] + z[at][k];
      rate(i, h, z, rate_.data());
      ++evaluations;
      if (!system_.residual(t + c[at] * h, argument_.data(), rate_.data(), r_[at].data()))
        return Outcome::evaluation_failed;
      if (!all_finite(r_[at].data(), n_)) return Outcome::not_finite;
    }
    for (std::size_t k = 0; k < n_; ++k) {
      const Eigen::Vector3d r = t_inverse_ * Eigen::Vector3d(r_[0][k], r_[1][k], r_[2][k]);
      r_[0][k] = -r[0];
      complex_[k] = {-r[1], -r[2]};
    }
    f.real->solve(r_[0].data());
    f.complex->solve(complex_.data());
    for (std::size_t k = 0; k < n_; ++k)
      r_[1][k] = complex_[k].real(), r_[2][k] = complex_[k].imag();
    const double size = std::sqrt(
        (norm.squares(r_[0].data()) + norm.squares(r_[1].data()) + norm.squares(r_[2].data())) /
        (3 * norm.count()));
    if (!std::isfinite(size)) return Outcome::not_finite;
    if (count > 1) {
      const double ratio = size / last;
      theta = count == 2 ? ratio : std::sqrt(ratio * last_ratio);
      last_ratio = ratio;
      // A good guess leaves its first corrections to the multipliers, which the norm does not see.
      const bool early = count <= 3 && size < 1;
      if (!(theta < 0.99) && !early && size > norm.rounding()) return Outcome::diverged;
      contraction = theta < 0.99 ? theta / (1 - theta) : 1;
      if (count < most && theta < 0.99 &&
          contraction * size * std::pow(theta, most - 1 - count) > fraction)
        return Outcome::slow;
    }
    last = std::max(size, 1e-16);
    for (std::size_t k = 0; k < n_; ++k) {
      for (std::size_t i = 0; i < 3; ++i) w_[i][k] += r_[i][k];
      const Eigen::Vector3d stage = t_ * Eigen::Vector3d(w_[0][k], w_[1][k], w_[2][k]);
      for (std::size_t i = 0; i < 3; ++i) z[i][k] = stage[static_cast<int>(i)];
    }
    if (contraction * size <= fraction) return Outcome::converged;
    if (count == most) return Outcome::slow;
  }
}

void Stages::filter(const Factors& f, double h, double* x) {
  std::fill(rate_.begin(), rate_.end(), 0.0);
  add_product(system_.pattern(), by_rate_, gamma / h, x, rate_);
  f.real->solve(rate_.data());
  std::copy(rate_.begin(), rate_.end(), x);
}

WholeStages::WholeStages(DaeSystem& system)
    : system_(system),
      n_(static_cast<std::size_t>(system.size())),
      inverse_(coefficients().inverse()),
      pattern_(pattern_of(system.pattern(), system.size())),
      matrix_(make_newton_matrix<double>(3 * system.size(), pattern_)),
      by_y_(entry_count(system.size(), system.pattern())),
      by_rate_(by_y_.size()),
      argument_(n_),
      rate_(n_),
      r_(3 * n_) {}

JacobianPattern WholeStages::pattern_of(const JacobianPattern& one, long n) {
  JacobianPattern all;
  if (one.column_start.empty()) return all;
  all.column_start.push_back(0);
  for (int j = 0; j < 3; ++j)
    for (std::size_t column = 0; column + 1 < one.column_start.size(); ++column) {
      for (long i = 0; i < 3; ++i)
        for (long k = one.column_start[column]; k < one.column_start[column + 1]; ++k)
          all.row.push_back(i * n + one.row[static_cast<std::size_t>(k)]);
      all.column_start.push_back(static_cast<long>(all.row.size()));
    }
  return all;
}

void WholeStages::place(double h, const double* y, const StageValues& z, std::size_t i) {
  const auto row = static_cast<Eigen::Index>(i);
  for (std::size_t k = 0; k < n_; ++k) {
    argument_[k] = y[k] + z[i][k];
    rate_[k] =
        (inverse_(row, 0) * z[0][k] + inverse_(row, 1) * z[1][k] + inverse_(row, 2) * z[2][k]) / h;
  }
}

bool WholeStages::differentiate(double t, double h, double rate_scale, const double* y,
                                const StageValues& z) {
  const JacobianPattern& one = system_.pattern();
  double* values = matrix_->values();
  for (std::size_t i = 0; i < 3; ++i) {
    place(h, y, z, i);
    ++jacobians;
    const double at = t + c[i] * h;
    if (!system_.jacobian(at, argument_.data(), rate_.data(), 0, by_y_.data()) ||
        !system_.jacobian(at, argument_.data(), rate_.data(), rate_scale, by_rate_.data()))
      return false;
    for (std::size_t j = 0; j < 3; ++j) {
      const double weight =
          inverse_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) / (h * rate_scale);
      for (std::size_t column = 0; column < n_; ++column) {
        // Column `column` of one block: where it begins, its length, and where it stands in all.
        const bool dense = one.column_start.empty();
        const auto first = dense ? column * n_ : static_cast<std::size_t>(one.column_start[column]);
        const auto count =
            dense ? n_ : static_cast<std::size_t>(one.column_start[column + 1]) - first;
        double* to = values + 3 * (j * by_y_.size() + first) + i * count;
        for (std::size_t k = 0; k < count; ++k)
          to[k] =
              (i == j ? by_y_[first + k] : 0.0) + weight * (by_rate_[first + k] - by_y_[first + k]);
      }
    }
  }
  return true;
}

Outcome WholeStages::solve(double t, double h, double rate_scale, const double* y,
                           const WeightedNorm& norm, double fraction, StageValues& z) {
  constexpr int most = 10;
  double last = 0;
  for (int count = 1; count <= most; ++count) {
    ++iterations;
    for (std::size_t i = 0; i < 3; ++i) {
      place(h, y, z, i);
      ++evaluations;
      if (!system_.residual(t + c[i] * h, argument_.data(), rate_.data(), r_.data() + i * n_))
        return Outcome::evaluation_failed;
    }
    if (!all_finite(r_.data(), r_.size())) return Outcome::not_finite;
    if (!differentiate(t, h, rate_scale, y, z)) return Outcome::evaluation_failed;
    if (!matrix_->factor()) return Outcome::diverged;
    matrix_->solve(r_.data());
    double squares = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      squares += norm.squares(r_.data() + i * n_);
      for (std::size_t k = 0; k < n_; ++k) z[i][k] -= r_[i * n_ + k];
    }
    const double size = std::sqrt(squares / (3 * norm.count()));
    if (!std::isfinite(size)) return Outcome::not_finite;
    // The second correction measures the first, which may lie outside the norm.
    if (count > 1 && (size <= fraction || size <= norm.rounding())) return Outcome::converged;
    if (count > 2 && size > last) return Outcome::diverged;
    last = size;
  }
  return Outcome::slow;
}

}  // namespace momenta::radau5
