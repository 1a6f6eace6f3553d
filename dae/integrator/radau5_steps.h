#pragma once
// The next step of Radau IIA by Gustafsson's prediction:
//
//   h_new = h min(s err^(−1/4), s h/h_old (err_old/err²)^(1/4)),   1/8 ≤ h_new/h ≤ 8,
//
// s = 0.9, less where Newton's method took many iterations; kept where it would grow by less than a
// fifth, with its factors. Source: Hairer, Wanner, Solving Ordinary Differential Equations II,
// IV.8.

#include <momenta/dae/integrator/gauge_symmetry.h>
#include <momenta/dae/integrator/radau5_stages.h>
#include <momenta/dae/integrator/radau5_tableau.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace momenta::radau5 {

class Prediction {
 public:
  static constexpr int most_iterations = 7;  ///< Newton iterations

  /// h over the next step, by this step's error alone.
  static double divisor(double error, int iterations) {
    const double caution =
        std::min(safety, safety * (1 + 2 * most_iterations) / (iterations + 2 * most_iterations));
    return std::clamp(std::pow(std::max(error, 1e-20), 0.25) / caution, 1 / grow, 1 / shrink);
  }
  /// The next step over h, after an accepted one; `first`: of the run, `rejected`: before.
  double factor(double h, double error, double divisor, bool first, bool rejected) {
    if (!first) {
      const double predicted = before_ / h * std::pow(error * error / error_before_, 0.25) / safety;
      divisor = std::max(divisor, std::clamp(predicted, 1 / grow, 1 / shrink));
    }
    before_ = h;
    error_before_ = std::max(1e-2, error);
    return rejected ? std::min(1 / divisor, 1.0) : 1 / divisor;
  }
  /// Whether the step is kept rather than changed by this factor.
  static bool keeps(double factor) { return factor >= 1 && factor <= 1.2; }

 private:
  static constexpr double safety = 0.9, shrink = 0.125, grow = 8;
  double before_ = 0, error_before_ = 1;
};

// Gauge reset between steps of Radau IIA: σ leaves p, and by the same constant what the last step
// foresees of the next. Any two stages differ in the new gauge as in the old but by
// (Φ_q(q_i) − Φ_q(q_0))ᵀσ. See gauge_symmetry.h.

class StagesInGauge {
 public:
  explicit StagesInGauge(GaugeSymmetry& gauge)
      : gauge_(gauge),
        directions_(static_cast<std::size_t>(gauge.direction_entries())),
        constant_(static_cast<std::size_t>(gauge.impulse_count())) {}

  /// Goes into the gauge in which σ of y is zero: y0 at t0 and z, the stages of a step of length h
  /// from there.
  void shift(const double* y, double t0, double h, std::vector<double>& y0, StageValues& z) {
    const double* sigma = gauge_.impulses(y);
    for (std::size_t i = 0; i < constant_.size(); ++i) constant_[i] = -sigma[i];
    before_ = y0;
    at(t0, y0);
    for (std::size_t i = 0; i < z.size(); ++i) {
      for (std::size_t k = 0; k < y0.size(); ++k) z[i][k] += before_[k];
      at(t0 + c[i] * h, z[i]);
      for (std::size_t k = 0; k < y0.size(); ++k) z[i][k] -= y0[k];
    }
  }

 private:
  void at(double t, std::vector<double>& y) {
    gauge_.gauge_directions(t, y.data(), directions_.data());
    gauge_.shift(directions_.data(), constant_.data(), y.data());
  }

  GaugeSymmetry& gauge_;
  std::vector<double> directions_, constant_, before_;
};

// Samples of Radau IIA: steps to a time inside the last one, of full order and on all constraints.
// Matrices of their own, so that looking changes nothing.

class Look {
 public:
  /// `whole`: steps by WholeStages.
  Look(DaeSystem& system, bool whole) : stages_(system), factors_(system.size(), system.pattern()) {
    if (whole) whole_ = std::make_unique<WholeStages>(system);
  }

  /// y and y' at t + h from (y0, y0') at t, with z a guess of the stages; `rate_scale` as in
  /// Stages::differentiate(). False where it does not converge.
  bool operator()(double t, double h, double rate_scale, const double* y0, const double* ydot0,
                  const WeightedNorm& norm, double fraction, StageValues& z, double* y,
                  double* ydot) {
    Outcome outcome = Outcome::diverged;
    if (whole_) {
      outcome = whole_->solve(t, h, rate_scale, y0, norm, fraction, z);
    } else {
      if (differentiated_ != t && !stages_.differentiate(t, y0, ydot0, rate_scale)) return false;
      differentiated_ = t;
      stages_.contraction = 1;
      if (stages_.factor(factors_, h))
        outcome = stages_.solve(factors_, t, h, y0, norm, fraction, patient_iterations, z);
    }
    for (std::size_t k = 0; k < z[2].size(); ++k) y[k] = y0[k] + z[2][k];
    stages_.rate(2, h, z, ydot);
    return outcome == Outcome::converged;
  }

 private:
  Stages stages_;
  Factors factors_;
  std::unique_ptr<WholeStages> whole_;  ///< null: simplified iterations
  double differentiated_ = std::numeric_limits<double>::quiet_NaN();  ///< at this t [s]
};

}  // namespace momenta::radau5
