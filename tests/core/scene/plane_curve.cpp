// Plane curves against differences, splines against their definition, faults in words.

#include <gtest/gtest.h>
#include <momenta/core/scene/plane_curve.h>

#include <numbers>

namespace momenta::core_plane_curve {
namespace {

using Eigen::Vector3d;

const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();

CurveSpec spline(bool closed) {
  CurveSpec spec;
  spec.kind = "spline";
  spec.points = {{1, 0, 0}, {0.6, 0.9, 0}, {-0.5, 1.1, 0}, {-0.9, -0.2, 0}, {0.1, -0.8, 0}};
  spec.closed = closed;
  return spec;
}
std::vector<CurveSpec> all_curves() {
  CurveSpec circle, ellipse, flat;
  circle.kind = "circle";
  circle.radius = 0.7;
  ellipse.kind = "ellipse";
  ellipse.semi_axes = {1.2, 0.4};
  ellipse.direction = Vector3d(0.6, 0.8, 0);
  flat.kind = "flat";
  flat.direction = Vector3d(0, -1, 0);
  return {circle, ellipse, flat, spline(true), spline(false)};
}

TEST(PlaneCurve, DerivativesAreDifferences) {
  constexpr double h = 1e-5;
  for (const CurveSpec& spec : all_curves()) {
    SCOPED_TRACE(spec.kind);
    const PlaneCurve curve(spec, x, y);
    for (double s = -3; s < 12; s += 0.377) {
      const auto at = curve.at(s), later = curve.at(s + h), sooner = curve.at(s - h);
      for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_NEAR(at.d[i], (later.p[i] - sooner.p[i]) / (2 * h), 1e-8);
        EXPECT_NEAR(at.dd[i], (later.d[i] - sooner.d[i]) / (2 * h), 1e-5);
      }
    }
  }
}

/// Through its points; p, p' and p'' go on across every knot and over the seam; an open one has no
/// curvature at its ends and goes on straight.
TEST(PlaneCurve, SplinesAreTwiceContinuous) {
  for (const bool closed : {true, false}) {
    const CurveSpec spec = spline(closed);
    const PlaneCurve curve(spec, x, y);
    double s = 0;
    for (std::size_t k = 0; k < spec.points.size(); ++k) {
      constexpr double h = 1e-9;
      const auto at = curve.at(s), later = curve.at(s + h), sooner = curve.at(s - h);
      for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_NEAR(at.p[i], spec.points[k][static_cast<Eigen::Index>(i)], 1e-14);
        EXPECT_NEAR(later.p[i], sooner.p[i], 1e-8);
        EXPECT_NEAR(later.d[i], sooner.d[i], 1e-7);
        EXPECT_NEAR(later.dd[i], sooner.dd[i], 1e-6);
      }
      s += (spec.points[(k + 1) % spec.points.size()] - spec.points[k]).norm();
    }
    if (closed) {
      EXPECT_DOUBLE_EQ(curve.period(), s);
      const auto here = curve.at(0.3), round = curve.at(0.3 - 2 * curve.period());
      for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(here.p[i], round.p[i], 1e-13);
    } else {
      for (const double end : {-0.5, curve.samples().back() + 0.5})
        for (const double bend : curve.at(end).dd) EXPECT_EQ(bend, 0);
    }
  }
}

/// What a closed curve bounds lies on the side that outward() does not point to.
TEST(PlaneCurve, OutwardLeavesWhatIsBounded) {
  for (CurveSpec spec : all_curves()) {
    if (spec.kind == "spline" && !spec.closed) continue;
    for (const bool reversed : {false, true}) {
      if (reversed) std::reverse(spec.points.begin(), spec.points.end());
      const PlaneCurve curve(spec, x, y);
      for (const double s : curve.samples()) {
        const auto at = curve.at(s);
        EXPECT_GT(curve.outward() * (-at.d[1] * at.p[0] + at.d[0] * at.p[1]), 0);
      }
    }
  }
  const PlaneCurve flat(all_curves()[2], x, y);
  EXPECT_DOUBLE_EQ(flat.at(0.4).d[0], -1);  // its left is −y
  EXPECT_DOUBLE_EQ(flat.outward(), 1);
}

TEST(PlaneCurve, FaultsAreWords) {
  for (const CurveSpec& spec : all_curves()) EXPECT_EQ(curve_fault(spec, z), "") << spec.kind;
  CurveSpec off = spline(true);
  off.points[2].z() = 0.1;
  EXPECT_NE(curve_fault(off, z).find("points[2] is 0.1 m off the plane"), std::string::npos)
      << curve_fault(off, z);
  CurveSpec twice = spline(false);
  twice.points[1] = twice.points[0];
  EXPECT_NE(curve_fault(twice, z).find("points[1] is the same as points[0]"), std::string::npos);
  CurveSpec ring = spline(true);
  ring.points.push_back(ring.points[0]);
  EXPECT_NE(curve_fault(ring, z).find("points[0] is the same as points[5]"), std::string::npos);
  ring.closed = false;
  EXPECT_EQ(curve_fault(ring, z), "");
  CurveSpec few = spline(true);
  few.points.resize(2);
  EXPECT_NE(curve_fault(few, z).find("has 2 points, expected at least 3"), std::string::npos);
  CurveSpec nan = spline(true);
  nan.points[0].x() = std::nan("");
  EXPECT_NE(curve_fault(nan, z), "");
  CurveSpec tilted = all_curves()[2];
  tilted.direction = Vector3d(0, 0.6, 0.8);
  EXPECT_NE(curve_fault(tilted, z).find("not at right angles to axis"), std::string::npos);
}

}  // namespace
}  // namespace momenta::core_plane_curve
