#pragma once
// Curves in the plane with coordinates along two axes e₁, e₂: p(s) with its first two derivatives.
//
//   line      p = s e
//   ellipse   p = a cos s e_a + b sin s e_b, e_b = e_a turned by a right angle from e₁ to e₂; a
//             circle has a = b
//   spline    cubic splines of both coordinates over the length of the chords
//   (core/expression/spline.h): p''
//             is continuous
//
// To the left of p' is J p' with J (x, y) = (−y, x).

#include <momenta/core/expression/spline.h>
#include <momenta/core/scene/loop_spec.h>

#include <array>
#include <optional>

namespace momenta {

/// Why a CurveSpec is no curve about a point in the plane across `axis` (a unit vector), in words;
/// empty: it is one.
std::string curve_fault(const CurveSpec& spec, const Eigen::Vector3d& axis);

/// p, p' and p'' at one parameter.
template <class S>
struct PlaneCurvePoint {
  std::array<S, 2> p, d, dd;
};

class PlaneCurve {
 public:
  /// A line along e₁.
  PlaneCurve() = default;
  /// @pre curve_fault(spec, e₁ × e₂) is empty; a direction of zero is e₁. O(points)
  PlaneCurve(const CurveSpec& spec, const Eigen::Vector3d& e1, const Eigen::Vector3d& e2);

  bool is_straight() const { return kind_ == Kind::line; }
  /// Period in its parameter; 0: not closed.
  double period() const { return period_; }
  /// Ascending parameters between which the curve turns little; for a spline from end to end, none
  /// for a line.
  const std::vector<double>& samples() const { return samples_; }
  /// Points of the curve at the samples.
  const std::vector<PlaneCurvePoint<double>>& sampled() const { return sampled_; }
  /// Largest distance of its samples from the origin [m]; 0 for a line.
  double reach() const { return reach_; }
  /// +1: the bounded side is to the right of p', −1: to the left.
  double outward() const { return outward_; }

  /// The point at s. No allocation, O(log points).
  template <class S>
  PlaneCurvePoint<S> at(const S& s) const {
    using std::cos, std::sin;
    const auto along = [](const std::array<double, 2>& e, const S& x) {
      return std::array<S, 2>{e[0] * x, e[1] * x};
    };
    switch (kind_) {
      case Kind::line:
        return {along(e_, s), along(e_, S(1.0)), {S(0.0), S(0.0)}};
      case Kind::ellipse: {
        const S c = cos(s), w = sin(s);
        const S x = semi_axes_[0] * c, y = semi_axes_[1] * w;
        const S dx = -semi_axes_[0] * w, dy = semi_axes_[1] * c;
        const std::array<S, 2> p{e_[0] * x - e_[1] * y, e_[1] * x + e_[0] * y};
        return {p, {e_[0] * dx - e_[1] * dy, e_[1] * dx + e_[0] * dy}, {-p[0], -p[1]}};
      }
      case Kind::spline:
        break;
    }
    PlaneCurvePoint<S> point;
    for (std::size_t i = 0; i < 2; ++i)
      if (period_ > 0)
        coordinates_[i].evaluate_round(s, point.p[i], point.d[i], point.dd[i]);
      else
        coordinates_[i].evaluate(s, point.p[i], point.d[i], point.dd[i]);
    return point;
  }

 private:
  enum class Kind { line, ellipse, spline };
  Kind kind_ = Kind::line;
  double period_ = 0, reach_ = 0, outward_ = 1;
  std::array<double, 2> e_{1, 0}, semi_axes_{};
  std::vector<CubicSpline> coordinates_;
  std::vector<double> samples_;
  std::vector<PlaneCurvePoint<double>> sampled_;
};

}  // namespace momenta
