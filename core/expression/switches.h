#pragma once
// Switches of formulas: comparisons, sign and floor. With each of them held, a formula has no jump:
// a variable, the mode m, stands for the switch,
//
//   a < b → m,   sign(a) → m,   floor(a) → m,
//
// and the switch turns where its argument, a − b or a, leaves the range of m. Corners in arguments
// are switches too, so that arguments are smooth and no zero hides between two looks,
//
//   abs(a) → m a,   min(a, b), max(a, b) → if(m, b, a).
//
// Elsewhere corners stay: beside them formulas may have no values, sqrt(abs(x)). So do a == b and a
// != b, which change at single places.

#include <momenta/core/expression/expression.h>
#include <momenta/core/expression/tape.h>

#include <string_view>
#include <vector>

namespace momenta {

class Switches {
 public:
  /// For formulas of so many variables; mode k is variable `variables` + k.
  explicit Switches(int variables) : variables_(variables) {}

  /// A formula with its switches held; equal switches of several formulas are one. Functions by
  /// points in it must outlive the result. O(tape)
  Expression held(const Expression& formula);

  std::size_t size() const { return all_.size(); }
  /// "sign", "floor", …; "if" for comparisons.
  std::string_view name(std::size_t k) const;
  /// a − b or a, of the variables and the modes of earlier switches.
  const Expression& argument(std::size_t k) const { return all_[k].argument; }
  /// The mode m at a value of the argument.
  double mode(std::size_t k, double argument) const;
  /// Positive where m is the mode, else negative.
  double margin(std::size_t k, double mode, double argument) const;
  /// The mode behind a zero of the margin where the argument has this value.
  double turned(std::size_t k, double mode, double argument) const;

 private:
  struct Switch {
    formula::Operation operation;
    int a, b;  ///< places on the tape
    Expression argument;
  };
  /// Variable of the mode of this switch.
  int mode_of(formula::Operation operation, int a, int b);

  int variables_;
  formula::Tape tape_;
  std::vector<Switch> all_;
};

}  // namespace momenta
