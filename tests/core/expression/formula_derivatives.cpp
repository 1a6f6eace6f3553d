// Formulas in every scalar against what they were computed from: derivatives by tapes, by dual
// numbers and along power series are one thing, and differences tend to them.

#include <gtest/gtest.h>
#include <momenta/core/expression/evaluate.h>
#include <momenta/core/expression/functions_quad.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace momenta::core_formula_derivatives {
namespace {

const std::vector<std::string> names{"x", "y", "t"};
constexpr std::array<double, 3> at{0.37, 0.61, 1.3};
constexpr std::array<int, 3> all{0, 1, 2};

/// Every operation and function with all it takes changing, and where they lie within each other.
const std::vector<std::string> smooth{"-x + y - t * x / y",
                                      "x^3 - y^-2 + t^1",
                                      "x^y + t^2.5 + 2^x",
                                      "sin(x) * cos(y) + tan(t * x)",
                                      "asin(x * y) - acos(x / 2) + atan(t - y)",
                                      "sinh(x) + cosh(y * t) - tanh(x - t)",
                                      "exp(-x * y) * log(t + x^2) + sqrt(x + y)",
                                      "atan2(x - t, y) + hypot(x, y * t)",
                                      "sqrt(sin(x)^2 + exp(tanh(y) / (1 + t^2))) ^ (x / y)"};
const std::vector<std::string> cornered{
    "if(x < y and not t <= 1, x^2 * y, t)", "if(x >= y or t == 2, x, y * t * y)",
    "min(x * t, y) + max(x^2, sin(y) * t)", "abs(x - t) * y + sign(x - y) * t + floor(9 * x) * y"};

std::vector<std::string> everything() {
  std::vector<std::string> list = smooth;
  list.insert(list.end(), cornered.begin(), cornered.end());
  return list;
}

template <class S>
std::vector<S> values(const Expression& f, const std::vector<S>& x) {
  std::vector<S> line(f.tape().size()), result(f.outputs().size());
  evaluate(f, x.data(), line.data(), result.data());
  return result;
}

template <class S>
std::vector<S> point() {
  return {S(at[0]), S(at[1]), S(at[2])};
}

TEST(FormulaDerivatives, GradientOfTheTapeIsThatOfDualNumbers) {
  using D = Dual<double, 3>;
  for (const std::string& text : everything()) {
    const Expression f(text, names);
    const std::vector<double> tape = values(f.with_derivatives(all), point<double>());
    std::vector<D> x;
    for (int i = 0; i < 3; ++i) x.push_back(D::variable(at[static_cast<std::size_t>(i)], i));
    const D dual = values(f, x).front();
    ASSERT_EQ(tape.size(), 4U);
    EXPECT_EQ(tape[0], f(at)) << text;
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(tape[1 + i], dual.b[i], 1e-13 * (1 + std::abs(dual.b[i]))) << text << " by " << i;
  }
}

/// (f(x + h) − f(x − h)) / 2h − f' in quad precision is O(h²): 1e-16 for h = 1e-8.
TEST(FormulaDerivatives, DifferencesTendToThem) {
  for (const std::string& text : everything()) {
    const Expression f(text, names), slopes = f.with_derivatives(all);
    const std::vector<Quad> exact = values(slopes, point<Quad>());
    for (std::size_t i = 0; i < 3; ++i) {
      std::vector<Quad> more = point<Quad>(), less = more;
      more[i] += Quad(1e-8), less[i] -= Quad(1e-8);
      const Quad difference = (values(f, more)[0] - values(f, less)[0]) / Quad(2e-8);
      EXPECT_NEAR(value_of(difference - exact[1 + i]), 0, 1e-13) << text << " by " << i;
    }
  }
}

/// Second derivatives three ways: of the tape's tape, dual numbers in dual numbers, dual numbers on
/// the tape.
TEST(FormulaDerivatives, SecondOnesAgree) {
  using D = Dual<double, 1>;
  using DD = Dual<D, 1>;
  for (const std::string& text : everything()) {
    const Expression f(text, names);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const std::array<int, 1> by_i{i}, by_j{j};
        const Expression first = f.with_derivatives(by_i);
        std::vector<D> x = point<D>();
        x[static_cast<std::size_t>(j)].b[0] = 1;
        const double mixed = values(first, x)[1].b[0];
        std::vector<DD> xx = point<DD>();
        xx[static_cast<std::size_t>(i)].b[0].a = 1;
        xx[static_cast<std::size_t>(j)].a.b[0] = 1;
        const double nested = values(f, xx)[0].b[0].b[0];
        const double scale = 1e-12 * (1 + std::abs(mixed));
        EXPECT_NEAR(nested, mixed, scale) << text << " by " << i << j;
        const double swapped = [&] {
          std::vector<D> z = point<D>();
          z[static_cast<std::size_t>(i)].b[0] = 1;
          return values(f.with_derivatives(by_j), z)[1].b[0];
        }();
        EXPECT_NEAR(swapped, mixed, scale) << text << " by " << i << j;
      }
  }
}

/// f along x + s v as a series: its sum at a small s is f there, to O(s⁶).
TEST(FormulaDerivatives, SeriesGoAlongCurves) {
  using Series = PowerSeries<5>;
  const std::array<double, 3> v{0.3, -0.7, 1.1}, w{-0.2, 0.5, 0.4};
  for (const std::string& text : everything()) {
    const Expression f(text, names);
    std::vector<Series> x = point<Series>();
    for (std::size_t i = 0; i < 3; ++i) x[i].c[1] = v[i], x[i].c[2] = w[i];
    const Series series = values(f, x)[0];
    const auto miss = [&](double s) {
      std::vector<Quad> there = point<Quad>();
      Quad sum(0.0), power(1.0);
      for (std::size_t i = 0; i < 3; ++i) there[i] += Quad(s) * (Quad(v[i]) + Quad(s) * Quad(w[i]));
      for (std::size_t k = 0; k < Series::terms; ++k, power *= Quad(s))
        sum += Quad(series.c[k]) * power;
      return std::abs(value_of(values(f, there)[0] - sum));
    };
    EXPECT_NEAR(series.c[0], f(at), 1e-15 * (1 + std::abs(f(at)))) << text;
    EXPECT_LE(miss(1e-3), 1e-12) << text;
    // Order six, or nothing but rounding of the coefficients.
    EXPECT_TRUE(miss(2e-2) < 1e-13 || std::abs(miss(2e-2) / miss(1e-2) - 64) < 16)
        << text << ": " << miss(2e-2) << ", " << miss(1e-2);
  }
}

/// Sparse dual numbers cut what hangs on more than they hold; here three unknowns, none cut.
TEST(FormulaDerivatives, SparseDualNumbersAreDualNumbers) {
  for (const std::string& text : everything()) {
    const Expression f(text, names);
    std::vector<LocalDual> x;
    for (int i = 0; i < 3; ++i)
      x.push_back(LocalDual::variable(at[static_cast<std::size_t>(i)], i));
    const LocalDual y = values(f, x)[0];
    const std::vector<double> tape = values(f.with_derivatives(all), point<double>());
    EXPECT_EQ(y.a, tape[0]);
    std::array<double, 3> slope{};
    for (std::size_t k = 0; k < static_cast<std::size_t>(y.terms); ++k)
      slope[static_cast<std::size_t>(y.at[k])] = y.b[k];
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(slope[i], tape[1 + i], 1e-13 * (1 + std::abs(slope[i]))) << text << " by " << i;
  }
}

/// What does not move has no slope, where the formula for it has none: no NaN comes of log(−2).
TEST(FormulaDerivatives, ConstantsHaveNoShare) {
  using D = Dual<double, 1>;
  const Expression power("(x - 3)^y", names), root("sqrt(x)", names), both("hypot(x, y)", names);
  const auto slope = [](const Expression& f, double x, double y) {
    return values(f, std::vector<D>{D(x), D(y), D::variable(1.0, 0)})[0].b[0];
  };
  EXPECT_EQ(slope(power, 1, 2), 0);
  EXPECT_EQ(slope(root, 0, 0), 0);
  EXPECT_EQ(slope(both, 0, 0), 0);
  const Expression square = Expression("x^y", names).with_derivatives(std::array{1});
  EXPECT_EQ(values(square, std::vector<double>{0.0, 2.0, 0.0})[1], 0);
}

TEST(FormulaDerivatives, TellsCornersByName) {
  for (const std::string& text : smooth) EXPECT_EQ(Expression(text, names).corner(), "") << text;
  EXPECT_EQ(Expression("if(x < 1, 2, 3)", names).corner(), "if");
  EXPECT_EQ(Expression("sin(abs(x))", names).corner(), "abs");
  EXPECT_EQ(Expression("floor(x) + min(x, y)", names).corner(), "floor");
  EXPECT_EQ(Expression("x + abs(-2)", names).corner(), "");
}

/// Reverse mode: the gradient by n variables costs a few times the formula, whatever n.
TEST(FormulaDerivatives, GradientsStayShort) {
  std::vector<std::string> many;
  std::vector<int> numbers;
  std::string product = "1";
  for (int i = 0; i < 200; ++i) {
    many.push_back("x" + std::to_string(i));
    numbers.push_back(i);
    product += " * sin(x" + std::to_string(i) + ")";
  }
  const Expression f(product, many), slopes = f.with_derivatives(numbers);
  EXPECT_LE(slopes.tape().size(), 5 * f.tape().size());
}

}  // namespace
}  // namespace momenta::core_formula_derivatives
