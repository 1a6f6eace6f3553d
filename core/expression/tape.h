#pragma once
// Instructions of a formula, each once.

#include <momenta/core/expression/expression.h>

#include <unordered_map>
#include <utility>

namespace momenta::formula {

using Operation = Expression::Operation;
using Instruction = Expression::Instruction;

/// How many instructions before it an instruction takes.
int operands_of(Operation operation);

/// An operation's value from those of a, b and c; neither a number nor a variable.
double value_of(const Instruction& in, double a, double b, double c);

/// A tape while it is written.
class Tape {
 public:
  /// The place of this instruction: a new one at the end, or where it stands already. Of numbers
  /// alone: that of the number it gives.
  int add(Instruction in);
  int number(double x) { return add({Operation::number, -1, -1, -1, x}); }
  const Instruction& operator[](int i) const { return all_[static_cast<std::size_t>(i)]; }

  /// What the last instruction needs; it stays the last.
  std::vector<Instruction> for_value(int last) const;

 private:
  bool is_number(int i) const { return i < 0 || (*this)[i].operation == Operation::number; }

  struct Hash {
    std::size_t operator()(const Instruction& in) const;
  };
  /// Bit by bit: −0 is another number than 0, and what is no number is itself.
  struct Equal {
    bool operator()(const Instruction& x, const Instruction& y) const;
  };
  std::vector<Instruction> all_;
  std::unordered_map<Instruction, int, Hash, Equal> known_;
};

}  // namespace momenta::formula
