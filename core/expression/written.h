#pragma once
// A number that records the formula computed with it, as one types it
// (core/expression/expression.h). Code that is a template over its number type,
//
//   template <class S> S length(const S* x) { using std::sqrt; return sqrt(x[0]*x[0] + x[1]*x[1]);
//   }
//
// called with Written gives "sqrt(x*x + y*y)". It is called once and must not branch on values:
// comparisons give a WrittenTruth, no bool, for choose(), the if(c, a, b) of typed formulas.
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

class WrittenTruth;

/// A known number, or a place on the tape of a formula.
class Written {
 public:
  /// A known number.
  Written(double number = 0) : number_(number) {}
  /// x₀ … x_(count−1) of one tape.
  static std::vector<Written> variables(int count);

  /// The formula, with these names for x₀, x₁, …; O(tape) characters. @throws std::logic_error
  /// where it has a number that is not finite
  std::string text(std::span<const std::string> names) const;
  /// Whether it is this number for every x.
  bool is(double number) const { return !tape_ && number_ == number; }

  friend Written operator+(const Written& a, const Written& b);
  friend Written operator-(const Written& a, const Written& b);
  friend Written operator*(const Written& a, const Written& b);
  friend Written operator/(const Written& a, const Written& b);
  friend Written operator-(const Written& a);
  friend Written operator+(const Written& a) { return a; }
  Written& operator+=(const Written& b) { return *this = *this + b; }  ///< itself plus b
  Written& operator-=(const Written& b) { return *this = *this - b; }  ///< itself minus b
  Written& operator*=(const Written& b) { return *this = *this * b; }  ///< itself times b
  Written& operator/=(const Written& b) { return *this = *this / b; }  ///< itself over b

  friend WrittenTruth operator<(const Written& a, const Written& b);
  friend WrittenTruth operator<=(const Written& a, const Written& b);
  friend WrittenTruth operator>(const Written& a, const Written& b);
  friend WrittenTruth operator>=(const Written& a, const Written& b);
  friend WrittenTruth operator==(const Written& a, const Written& b);
  friend WrittenTruth operator!=(const Written& a, const Written& b);
  friend WrittenTruth operator&&(const WrittenTruth& a, const WrittenTruth& b);
  friend WrittenTruth operator||(const WrittenTruth& a, const WrittenTruth& b);
  friend WrittenTruth operator!(const WrittenTruth& a);

  friend Written sin(const Written& a);
  friend Written cos(const Written& a);
  friend Written tan(const Written& a);
  friend Written asin(const Written& a);
  friend Written acos(const Written& a);
  friend Written atan(const Written& a);
  friend Written sinh(const Written& a);
  friend Written cosh(const Written& a);
  friend Written tanh(const Written& a);
  friend Written exp(const Written& a);
  friend Written log(const Written& a);
  friend Written sqrt(const Written& a);
  friend Written abs(const Written& a);
  friend Written floor(const Written& a);
  friend Written atan2(const Written& y, const Written& x);
  friend Written hypot(const Written& a, const Written& b);
  friend Written min(const Written& a, const Written& b);
  friend Written max(const Written& a, const Written& b);
  /// A product for whole exponents up to 1000, so that it has derivatives at negative bases.
  friend Written pow(const Written& base, const Written& exponent);
  friend Written pow(const Written& base, double exponent) { return pow(base, Written(exponent)); }
  /// a where c holds, else b; both are computed.
  friend Written choose(const WrittenTruth& c, const Written& a, const Written& b);

 private:
  friend class WrittenTruth;
  using Operation = formula::Operation;
  Written(std::shared_ptr<formula::Tape> tape, int place) : tape_(std::move(tape)), place_(place) {}
  /// @throws std::logic_error for operands of different calls of variables()
  static Written of(Operation o, const Written& a, const Written* b = nullptr,
                    const Written* c = nullptr, double number = 0);

  double number_ = 0;                    ///< value without a tape
  std::shared_ptr<formula::Tape> tape_;  ///< null: a known number
  int place_ = -1;
};

/// A comparison of Written numbers: no bool, since it is unknown when the formula is written.
class WrittenTruth {
 public:
  friend WrittenTruth operator&&(const WrittenTruth& a, const WrittenTruth& b);
  friend WrittenTruth operator||(const WrittenTruth& a, const WrittenTruth& b);
  friend WrittenTruth operator!(const WrittenTruth& a);

 private:
  friend class Written;
  friend WrittenTruth operator<(const Written& a, const Written& b);
  friend WrittenTruth operator<=(const Written& a, const Written& b);
  friend WrittenTruth operator==(const Written& a, const Written& b);
  friend WrittenTruth operator!=(const Written& a, const Written& b);
  friend Written choose(const WrittenTruth& c, const Written& a, const Written& b);
  explicit WrittenTruth(Written value) : value_(std::move(value)) {}
  Written value_;  ///< 1 or 0
};

/// The same for plain numbers, so that one template serves both.
inline double choose(bool c, double a, double b) {
  return c ? a : b;
}

}  // namespace momenta
