#pragma once
// Loops of a run that come apart, so that it continues with another mechanism.
//
// Each equation is judged in its own unit: points in lengths of the scene, axes in radians,
// couplers in the natural size of their terms (LoopUnits). With |Φ|∞ in these units
//
//   forms that drift                         |Φ|∞ ≤ 1/4
//   forms that hold Φ = 0, adaptive steps    |Φ|∞ ≤ 10⁴ rtol, no less than 10⁻⁶, no more than 1/4
//
// The second bound is what the Newton iterations and the interpolants between steps leave, with a
// margin; beyond it a form no longer holds Φ = 0.

#include <momenta/dae/form/form.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/kkt/loop_units.h>
#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/run/run_result.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace momenta {

class LoopClosureMonitor {
 public:
  static constexpr double most = 0.25;

  /// @pre mechanism.m() > 0
  LoopClosureMonitor(const Mechanism& mechanism, const RunSettings& s)
      : mechanism_(mechanism), units_(mechanism) {
    const Integrator& method = integrator(s.integrator);
    if ((s.project || holds_positions(s.form)) && method.step == Integrator::Step::adaptive)
      least_ = std::clamp(1e4 * s.rtol, 1e-6, most);
  }

  /// |Φ|∞ in LoopUnits.
  double gap(const Eigen::VectorXd& phi) { return gap(phi, worst_); }
  /// The same, and its row; Φ̇ alike.
  double gap(const Eigen::VectorXd& phi, Eigen::Index& row) const {
    return phi.cwiseAbs().cwiseQuotient(units_.equations).maxCoeff(&row);
  }
  /// Rounding of |Φ|₂, of rows in m or, with `angles`, in rad, with room.
  double rounding(bool angles) const {
    constexpr double room = 10;
    double sum = 0;
    for (Eigen::Index i = 0; i < units_.equations.size(); ++i)
      if (mechanism_.angle_rows()[static_cast<std::size_t>(i)] == angles)
        sum += units_.equations[i] * units_.equations[i];
    return room * units_.rounding * std::sqrt(sum);
  }
  /// Largest rate of a joint, slides in lengths of the scene [1/s].
  double speed(const Eigen::VectorXd& u) const {
    return u.size() > 0 ? u.cwiseQuotient(units_.rates).cwiseAbs().maxCoeff() : 0;
  }
  /// q (nq), slides in lengths of the scene.
  std::vector<double> in_units(const Eigen::VectorXd& q) const {
    std::vector<double> pose(q.begin(), q.end());
    for (const auto& body : mechanism_.tree().bodies)
      for (int i = 0; i < std::min(body.nq, body.nv); ++i)
        pose[static_cast<std::size_t>(body.q + i)] /= units_.rates[body.u + i];
    return pose;
  }
  /// One sentence if the loops are apart at t [s]; else empty. `at_sample`: after all corrections.
  std::string found(double t, const Eigen::VectorXd& phi, bool at_sample) {
    const double open = gap(phi), limit = at_sample ? least_ : most;
    if (open <= limit) return "";
    const std::string& loop = mechanism_.rows()[static_cast<std::size_t>(worst_)].loop;
    char text[160];
    std::snprintf(
        text, sizeof text, "' is open by %.3g %s, %s %.2g", open,
        mechanism_.angle_rows()[static_cast<std::size_t>(worst_)] ? "rad" : "of the scene's length",
        limit < most ? "where this form holds it within" : "the most a drift may be is", limit);
    char time[32];
    std::snprintf(time, sizeof time, "%.6g", t);
    return std::string("at t = ") + time + " s the " + loop_word(mechanism_) +
           "s came apart: " + loop_word(mechanism_) + " '" + loop + text;
  }

 private:
  const Mechanism& mechanism_;
  LoopUnits units_;
  double least_ = most;
  Eigen::Index worst_ = 0;
};

}  // namespace momenta
