#include <momenta/core/expression/formula_text.h>
#include <momenta/core/expression/function_names.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace momenta::formula {
namespace {

constexpr double longest_without = 20'000;  // characters of a text without definitions
constexpr int deepest_without = 100;        // nested operations
constexpr int deepest_between = 40;         // nested operations between definitions

/// Precedence, as in the grammar of expression.h.
enum Level { or_level, and_level, not_level, comparison, sum, product, sign, power, primary };

struct Sign {
  const char* text;
  Level level, left, right;  ///< precedence of the operation, least ones of its operands
};

Sign sign_of(Operation operation) {
  switch (operation) {
    case Operation::add:
      return {" + ", sum, sum, product};
    case Operation::subtract:
      return {" - ", sum, sum, product};
    case Operation::multiply:
      return {"*", product, product, sign};
    case Operation::divide:
      return {"/", product, product, sign};
    case Operation::power:
      return {"^", power, primary, sign};
    case Operation::less:
      return {" < ", comparison, sum, sum};
    case Operation::less_equal:
      return {" <= ", comparison, sum, sum};
    case Operation::equal:
      return {" == ", comparison, sum, sum};
    case Operation::unequal:
      return {" != ", comparison, sum, sum};
    case Operation::both:
      return {" and ", and_level, and_level, not_level};
    case Operation::either:
      return {" or ", or_level, or_level, and_level};
    default:
      return {nullptr, primary, or_level, or_level};
  }
}

class Text {
 public:
  Text(const std::vector<Instruction>& tape, std::span<const std::string> names)
      : tape_(tape), names_(names), told_(tape.size()) {
    while (std::any_of(names.begin(), names.end(),
                       [&](const std::string& name) { return name.starts_with(prefix_); }))
      prefix_ += "_";
  }

  std::string of(int output) {
    const std::vector<char> defined = definitions(output);
    std::string before;
    int count = 0;
    for (int i = 0; i <= output; ++i) {
      Told& told = told_[index(i)];
      told = told_of(tape_[index(i)]);
      if (!defined[index(i)]) continue;
      const std::string name = prefix_ + std::to_string(++count);
      before += name + " := " + told.text + "; ";
      told = {name, primary};
    }
    return before + told_[index(output)].text;
  }

 private:
  struct Told {
    std::string text;
    Level level = primary;
  };
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  static void each_operand(const Instruction& in, auto&& act) {
    const int operands[]{in.a, in.b, in.c};
    for (int k = 0; k < operands_of(in.operation); ++k) act(operands[k]);
  }

  /// Marks the instructions written as definitions; none where the text stays short and flat.
  std::vector<char> definitions(int output) const {
    std::vector<char> defined(tape_.size(), 0);
    std::vector<double> length(tape_.size(), 0);
    std::vector<int> depth(tape_.size(), 0), uses(tape_.size(), 0);
    for (std::size_t i = 0; i < tape_.size(); ++i) {
      length[i] = 8;
      each_operand(tape_[i], [&](int k) {
        length[i] += length[index(k)];
        depth[i] = std::max(depth[i], depth[index(k)] + 1);
        ++uses[index(k)];
      });
    }
    if (length[index(output)] <= longest_without && depth[index(output)] <= deepest_without)
      return defined;
    std::fill(depth.begin(), depth.end(), 0);
    for (std::size_t i = 0; i < tape_.size(); ++i) {
      each_operand(tape_[i], [&](int k) { depth[i] = std::max(depth[i], depth[index(k)] + 1); });
      const bool leaf = operands_of(tape_[i].operation) == 0;
      if (leaf || i == index(output) || (uses[i] < 2 && depth[i] < deepest_between)) continue;
      defined[i] = 1;
      depth[i] = 0;
    }
    return defined;
  }

  std::string at_least(Level needed, int i) const {
    const Told& told = told_[index(i)];
    return told.level >= needed ? told.text : "(" + told.text + ")";
  }

  Told told_of(const Instruction& in) const {
    if (in.operation == Operation::number) return number(in.number);
    if (in.operation == Operation::variable) return {names_[index(in.a)], primary};
    if (in.operation == Operation::negative) return {"-" + at_least(sign, in.a), sign};
    if (in.operation == Operation::opposite) return {"not " + at_least(not_level, in.a), not_level};
    if (in.operation == Operation::whole_power)
      return {at_least(primary, in.a) + "^" + reading::digits(in.number), power};
    if (const Sign s = sign_of(in.operation); s.text)
      return {at_least(s.left, in.a) + s.text + at_least(s.right, in.b), s.level};
    std::string call(function_name(in.operation));
    const char* between = "(";
    each_operand(in, [&](int k) {
      call += between + told_[index(k)].text;
      between = ", ";
    });
    return {call + ")", primary};
  }
  static Told number(double x) {
    if (!std::isfinite(x))
      throw std::logic_error("a formula has a number in it that is " +
                             std::string(std::isnan(x) ? "none (nan)" : "infinite") +
                             ", expected finite numbers");
    return {reading::digits(x), std::signbit(x) ? sign : primary};
  }

  const std::vector<Instruction>& tape_;
  std::span<const std::string> names_;
  std::vector<Told> told_;
  std::string prefix_ = "s";
};

}  // namespace

std::string text_of(const std::vector<Instruction>& tape, int output,
                    std::span<const std::string> names) {
  return Text(tape, names).of(output);
}

}  // namespace momenta::formula
