#pragma once
// Quadruple precision for the kernels: __float128, 113 bits of mantissa. Slow, for references only.
// Link with libquadmath.

#include <momenta/core/scalar/dual.h>
#include <quadmath.h>

namespace momenta {

struct Quad {
  __float128 v{};

  Quad() = default;
  Quad(double value) : v(value) {}  // NOLINT: constants mix freely, as with dual numbers
  static Quad of(__float128 value) {
    Quad x;
    x.v = value;
    return x;
  }

  Quad& operator+=(const Quad& y) { return *this = *this + y; }
  Quad& operator-=(const Quad& y) { return *this = *this - y; }
  Quad& operator*=(const Quad& y) { return *this = *this * y; }
  Quad& operator/=(const Quad& y) { return *this = *this / y; }

  friend Quad operator+(const Quad& x, const Quad& y) { return of(x.v + y.v); }
  friend Quad operator-(const Quad& x, const Quad& y) { return of(x.v - y.v); }
  friend Quad operator*(const Quad& x, const Quad& y) { return of(x.v * y.v); }
  friend Quad operator/(const Quad& x, const Quad& y) { return of(x.v / y.v); }
  friend Quad operator-(const Quad& x) { return of(-x.v); }

  friend bool operator<(const Quad& x, const Quad& y) { return x.v < y.v; }
  friend bool operator>(const Quad& x, const Quad& y) { return x.v > y.v; }
  friend bool operator<=(const Quad& x, const Quad& y) { return x.v <= y.v; }
  friend bool operator>=(const Quad& x, const Quad& y) { return x.v >= y.v; }

  friend Quad sin(const Quad& x) { return of(sinq(x.v)); }
  friend Quad cos(const Quad& x) { return of(cosq(x.v)); }
  friend Quad sqrt(const Quad& x) { return of(sqrtq(x.v)); }
  friend Quad abs(const Quad& x) { return of(fabsq(x.v)); }
};

inline double value_of(const Quad& x) {
  return static_cast<double>(x.v);
}
inline bool all_positive(const Quad& x) {
  return x.v > 0;
}
inline Quad where_greater(const Quad& a, const Quad& b, const Quad& x, const Quad& y) {
  return a > b ? x : y;
}
/// Size of a pivot, for the choice of the next one.
inline double size_of(const Quad& x) {
  return x.v > 0 ? value_of(x) : 0;
}

}  // namespace momenta
