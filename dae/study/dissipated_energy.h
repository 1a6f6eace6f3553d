#pragma once
// The work, along a run, of the forces without potential: dampers, stops, moments, formulas; and of
// what changes potentials with time. The power is evaluated at the five Gauss points of each step,
// and the polynomial through these values gives the work up to any time inside the step.

#include <momenta/core/lagrangian/lagrangian_model.h>
#include <momenta/core/scene/formula.h>
#include <momenta/dae/mechanism.h>
#include <momenta/dae/solver/memory.h>

#include <algorithm>
#include <array>

namespace momenta {

class DissipatedEnergy {
 public:
  explicit DissipatedEnergy(const Mechanism& mechanism)
      : any_(mechanism.scene().lagrangian ? mechanism.lagrangian().has_power
                                          : loses_energy(mechanism.scene())) {}

  /// Whether there is anything to integrate.
  bool any() const { return any_; }

  /// `power(t, watts)` at times inside the step that was just taken; false: no value, and the step
  /// counts as it was last known.
  template <class Power>
  bool step(double t0, double t1, Power&& power) {
    work_ = until(end_);
    from_ = t0;
    end_ = t1;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (!power(t0 + points[i] * (t1 - t0), power_[i])) return false;
    return true;
  }

  void carry(Memory& memory) {
    memory(work_), memory(from_), memory(end_), memory(power_.data(), power_.size());
  }

  /// Up to a time in the last step [J].
  double until(double t) const {
    if (!(end_ > from_)) return work_;
    const double part = (t - from_) / (end_ - from_);
    double mean = 0;  // of the power from from_ to t
    for (std::size_t i = 0; i < points.size(); ++i) mean += weights[i] * power_at(part * points[i]);
    return work_ + mean * (t - from_);
  }

 private:
  // On [0, 1].
  static constexpr std::array<double, 5> points{0.046910077030668004, 0.23076534494715845, 0.5,
                                                0.76923465505284155, 0.95308992296933200};
  static constexpr std::array<double, 5> weights{0.11846344252809454, 0.23931433524968324,
                                                 0.28444444444444444, 0.23931433524968324,
                                                 0.11846344252809454};

  static bool takes_time(const Scene& scene, const ForceSpec& potential) {
    const auto signals = FormulaReader(scene).read(potential.law).signals;
    return std::any_of(signals.begin(), signals.end(),
                       [](const Signal& s) { return s.kind == Signal::Kind::time; });
  }
  static bool loses_energy(const Scene& scene) {
    for (const auto& joint : scene.joints)
      if (joint.damping != 0 || joint.friction != 0 || (joint.limits && joint.stop_damping != 0))
        return true;
    for (const auto& f : scene.forces)
      if ((has_formula(f) && (f.kind != "potential" || takes_time(scene, f))) ||
          ((f.kind == "spring-damper" || f.kind == "coordinate-spring") &&
           (f.damping != 0 || f.stop_damping != 0)) ||
          (f.kind == "bushing" && (f.damping != 0 || f.rotational_damping != 0)) ||
          (f.kind == "wrench" && (f.in_body_axes || f.torque.norm() > 0)))
        return true;
    return false;
  }

  /// The polynomial through the powers, at a fraction of the step.
  double power_at(double x) const {
    double sum = 0;
    for (std::size_t i = 0; i < power_.size(); ++i) {
      double term = power_[i];
      for (std::size_t j = 0; j < power_.size(); ++j)
        if (j != i) term *= (x - points[j]) / (points[i] - points[j]);
      sum += term;
    }
    return sum;
  }

  bool any_;
  double work_ = 0;  ///< up to from_ [J]
  double from_ = 0, end_ = 0;
  std::array<double, 5> power_{};  ///< at the points of the last step [W]
};

}  // namespace momenta
