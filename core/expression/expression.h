#pragma once
// Formulas of users: numbers, + − * / ^, comparisons, and, or, not, if(c, a, b), the usual
// functions, pi, and names known to the caller; nothing else is executed.
//
//   or:         and { "or" and }                    power:   primary [ "^" sign ]
//   and:        not { "and" not }                   sign:    { "-" | "+" } power
//   not:        "not" not | comparison              primary: number | name | "(" or ")"
//   comparison: sum [ (< <= > >= == !=) sum ]                | function "(" or { "," or } ")"
//   sum:        product { (+ -) product }
//   product:    sign { (* /) sign }
//
// So −a^2 = −(a²), 2^3^2 = 2^9, a < b < c is refused. Names are letters, digits and _, begin with a
// letter, and may be joined by dots; the first may stand in single quotes with any other
// characters: 'left-knee'.q. A caller may know names with brackets, "der(x)"; they are no calls.
// Comparisons give truths, which are no numbers and which only and, or, not and if() take.
//
// A formula is kept as a tape: one instruction a line, each of numbers found by those before it;
// repeated parts are computed once, parts of numbers alone when it is read. Both values of if() are
// computed and one is taken. Derivatives are tapes too and can be differentiated again (evaluate.h
// computes a tape in any scalar).

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

/// The sentence on a text that is no formula; the place counts characters from 0.
class ExpressionError : public std::invalid_argument {
 public:
  ExpressionError(const std::string& sentence, std::size_t place)
      : std::invalid_argument(sentence), place_(place) {}
  std::size_t place() const { return place_; }

 private:
  std::size_t place_;
};

/// Whether a name is letters, digits and _, a letter or _ first: formulas take it unquoted.
bool is_plain_name(std::string_view name);
/// Whether formulas have a function, a number or a word of this name themselves.
bool is_reserved_name(std::string_view name);

/// Meanings of the names in a formula.
class FormulaNames {
 public:
  /// A variable, or a number.
  struct Meaning {
    int variable = -1;  ///< number of the variable; −1: none
    double number = 0;  ///< the number, where it is no variable
  };
  virtual ~FormulaNames() = default;
  /// Meaning of a name written at a place; nothing: unknown. @throws ExpressionError
  virtual std::optional<Meaning> meaning(std::string_view name, std::size_t place) = 0;
  /// A function of one number by its name; null: unknown.
  virtual std::shared_ptr<const CubicSpline> function(std::string_view) { return nullptr; }
  /// The names of these functions.
  virtual std::vector<std::string_view> functions() const { return {}; }
  /// End of the sentence on an unknown name: "; did you mean …?", or ", expected …".
  virtual std::string expected(std::string_view name) const = 0;
  /// The same for a name with brackets, "der(x)", where known names begin so; else empty.
  virtual std::string expected_in_brackets(std::string_view, std::string_view) const { return {}; }
};

/// A formula read: y = f(x₀, x₁, …), perhaps with derivatives.
class Expression {
 public:
  using Operation = formula::Operation;
  using Instruction = formula::Instruction;

  /// A formula of the variables x₀, x₁, … by name. @throws ExpressionError. O(length) and look-ups
  Expression(std::string_view text, std::span<const std::string> names);
  /// A formula of names of any meaning. @throws ExpressionError
  Expression(std::string_view text, FormulaNames& names);
  /// The values at these places of a tape, simplified (core/expression/simplify.h). O(tape)
  Expression(const formula::Tape& tape, std::span<const int> outputs);

  /// Whether the formula is a truth: its value is then 1 or 0.
  bool is_truth() const { return truth_; }
  /// Numbers of the variables in it, ascending.
  std::vector<int> variables() const;
  const std::vector<Instruction>& tape() const { return tape_; }
  /// Places of its values on the tape: f, then derivatives.
  const std::vector<int>& outputs() const { return outputs_; }
  /// Steps that run the tape in plain numbers, on a line no longer than the tape.
  const formula::Steps& steps() const { return steps_; }

  /// f and ∂f/∂x_v of each of these variables, exact; abs, sign, floor, min, max and if() have the
  /// derivative of their piece. O(tape) instructions for any number of variables.
  Expression with_derivatives(std::span<const int> variables) const;
  /// f, ∂f/∂x_v and ∂²f/∂x_v², equally exact.
  Expression with_two_derivatives(int variable) const;
  /// f, ∂f/∂x_v of each of these variables, and ∂²f/∂x_v∂x_w for w up to v, v by v.
  Expression with_second_derivatives(std::span<const int> variables) const;
  /// Name of a function in it with corners or jumps, or of one by points with corners or jumps in
  /// f' or f"; empty: f" is continuous where it is finite.
  std::string_view corner() const;

  /// The value; infinite or not a number where arithmetic makes it so. O(tape)
  double operator()(std::span<const double> x) const;

 private:
  Expression() = default;
  /// Keeps the instructions needed for these places of a tape.
  void keep(const formula::Tape& tape, std::vector<int> outputs);
  /// The values at these places of a tape that continues that of this formula.
  Expression with(const formula::Tape& tape, std::vector<int> outputs) const;
  std::vector<Instruction> tape_;
  std::vector<int> outputs_;
  std::vector<std::shared_ptr<const CubicSpline>> splines_;  ///< functions by points on the tape
  formula::Steps steps_;
  bool truth_ = false;
};

}  // namespace momenta
