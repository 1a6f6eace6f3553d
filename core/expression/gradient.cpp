// Derivatives of a tape by reverse mode. With ȳ the derivative of the result by instruction y,
//
//   y = f(a, b):   ā += ȳ ∂f/∂a,   b̄ += ȳ ∂f/∂b,
//
// from the last instruction to the first, where 1 stands at the last.

#include <momenta/core/expression/tape.h>

namespace momenta::formula {
namespace {

using O = Operation;

class Backward {
 public:
  Backward(Tape& tape, int value) : tape_(tape), bar_(static_cast<std::size_t>(value) + 1, -1) {
    bar_.back() = tape.number(1);
    for (int y = value; y >= 0; --y)
      if (of(y) >= 0) step(y, of(y));
  }
  int by_variable(int v) {
    for (int y = 0; y < static_cast<int>(bar_.size()); ++y)
      if (tape_[y].operation == O::variable && tape_[y].a == v)
        return of(y) >= 0 ? of(y) : tape_.number(0);
    return tape_.number(0);
  }

 private:
  int& of(int y) { return bar_[static_cast<std::size_t>(y)]; }
  bool is(int i, double x) const { return tape_[i].operation == O::number && tape_[i].number == x; }
  /// Whether the instruction is a choice with zero on one side.
  bool is_part(const Instruction& in) const {
    return in.operation == O::choice && (is(in.b, 0) || is(in.c, 0));
  }
  /// Moves signs outward, where two cancel or a sum takes them, and choices too: the value not
  /// chosen, sqrt(x) in if(x > 0, sqrt(x), 0), may have no slope.
  int times(int a, int b) {
    if (is(a, 1)) return b;
    if (is(a, 0)) return a;
    if (const Instruction in = tape_[a]; is_part(in)) {
      const int chosen = times(in.b, b);
      return tape_.add(O::choice, in.a, chosen, times(in.c, b));
    }
    if (is(b, 1)) return a;
    if (tape_[a].operation == O::negative) return negative(times(tape_[a].a, b));
    if (tape_[b].operation == O::negative) return negative(times(a, tape_[b].a));
    return tape_.add(O::multiply, a, b);
  }
  int over(int a, int b) {
    if (is(a, 0)) return a;
    if (const Instruction in = tape_[a]; is_part(in)) {
      const int chosen = over(in.b, b);
      return tape_.add(O::choice, in.a, chosen, over(in.c, b));
    }
    if (tape_[a].operation == O::negative) return negative(over(tape_[a].a, b));
    return tape_.add(O::divide, a, b);
  }
  int power(int a, int n) {
    if (n == 0) return tape_.number(1);
    return n == 1 ? a : tape_.add({O::whole_power, a, -1, -1, static_cast<double>(n)});
  }
  int square(int a) { return power(a, 2); }
  int negative(int a) {
    const Instruction& in = tape_[a];
    return in.operation == O::negative ? in.a : tape_.add(O::negative, a);
  }
  int one_minus(int a) { return tape_.add(O::subtract, tape_.number(1), a); }
  void give(int to, int share) {
    if (tape_[to].operation == O::number) return;
    int& bar = of(to);
    if (bar < 0)
      bar = share;
    else if (tape_[share].operation == O::negative)
      bar = tape_.add(O::subtract, bar, tape_[share].a);
    else if (tape_[bar].operation == O::negative)
      bar = tape_.add(O::subtract, share, tape_[bar].a);
    else
      bar = tape_.add(O::add, bar, share);
  }
  void give_where(int condition, int to, int share, bool where_true = true) {
    const int zero = tape_.number(0);
    give(to, where_true ? tape_.add(O::choice, condition, share, zero)
                        : tape_.add(O::choice, condition, zero, share));
  }

  void step(int y, int bar) {
    const Instruction in = tape_[y];
    const int a = in.a, b = in.b;
    switch (in.operation) {
      case O::negative:
        return give(a, negative(bar));
      case O::add:
        give(a, bar);
        return give(b, bar);
      case O::subtract:
        give(a, bar);
        return give(b, negative(bar));
      case O::multiply:
        give(a, times(bar, b));
        return give(b, times(bar, a));
      case O::divide: {
        const int ratio = over(bar, b);
        give(a, ratio);
        return give(b, negative(times(ratio, y)));
      }
      case O::whole_power: {
        const int n = static_cast<int>(in.number);
        if (n != 0) give(a, times(bar, times(tape_.number(n), power(a, n - 1))));
        return;
      }
      case O::power: {
        const int less = tape_.add(O::subtract, b, tape_.number(1));
        give(a, times(bar, times(b, tape_.add(O::power, a, less))));
        if (tape_[b].operation == O::number) return;
        const int zero = tape_.number(0), log = tape_.add(O::log, a);
        return give_where(tape_.add(O::equal, y, zero), b, times(bar, times(y, log)), false);
      }
      case O::choice:
        give_where(a, b, bar);
        return give_where(a, in.c, bar, false);
      case O::min:
      case O::max: {
        const int second =
            in.operation == O::min ? tape_.add(O::less, b, a) : tape_.add(O::less, a, b);
        give_where(second, b, bar);
        return give_where(second, a, bar, false);
      }
      case O::abs: {
        const int below = tape_.add(O::less, a, tape_.number(0));
        return give(a, tape_.add(O::choice, below, negative(bar), bar));
      }
      case O::atan2: {
        const int share = over(bar, tape_.add(O::add, square(a), square(b)));
        give(a, times(share, b));
        return give(b, negative(times(share, a)));
      }
      case O::hypot: {
        const int share = over(bar, y);
        give(a, times(share, a));
        return give(b, times(share, b));
      }
      case O::sin:
        return give(a, times(bar, tape_.add(O::cos, a)));
      case O::cos:
        return give(a, negative(times(bar, tape_.add(O::sin, a))));
      case O::tan:
        return give(a, times(bar, tape_.add(O::add, tape_.number(1), square(y))));
      case O::tanh:
        return give(a, times(bar, one_minus(square(y))));
      case O::sinh:
        return give(a, times(bar, tape_.add(O::cosh, a)));
      case O::cosh:
        return give(a, times(bar, tape_.add(O::sinh, a)));
      case O::exp:
        return give(a, times(bar, y));
      case O::log:
        return give(a, over(bar, a));
      case O::sqrt:
        return give(a, over(times(bar, tape_.number(0.5)), y));
      case O::asin:
        return give(a, over(bar, tape_.add(O::sqrt, one_minus(square(a)))));
      case O::acos:
        return give(a, negative(over(bar, tape_.add(O::sqrt, one_minus(square(a))))));
      case O::atan:
        return give(a, over(bar, tape_.add(O::add, tape_.number(1), square(a))));
      case O::spline:
        if (in.number < 3)
          give(a, times(bar, tape_.add({O::spline, a, -1, -1, in.number + 1, in.spline})));
        return;
      default:  // numbers, variables; truths, sign and floor have no slope
        return;
    }
  }

  Tape& tape_;
  std::vector<int> bar_;
};

}  // namespace

std::vector<int> add_gradient(Tape& tape, int value, std::span<const int> variables) {
  Backward backward(tape, value);
  std::vector<int> places;
  for (const int v : variables) places.push_back(backward.by_variable(v));
  return places;
}

}  // namespace momenta::formula
