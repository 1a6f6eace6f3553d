#pragma once
// y inside a step of an explicit Runge-Kutta method, from its stages. With Δ = y_new − y,
// θ = (t' − t)/h:
//
//   y(θ) = r_0 + θ(r_1 + (1−θ)(r_2 + θ(r_3 + (1−θ)(r_4 + …)))),
//   r_0 = y, r_1 = Δ, r_2 = h k_0 − Δ, r_3 = Δ − h k_s − r_2, r_{4+i} = h Σ_j d_ij k_j,
//
// k_s = f at the end; the first four terms are the Hermite cubic. Source: Hairer, Norsett, Wanner,
// Solving Ordinary Differential Equations I, II.6.

#include <momenta/dae/integrator/aligned_array.h>
#include <momenta/dae/integrator/stage_sum.h>

#include <cstddef>
#include <utility>

namespace momenta::explicit_rk {

template <class Tableau>
class DenseOutput {
  static constexpr std::size_t s = Tableau::stages, terms = 4 + Tableau::dense_rows;

 public:
  explicit DenseOutput(std::size_t n) : n_(n), stride_(padded(n)), r_(terms * stride_) {}

  /// Sets the polynomial of a step of length h; `k`: all stages, those of dense output included,
  /// padded(n) apart. y and y_new are as long.
  void set(const double* y, const double* y_new, double h, const double* k) {
    for (std::size_t i = 0; i < stride_; ++i) {
      const double delta = y_new[i] - y[i], bend = h * k[i] - delta;
      r_[i] = y[i];
      r_[stride_ + i] = delta;
      r_[2 * stride_ + i] = bend;
      r_[3 * stride_ + i] = delta - h * k[s * stride_ + i] - bend;
    }
    further(h, k, std::make_index_sequence<Tableau::dense_rows>{});
  }
  /// y at θ, n values.
  void at(double theta, double* out) const {
    const double rest = 1 - theta;
    for (std::size_t i = 0; i < n_; ++i) {
      double value = r_[(terms - 1) * stride_ + i];
      for (std::size_t j = terms - 1; j-- > 0;)
        value = r_[j * stride_ + i] + (j % 2 == 0 ? theta : rest) * value;
      out[i] = value;
    }
  }
  /// Terms of the polynomial, for a check that they are finite.
  const double* entries() const { return r_.data(); }
  std::size_t size() const { return terms * stride_; }

 private:
  template <std::size_t... row>
  void further([[maybe_unused]] double h, [[maybe_unused]] const double* k,
               std::index_sequence<row...>) {
    (
        [&] {
          for (std::size_t i = 0; i < stride_; i += width)
            store(r_.data() + (4 + row) * stride_ + i,
                  h * stage_sum<Tableau::d, row>(k + i, stride_));
        }(),
        ...);
  }

  std::size_t n_, stride_;
  AlignedArray r_;
};

}  // namespace momenta::explicit_rk
