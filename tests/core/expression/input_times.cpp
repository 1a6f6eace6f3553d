// Times at which inputs change: found where formulas have them, to rounding where switches are
// linear in t, and nowhere else.

#include <gtest/gtest.h>
#include <momenta/core/expression/input_times.h>

#include <cmath>
#include <string>
#include <vector>

namespace momenta::core_input_times {
namespace {

constexpr double t0 = -1, end = 9;

/// Of a formula of t, x and a number c = 2.
std::vector<double> times(const std::string& formula) {
  const std::vector<std::string> names{"t", "x", "c"};
  InputTimes all(t0, end);
  all.add(Expression(formula, names), 0,
          [](int i) { return i == 2 ? std::optional(2.0) : std::nullopt; });
  return all.all();
}

/// Pairs of times, just before and just behind a jump.
void expect_jumps(const std::string& formula, const std::vector<double>& at, double within) {
  const std::vector<double> found = times(formula);
  ASSERT_EQ(found.size(), 2 * at.size()) << formula;
  for (std::size_t i = 0; i < at.size(); ++i) {
    EXPECT_LT(found[2 * i], at[i]) << formula;
    EXPECT_GT(found[2 * i + 1], at[i]) << formula;
    EXPECT_LT(found[2 * i + 1] - found[2 * i], within) << formula;
  }
}

TEST(InputTimes, OfLinearSwitchesAreTheirZeros) {
  expect_jumps("if(t < 3.1, x, 2*x)", {3.1}, 1e-10);
  expect_jumps("x*sign(1 - 2*t)", {0.5}, 1e-10);
  expect_jumps("if(c*t <= 7 and x > 0, 1, 0)", {3.5}, 1e-10);
  // A window of a nanosecond, between any two looks.
  expect_jumps("x + if(t < 4.7, 0, 1) - if(t < 4.700000001, 0, 1)", {4.7, 4.700000001}, 1e-10);
  expect_jumps("floor(t/c)*x", {0, 2, 4, 6, 8}, 1e-10);
  ASSERT_EQ(times("x*abs(t - 1.5)").size(), 1u);
  EXPECT_NEAR(times("x*abs(t - 1.5)").front(), 1.5, 1e-12);
  EXPECT_NEAR(times("max(x*0 + t, 2 + 0*x)*0 + max(t, c)").front(), 2, 1e-12);
}

TEST(InputTimes, OfOtherSwitchesAreFoundByLooks) {
  expect_jumps("x*sign(t^2 - 2)", {std::sqrt(2.0)}, 1e-10);
  expect_jumps(
      "if(sin(t) > 0.5, x, 0)",
      {std::asin(0.5), M_PI - std::asin(0.5), 2 * M_PI + std::asin(0.5), 3 * M_PI - std::asin(0.5)},
      1e-10);
  expect_jumps("x*exp(if(t^3 > 8, 1, 0))", {2}, 1e-10);
}

TEST(InputTimes, OfPulsesAreWhereTheyBeginAndEnd) {
  for (const char* formula : {"x*exp(-((t - 4)/0.02)^2)", "x + max(0, 1 - abs(10*t - 40))"}) {
    const std::vector<double> found = times(formula);
    ASSERT_GE(found.size(), 2u) << formula;
    EXPECT_LT(found.front(), 3.95) << formula;
    EXPECT_GT(found.front(), 3.8) << formula;
    EXPECT_GT(found.back(), 4.05) << formula;
    EXPECT_LT(found.back(), 4.2) << formula;
  }
}

TEST(InputTimes, AreNoneOfWhatVariesThroughoutOrIsNoInput) {
  for (const char* formula : {"x*sin(19*t)", "t^2 + x", "if(x < 1, t, 2*t)", "abs(x - t)", "c*x",
                              "sign(x)*cos(t)", "exp(-t)*x", "x/(t - 4)"})
    EXPECT_EQ(times(formula), std::vector<double>{}) << formula;
}

}  // namespace
}  // namespace momenta::core_input_times
