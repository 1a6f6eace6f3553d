#pragma once
// Gauge reset between steps of Radau IIA: σ leaves p, and by the same constant what the last step
// foresees of the next. Any two stages differ in the new gauge as in the old but by
// (Φ_q(q_i) − Φ_q(q_0))ᵀσ. See gauge_symmetry.h.

#include <momenta/dae/solver/gauge_symmetry.h>
#include <momenta/dae/solver/radau5_tableau.h>

#include <algorithm>

namespace momenta::radau5 {

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

}  // namespace momenta::radau5
