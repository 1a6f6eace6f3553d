// Steps of a formula against its tape, instruction by instruction: bit for bit, since every
// operation of a step is rounded by itself; in packs lane by lane.

#include <gtest/gtest.h>
#include <momenta/core/expression/evaluate.h>
#include <momenta/core/expression/run_steps.h>

#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <vector>

namespace momenta::core_steps {
namespace {

const std::vector<std::string> names{"a", "b", "c", "d"};
constexpr std::array<double, 4> at{0.3713, -1.917, 2.501, 0.611};

/// The plain twin: one instruction after the other.
std::vector<double> by_instructions(const Expression& f) {
  std::vector<double> line(f.tape().size()), values;
  double* next = line.data();
  for (const formula::Instruction& in : f.tape())
    formula::execute(in, at.data(), static_cast<const double*>(line.data()), *next++);
  for (const int i : f.outputs()) values.push_back(line[static_cast<std::size_t>(i)]);
  return values;
}

std::vector<double> by_steps(const Expression& f) {
  std::vector<double> line(f.steps().line), values(f.outputs().size());
  EXPECT_LE(line.size(), f.tape().size());
  formula::run(f.steps(), at.data(), line.data(), values.data());
  return values;
}

void expect_same(const Expression& f, const std::string& text) {
  const std::vector<double> expected = by_instructions(f), found = by_steps(f);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_EQ(std::bit_cast<std::uint64_t>(found[i]), std::bit_cast<std::uint64_t>(expected[i]))
        << text << ": " << found[i] << ", by instructions " << expected[i];
}

/// Every way in which three operations can be one step, and more of them than fit into one.
std::vector<std::string> arithmetic() {
  std::vector<std::string> all{
      "a * a - b * b",    "a^2 + b^2 + c^2 + d^2", "(a + b)^3 - a^5", "(a - b)^-2 + c^12 / d^13",
      "-(a * b) - (-c)",  "c * (a - b)^2",         "(a * b)^2 - c",   "d / ((a + b)^2 * c)",
      "((a - b)^2)^2 + c"};
  for (const std::string x : {"+", "-", "*", "/"})
    for (const std::string y : {"+", "-", "*", "/"}) {
      const std::string first = "(a " + x + " b)";
      all.push_back(first + y + "c");
      all.push_back("c" + y + first);
      for (const std::string z : {"+", "-", "*", "/"}) {
        all.push_back("(" + first + y + "c)" + z + "d");
        all.push_back("(c" + y + first + ")" + z + "d");
        all.push_back("d" + z + "(" + first + y + "c)");
        all.push_back("d" + z + "(c" + y + first + ")");
        all.push_back(first + y + "(c" + z + "d)");
        all.push_back("(" + first + y + "(c" + z + "d)) * (" + first + "- d" + z + "c)");
      }
    }
  return all;
}

const std::vector<std::string> others{"if(a < b, c, d) + if(a <= d and b != c, a, b) * c",
                                      "min(a, b) - max(c, d) / abs(b)",
                                      "sign(b) * floor(c) + atan2(a, b) - hypot(c, d)",
                                      "exp(a) * log(c) + sqrt(d) - tanh(b) / cosh(a)",
                                      "c^a + c^d - tan(a) * asin(a) + acos(d) - atan(b) + sinh(d)",
                                      "a",
                                      "2.5",
                                      "-a"};

TEST(Steps, OfArithmeticAreTheTapeBitForBit) {
  for (const std::string& text : arithmetic()) {
    const Expression f(text, names);
    expect_same(f, text);
    expect_same(f.with_derivatives(std::array{0, 1, 2, 3}), text + ", slopes");
  }
}

TEST(Steps, OfFunctionsAndComparisonsToo) {
  for (const std::string& text : others) expect_same(Expression(text, names), text);
}

/// The sine and the cosine of one number are one step, wherever they stand.
TEST(Steps, MakeSineAndCosineTogether) {
  for (const std::string text : {"sin(a * b) + 2 * cos(a * b)", "cos(a) - b * sin(a)"}) {
    const Expression f(text, names);
    const double found = by_steps(f)[0], expected = by_instructions(f)[0];
    EXPECT_NEAR(found, expected, 4e-16 * (1 + std::abs(expected))) << text;
    int alone = 0, together = 0;
    for (const formula::Step& s : f.steps().all) {
      together += s.act == formula::sine_and_cosine;
      alone += s.act == static_cast<int>(formula::Operation::sin) ||
               s.act == static_cast<int>(formula::Operation::cos);
    }
    EXPECT_EQ(together, 1) << text;
    EXPECT_EQ(alone, 0) << text;
  }
}

TEST(Steps, TakeThreeOperationsAtOnce) {
  EXPECT_EQ(Expression("(a + b) * (c - d)", names).steps().all.size(), 1U);
  EXPECT_EQ(Expression("((a + b) * c - d) / a + b", names).steps().all.size(), 2U);
  // what two others take is computed once
  EXPECT_EQ(Expression("(a + b) * c + sin(a + b)", names).steps().all.size(), 3U);
}

TEST(Steps, InPacksAreThoseOfEachLane) {
  using P = Pack<2, 90>;  // a level of its own
  std::vector<std::string> all = arithmetic();
  all.insert(all.end(), others.begin(), others.end());
  all.push_back("sin(a) * cos(a) - sin(b) + cos(c)");
  for (const std::string& text : all) {
    const Expression f(text, names);
    std::vector<P> x(4), line(f.steps().line), y(1);
    for (std::size_t i = 0; i < 4; ++i) x[i].set_lane(0, at[i]), x[i].set_lane(1, at[3 - i]);
    formula::run_steps(f.steps(), x.data(), line.data(), y.data());
    for (int lane = 0; lane < 2; ++lane) {
      std::array<double, 4> alone;
      for (std::size_t i = 0; i < 4; ++i) alone[i] = x[i].lane(lane);
      const double expected = f(alone), found = y[0].lane(lane);
      if (std::isnan(expected)) {
        EXPECT_TRUE(std::isnan(found)) << text;
      } else {
        EXPECT_NEAR(found, expected, 2e-14 * (1 + std::abs(expected))) << text;
      }
    }
  }
}

}  // namespace
}  // namespace momenta::core_steps
