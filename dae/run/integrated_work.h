#pragma once
// The work, along a run, of what has no potential: dampers, stops, moments, formulas; drives; and
// what changes potentials with time. The power is evaluated at the Gauss points of each step, and
// the polynomial through these values gives the work up to any time inside the step: five points
// give that of a whole step to order 10, up to a time inside it only to order 6, and that of nine
// points is of order 10 there too.

#include <momenta/core/scene/formula.h>
#include <momenta/core/scene/lagrangian/lagrangian_model.h>
#include <momenta/dae/integrator/memory.h>
#include <momenta/dae/mechanism/mechanism.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace momenta {

class IntegratedWork {
 public:
  /// Whether forces other than drives have no potential.
  static bool has_any(const Mechanism& mechanism) {
    return mechanism.scene().lagrangian ? mechanism.lagrangian().has_power
                                        : loses_energy(mechanism.scene());
  }

  /// Takes the step just taken. `power(t, watts, flow)`: power of all sources, and the sum of
  /// absolute values; false: no value, and older powers are used. `inside`: work up to times inside
  /// the step will be asked for.
  template <class Power>
  bool step(double t0, double t1, bool inside, Power&& power) {
    work_ = until(end_);
    from_ = t0;
    end_ = t1;
    count_ = inside ? nine.size() : five.size();
    double mean = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      double flow = 0;
      if (!power(t0 + point(i) * (t1 - t0), power_[i], flow)) return false;
      mean += flow / static_cast<double>(count_);
    }
    turned_over_ += mean * (t1 - t0);
    return true;
  }

  void carry(Memory& memory) {
    memory(work_), memory(from_), memory(end_), memory(count_), memory(turned_over_);
    memory(power_.data(), power_.size());
  }

  /// Adds work [J] done at once, at the end of the last step.
  void add(double work) {
    work_ = until(end_) + work;
    from_ = end_;
    turned_over_ += std::abs(work);
  }

  /// Energy in and out through all sources so far, to a few digits [J].
  double turned_over() const { return turned_over_; }

  /// Work up to a time in the last step [J].
  double until(double t) const {
    if (!(end_ > from_)) return work_;
    const double part = (t - from_) / (end_ - from_);
    double mean = 0;  // power from from_ to t: exact, the polynomial's degree is below 10
    for (std::size_t i = 0; i < five.size(); ++i) mean += weights[i] * power_at(part * five[i]);
    return work_ + mean * (t - from_);
  }

 private:
  // Gauss points and weights on [0, 1].
  static constexpr std::array<double, 5> five{0.046910077030668004, 0.23076534494715845, 0.5,
                                              0.76923465505284155, 0.95308992296933200};
  static constexpr std::array<double, 9> nine{
      0.015919880246186955, 0.08198444633668210, 0.19331428364970480, 0.33787328829809555, 0.5,
      0.66212671170190445,  0.80668571635029520, 0.91801555366331790, 0.98408011975381304};
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
      if (joint.damping != 0 || joint.friction != 0 || joint.bearing ||
          (joint.limits && joint.stop_damping != 0))
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

  double point(std::size_t i) const { return count_ == five.size() ? five[i] : nine[i]; }
  /// The polynomial through the powers, at a fraction of the step.
  double power_at(double x) const {
    double sum = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      double term = power_[i];
      for (std::size_t j = 0; j < count_; ++j)
        if (j != i) term *= (x - point(j)) / (point(i) - point(j));
      sum += term;
    }
    return sum;
  }

  double work_ = 0;         ///< up to from_ [J]
  double turned_over_ = 0;  ///< up to end_ [J]
  double from_ = 0, end_ = 0;
  std::size_t count_ = five.size();
  std::array<double, 9> power_{};  ///< at the points of the last step [W]
};

}  // namespace momenta
