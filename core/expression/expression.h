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
// letter, and may have dots between; the first of them may stand in single quotes and then has any
// other characters: 'left-knee'.q. A caller may know names with brackets, "der(x)"; they are no
// calls. Comparisons give truths, which and, or, not and if() take and
// nothing else does; a truth is no number.
//
// A formula is kept as a tape: one instruction a line, each of numbers found by those before it;
// what occurs twice is computed once, what is made of numbers alone when it is read. Both values of
// if() are computed and one is taken. Derivatives are tapes too, so that they have derivatives
// again (evaluate.h computes a tape in any scalar).

#include <momenta/core/expression/steps.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace momenta {

class CubicSpline;  // core/expression/spline.h
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

/// Whether it is letters, digits and _, a letter or _ first: a name that formulas take as it is.
bool is_plain_name(std::string_view name);
/// Whether formulas have a function, a number or a word of this name by themselves.
bool is_reserved_name(std::string_view name);

/// What the names in a formula stand for.
class FormulaNames {
 public:
  /// A variable, or a number.
  struct Meaning {
    int variable = -1;  ///< its number; −1: none
    double number = 0;  ///< where it is no variable
  };
  virtual ~FormulaNames() = default;
  /// Of a name as it is written at a place; nothing: it is unknown. @throws ExpressionError
  virtual std::optional<Meaning> meaning(std::string_view name, std::size_t place) = 0;
  /// A function of one number by its name; null: unknown.
  virtual std::shared_ptr<const CubicSpline> function(std::string_view) { return nullptr; }
  /// The names of these functions.
  virtual std::vector<std::string_view> functions() const { return {}; }
  /// How the sentence about an unknown name ends: "; did you mean …?", or ", expected …".
  virtual std::string expected(std::string_view name) const = 0;
  /// The same of a name with brackets, "der(x)", where there are such that begin with the word,
  /// "der"; empty: there are none.
  virtual std::string expected_in_brackets(std::string_view, std::string_view) const { return {}; }
};

/// A formula read: y = f(x₀, x₁, …), or such with its derivatives.
class Expression {
 public:
  using Operation = formula::Operation;
  using Instruction = formula::Instruction;

  /// The names of the variables x₀, x₁, … @throws ExpressionError. O(length) and lookups of names
  Expression(std::string_view text, std::span<const std::string> names);
  /// Names of any meaning. @throws ExpressionError
  Expression(std::string_view text, FormulaNames& names);
  /// The values at these places of a tape, simplified (core/expression/simplify.h). O(tape)
  Expression(const formula::Tape& tape, std::span<const int> outputs);

  /// Whether the formula is a comparison or made of such: its value is then 1 or 0.
  bool is_truth() const { return truth_; }
  /// Which variables it takes, ascending.
  std::vector<int> variables() const;
  const std::vector<Instruction>& tape() const { return tape_; }
  /// Where its values stand on the tape: f, then its derivatives.
  const std::vector<int>& outputs() const { return outputs_; }
  /// How the tape is run in plain numbers; their line is no longer than the tape.
  const formula::Steps& steps() const { return steps_; }

  /// f and ∂f/∂x_v of each of these variables, exact: of abs, sign, floor, min, max and if() that
  /// of the piece they are on. O(tape) instructions for any number of variables.
  Expression with_derivatives(std::span<const int> variables) const;
  /// f, ∂f/∂x_v and ∂²f/∂x_v², as exact as those.
  Expression with_two_derivatives(int variable) const;
  /// f, ∂f/∂x_v of each of these variables, and ∂²f/∂x_v∂x_w for w up to v, v by v.
  Expression with_second_derivatives(std::span<const int> variables) const;
  /// A function in it that has corners or jumps, by its name, or one by points that has them in f'
  /// or f"; empty: none, f" is continuous where it is finite.
  std::string_view corner() const;

  /// Its value; infinite or not a number where arithmetic makes it so. O(tape)
  double operator()(std::span<const double> x) const;

 private:
  Expression() = default;
  /// Keeps what these places of a tape need.
  void keep(const formula::Tape& tape, std::vector<int> outputs);
  /// The values at these places of a tape that goes on from this formula's.
  Expression with(const formula::Tape& tape, std::vector<int> outputs) const;
  std::vector<Instruction> tape_;
  std::vector<int> outputs_;
  std::vector<std::shared_ptr<const CubicSpline>> splines_;  ///< those that it takes
  formula::Steps steps_;
  bool truth_ = false;
};

}  // namespace momenta
