#pragma once
// Formulas that users write: numbers, + − * / ^, comparisons, and, or, not, if(c, a, b), the usual
// functions, pi, and names that the caller knows. A formula executes nothing but these.
//
//   or:         and { "or" and }                    power:   primary [ "^" sign ]
//   and:        not { "and" not }                   sign:    { "-" | "+" } power
//   not:        "not" not | comparison              primary: number | name | "(" or ")"
//   comparison: sum [ (< <= > >= == !=) sum ]                | function "(" or { "," or } ")"
//   sum:        product { (+ -) product }
//   product:    sign { (* /) sign }
//
// So −a^2 = −(a²), 2^3^2 = 2^9, a < b < c is refused. Names are letters, digits and _, begin with a
// letter, and may have dots between. Comparisons give truths, which and, or, not and if() take and
// nothing else does; a truth is no number.
//
// A formula is kept as a tape: one instruction a line, each of numbers found by those before it;
// what occurs twice is computed once, what is made of numbers alone when it is read. Both values of
// if() are computed and one is taken. Derivatives are tapes too, so that they have derivatives
// again (evaluate.h computes a tape in any scalar).

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace momenta {

namespace formula {
class Tape;  // core/expression/tape.h
}

/// A formula that is none: one sentence; the place counts characters from 0.
class ExpressionError : public std::invalid_argument {
 public:
  ExpressionError(const std::string& sentence, std::size_t place)
      : std::invalid_argument(sentence), place_(place) {}
  std::size_t place() const { return place_; }

 private:
  std::size_t place_;
};

/// A formula read: y = f(x₀, x₁, …), or such with its derivatives.
class Expression {
 public:
  enum class Operation : std::uint8_t {
    number,
    variable,
    negative,
    add,
    subtract,
    multiply,
    divide,
    power,
    whole_power,
    less,
    less_equal,
    equal,
    unequal,
    both,
    either,
    opposite,
    choice,
    sin,
    cos,
    tan,
    asin,
    acos,
    atan,
    sinh,
    cosh,
    tanh,
    exp,
    log,
    sqrt,
    abs,
    sign,
    floor,
    atan2,
    hypot,
    min,
    max
  };
  struct Instruction {
    Operation operation = Operation::number;
    int a = -1, b = -1, c = -1;  ///< instructions before; of a variable a is its number
    double number = 0;           ///< of a whole power the exponent
  };

  /// The names of the variables x₀, x₁, … @throws ExpressionError. O(length) and lookups of names
  Expression(std::string_view text, std::span<const std::string> names);
  /// The values at these places of a tape, simplified (core/expression/simplify.h). O(tape)
  Expression(const formula::Tape& tape, std::span<const int> outputs);

  /// Whether the formula is a comparison or made of such: its value is then 1 or 0.
  bool is_truth() const { return truth_; }
  /// Which variables it takes, ascending.
  std::vector<int> variables() const;
  const std::vector<Instruction>& tape() const { return tape_; }
  /// Where its values stand on the tape: f, then its derivatives.
  const std::vector<int>& outputs() const { return outputs_; }

  /// f and ∂f/∂x_v of each of these variables, exact: of abs, sign, floor, min, max and if() that
  /// of the piece they are on. O(tape) instructions for any number of variables.
  Expression with_derivatives(std::span<const int> variables) const;
  /// A function in it that has corners or jumps, by its name; empty: none, f is smooth where it is
  /// finite.
  std::string_view corner() const;

  /// Its value; infinite or not a number where arithmetic makes it so. O(tape)
  double operator()(std::span<const double> x) const;

 private:
  Expression() = default;
  std::vector<Instruction> tape_;
  std::vector<int> outputs_;
  bool truth_ = false;
};

}  // namespace momenta
