#pragma once
// λ as a form itself has it, without a solution of (3): the multipliers in its state, or, of
// momentum forms, whose multipliers are impulses,
//
//   λ = σ̇ + κσ,
//
// from σ of (7) at the Chebyshev-Lobatto points of a step, x_k = (1 − cos(kπ/n))/2 with n = 6: the
// derivative of the polynomial through them. Within a step a gauge by jumps (reset, flip) is at
// rest, and κ = 0 there. Errors of σ enter divided by the step length h: rounding of σ, some ε|p|
// whatever the gauge, since σ is what (7) leaves of p, becomes noise of up to
// 2n² ε|p|/h, and an error of σ of order h^(p+1) one of order h^p.

#include <momenta/dae/form/form.h>
#include <momenta/dae/solver/integration.h>
#include <momenta/dae/solver/lagrange_basis.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace momenta {

class OwnMultipliers {
 public:
  OwnMultipliers(Form& form, int m)
      : form_(form), impulses_(form.momentum_like()), m_(m), lambda_(m) {
    for (std::size_t k = 0; k <= n; ++k)
      points_[k] = 0.5 * (1 - std::cos(static_cast<double>(k) * std::numbers::pi / n));
  }

  /// Looks at the step that was just taken; of momentum forms only, n + 1 solutions of (7).
  /// `state`: room for one of the integrator's.
  void step(double t0, double t1, const Interpolant& between, std::vector<double>& state) {
    if (!impulses_) return;
    from_ = t0, end_ = t1;
    known_ = true;
    for (std::size_t k = 0; k <= n && known_; ++k) {
      const double t = t0 + points_[k] * (t1 - t0);
      between(t, state.data());
      known_ = form_.read(t, state.data(), nullptr, there_);
      sigma_[k] = there_.multipliers;
    }
  }

  /// λ at a time in that step (m), `multipliers` the form's there; empty: not known, as before the
  /// first step of a momentum form.
  const Eigen::VectorXd& at(double t, const Eigen::VectorXd& multipliers) {
    if (!impulses_) return lambda_ = multipliers;
    const double length = end_ - from_, x = (t - from_) / length;
    constexpr double rounding = 1e-9;
    if (!known_ || !(x >= -rounding && x <= 1 + rounding)) return lambda_ = Eigen::VectorXd();
    const double kappa = form_.gauge().kind == Gauge::Kind::leak ? form_.gauge().kappa : 0;
    lambda_.setZero(m_);
    for (std::size_t k = 0; k <= n; ++k) {
      const auto [value, slope] =
          lagrange_basis(static_cast<int>(n) + 1, static_cast<int>(k), x,
                         [this](int j) { return points_[static_cast<std::size_t>(j)]; });
      lambda_ += (slope / length + kappa * value) * sigma_[k];
    }
    return lambda_;
  }

 private:
  static constexpr std::size_t n = 6;

  Form& form_;
  bool impulses_, known_ = false;
  int m_;
  double from_ = 0, end_ = 0;
  std::array<double, n + 1> points_{};
  std::array<Eigen::VectorXd, n + 1> sigma_;
  Snapshot there_;
  Eigen::VectorXd lambda_;
};

}  // namespace momenta
