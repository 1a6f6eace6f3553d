#pragma once
// Instructions of a formula, each once.

#include <momenta/core/expression/expression.h>

#include <unordered_map>
#include <utility>

namespace momenta::formula {

/// How many instructions before it an instruction takes.
int operands_of(Operation operation);

/// A tape while it is written.
class Tape {
 public:
  Tape() = default;
  /// Goes on where another ended.
  explicit Tape(const std::vector<Instruction>& written);

  /// The place of this instruction: a new one at the end, or where it stands already. Of numbers
  /// alone: that of the number it gives.
  int add(Instruction in);
  int add(Operation o, int a, int b = -1, int c = -1) { return add({o, a, b, c, 0}); }
  int number(double x) { return add({Operation::number, -1, -1, -1, x}); }
  const Instruction& operator[](int i) const { return all_[static_cast<std::size_t>(i)]; }
  int size() const { return static_cast<int>(all_.size()); }

  /// What these instructions need, in its order; `at` becomes their places in it.
  std::vector<Instruction> needed_for(std::vector<int>& at) const;

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

/// Adds the derivatives of instruction `value` by variables: their places, of zeros that of the
/// number 0. Reverse mode: one pass over the tape, O(tape) new instructions for any number of them.
/// Source: Griewank and Walther, Evaluating Derivatives, section 3.2.
std::vector<int> add_gradient(Tape& tape, int value, std::span<const int> variables);

}  // namespace momenta::formula
