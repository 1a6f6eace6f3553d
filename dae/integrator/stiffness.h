#pragma once
// Stiffness: steps of an explicit method held by its stability and not by its tolerance.
//
// The last stage g_s and the end y_1 of a step belong to the same time, so
//
//   h ρ = h |f(y_1) − f(g_s)| / |y_1 − g_s|
//
// estimates h |λ| of the dominant eigenvalue at no evaluation more. Where it stays at the end of
// the method's real stability interval, step after step, the problem is stiff. The interval is that
// of the stability function R(z) = 1 + z Σ b_j k_j, k_i = 1 + z Σ a_ij k_j, itself: the first z < 0
// with |R| > 1. Source: Hairer, Wanner, Solving Ordinary Differential Equations II, IV.2.

#include <momenta/dae/integrator/memory.h>

#include <cmath>
#include <cstddef>
#include <limits>

namespace momenta::explicit_rk {

/// Length of the real stability interval. Some 10⁴ operations: for the compiler.
template <class Tableau>
consteval double stability_interval() {
  constexpr std::size_t s = Tableau::stages;
  for (double z = 0.02;; z += 0.02) {
    double k[s + 1]{};
    for (std::size_t i = 0; i <= s; ++i) {
      k[i] = 1;
      for (std::size_t j = 0; j < i; ++j) k[i] -= z * Tableau::a[i][j] * k[j];
    }
    if (!(k[s] >= -1 && k[s] <= 1)) return z;  // row s of a is b: k_s = R
  }
}

/// Counts steps at the stability limit as HW's codes do: 15 before six in a row elsewhere.
class Stiffness {
 public:
  explicit Stiffness(double interval) : limit_(0.9 * interval) {}

  /// Whether to look at this step: one in 32, all once one was at the limit.
  bool looks(long step) const { return std::isnan(from_) && (suspects_ > 0 || step % 32 == 0); }
  /// Takes h ρ of a step that began at t.
  void take(double h_rho, double t) {
    if (h_rho > limit_) {
      if (suspects_++ == 0) first_ = t;
      clear_ = 0;
      if (suspects_ == 15) from_ = first_;
    } else if (suspects_ > 0 && ++clear_ == 6) {
      suspects_ = clear_ = 0;
    }
  }
  /// Since when the problem is stiff [s]; NaN: it is not.
  double from() const { return from_; }

  void carry(Memory& memory) { memory(suspects_), memory(clear_), memory(first_), memory(from_); }

 private:
  double limit_;
  int suspects_ = 0, clear_ = 0;
  double first_ = 0, from_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace momenta::explicit_rk
