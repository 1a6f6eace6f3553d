// Formulas that C++ writes: the tapes that the parser makes of the same text, whatever the order in
// which the compiler computes operands.

#include <gtest/gtest.h>
#include <momenta/core/expression/traced.h>

#include <cmath>
#include <stdexcept>

#include "equations/refusal.h"

namespace momenta::core_written {
namespace {

using formula::Instruction;

void expect_typed(const Traced& written, const std::string& text) {
  const std::vector<std::string> names{"x", "y", "z"};
  const Expression typed(text, names), found(written.text(names), names);
  ASSERT_EQ(found.tape().size(), typed.tape().size()) << text;
  for (std::size_t i = 0; i < typed.tape().size(); ++i) {
    const Instruction &a = typed.tape()[i], &b = found.tape()[i];
    EXPECT_TRUE(a.operation == b.operation && a.a == b.a && a.b == b.b && a.c == b.c &&
                a.number == b.number)
        << text << ", instruction " << i;
  }
  EXPECT_EQ(found.outputs(), typed.outputs()) << text;
}

TEST(Traced, HasTheTapesOfTheParser) {
  const std::vector<Traced> all = Traced::variables(3);
  const Traced &x = all[0], &y = all[1], &z = all[2];
  expect_typed(x, "x");
  expect_typed(Traced(2.5), "2.5");
  expect_typed(sin(x) * cos(y) + tan(z) * exp(x), "sin(x)*cos(y) + tan(z)*exp(x)");
  expect_typed(x - y - z, "x - y - z");
  expect_typed(x / y / (z + 3), "x/y/(z + 3)");
  expect_typed(-pow(x, 2), "-x^2");
  expect_typed(pow(pow(x, -3) + 2, 0.5), "(x^-3 + 2)^0.5");
  expect_typed(pow(x, y), "x^y");
  expect_typed(pow(2.0, y), "2^y");
  expect_typed(asin(x) + acos(y) - atan(z), "asin(x) + acos(y) - atan(z)");
  expect_typed(sinh(x) + cosh(y) * tanh(z), "sinh(x) + cosh(y)*tanh(z)");
  expect_typed(log(x) * sqrt(y) / abs(z), "log(x)*sqrt(y)/abs(z)");
  expect_typed(floor(x) + atan2(y, x) - hypot(z, 4.0), "floor(x) + atan2(y, x) - hypot(z, 4)");
  expect_typed(min(x, y) * max(y, z), "min(x, y)*max(y, z)");
  expect_typed(choose(x < y || !(y > 0 && z == 1), x, y),
               "if(x < y or not (y > 0 and z == 1), x, y)");
  expect_typed(choose(x <= y, choose(y >= z, x, y), choose(x != 2, z, 0)),
               "if(x <= y, if(y >= z, x, y), if(x != 2, z, 0))");
  expect_typed(choose(Traced(1) < Traced(2), x, y), "x");
  Traced sum = x;
  sum += y;
  sum *= z;
  sum -= 1;
  sum /= x;
  expect_typed(sum, "((x + y)*z - 1)/x");
}

TEST(Traced, ComputesNumbersAtOnce) {
  EXPECT_TRUE((Traced(2) * 3 + pow(Traced(2), 3)).is(14));
  EXPECT_TRUE(Traced().is(0));
  EXPECT_FALSE(Traced::variables(1)[0].is(0));
}

TEST(Traced, IsTextThatReadsBack) {
  const std::vector<std::string> names{"x", "y", "z"};
  const std::vector<Traced> all = Traced::variables(3);
  const Traced &x = all[0], &y = all[1], &z = all[2];
  EXPECT_EQ((-pow(x + y, 2) * (x - (y - z)) / (x * (y / z))).text(names),
            "-(x + y)^2*(x - (y - z))/(x*(y/z))");
  EXPECT_EQ((-(x * y) - -z).text(names), "-(x*y) - -z");
  EXPECT_EQ((pow(pow(x, y), z) + pow(x, pow(y, z)) + pow(x, -y)).text(names),
            "(x^y)^z + x^y^z + x^-y");
  EXPECT_EQ((0.1 * x + -2.5e-300 * y).text(names), "0.1*x + -2.5e-300*y");
  EXPECT_EQ(choose(!(x < y && y < z) || x == 2, -x, pow(-2.0, y)).text(names),
            "if(not (x < y and y < z) or x == 2, -x, (-2)^y)");
  EXPECT_EQ(
      equations::thrown<std::logic_error>([&] { (void)(x / 0.0 + Traced(1) / 0).text(names); }),
      "a formula has a number in it that is infinite, expected finite numbers");
}

// A text without definitions would be of 2^60 characters, and 5000 operations deep.
TEST(Traced, DefinesWhatIsUsedAgain) {
  const std::vector<std::string> names{"s", "s1", "t"};
  const std::vector<Traced> all = Traced::variables(3);
  Traced product = all[0];
  for (int i = 0; i < 60; ++i) product = product * product + all[1];
  const std::string text = product.text(names);
  EXPECT_LT(text.size(), 5000U);
  EXPECT_TRUE(text.starts_with("s_1 := ")) << text;
  EXPECT_EQ(Expression(text, names).tape().size(), 2 + 2 * 60U);

  Traced deep = all[2];
  double expected = 0.3;
  for (int i = 0; i < 5000; ++i) {
    deep = sin(deep) + all[2];
    expected = std::sin(expected) + 0.3;
  }
  const double x[]{0, 0, 0.3};
  EXPECT_EQ(Expression(deep.text(names), names)(x), expected);
}

TEST(Traced, DefinitionsAreRefusedInOneSentence) {
  const std::vector<std::string> names{"x", "y"};
  const auto told = [&](const std::string& text) -> std::string {
    try {
      Expression read(text, names);
      return "read";
    } catch (const ExpressionError& e) {
      return std::to_string(e.place()) + ": " + e.what();
    }
  };
  EXPECT_EQ(told("r := hypot(x, y); q := r^2; q + 1/r"), "read");
  EXPECT_EQ(told("c := x > 0; if(c, x, y)"), "read");
  const std::string taken = " is no new name, expected letters, digits and _ for what ':=' defines";
  EXPECT_EQ(told("x := 2; x"), "0: 'x'" + taken);
  EXPECT_EQ(told("r := 2; r := 3; r"), "8: 'r'" + taken);
  EXPECT_EQ(told("sin := 2; sin"), "0: 'sin'" + taken);
  EXPECT_EQ(told("r.a := 2; r.a"), "0: 'r.a'" + taken);
  EXPECT_EQ(told("r := 2"), "6: ends, expected ';' after the definition of 'r'");
  EXPECT_EQ(told("r := 2, r"), "6: found ',', expected ';' after the definition of 'r'");
  EXPECT_EQ(told("r := 2;"), "7: ends where a number is expected");
  EXPECT_EQ(told("r := x; r(y)"), "8: 'r' is no function, expected an operator between it and '('");
  EXPECT_EQ(told("q + 1; q := 2"), "0: unknown name 'q', expected one of: x, y, pi");
}

TEST(Traced, RefusesNumbersOfTwoFormulas) {
  const Traced x = Traced::variables(1)[0], y = Traced::variables(1)[0];
  EXPECT_EQ(equations::thrown<std::logic_error>([&] { (void)(x + y); }),
            "a formula has variables of two calls of Traced::variables in it, expected those "
            "of one: has a number been kept from another formula?");
}

}  // namespace
}  // namespace momenta::core_written
