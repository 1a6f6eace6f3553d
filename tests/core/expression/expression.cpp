// Formulas against trees of C++ calls that are written out as text, and what is no formula.

#include "equations/random_tree.h"

#include <gtest/gtest.h>
#include <momenta/core/expression/evaluate.h>
#include <momenta/core/expression/expression.h>
#include <momenta/core/expression/switches.h>

#include <cmath>
#include <functional>
#include <limits>
#include <span>

namespace momenta::core_expression {
namespace {

using equations::RandomTree;

const std::vector<std::string> names{"a", "b_2", "O.q"};
constexpr double a = 0.7, b = -1.9, c = 2.5;

double value(const std::string& text) {
  return Expression(text, names)(std::array{a, b, c});
}

/// A formula made by chance: its text and its value, both from the same calls.
struct Made {
  std::string text;
  double value;
};

Made number(RandomTree& random) {
  switch (random.below(5)) {
    case 0:
      return {"a", a};
    case 1:
      return {"b_2", b};
    case 2:
      return {"O.q", c};
    case 3:
      return {"1.5e-1", 1.5e-1};
    default:
      return {"pi", 3.14159265358979323846};
  }
}

Made any(RandomTree& random, int depth);

Made comparison(RandomTree& random, int depth) {
  const Made x = any(random, depth - 1), y = any(random, depth - 1);
  const auto told = [&](const char* sign, bool holds) {
    return Made{"(" + x.text + " " + sign + " " + y.text + ")", holds ? 1.0 : 0.0};
  };
  switch (random.below(6)) {
    case 0:
      return told("<", x.value < y.value);
    case 1:
      return told("<=", x.value <= y.value);
    case 2:
      return told(">", x.value > y.value);
    case 3:
      return told(">=", x.value >= y.value);
    case 4:
      return told("==", x.value == y.value);
    default:
      return told("!=", x.value != y.value);
  }
}

Made truth(RandomTree& random, int depth) {
  const Made x = comparison(random, depth), y = comparison(random, depth);
  switch (random.below(4)) {
    case 0:
      return {"(" + x.text + " and " + y.text + ")", x.value != 0 && y.value != 0 ? 1.0 : 0.0};
    case 1:
      return {"(" + x.text + " or " + y.text + ")", x.value != 0 || y.value != 0 ? 1.0 : 0.0};
    case 2:
      return {"(not " + x.text + ")", x.value == 0 ? 1.0 : 0.0};
    default:
      return x;
  }
}

Made any(RandomTree& random, int depth) {
  if (depth <= 0) return number(random);
  const Made x = any(random, depth - 1), y = any(random, depth - 1);
  const auto of = [&](const std::string& function, double v) {
    return Made{function + "(" + x.text + ")", v};
  };
  const auto of_both = [&](const std::string& function, double v) {
    return Made{function + "(" + x.text + ", " + y.text + ")", v};
  };
  const auto between = [&](const std::string& sign, double v) {
    return Made{"(" + x.text + sign + y.text + ")", v};
  };
  switch (random.below(27)) {
    case 0:
      return between(" + ", x.value + y.value);
    case 1:
      return between("-", x.value - y.value);
    case 2:
      return between("*", x.value * y.value);
    case 3:
      return between(" / ", x.value / y.value);
    case 4:
      return between("^", std::pow(x.value, y.value));
    case 5:
      return {"(-" + x.text + ")", -x.value};
    case 6:
      return {"(+" + x.text + ")", x.value};
    case 7:
      return of("sin", std::sin(x.value));
    case 8:
      return of("cos", std::cos(x.value));
    case 9:
      return of("tan", std::tan(x.value));
    case 10:
      return of("asin", std::asin(x.value));
    case 11:
      return of("acos", std::acos(x.value));
    case 12:
      return of("atan", std::atan(x.value));
    case 13:
      return of("sinh", std::sinh(x.value));
    case 14:
      return of("cosh", std::cosh(x.value));
    case 15:
      return of("tanh", std::tanh(x.value));
    case 16:
      return of("exp", std::exp(x.value));
    case 17:
      return of("log", std::log(x.value));
    case 18:
      return of("sqrt", std::sqrt(x.value));
    case 19:
      return of("abs", std::abs(x.value));
    case 20:
      return of("sign", x.value > 0 ? 1 : x.value < 0 ? -1 : x.value);
    case 21:
      return of("floor", std::floor(x.value));
    case 22:
      return of_both("atan2", std::atan2(x.value, y.value));
    case 23:
      return of_both("hypot", std::hypot(x.value, y.value));
    case 24:
      return of_both("min", std::isunordered(x.value, y.value) ? x.value + y.value
                            : x.value < y.value                ? x.value
                                                               : y.value);
    case 25:
      return of_both("max", std::isunordered(x.value, y.value) ? x.value + y.value
                            : x.value > y.value                ? x.value
                                                               : y.value);
    default: {
      const Made condition = truth(random, depth - 1);
      return {"if(" + condition.text + ", " + x.text + ", " + y.text + ")",
              condition.value != 0 ? x.value : y.value};
    }
  }
}

TEST(Expression, IsTheSameAsTheCalls) {
  int finite = 0;
  for (unsigned seed = 0; seed < 3000; ++seed) {
    RandomTree random(seed);
    const Made made = any(random, 1 + static_cast<int>(seed % 5));
    if (!std::isfinite(made.value) || made.text.size() > 9000) continue;
    ++finite;
    // Powers with whole exponents are products, which round otherwise.
    EXPECT_NEAR(value(made.text), made.value, 1e-11 * (1 + std::abs(made.value))) << made.text;
  }
  EXPECT_GT(finite, 1000);
}

TEST(Expression, OperatorsBindAsUsual) {
  EXPECT_EQ(value("1 + 2 * 3"), 7);
  EXPECT_EQ(value("8 - 2 - 1"), 5);
  EXPECT_EQ(value("8 / 2 / 2"), 2);
  EXPECT_EQ(value("-3^2"), -9);
  EXPECT_EQ(value("2^3^2"), 512);
  EXPECT_EQ(value("2^-2"), 0.25);
  EXPECT_EQ(value("2 * -3"), -6);
  EXPECT_EQ(value("--3"), 3);
  EXPECT_EQ(value("if(1 < 2 and 2 < 1 or 3 < 4, 5, 6)"), 5);
  EXPECT_EQ(value("if(not 1 < 2, 5, 6)"), 6);
  EXPECT_EQ(value("1.5E2 + .5"), 150.5);
  EXPECT_EQ(value("(-2)^3"), -8);
  EXPECT_EQ(value("if(a < 1, 1 / 0, 2)"), std::numeric_limits<double>::infinity());
}

TEST(Expression, SaysWhetherItCompares) {
  EXPECT_TRUE(Expression("a + 1 <= b_2", names).is_truth());
  EXPECT_TRUE(Expression("not (a == 1) or a > 2", names).is_truth());
  EXPECT_FALSE(Expression("if(a < 1, 2, 3)", names).is_truth());
}

TEST(Expression, ComputesOnceWhatOccursTwice) {
  const Expression once("sin(a * 2) + 1", names), twice("sin(a * 2) + 1 + 0 * sin(a * 2)", names);
  EXPECT_LE(twice.tape().size(), once.tape().size() + 3);
  EXPECT_EQ(Expression("2 * pi / 4 + sqrt(9)", names).tape().size(), 1U);
  EXPECT_EQ(Expression("a + 0 * (b_2 + O.q)", names).variables(), (std::vector{0, 1, 2}));
}

struct Mistake {
  const char* text;
  std::size_t place;
  const char* sentence;  ///< a part of it
};

TEST(Expression, MistakesAreNamedWithTheirPlace) {
  const Mistake mistakes[] = {
      {"", 0, "is empty"},
      {"   ", 3, "ends where a number is expected"},
      {"a +", 3, "ends where a number is expected"},
      {"a + * 2", 4, "found '*'"},
      {"(a + 1", 0, "a bracket '(' is not closed, expected ')'"},
      {"a + 1)", 5, "found ')', expected an operator or the end"},
      {"a a", 2, "found 'a', expected an operator"},
      {"2a", 0, "found '2a', expected an operator after the number"},
      {"1..5", 0, "expected an operator after the number"},
      {"1e999", 0, "found a number that no double can hold"},
      {"b_3", 0, "unknown name 'b_3'; did you mean 'b_2'?"},
      {"zeta * 2", 0, "unknown name 'zeta', expected one of: a, b_2, O.q, pi"},
      {"1 + P.q", 4, "unknown name 'P.q'; did you mean 'O.q'?"},
      {"sine(a)", 0, "unknown function 'sine'; did you mean 'sin'?"},
      {"sin", 0, "function 'sin' stands without '('"},
      {"sin(a, a)", 0, "function 'sin' has 2 arguments, expected 1"},
      {"atan2(a)", 0, "function 'atan2' has 1 arguments, expected 2"},
      {"sin()", 0, "function 'sin' has 0 arguments"},
      {"max(a, 2", 8, "the bracket of function 'max' is not closed, expected ')'"},
      {"max(a; 2)", 5, "found ';', expected ',' or ')'"},
      {"a ** 2", 2, "found '**', expected '^'"},
      {"a < b_2 < 3", 8, "expected 'and' between two of them"},
      {"a + (a < 1)", 4, "a comparison stands where a number is expected"},
      {"a and a < 1", 0, "a number stands where a comparison is expected"},
      {"if(a, 1, 2)", 3, "a number stands where a comparison is expected"},
      {"if(a < 1, a < 2, 2)", 10, "a comparison stands where a number is expected"},
      {"not a", 4, "a number stands where a comparison is expected"},
      {"-(a < 1)", 1, "a comparison stands where a number is expected"},
      {"a = 2", 2, "found '='"},
      {"a & 1", 2, "found '&'"},
      {"µ + 1", 0, "found 'µ', expected a number or a name"},
      {"a.", 1, "found '.'"},
      {"$a", 0, "found '$'"},
      {"pi(2)", 0, "'pi' is no function, expected an operator between it and '('"},
      {"a(2)", 0, "'a' is no function, expected an operator between it and '('"},
      {"ln(a)", 0, "unknown function 'ln', expected log(x)"},
      {"a*1,5", 3, "found ',' in a number, expected '.'"},
      {"if(a < 1 && a > 0, a, 1)", 9, "found '&&', expected 'and'"},
      {"a²", 1, "found '²', expected '^2'"},
  };
  for (const Mistake& m : mistakes) {
    try {
      (void)Expression(m.text, names);
      ADD_FAILURE() << m.text << " is read";
    } catch (const ExpressionError& e) {
      EXPECT_NE(std::string(e.what()).find(m.sentence), std::string::npos)
          << m.text << ": " << e.what();
      EXPECT_EQ(e.place(), m.place) << m.text << ": " << e.what();
    }
  }
}

TEST(Expression, NamesMayHaveBrackets) {
  const std::vector<std::string> with{"x", "der(x)", "der"};
  const double values[]{3, 5, 7};
  const auto value = [&](const char* text) { return Expression(text, with)(values); };
  EXPECT_EQ(value("der(x) - x"), 2);
  EXPECT_EQ(value("2*der ( x )^2"), 50);
  EXPECT_EQ(value("sin(der(x))"), std::sin(5.0));
  EXPECT_EQ(value("der + (x)"), 10);
  EXPECT_EQ(Expression("der(x) + der(x)*x", with).variables(), (std::vector<int>{0, 1}));
  const auto sentence = [&](const char* text) {
    try {
      (void)Expression(text, with);
    } catch (const ExpressionError& e) {
      return std::to_string(e.place()) + " " + e.what();
    }
    return std::string("is read");
  };
  EXPECT_EQ(sentence("1 + der(y)"), "4 unknown name 'der(y)'; did you mean 'der(x)'?");
  EXPECT_EQ(sentence("der(x + 1)"), "0 unknown name 'der(x+1)'; did you mean 'der(x)'?");
  EXPECT_EQ(sentence("der(x"), "0 unknown name 'der', expected one of: der(x)");
  EXPECT_EQ(sentence("dot(x)").substr(0, 24), "0 unknown function 'dot'");
}

TEST(Expression, BoundsHowDeepAndHowLongItIs) {
  EXPECT_THROW(Expression(std::string(5000, '(') + "1" + std::string(5000, ')'), names),
               ExpressionError);
  EXPECT_THROW(Expression(std::string(9000, '-') + "1", names), ExpressionError);
  EXPECT_THROW(Expression(std::string(2'000'000, ' ') + "1", names), ExpressionError);
  std::string powers = "a", sum = "a";
  for (int i = 0; i < 2000; ++i) powers += "^a", sum += "+a";
  EXPECT_THROW(Expression(powers, names), ExpressionError);
  EXPECT_NEAR(value(sum), 2001 * a, 1e-9);
}

// What is not chosen need have no slope.
TEST(Expression, DifferentiatesWhatIsChosenAlone) {
  const std::vector<std::string> x{"x"};
  const auto slope = [&](const char* text, double at) {
    const int by = 0;
    const Expression both = Expression(text, x).with_derivatives(std::span(&by, 1));
    std::vector<double> line(both.tape().size()), values(2);
    evaluate(both, &at, line.data(), values.data());
    return values[1];
  };
  EXPECT_EQ(slope("if(x < 0, (-x)^1.5, 0)", 1), 0);
  EXPECT_NEAR(slope("if(x < 0, (-x)^1.5, 0)", -4), -3, 1e-15);
  EXPECT_NEAR(slope("if(x > 0, log(x), if(x < -1, sqrt(-x - 1), sin(x)))", -0.5), std::cos(0.5),
              1e-15);
  EXPECT_EQ(slope("2*max(0, x)^0.5", -1), 0);
  EXPECT_NEAR(slope("3*if(x > 0, 1/sqrt(x), 0)", 4), -3.0 / 16, 1e-15);
}

// With its switches held where they are a formula is what it was; each turns where its mode ends.
TEST(Expression, HoldsItsSwitches) {
  const std::vector<std::string> xy{"x", "y"};
  for (const char* text :
       {"if(x < y and not y <= 0.5, x^2, 3*y)", "abs(x - y) + sign(x)*y", "floor(3*x) + floor(y)",
        "min(x, y)*sign(max(x, 2*y))", "if(abs(x) > max(y, 0.2), sign(y), floor(x/y))"}) {
    const Expression formula(text, xy);
    Switches switches(2);
    const Expression held = switches.held(formula);
    for (const formula::Instruction& in : held.tape()) {
      EXPECT_NE(in.operation, formula::Operation::less) << text;
      EXPECT_NE(in.operation, formula::Operation::sign) << text;
      EXPECT_NE(in.operation, formula::Operation::floor) << text;
    }
    for (const double x : {-0.9, 0.3, 1.7})
      for (const double y : {-1.2, 0.4, 0.8}) {
        std::vector<double> all{x, y};
        for (std::size_t k = 0; k < switches.size(); ++k) {
          const double argument = switches.argument(k)(all);
          all.push_back(switches.mode(k, argument));
          EXPECT_GT(switches.margin(k, all.back(), argument), 0) << text;
        }
        EXPECT_EQ(held(all), formula(std::vector<double>{x, y})) << text;
      }
  }
  Switches switches(2);
  switches.held(Expression("floor(x)", xy));
  EXPECT_EQ(switches.name(0), "floor");
  EXPECT_EQ(switches.turned(0, 2, 3), 3);
  EXPECT_EQ(switches.turned(0, 2, 2), 1);
  EXPECT_LT(switches.margin(0, 2, 3.1), 0);
}

/// Any characters: a formula or one sentence, and no more.
TEST(Expression, AnyTextIsReadOrRefused) {
  const std::string letters = "ab_2O.q sincoqrtif()(),+-*/^<>=!andornot0123456789e.\x80\xff\n";
  int read = 0;
  for (unsigned seed = 0; seed < 20'000; ++seed) {
    RandomTree random(seed);
    std::string text;
    for (int i = random.below(12); i >= 0; --i)
      text += letters[static_cast<std::size_t>(random.below(static_cast<int>(letters.size())))];
    try {
      (void)value(text);
      ++read;
    } catch (const ExpressionError& e) {
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
      EXPECT_LE(e.place(), text.size());
    }
  }
  EXPECT_GT(read, 100);
}

}  // namespace
}  // namespace momenta::core_expression
