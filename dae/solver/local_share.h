#pragma once
// The share of the tolerance that one step may spend.
//
// N steps add up N local errors. On most motions they cancel for the larger part, and a tolerance
// for each step serves; on an undamped oscillation they do not: a formula damps or excites it, each
// period alike, and what it does to the energy grows with the number of periods. A spring of 10⁸
// N m/rad in a four-bar takes 7·10⁵ steps for 10 s. So from N₀ = 10⁴ steps in a run on, counted as
// they would be at the present length, N local errors add up to no more than N₀ tolerances:
//
//   error of a step ≤ tol min(1, N₀ h̄/T),   T the span of the run, h̄ a mean of the last steps:
//
// error per step below, error per unit step above (Hairer, Nørsett, Wanner, Solving Ordinary
// Differential Equations I, II.4). h̄ forgets over a thousand steps, and begins at T/N₀: were it the
// step tried, each rejection would make the test harder, and a start at short steps impossible.
// Rounding is left alone: no share is less than 10³ ε/rtol.

#include <algorithm>
#include <limits>

namespace momenta {

class LocalShare {
 public:
  /// For a run over `span` [s] at a relative tolerance.
  LocalShare(double span, double rtol)
      : span_(span),
        least_(std::min(1.0, 1e3 * std::numeric_limits<double>::epsilon() / rtol)),
        mean_(span / steps) {}

  /// The share, between 0 and 1.
  double now() const { return std::clamp(steps * mean_ / span_, least_, 1.0); }
  /// Notes a step of h [s].
  void passed(double h) { mean_ += (std::min(h, span_ / steps) - mean_) / memory; }

 private:
  static constexpr double steps = 1e4, memory = 1e3;
  double span_, least_, mean_;
};

}  // namespace momenta
