#pragma once
// A number that records the formula computed with it, as one types it
// (core/expression/expression.h). Code that is a template over its number type,
//
//   template <class S> S length(const S* x) { using std::sqrt; return sqrt(x[0]*x[0] + x[1]*x[1]);
//   }
//
// called with Traced gives "sqrt(x*x + y*y)". It is called once and must not branch on values:
// comparisons give a TracedTruth, no bool, for choose(), the if(c, a, b) of typed formulas.
//
// Repeated parts are written once, by a definition "s1 := …;", where the text would be long or
// deep. Else the text reads as the code, whatever order C++ evaluates operands in, and gives the
// tape of the same formula typed.

#include <momenta/core/expression/expression.h>

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace momenta {

class TracedTruth;

/// A known number, or a place on the tape of a formula.
class Traced {
 public:
  /// A known number.
  Traced(double number = 0) : number_(number) {}
  /// x₀ … x_(count−1) of one tape.
  static std::vector<Traced> variables(int count);

  /// The formula, with these names for x₀, x₁, …; O(tape) characters. @throws std::logic_error
  /// where it has a number that is not finite
  std::string text(std::span<const std::string> names) const;
  /// Whether it is this number for every x.
  bool is(double number) const { return !tape_ && number_ == number; }

  friend Traced operator+(const Traced& a, const Traced& b);
  friend Traced operator-(const Traced& a, const Traced& b);
  friend Traced operator*(const Traced& a, const Traced& b);
  friend Traced operator/(const Traced& a, const Traced& b);
  friend Traced operator-(const Traced& a);
  friend Traced operator+(const Traced& a) { return a; }
  Traced& operator+=(const Traced& b) { return *this = *this + b; }  ///< itself plus b
  Traced& operator-=(const Traced& b) { return *this = *this - b; }  ///< itself minus b
  Traced& operator*=(const Traced& b) { return *this = *this * b; }  ///< itself times b
  Traced& operator/=(const Traced& b) { return *this = *this / b; }  ///< itself over b

  friend TracedTruth operator<(const Traced& a, const Traced& b);
  friend TracedTruth operator<=(const Traced& a, const Traced& b);
  friend TracedTruth operator>(const Traced& a, const Traced& b);
  friend TracedTruth operator>=(const Traced& a, const Traced& b);
  friend TracedTruth operator==(const Traced& a, const Traced& b);
  friend TracedTruth operator!=(const Traced& a, const Traced& b);
  friend TracedTruth operator&&(const TracedTruth& a, const TracedTruth& b);
  friend TracedTruth operator||(const TracedTruth& a, const TracedTruth& b);
  friend TracedTruth operator!(const TracedTruth& a);

  friend Traced sin(const Traced& a);
  friend Traced cos(const Traced& a);
  friend Traced tan(const Traced& a);
  friend Traced asin(const Traced& a);
  friend Traced acos(const Traced& a);
  friend Traced atan(const Traced& a);
  friend Traced sinh(const Traced& a);
  friend Traced cosh(const Traced& a);
  friend Traced tanh(const Traced& a);
  friend Traced exp(const Traced& a);
  friend Traced log(const Traced& a);
  friend Traced sqrt(const Traced& a);
  friend Traced abs(const Traced& a);
  friend Traced floor(const Traced& a);
  friend Traced atan2(const Traced& y, const Traced& x);
  friend Traced hypot(const Traced& a, const Traced& b);
  friend Traced min(const Traced& a, const Traced& b);
  friend Traced max(const Traced& a, const Traced& b);
  /// A product for whole exponents up to 1000, so that it has derivatives at negative bases.
  friend Traced pow(const Traced& base, const Traced& exponent);
  friend Traced pow(const Traced& base, double exponent) { return pow(base, Traced(exponent)); }
  /// a where c holds, else b; both are computed.
  friend Traced choose(const TracedTruth& c, const Traced& a, const Traced& b);

 private:
  friend class TracedTruth;
  using Operation = formula::Operation;
  Traced(std::shared_ptr<formula::Tape> tape, int place) : tape_(std::move(tape)), place_(place) {}
  /// @throws std::logic_error for operands of different calls of variables()
  static Traced of(Operation o, const Traced& a, const Traced* b = nullptr,
                   const Traced* c = nullptr, double number = 0);

  double number_ = 0;                    ///< value without a tape
  std::shared_ptr<formula::Tape> tape_;  ///< null: a known number
  int place_ = -1;
};

/// A comparison of Traced numbers: no bool, since it is unknown when the formula is written.
class TracedTruth {
 public:
  friend TracedTruth operator&&(const TracedTruth& a, const TracedTruth& b);
  friend TracedTruth operator||(const TracedTruth& a, const TracedTruth& b);
  friend TracedTruth operator!(const TracedTruth& a);

 private:
  friend class Traced;
  friend TracedTruth operator<(const Traced& a, const Traced& b);
  friend TracedTruth operator<=(const Traced& a, const Traced& b);
  friend TracedTruth operator==(const Traced& a, const Traced& b);
  friend TracedTruth operator!=(const Traced& a, const Traced& b);
  friend Traced choose(const TracedTruth& c, const Traced& a, const Traced& b);
  explicit TracedTruth(Traced value) : value_(std::move(value)) {}
  Traced value_;  ///< 1 or 0
};

/// The same for plain numbers, so that one template serves both.
inline double choose(bool c, double a, double b) {
  return c ? a : b;
}

}  // namespace momenta
