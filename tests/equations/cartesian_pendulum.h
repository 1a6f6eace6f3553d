#pragma once
// A point of 1 kg on a rod of 1 m in x, y, released level: q' = v, v' = −λ q − g, with the
// constraint x v_x + y v_y = 0 (index 2) or (|q|² − 1)/2 = 0 (index 3); exact Jacobians by hand,
// and the same motion by the angle.

#include <momenta/dae/integrator/integration.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace momenta::equations {

class CartesianPendulum : public DaeSystem {
 public:
  static constexpr double g = 9.81;
  explicit CartesianPendulum(int index) : index_(index) {}

  int size() const override { return 5; }
  bool residual(double, const double* y, const double* yd, double* r) override {
    r[0] = yd[0] - y[2];
    r[1] = yd[1] - y[3];
    r[2] = yd[2] + y[4] * y[0];
    r[3] = yd[3] + y[4] * y[1] + g;
    r[4] = index_ == 2 ? y[0] * y[2] + y[1] * y[3] : 0.5 * (y[0] * y[0] + y[1] * y[1] - 1);
    return true;
  }
  bool jacobian(double, const double* y, const double*, double c, double* j) override {
    std::fill(j, j + 25, 0.0);
    j[0] = c, j[2] = y[4], j[4] = index_ == 2 ? y[2] : y[0];
    j[5 + 1] = c, j[5 + 3] = y[4], j[5 + 4] = index_ == 2 ? y[3] : y[1];
    j[10 + 0] = -1, j[10 + 2] = c, j[10 + 4] = index_ == 2 ? y[0] : 0;
    j[15 + 1] = -1, j[15 + 3] = c, j[15 + 4] = index_ == 2 ? y[1] : 0;
    j[20 + 2] = y[0], j[20 + 3] = y[1];
    return true;
  }
  const JacobianPattern& pattern() const override { return pattern_; }
  bool start(double, double* y, double* yd) override {
    const double y0[] = {1, 0, 0, 0, 0}, yd0[] = {0, 0, 0, -g, 0};
    std::copy(y0, y0 + 5, y);
    std::copy(yd0, yd0 + 5, yd);
    return true;
  }
  bool differential(int i) const override { return i < (index_ == 2 ? 4 : 2); }
  double scale(int i) const override {
    return differential(i) ? 1 : std::numeric_limits<double>::infinity();
  }
  Weight weight(int i) const override {
    if (i == 4) return {-1, 0};
    return {differential(i) ? 0 : 1, 1.0};
  }

  /// x, y, v_x, v_y, λ at t: φ from the horizontal, φ'' = −g cos φ, λ = φ'² − g sin φ.
  static std::vector<double> exact(double t) {
    class Angle final : public OdeSystem {
      int size() const override { return 2; }
      bool rhs(double, const double* y, double* f) override {
        f[0] = y[1], f[1] = -g * std::cos(y[0]);
        return true;
      }
    } angle;
    IntegrationOptions tight;
    tight.rtol = tight.atol = 1e-14;
    const auto r = integrate_explicit("dop853", angle, 0, {0, 0}, {t}, tight, {});
    EXPECT_TRUE(r.done) << r.reason;
    const double c = std::cos(r.y[0]), s = std::sin(r.y[0]), w = r.y[1];
    return {c, s, -w * s, w * c, w * w - g * s};
  }

 protected:
  JacobianPattern pattern_;

 private:
  int index_;
};

}  // namespace momenta::equations
