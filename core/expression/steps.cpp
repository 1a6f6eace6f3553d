#include <momenta/core/expression/steps.h>
#include <momenta/core/expression/tape.h>

#include <optional>
#include <unordered_map>

namespace momenta::formula {
namespace {

using A = Arithmetic;

int number_of(A o) {
  return static_cast<int>(o);
}

struct Binary {
  A operation;
  int a, b;
};

class Maker {
 public:
  Maker(const std::vector<Instruction>& tape, const std::vector<int>& outputs)
      : tape_(tape), uses_(tape.size(), 0), absorbed_(tape.size(), 0), place_(tape.size(), -1) {
    for (const Instruction& in : tape) {
      const int count = operands_of(in.operation);
      const int of[]{in.a, in.b, in.c};
      for (int i = 0; i < count; ++i) ++uses_[index(of[i])];
    }
    for (const int i : outputs) uses_[index(i)] += 2;  // outputs are never within a step
    for (std::size_t i = tape.size(); i-- > 0;)
      if (!absorbed_[i]) absorb(static_cast<int>(i));
    lay_out();
    for (std::size_t i = 0; i < tape.size(); ++i)
      if (!absorbed_[i]) write(static_cast<int>(i));
    for (const int i : outputs) steps_.outputs.push_back(place_[index(i)]);
  }
  Steps take() { return std::move(steps_); }

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  const Instruction& at(int i) const { return tape_[index(i)]; }

  std::optional<Binary> binary(int i) const {
    const Instruction& in = at(i);
    switch (in.operation) {
      case Operation::add:
        return Binary{A::add, in.a, in.b};
      case Operation::subtract:
        return Binary{A::subtract, in.a, in.b};
      case Operation::multiply:
        return Binary{A::multiply, in.a, in.b};
      case Operation::divide:
        return Binary{A::divide, in.a, in.b};
      case Operation::whole_power:
        if (in.number == 2) return Binary{A::multiply, in.a, in.a};
        return {};
      default:
        return {};
    }
  }
  /// Whether instruction i is needed by its one taker alone.
  bool is_within(int i) const { return uses_[index(i)] == 1 && binary(i).has_value(); }

  /// Marks the instructions that the step ending with i takes in.
  void absorb(int i) {
    const auto y = binary(i);
    if (!y) return;
    const bool left = is_within(y->a), right = is_within(y->b);
    if (left) absorbed_[index(y->a)] = 1;
    if (right) absorbed_[index(y->b)] = 1;
    if (left == right) return;
    const Binary inner = *binary(left ? y->a : y->b);
    if (inner.a == inner.b) return;  // a square takes its operand twice
    if (is_within(inner.a))
      absorbed_[index(inner.a)] = 1;
    else if (is_within(inner.b))
      absorbed_[index(inner.b)] = 1;
  }

  void lay_out() {
    int next = 0;
    for (std::size_t i = 0; i < tape_.size(); ++i)
      if (tape_[i].operation == Operation::number)
        place_[i] = next++, steps_.numbers.push_back(tape_[i].number);
    for (std::size_t i = 0; i < tape_.size(); ++i)
      if (tape_[i].operation == Operation::variable)
        place_[i] = next++, steps_.variables.push_back(tape_[i].a);
    for (std::size_t i = 0; i < tape_.size(); ++i)
      if (place_[i] < 0 && !absorbed_[i]) place_[i] = next++;
    steps_.line = index(next);
  }
  int place(int i) const { return i < 0 ? 0 : place_[index(i)]; }

  /// The operation of y on its operand x, and its other operand.
  static std::pair<A, int> on(const Binary& y, bool left) {
    if (left) return {y.operation, y.b};
    const A turned = y.operation == A::subtract ? A::from
                     : y.operation == A::divide ? A::under
                                                : y.operation;
    return {turned, y.a};
  }

  void write(int i) {
    const Instruction& in = at(i);
    if (in.operation == Operation::number || in.operation == Operation::variable) return;
    Step s;
    s.to = place(i);
    const auto y = binary(i);
    if (!y) return write_function(in, s);
    const bool left = absorbed_[index(y->a)], right = absorbed_[index(y->b)];
    if (left && right) {
      const Binary l = *binary(y->a), r = *binary(y->b);
      s.act = code(tree_acts +
                   (number_of(l.operation) * forward_arithmetic + number_of(y->operation)) *
                       forward_arithmetic +
                   number_of(r.operation));
      s.a = place(l.a), s.b = place(l.b), s.c = place(r.a), s.d = place(r.b);
    } else if (left || right) {
      const Binary x = *binary(left ? y->a : y->b);
      const auto [last, other] = on(*y, left);
      const bool first = absorbed_[index(x.a)], second = absorbed_[index(x.b)];
      if (first || second) {
        const Binary w = *binary(first ? x.a : x.b);
        const auto [middle, beside] = on(x, first);
        s.act =
            code(chain_acts +
                 (number_of(w.operation) * all_arithmetic + number_of(middle)) * all_arithmetic +
                 number_of(last));
        s.a = place(w.a), s.b = place(w.b), s.c = place(beside), s.d = place(other);
      } else {
        s.act = code(pair_acts + number_of(x.operation) * all_arithmetic + number_of(last));
        s.a = place(x.a), s.b = place(x.b), s.c = place(other);
      }
    } else {
      s.act = code(single_acts + number_of(y->operation));
      s.a = place(y->a), s.b = place(y->b);
    }
    steps_.all.push_back(s);
  }

  void write_function(const Instruction& in, Step s) {
    s.a = place(in.a), s.b = place(in.b), s.c = place(in.c);
    s.n = static_cast<std::int16_t>(in.number);
    s.spline = in.spline;
    s.act = code(static_cast<int>(in.operation));
    if (in.operation == Operation::whole_power && in.number >= 0 && in.number <= highest_power)
      s.act = code(power_acts + s.n);
    if (in.operation == Operation::sin || in.operation == Operation::cos) {
      const bool sine = in.operation == Operation::sin;
      const auto [at, first] = turned_.try_emplace(s.a, steps_.all.size());
      Step& known = first ? s : steps_.all[at->second];
      if (known.act == code(static_cast<int>(sine ? Operation::cos : Operation::sin))) {
        // The first of the two makes both; known.b is where the cosine goes.
        known.b = sine ? known.to : s.to;
        if (sine) known.to = s.to;
        known.act = code(sine_and_cosine);
        return;
      }
    }
    steps_.all.push_back(s);
  }
  static std::uint16_t code(int act) { return static_cast<std::uint16_t>(act); }

  const std::vector<Instruction>& tape_;
  std::vector<int> uses_;
  std::vector<char> absorbed_;
  std::vector<int> place_;
  std::unordered_map<int, std::size_t> turned_;  ///< step of the first sine or cosine of a place
  Steps steps_;
};

}  // namespace

Steps steps_of(const std::vector<Instruction>& tape, const std::vector<int>& outputs) {
  return Maker(tape, outputs).take();
}

}  // namespace momenta::formula
