#include <momenta/core/scalar/all_finite.h>
#include <momenta/dae/solver/radau5_stages.h>

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

}  // namespace momenta::radau5
