#pragma once
// What the sweeps that carry loops ask of a scalar beside arithmetic, for dual numbers: they choose
// by values, and derivatives come along.

#include <momenta/core/scalar/dual.h>

namespace momenta {

/// x where a > b, else y.
template <int N>
MOMENTA_INLINE Dual<double, N> where_greater(const Dual<double, N>& a, const Dual<double, N>& b,
                                             const Dual<double, N>& x, const Dual<double, N>& y) {
  return a.a > b.a ? x : y;
}
/// What tells the size of a pivot to the choice of the next one.
template <int N>
MOMENTA_INLINE double size_of(const Dual<double, N>& x) {
  return x.a > 0 ? x.a : 0;
}

}  // namespace momenta
