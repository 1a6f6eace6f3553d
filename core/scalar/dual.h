#pragma once
// Dual numbers a + Σ b_i ε_i, ε_i ε_j = 0: a function evaluated on them gives its value and N
// directional derivatives, exact to rounding. S may itself be a dual number (second derivatives).

#include <momenta/core/scalar/pack.h>

#include <array>
#include <cmath>
#include <concepts>
#include <type_traits>

namespace momenta {

template <class S, int N>
struct Dual {
  S a{};                 ///< value
  std::array<S, N> b{};  ///< derivatives along N directions

  Dual() = default;
  Dual(double value) : a(value) {}  // NOLINT: constants mix freely with dual numbers
  template <class T>
  requires(std::is_same_v<T, S> && !std::is_same_v<T, double>) Dual(const T& value)
      : a(value) {}  // NOLINT

  /// value + ε_direction
  static Dual variable(S value, int direction) {
    Dual x;
    x.a = value;
    x.b[static_cast<std::size_t>(direction)] = S(1.0);
    return x;
  }

  Dual& operator+=(const Dual& y) {
    a += y.a;
    for (int i = 0; i < N; ++i) b[i] += y.b[i];
    return *this;
  }
  Dual& operator-=(const Dual& y) {
    a -= y.a;
    for (int i = 0; i < N; ++i) b[i] -= y.b[i];
    return *this;
  }
  Dual& operator*=(const Dual& y) { return *this = *this * y; }
  Dual& operator/=(const Dual& y) { return *this = *this / y; }

  friend Dual operator+(Dual x, const Dual& y) { return x += y; }
  friend Dual operator-(Dual x, const Dual& y) { return x -= y; }
  friend Dual operator-(const Dual& x) {
    Dual r;
    r.a = -x.a;
    for (int i = 0; i < N; ++i) r.b[i] = -x.b[i];
    return r;
  }
  friend Dual operator+(const Dual& x) { return x; }
  friend Dual operator*(const Dual& x, const Dual& y) {
    Dual r;
    r.a = x.a * y.a;
    for (int i = 0; i < N; ++i) r.b[i] = x.a * y.b[i] + x.b[i] * y.a;
    return r;
  }
  friend Dual operator/(const Dual& x, const Dual& y) {
    Dual r;
    const S inverse = S(1.0) / y.a;
    r.a = x.a * inverse;
    for (int i = 0; i < N; ++i) r.b[i] = (x.b[i] - r.a * y.b[i]) * inverse;
    return r;
  }
  // Mixed with plain numbers without zero derivatives.
  template <std::same_as<double> T>
  friend Dual operator+(Dual x, T y) {
    x.a += S(y);
    return x;
  }
  template <std::same_as<double> T>
  friend Dual operator+(T y, Dual x) {
    x.a += S(y);
    return x;
  }
  template <std::same_as<double> T>
  friend Dual operator-(Dual x, T y) {
    x.a -= S(y);
    return x;
  }
  friend Dual operator*(double s, const Dual& x) { return chain(x, S(s) * x.a, S(s)); }
  friend Dual operator*(const Dual& x, double s) { return s * x; }
  friend Dual operator/(const Dual& x, double s) { return (1.0 / s) * x; }

  friend bool operator<(const Dual& x, const Dual& y) { return x.a < y.a; }
  friend bool operator>(const Dual& x, const Dual& y) { return y.a < x.a; }
  friend bool operator<=(const Dual& x, const Dual& y) { return !(y.a < x.a); }
  friend bool operator>=(const Dual& x, const Dual& y) { return !(x.a < y.a); }

  /// f(x) with f' at x: the chain rule.
  static Dual chain(const Dual& x, const S& value, const S& slope) {
    Dual r;
    r.a = value;
    for (int i = 0; i < N; ++i) r.b[i] = slope * x.b[i];
    return r;
  }
  friend Dual sin(const Dual& x) {
    using std::cos, std::sin;
    return chain(x, sin(x.a), cos(x.a));
  }
  friend Dual cos(const Dual& x) {
    using std::cos, std::sin;
    return chain(x, cos(x.a), -sin(x.a));
  }
  friend Dual sqrt(const Dual& x) {
    using std::sqrt;
    const S root = sqrt(x.a);
    return chain(x, root, S(0.5) / root);
  }
};

/// The plain number inside a scalar.
inline double value_of(double x) {
  return x;
}
inline double value_of(long double x) {
  return static_cast<double>(x);
}
template <class S, int N>
double value_of(const Dual<S, N>& x) {
  return value_of(x.a);
}

/// True when a pivot can be divided by; packs of states ask every lane.
template <class S>
bool all_positive(const S& x) {
  return value_of(x) > 0;
}
template <class S, int N>
MOMENTA_INLINE bool all_positive(const Dual<S, N>& x) {
  return all_positive(x.a);
}

/// Eight directions at once, for code compiled for any machine.
using Dual8 = Dual<double, 8>;

/// W directions from one state in the lanes of a register. The value fills all lanes: a product is
/// three operations on whole registers, no broadcast.
template <int W, int L>
using Directions = Dual<Pack<W, L>, 1>;

/// A Dual8 as plain numbers, value and derivatives, to pass between code compiled for different
/// machines.
constexpr int dual8_numbers = 9;
inline void spread(const Dual8& x, double* to) {
  to[0] = x.a;
  for (std::size_t i = 0; i < 8; ++i) to[1 + i] = x.b[i];
}
inline void gather(const double* from, Dual8& x) {
  x.a = from[0];
  for (std::size_t i = 0; i < 8; ++i) x.b[i] = from[1 + i];
}
template <int W, int L>
MOMENTA_INLINE void spread(const Directions<W, L>& x, double* to) {
  static_assert(W < dual8_numbers);
  to[0] = x.a.lane(0);
  x.b[0].store(to + 1);
}
template <int W, int L>
MOMENTA_INLINE void gather(const double* from, Directions<W, L>& x) {
  x.a = Pack<W, L>(from[0]);
  x.b[0] = Pack<W, L>::load(from + 1);
}

}  // namespace momenta
