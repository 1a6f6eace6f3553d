#pragma once
// The functions of formulas in every scalar. Each derivative follows from the argument x and the
// value y,
//
//   exp' = y,  log' = 1/x,  tan' = 1 + y²,  tanh' = 1 − y²,  asin' = 1/√(1 − x²),  atan' = 1/(1 +
//   x²) (x^a)' = a x^(a−1),  ∂(a^b)/∂b = y log a,  ∂atan2(y, x) = (x dy − y dx) / (x² + y²), …
//
// which is the chain rule of dual numbers, and on power series the recurrence of y' = f'(x) x',
//
//   k y_k = Σ_(i=1…k) i x_i f'_(k−i),     f'_j from x_0 … x_j and y_0 … y_j.
//
// abs, sign, floor, min, max and if() have the derivative of the piece they are on.

#include <momenta/core/expression/expression.h>
#include <momenta/core/scalar/counted.h>
#include <momenta/core/scalar/dual.h>
#include <momenta/core/scalar/local_dual.h>
#include <momenta/core/scalar/power_series.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

namespace momenta::formula {

/// The functions of one and two numbers of a scalar S, and whether a number is exactly zero.
template <class S>
struct Functions;

template <class S>
S function(Operation o, const S& x) {
  return Functions<S>::of(o, x);
}
template <class S>
S function(Operation o, const S& a, const S& b) {
  return Functions<S>::of(o, a, b);
}

/// xⁿ by squaring.
template <class S>
S whole_power(const S& x, int n) {
  S result(1.0), square = x;
  for (unsigned k = static_cast<unsigned>(n < 0 ? -n : n); k > 0; k >>= 1) {
    if (k & 1) result = result * square;
    if (k > 1) square = square * square;
  }
  return n < 0 ? S(1.0) / result : result;
}

/// One of two. A sparse dual depends on both, so that its pattern holds at every state.
template <class S>
const S& chosen(bool first, const S& a, const S& b) {
  return first ? a : b;
}
inline LocalDual chosen(bool first, const LocalDual& a, const LocalDual& b) {
  const LocalDual &taken = first ? a : b, &left = first ? b : a;
  return LocalDual::sum(taken.a, taken, 1, LocalDual::chain(left, 0, 0), 1);
}

/// f'(x), where y = f(x).
template <class S>
S slope(Operation o, const S& x, const S& y) {
  switch (o) {
    case Operation::sin:
      return function(Operation::cos, x);
    case Operation::cos:
      return -function(Operation::sin, x);
    case Operation::tan:
      return S(1.0) + y * y;
    case Operation::asin:
      return S(1.0) / function(Operation::sqrt, S(1.0) - x * x);
    case Operation::acos:
      return S(-1.0) / function(Operation::sqrt, S(1.0) - x * x);
    case Operation::atan:
      return S(1.0) / (S(1.0) + x * x);
    case Operation::sinh:
      return function(Operation::cosh, x);
    case Operation::cosh:
      return function(Operation::sinh, x);
    case Operation::tanh:
      return S(1.0) - y * y;
    case Operation::exp:
      return y;
    case Operation::log:
      return S(1.0) / x;
    default:
      return S(0.5) / y;
  }
}
/// ∂f/∂a and ∂f/∂b, where y = f(a, b). A power of zero has no slope along its exponent.
template <class S>
std::pair<S, S> slopes(Operation o, const S& a, const S& b, const S& y) {
  switch (o) {
    case Operation::power:
      return {value_of(a) != 0 ? S(b * y / a) : S(b * function(Operation::power, a, S(b - S(1.0)))),
              value_of(y) == 0 ? S(0.0) : S(y * function(Operation::log, a))};
    case Operation::atan2: {
      const S square = a * a + b * b;
      return {b / square, -a / square};
    }
    default:
      return {a / y, b / y};
  }
}

template <class S>
requires std::is_floating_point_v<S>
struct Functions<S> {
  static bool is_zero(S x) { return x == 0; }
  static S of(Operation o, S a) {
    switch (o) {
      case Operation::sin:
        return std::sin(a);
      case Operation::cos:
        return std::cos(a);
      case Operation::tan:
        return std::tan(a);
      case Operation::asin:
        return std::asin(a);
      case Operation::acos:
        return std::acos(a);
      case Operation::atan:
        return std::atan(a);
      case Operation::sinh:
        return std::sinh(a);
      case Operation::cosh:
        return std::cosh(a);
      case Operation::tanh:
        return std::tanh(a);
      case Operation::exp:
        return std::exp(a);
      case Operation::log:
        return std::log(a);
      default:
        return std::sqrt(a);
    }
  }
  static S of(Operation o, S a, S b) {
    switch (o) {
      case Operation::power:
        return std::pow(a, b);
      case Operation::atan2:
        return std::atan2(a, b);
      default:
        return std::hypot(a, b);
    }
  }
};

template <class S, int N>
struct Functions<Dual<S, N>> {
  static bool is_zero(const Dual<S, N>& x) { return Functions<S>::is_zero(x.a) && is_constant(x); }
  static bool is_constant(const Dual<S, N>& x) {
    return std::all_of(x.b.begin(), x.b.end(), Functions<S>::is_zero);
  }
  static Dual<S, N> of(Operation o, const Dual<S, N>& x) {
    const S y = function(o, x.a);
    return is_constant(x) ? Dual<S, N>::chain(x, y, S(0.0))
                          : Dual<S, N>::chain(x, y, slope(o, x.a, y));
  }
  static Dual<S, N> of(Operation o, const Dual<S, N>& a, const Dual<S, N>& b) {
    const S y = function(o, a.a, b.a);
    const auto [by_a, by_b] = slopes(o, a.a, b.a, y);
    // A constant has no share: log a of a^2.5 has no value at negative a.
    const S none(0.0);
    const S along_a = is_constant(a) ? none : by_a, along_b = is_constant(b) ? none : by_b;
    Dual<S, N> r;
    r.a = y;
    for (std::size_t i = 0; i < static_cast<std::size_t>(N); ++i)
      r.b[i] = along_a * a.b[i] + along_b * b.b[i];
    return r;
  }
};

template <>
struct Functions<LocalDual> {
  static LocalDual of(Operation o, const LocalDual& x) {
    const double y = function(o, x.a);
    return LocalDual::chain(x, y, x.terms == 0 ? 0 : slope(o, x.a, y));
  }
  static LocalDual of(Operation o, const LocalDual& a, const LocalDual& b) {
    const double y = function(o, a.a, b.a);
    const auto [by_a, by_b] = slopes(o, a.a, b.a, y);
    return LocalDual::sum(y, a, a.terms == 0 ? 0 : by_a, b, b.terms == 0 ? 0 : by_b);
  }
};

/// y_1, y_2, … from y_0 by y' = Σ f'(x) x' over the arguments; `next`(i, j) is Σ i x_i f'_j from
/// the terms of y so far.
template <int K>
struct Functions<PowerSeries<K>> {
  using Series = PowerSeries<K>;
  static bool is_zero(const Series& x) { return x.c[0] == 0 && is_constant(x); }
  static bool is_constant(const Series& x) {
    return std::all_of(x.c.begin() + 1, x.c.end(), [](double c) { return c == 0; });
  }
  static Series of(Operation o, const Series& x) {
    if (o == Operation::sin) return sin(x);  // a pair, each the slope of the other
    if (o == Operation::cos) return cos(x);
    Series y(function(o, x.c[0]));
    if (o == Operation::sinh || o == Operation::cosh) {
      const Series e = function(Operation::exp, x), inverse = Series(1.0) / e;
      const Series twice = o == Operation::sinh ? e - inverse : e + inverse;
      for (std::size_t k = 1; k < Series::terms; ++k) y.c[k] = 0.5 * twice.c[k];
      return y;
    }
    if (is_constant(x)) return y;
    for (std::size_t k = 1; k < Series::terms; ++k) y.c[k] = term(k, x, slope(o, x, y));
    return y;
  }
  static Series of(Operation o, const Series& a, const Series& b) {
    Series y(function(o, a.c[0], b.c[0]));
    const bool by_a = !is_constant(a), by_b = !is_constant(b);
    if (o == Operation::power && a.c[0] == 0 && by_a) {  // 0^b has a series for whole b alone
      std::fill(y.c.begin() + 1, y.c.end(), std::numeric_limits<double>::quiet_NaN());
      return y;
    }
    for (std::size_t k = 1; k < Series::terms && (by_a || by_b); ++k) {
      const auto [along_a, along_b] = slopes(o, a, b, y);
      y.c[k] = (by_a ? term(k, a, along_a) : 0) + (by_b ? term(k, b, along_b) : 0);
    }
    return y;
  }

 private:
  static double term(std::size_t k, const Series& x, const Series& along) {
    double sum = 0;
    for (std::size_t i = 1; i <= k; ++i) sum += static_cast<double>(i) * x.c[i] * along.c[k - i];
    return sum / static_cast<double>(k);
  }
};

/// Each counts like an angle: the paper's table has no other functions.
template <>
struct Functions<Counted> {
  static Counted of(Operation o, const Counted& a) { return counted(function(o, a.value())); }
  static Counted of(Operation o, const Counted& a, const Counted& b) {
    return counted(function(o, a.value(), b.value()));
  }

 private:
  static Counted counted(double value) {
    ++Counted::count.executed.angles;
    ++Counted::count.needed.angles;
    return Counted::variable(value);
  }
};

}  // namespace momenta::formula
