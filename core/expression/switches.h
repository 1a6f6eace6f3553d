#pragma once
// The switches of formulas: what comparisons, sign and floor turn at. With each of them held as it
// is, a formula has no jump: it has a variable where it had the switch,
//
//   a < b → m,   sign(a) → m,   floor(a) → m,
//
// and it turns where its argument, a − b or a, leaves what the mode m is of. Corners in arguments
// are switches too, so that arguments are smooth and no zero is between two looks,
//
//   abs(a) → m a,   min(a, b), max(a, b) → if(m, b, a).
//
// Elsewhere corners stay as they are: beside them formulas may have no values, sqrt(abs(x)). So do
// a == b and a != b, which hold or fail at single places.

#include <momenta/core/expression/expression.h>
#include <momenta/core/expression/tape.h>

#include <string_view>
#include <vector>

namespace momenta {

class Switches {
 public:
  /// Of formulas of so many variables; mode k is variable `variables` + k.
  explicit Switches(int variables) : variables_(variables) {}

  /// A formula with its switches held; equal switches of several formulas are one. What it takes of
  /// functions by points must outlive the result. O(tape)
  Expression held(const Expression& formula);

  std::size_t size() const { return all_.size(); }
  /// "sign", "floor", …; of comparisons "if".
  std::string_view name(std::size_t k) const;
  /// a − b or a, of the variables and the modes of switches before it.
  const Expression& argument(std::size_t k) const { return all_[k].argument; }
  /// m at a value of the argument.
  double mode(std::size_t k, double argument) const;
  /// Above zero where m is the mode, below zero where it is not.
  double margin(std::size_t k, double mode, double argument) const;
  /// The mode behind a zero of the margin, near which the argument has this value.
  double turned(std::size_t k, double mode, double argument) const;

 private:
  struct Switch {
    formula::Operation operation;
    int a, b;  ///< places on the tape
    Expression argument;
  };
  /// The place of its mode.
  int mode_of(formula::Operation operation, int a, int b);

  int variables_;
  formula::Tape tape_;
  std::vector<Switch> all_;
};

}  // namespace momenta
