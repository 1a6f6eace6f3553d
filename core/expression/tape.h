#pragma once
// Instructions of a formula, each once.

#include <momenta/core/expression/expression.h>

#include <unordered_map>
#include <utility>

namespace momenta::formula {

/// Number of operands of an instruction.
int operands_of(Operation operation);

/// A tape under construction.
class Tape {
 public:
  Tape() = default;
  /// Continues a written tape.
  explicit Tape(const std::vector<Instruction>& written);

  /// The place of this instruction, added unless it is there; for operands that are numbers, that
  /// of the result.
  int add(Instruction in);
  int add(Operation o, int a, int b = -1, int c = -1) { return add({o, a, b, c, 0}); }
  int number(double x) { return add({Operation::number, -1, -1, -1, x}); }
  const Instruction& operator[](int i) const { return all_[static_cast<std::size_t>(i)]; }
  int size() const { return static_cast<int>(all_.size()); }

  /// The instructions needed for the places `at`, in order; `at` becomes their places among them.
  std::vector<Instruction> needed_for(std::vector<int>& at) const;

 private:
  bool is_number(int i) const { return i < 0 || (*this)[i].operation == Operation::number; }

  struct Hash {
    std::size_t operator()(const Instruction& in) const;
  };
  /// Bit by bit: −0 differs from 0, and NaN equals itself.
  struct Equal {
    bool operator()(const Instruction& x, const Instruction& y) const;
  };
  std::vector<Instruction> all_;
  std::unordered_map<Instruction, int, Hash, Equal> known_;
};

/// Adds derivatives of instruction `value`; gives their places, that of the number 0 for zeros.
/// Reverse mode: one pass, O(tape) new instructions for any number of variables. Source: Griewank
/// and Walther, Evaluating Derivatives, section 3.2.
std::vector<int> add_gradient(Tape& tape, int value, std::span<const int> variables);

}  // namespace momenta::formula
