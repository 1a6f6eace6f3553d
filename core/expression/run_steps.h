#pragma once
// Runs the steps of a formula (steps.h) in plain numbers and in packs, by a table of acts. Included
// only where instantiated: acts are compiled once a scalar.

#include <momenta/core/expression/functions.h>
#include <momenta/core/expression/steps.h>
#include <momenta/core/scalar/pack.h>
#include <momenta/core/scalar/sine_cosine.h>

#include <array>
#include <utility>

namespace momenta::formula {

template <Arithmetic o, class S>
MOMENTA_INLINE S arithmetic(const S& a, const S& b) {
  if constexpr (o == Arithmetic::add) return a + b;
  if constexpr (o == Arithmetic::subtract) return a - b;
  if constexpr (o == Arithmetic::multiply) return a * b;
  if constexpr (o == Arithmetic::divide) return a / b;
  if constexpr (o == Arithmetic::from) return b - a;
  if constexpr (o == Arithmetic::under) return b / a;
}

/// xⁿ by the multiplications of whole_power().
template <int n, class S>
MOMENTA_INLINE S whole_power_of(const S& x) {
  if constexpr (n == 0) return S(1.0);
  if constexpr (n == 1) return x;
  if constexpr (n > 1) {
    const S rest = whole_power_of<n / 2>(S(x * x));
    return n % 2 == 1 ? x * rest : rest;
  }
}

template <class S>
using Act = void (*)(const Step& s, S* line);

/// A function or comparison of single numbers, as in execute() (evaluate.h).
double one_by_one(const Step& s, Operation o, double a, double b, double c);

/// The same in a pack: library functions are called lane by lane, out of line, so that none is
/// compiled for a level.
template <Operation o, int W, int L>
MOMENTA_INLINE Pack<W, L> lane_by_lane(const Step& s, const Pack<W, L>* line) {
  const Pack<W, L> a = line[s.a], b = line[s.b], c = line[s.c];
  if constexpr (o == Operation::negative) return -a;
  if constexpr (o == Operation::whole_power) return whole_power(a, s.n);
  if constexpr (o == Operation::sin) return sin(a);
  if constexpr (o == Operation::cos) return cos(a);
  if constexpr (o == Operation::sqrt) return sqrt(a);
  Pack<W, L> y;
  for (int i = 0; i < W; ++i) {
    const double x = a.lane(i), z = b.lane(i);
    if constexpr (o == Operation::less)
      y.set_lane(i, x < z ? 1.0 : 0.0);
    else if constexpr (o == Operation::less_equal)
      y.set_lane(i, x <= z ? 1.0 : 0.0);
    else if constexpr (o == Operation::choice)
      y.set_lane(i, x != 0 ? z : c.lane(i));
    else
      y.set_lane(i, one_by_one(s, o, x, z, c.lane(i)));
  }
  return y;
}
/// Single numbers are run in run_steps.cpp alone.
template <Operation o>
double lane_by_lane(const Step& s, const double* line);

/// Executes an act of the table.
template <int act, class S>
void execute_step(const Step& s, S* line) {
  using A = Arithmetic;
  if constexpr (act >= power_acts && act <= power_acts + highest_power) {
    line[s.to] = whole_power_of<act - power_acts>(line[s.a]);
  } else if constexpr (act < single_acts) {
    line[s.to] = lane_by_lane<static_cast<Operation>(act)>(s, line);
  } else if constexpr (act < pair_acts) {
    line[s.to] = arithmetic<static_cast<A>(act - single_acts)>(line[s.a], line[s.b]);
  } else if constexpr (act < chain_acts) {
    constexpr int k = act - pair_acts;
    const S first = arithmetic<static_cast<A>(k / all_arithmetic)>(line[s.a], line[s.b]);
    line[s.to] = arithmetic<static_cast<A>(k % all_arithmetic)>(first, line[s.c]);
  } else if constexpr (act < tree_acts) {
    constexpr int k = act - chain_acts, both = k / all_arithmetic;
    const S first = arithmetic<static_cast<A>(both / all_arithmetic)>(line[s.a], line[s.b]);
    const S second = arithmetic<static_cast<A>(both % all_arithmetic)>(first, line[s.c]);
    line[s.to] = arithmetic<static_cast<A>(k % all_arithmetic)>(second, line[s.d]);
  } else if constexpr (act < sine_and_cosine) {
    constexpr int k = act - tree_acts, outer = k / forward_arithmetic;
    const S left = arithmetic<static_cast<A>(outer / forward_arithmetic)>(line[s.a], line[s.b]);
    const S right = arithmetic<static_cast<A>(k % forward_arithmetic)>(line[s.c], line[s.d]);
    line[s.to] = arithmetic<static_cast<A>(outer % forward_arithmetic)>(left, right);
  } else {
    const S angle = line[s.a];
    sine_cosine(angle, line[s.to], line[s.b]);
  }
}

template <class S>
class Acts {
  template <int... act>
  static constexpr std::array<Act<S>, acts> make(std::integer_sequence<int, act...>) {
    return {{of<act>()...}};
  }
  /// The function of an act; null where no step has it.
  template <int act>
  static constexpr Act<S> of() {
    constexpr int operations = static_cast<int>(Operation::spline) + 1;
    if constexpr (act >= operations && act < single_acts &&
                  !(act >= power_acts && act <= power_acts + highest_power))
      return nullptr;
    else
      return &execute_step<act, S>;
  }

 public:
  static constexpr std::array<Act<S>, acts> table = make(std::make_integer_sequence<int, acts>());
};

template <class S>
void run_steps(const Steps& steps, const S* x, S* line, S* values) {
  S* next = line;
  for (const double number : steps.numbers) *next++ = S(number);
  for (const int v : steps.variables) *next++ = x[v];
  const Act<S>* const table = Acts<S>::table.data();
  const Step* const end = steps.all.data() + steps.all.size();
  for (const Step* s = steps.all.data(); s != end; ++s) table[s->act](*s, line);
  for (const int at : steps.outputs) *values++ = line[at];
}

}  // namespace momenta::formula
