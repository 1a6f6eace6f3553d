#pragma once
// q ∘ exp δ: the coordinates that constant rates δ reach from q in a unit of time. Exact where q' =
// u; for quaternions one step of the classical Runge-Kutta method, fourth order in δ, normalised to
// unit length.

#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <vector>

namespace momenta {

class CoordinateMotion {
 public:
  explicit CoordinateMotion(const Mechanism& mechanism)
      : mechanism_(mechanism),
        stage_(static_cast<std::size_t>(mechanism.nq())),
        rate_(stage_.size()) {}

  /// q and moved (nq), delta (nv); they may not overlap.
  void move(const Evaluation<double>& e, const double* q, const double* delta, double* moved) {
    const std::size_t n = stage_.size();
    std::copy_n(q, n, moved);
    if (!mechanism_.plan().quasi_velocities) {
      e.coordinate_rates(q, delta, rate_.data());
      for (std::size_t i = 0; i < n; ++i) moved[i] += rate_[i];
      return;
    }
    constexpr std::array<double, 4> ahead{0.5, 0.5, 1, 0},
        weight{1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
    std::copy_n(q, n, stage_.data());
    for (std::size_t k = 0; k < 4; ++k) {
      e.coordinate_rates(stage_.data(), delta, rate_.data());
      for (std::size_t i = 0; i < n; ++i) {
        moved[i] += weight[k] * rate_[i];
        stage_[i] = q[i] + ahead[k] * rate_[i];
      }
    }
    for (const auto& b : mechanism_.tree().bodies) {
      if (!b.has_quaternion()) continue;
      Eigen::Map<Eigen::Vector4d>(moved + b.q + (b.nq - 4)).normalize();
    }
  }

 private:
  const Mechanism& mechanism_;
  std::vector<double> stage_, rate_;
};

}  // namespace momenta
