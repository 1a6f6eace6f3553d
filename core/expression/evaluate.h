#pragma once
// Values of a formula in every scalar: one pass over its tape.

#include <momenta/core/expression/functions.h>
#include <momenta/core/expression/spline.h>

#include <cmath>
#include <type_traits>

namespace momenta {

namespace formula {

/// Value of one instruction from those before it on the line.
template <class S>
inline void execute(const Expression::Instruction& in, const S* x, const S* line, S& y) {
  using O = Operation;
  const auto truth = [](bool holds) { return S(holds ? 1.0 : 0.0); };
  const auto a = [&]() -> const S& { return line[in.a]; };
  const auto b = [&]() -> const S& { return line[in.b]; };
  switch (in.operation) {
    case O::number:
      y = S(in.number);
      break;
    case O::variable:
      y = x[in.a];
      break;
    case O::negative:
      y = -a();
      break;
    case O::add:
      y = a() + b();
      break;
    case O::subtract:
      y = a() - b();
      break;
    case O::multiply:
      y = a() * b();
      break;
    case O::divide:
      y = a() / b();
      break;
    case O::whole_power:
      y = whole_power(a(), static_cast<int>(in.number));
      break;
    case O::less:
      y = truth(value_of(a()) < value_of(b()));
      break;
    case O::less_equal:
      y = truth(value_of(a()) <= value_of(b()));
      break;
    case O::equal:
      y = truth(value_of(a()) == value_of(b()));
      break;
    case O::unequal:
      y = truth(value_of(a()) != value_of(b()));
      break;
    case O::both:
      y = truth(value_of(a()) != 0 && value_of(b()) != 0);
      break;
    case O::either:
      y = truth(value_of(a()) != 0 || value_of(b()) != 0);
      break;
    case O::opposite:
      y = truth(value_of(a()) == 0);
      break;
    case O::choice:
      y = chosen(value_of(a()) != 0, b(), line[in.c]);
      break;
    case O::abs:
      y = std::signbit(value_of(a())) ? -a() : a();
      break;
    case O::sign:
      y = value_of(a()) > 0 ? S(1.0) : value_of(a()) < 0 ? S(-1.0) : S(value_of(a()));
      break;
    case O::floor:
      y = S(std::floor(value_of(a())));
      break;
    case O::min:  // NaN is both the least and the largest of two
      y = chosen(std::isnan(value_of(b())) || value_of(b()) < value_of(a()), b(), a());
      break;
    case O::max:
      y = chosen(std::isnan(value_of(b())) || value_of(b()) > value_of(a()), b(), a());
      break;
    case O::spline:
      y = in.spline->derivative(a(), static_cast<int>(in.number));
      break;
    case O::power:
    case O::atan2:
    case O::hypot:
      y = function(in.operation, a(), b());
      break;
    default:
      y = function(in.operation, a());
  }
}

}  // namespace formula

/// Writes the values of a formula at x₀, x₁, … to `values`; `line` has room for its tape. S: any
/// scalar with formula::Functions, compared by value. No allocation. O(tape)
template <class S>
void evaluate(const Expression& formula, const S* x, S* line, S* values) {
  if constexpr (std::is_same_v<S, double>) {
    formula::run(formula.steps(), x, line, values);
  } else {
    S* next = line;
    for (const formula::Instruction& in : formula.tape()) formula::execute(in, x, line, *next++);
    for (const int at : formula.outputs()) *values++ = line[at];
  }
}

}  // namespace momenta
