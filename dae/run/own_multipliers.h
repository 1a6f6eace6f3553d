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
//
// Their integral from the start, the impulses of the loops, has no gauge in it either,
//
//   ∫λ dt = Δσ + ∫κσ dt,
//
// Δσ summed over the steps where a gauge jumps between them, else σ less that of the start. The
// integrals are those of the polynomial.

#include <momenta/dae/form/form.h>
#include <momenta/dae/integrator/integration.h>
#include <momenta/dae/integrator/lagrange_basis.h>
#include <momenta/dae/integrator/memory.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace momenta {

class OwnMultipliers {
 public:
  /// `sums`: for impulses(), with step() called after every step.
  OwnMultipliers(Form& form, int m, bool sums)
      : form_(form), impulses_(form.momentum_like()), sums_(sums), m_(m), lambda_(m) {
    if (sums) total_ = first_ = Eigen::VectorXd::Zero(m);
    for (std::size_t k = 0; k <= n; ++k)
      points_[k] = 0.5 * (1 - std::cos(static_cast<double>(k) * std::numbers::pi / n));
  }

  /// Whether step() has to see every step.
  bool sums() const { return sums_; }

  /// Reads the state at n + 1 points of the step just taken; without impulse multipliers only for
  /// impulses(). `state`: work space for the integrator's.
  void step(double t0, double t1, const Interpolant& between, std::vector<double>& state) {
    if (!impulses_ && !sums_) return;
    if (sums_) settle();
    from_ = t0, end_ = t1;
    known_ = true;
    for (std::size_t k = 0; k <= n && known_; ++k) {
      const double t = t0 + points_[k] * (t1 - t0);
      between(t, state.data());
      known_ = form_.read(t, state.data(), nullptr, there_);
      sigma_[k] = there_.multipliers;
    }
    if (sums_ && !begun_ && known_) begun_ = true, first_ = sigma_[0];
    lost_ |= !known_;
  }

  /// λ at a time in that step (m), `multipliers`: the form's there; empty: unknown, as before the
  /// first step of a momentum form.
  const Eigen::VectorXd& at(double t, const Eigen::VectorXd& multipliers) {
    if (!impulses_) return lambda_ = multipliers;
    const double length = end_ - from_, x = (t - from_) / length;
    constexpr double rounding = 1e-9;
    if (!known_ || !(x >= -rounding && x <= 1 + rounding)) return lambda_ = Eigen::VectorXd();
    const double kappa = leak();
    lambda_.setZero(m_);
    for (std::size_t k = 0; k <= n; ++k) {
      const auto [value, slope] =
          lagrange_basis(static_cast<int>(n) + 1, static_cast<int>(k), x,
                         [this](int j) { return points_[static_cast<std::size_t>(j)]; });
      lambda_ += (slope / length + kappa * value) * sigma_[k];
    }
    return lambda_;
  }

  /// ∫λ dt up to a time in the last step (m); empty: unknown. Zero before the first step.
  /// @pre sums
  Eigen::VectorXd impulses(double t) const {
    if (lost_) return {};
    if (!known_) return begun_ ? Eigen::VectorXd() : Eigen::VectorXd::Zero(m_);
    const double x = (t - from_) / (end_ - from_);
    return total_ + gained(x) + (impulses_ && !jumps() ? value(x) - first_ : none());
  }
  void carry(Memory& memory) {
    if (!sums_) return;
    Eigen::VectorXd total = known_ ? total_ + gained(1) : total_;
    const auto size = static_cast<std::size_t>(m_);
    memory(total.data(), size), memory(first_.data(), size), memory(begun_), memory(lost_);
    if (memory.reads()) total_ = total;
  }

 private:
  static constexpr std::size_t n = 6;

  Eigen::VectorXd none() const { return Eigen::VectorXd::Zero(m_); }
  double leak() const { return form_.gauge().kind == Gauge::Kind::leak ? form_.gauge().kappa : 0; }
  bool jumps() const {
    const Gauge::Kind kind = form_.gauge().kind;
    return kind == Gauge::Kind::reset || kind == Gauge::Kind::flip;
  }
  /// The polynomial at a fraction of the step.
  Eigen::VectorXd value(double x) const {
    Eigen::VectorXd sum = none();
    for (std::size_t k = 0; k <= n; ++k)
      sum += lagrange_basis(static_cast<int>(n) + 1, static_cast<int>(k), x,
                            [this](int j) { return points_[static_cast<std::size_t>(j)]; })
                 .value *
             sigma_[k];
    return sum;
  }
  /// From the step's start to a fraction of it: ∫λ dt or ∫κσ dt by four Gauss points, exact to
  /// degree 7, and changes of σ in a gauge with jumps.
  Eigen::VectorXd gained(double x) const {
    constexpr std::array<double, 4> at{0.069431844202973712, 0.33000947820757187,
                                       0.66999052179242813, 0.93056815579702629},
        weight{0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693};
    Eigen::VectorXd sum = none();
    const double factor = impulses_ ? leak() : 1;
    for (std::size_t i = 0; i < at.size() && factor != 0; ++i)
      sum += factor * x * (end_ - from_) * weight[i] * value(x * at[i]);
    if (impulses_ && jumps()) sum += value(x) - sigma_[0];
    return sum;
  }
  /// Adds the last step to the total.
  void settle() {
    if (known_) total_ += gained(1);
    known_ = false;
  }

  Form& form_;
  bool impulses_, sums_, known_ = false, begun_ = false, lost_ = false;
  int m_;
  double from_ = 0, end_ = 0;
  std::array<double, n + 1> points_{};
  std::array<Eigen::VectorXd, n + 1> sigma_;
  Snapshot there_;
  Eigen::VectorXd lambda_, total_, first_;
};

}  // namespace momenta
