// Motion laws: f against its formula, the derivatives against dual numbers and differences, and
// two continuous derivatives everywhere.

#include <gtest/gtest.h>
#include <momenta/core/scene/drive.h>

#include <cmath>
#include <limits>
#include <vector>

#include "equations/tolerance.h"

namespace momenta::core_drive {
namespace {

template <class S>
struct Motion {
  S f, fdot, fddot;
};

template <class S>
Motion<S> at(const MotionLaw& law, S t) {
  Motion<S> motion{};
  law.evaluate(t, motion.f, motion.fdot, motion.fddot);
  return motion;
}

DriveSpec polynomial() {
  DriveSpec spec;
  spec.kind = "polynomial";
  spec.coefficients = {1, -2, 0.5, 0.25};
  return spec;
}

DriveSpec harmonic() {
  DriveSpec spec;
  spec.kind = "harmonic";
  spec.offset = 0.5;
  spec.amplitude = 2;
  spec.frequency = 3;
  spec.phase = 0.25;
  return spec;
}

DriveSpec step() {
  DriveSpec spec;
  spec.kind = "step";
  spec.from = 1;
  spec.to = -2;
  spec.start = 0.5;
  spec.duration = 2;
  return spec;
}

DriveSpec table() {
  DriveSpec spec;
  spec.kind = "table";
  spec.times = {-1, 0, 0.5, 2, 3};
  spec.values = {0, 1, 0.5, -1, 2};
  return spec;
}

DriveSpec formula() {
  DriveSpec spec;
  spec.kind = "formula";
  spec.law = "0.5 * sin(2 * t + 0.3) * exp(-t^2 / 8) + tanh(t) / (2 + cos(t))";
  return spec;
}

const std::vector<DriveSpec> all_laws{polynomial(), harmonic(), step(), table(), formula()};

TEST(MotionLaw, Values) {
  // 1 − 2·2 + 0.5·4 + 0.25·8 = 1;  −2 + 2 + 0.75·4 = 3;  1 + 1.5·2 = 4
  const auto p = at(MotionLaw(polynomial()), 2.0);
  EXPECT_EQ(p.f, 1);
  EXPECT_EQ(p.fdot, 3);
  EXPECT_EQ(p.fddot, 4);
  EXPECT_DOUBLE_EQ(at(MotionLaw(harmonic()), 0.4).f, 0.5 + 2 * std::sin(1.45));
  EXPECT_NEAR(at(MotionLaw(harmonic()), 0.4).fdot, 6 * std::cos(1.45), 1e-15 * 6);

  const MotionLaw jump(step());
  EXPECT_EQ(at(jump, -10.0).f, 1);
  EXPECT_EQ(at(jump, 0.5).f, 1);
  EXPECT_EQ(at(jump, 1.5).f, -0.5);                    // half way
  EXPECT_EQ(at(jump, 1.5).fdot, -3 * (15.0 / 8) / 2);  // s'(1/2) = 15/8
  EXPECT_EQ(at(jump, 1.5).fddot, 0);
  EXPECT_EQ(at(jump, 2.5).f, -2);
  EXPECT_EQ(at(jump, 1e300).fdot, 0);

  const DriveSpec points = table();
  const MotionLaw spline(points);
  for (std::size_t i = 0; i < points.times.size(); ++i)
    EXPECT_NEAR(at(spline, points.times[i]).f, points.values[i], 1e-15);
}

TEST(MotionLaw, DerivativesOfDuals) {
  for (const DriveSpec& spec : all_laws) {
    const MotionLaw law(spec);
    for (double t = -2.03; t < 4; t += 0.1) {
      const auto plain = at(law, t);
      Dual<double, 1> moved(t);
      moved.b[0] = 1;
      const auto dual = at(law, moved);
      const double tol = 64 * std::numeric_limits<double>::epsilon() *
                         (1 + std::abs(plain.fddot) + std::abs(plain.f));
      EXPECT_NEAR(dual.f.a, plain.f, spec.kind == "formula" ? tol : 0);  // it may divide
      EXPECT_NEAR(dual.f.b[0], plain.fdot, tol) << spec.kind << " at " << t;
      EXPECT_NEAR(dual.fdot.b[0], plain.fddot, tol) << spec.kind << " at " << t;
    }
  }
}

TEST(MotionLaw, DerivativesAgainstCentralDifferences) {
  const double h = 1e-5,
               difference_tol = 1e-7;  // h² f⁗ and ε/h, f and its derivatives of order 100
  for (const DriveSpec& spec : all_laws) {
    const MotionLaw law(spec);
    for (double t = -2.03; t < 4; t += 0.1) {
      const auto before = at(law, t - h), here = at(law, t), after = at(law, t + h);
      EXPECT_NEAR((after.f - before.f) / (2 * h), here.fdot, difference_tol)
          << spec.kind << " at " << t;
      EXPECT_NEAR((after.fdot - before.fdot) / (2 * h), here.fddot, difference_tol)
          << spec.kind << " at " << t;
    }
  }
}

TEST(MotionLaw, TwiceContinuouslyDifferentiable) {
  const double gap = 1e-12, jump_tol = 1e-9;  // gap × third derivative, below 1000 here
  for (const double t : {0.5, 2.5}) {
    const MotionLaw law(step());
    const auto left = at(law, t - gap), right = at(law, t + gap);
    EXPECT_NEAR(left.f, right.f, jump_tol);
    EXPECT_NEAR(left.fdot, right.fdot, jump_tol);
    EXPECT_NEAR(left.fddot, right.fddot, jump_tol);
  }
  const DriveSpec points = table();
  for (const double t : points.times) {
    const MotionLaw law(points);
    const auto left = at(law, t - gap), right = at(law, t + gap);
    EXPECT_NEAR(left.f, right.f, jump_tol);
    EXPECT_NEAR(left.fdot, right.fdot, jump_tol);
    EXPECT_NEAR(left.fddot, right.fddot, jump_tol);
  }
}

TEST(MotionLaw, TableIsNaturalAndStraightOutside) {
  const MotionLaw law(table());
  EXPECT_NEAR(at(law, -1.0).fddot, 0, 1e-14);
  EXPECT_EQ(at(law, -5.0).fddot, 0);
  EXPECT_EQ(at(law, 7.0).fddot, 0);
  EXPECT_EQ(at(law, -5.0).fdot, at(law, -2.0).fdot);
  EXPECT_DOUBLE_EQ(at(law, 5.0).f, 2 + 2 * at(law, 3.0).fdot);
  EXPECT_DOUBLE_EQ(at(law, -3.0).f, -2 * at(law, -1.0).fdot);
}

TEST(MotionLaw, TwoPointsAreALine) {
  DriveSpec spec = table();
  spec.times = {1, 3};
  spec.values = {0, 4};
  const MotionLaw law(spec);
  for (const double t : {0.0, 1.0, 2.0, 3.0, 4.0}) {
    EXPECT_EQ(at(law, t).f, 2 * (t - 1));
    EXPECT_EQ(at(law, t).fdot, 2);
    EXPECT_EQ(at(law, t).fddot, 0);
  }
}

TEST(MotionLaw, TableConvergesWithTheFourthPower) {
  // sin on [0, π]: its second derivative vanishes at both ends, as that of a natural spline does
  double previous = 0;
  for (const int n : {8, 16, 32}) {
    DriveSpec spec = table();
    spec.times.clear();
    spec.values.clear();
    for (int i = 0; i <= n; ++i) {
      spec.times.push_back(std::acos(-1) * i / n);
      spec.values.push_back(std::sin(spec.times.back()));
    }
    const MotionLaw law(spec);
    double error = 0;
    for (double t = 0; t < 3.14; t += 0.01)
      error = equations::larger(error, std::abs(at(law, t).f - std::sin(t)));
    if (previous > 0) {
      EXPECT_NEAR(previous / error, 16, 2);
    }
    previous = error;
  }
}

TEST(MotionLaw, LongDouble) {
  for (const DriveSpec& spec : all_laws) {
    const MotionLaw law(spec);
    const auto wide = at(law, 1.25L);
    const auto plain = at(law, 1.25);
    EXPECT_NEAR(static_cast<double>(wide.f), plain.f, 1e-15 * 8);
    EXPECT_NEAR(static_cast<double>(wide.fddot), plain.fddot, 1e-15 * 64);
  }
}

TEST(MotionLaw, RefusesWhatIsNoLaw) {
  DriveSpec spec;
  spec.joint = "O";
  EXPECT_THROW(MotionLaw{spec}, SceneError);
  spec = polynomial();
  spec.coefficients.clear();
  EXPECT_THROW(MotionLaw{spec}, SceneError);
  spec = table();
  spec.times[1] = spec.times[2];
  EXPECT_THROW(MotionLaw{spec}, SceneError);
  spec = step();
  spec.duration = std::nan("");
  EXPECT_THROW(MotionLaw{spec}, SceneError);
  for (const char* law : {"", "2 *", "O.q", "t < 1"}) {
    spec = formula();
    spec.law = law;
    EXPECT_THROW(MotionLaw{spec}, SceneError) << law;
  }
}

}  // namespace
}  // namespace momenta::core_drive
