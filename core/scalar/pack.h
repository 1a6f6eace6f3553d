#pragma once
// Several states in one scalar, state i in lane i: any kernel for one state evaluates Width at
// once. Widths follow the machine's registers: 2 doubles on x86-64, 4 with AVX2 (level 3), 8 with
// AVX-512 (level 4); a wider pack than the target has is slower than single states.
//
// `Level` is the x86-64 level the code is compiled for. As part of the type it keeps kernels of
// several levels in one library from sharing symbols; Pack<1, Level> is a double with that mark.

#include <cmath>

#define MOMENTA_INLINE inline __attribute__((always_inline))

namespace momenta {

/// Registers of the compiler: doubles, and integers of the same width for comparisons.
template <int Width>
struct Register;
template <>
struct Register<1> {
  typedef double Doubles;
  typedef long long Integers;
};
template <>
struct Register<2> {
  typedef double Doubles __attribute__((vector_size(16)));
  typedef long long Integers __attribute__((vector_size(16)));
};
template <>
struct Register<4> {
  typedef double Doubles __attribute__((vector_size(32)));
  typedef long long Integers __attribute__((vector_size(32)));
};
template <>
struct Register<8> {
  typedef double Doubles __attribute__((vector_size(64)));
  typedef long long Integers __attribute__((vector_size(64)));
};

template <int Width, int Level>
struct Pack {
  using Lanes = typename Register<Width>::Doubles;
  Lanes v;  ///< uninitialised, as plain doubles are; Pack{} is zero

  Pack() = default;
  /// One broadcast: x − 0 is x whatever its sign, and folds; filling lane by lane compiles to one
  /// masked move a lane.
  MOMENTA_INLINE Pack(double x) {  // NOLINT: constants mix freely
    if constexpr (Width == 1)
      v = x;
    else
      v = x - Lanes{};
  }
  static MOMENTA_INLINE Pack of(Lanes x) {
    Pack p;
    p.v = x;
    return p;
  }
  MOMENTA_INLINE double lane(int i) const {
    if constexpr (Width == 1)
      return v;
    else
      return v[i];
  }
  MOMENTA_INLINE void set_lane(int i, double x) {
    if constexpr (Width == 1)
      v = x;
    else
      v[i] = x;
  }
  static MOMENTA_INLINE Pack load(const double* at) {
    Pack x;
    __builtin_memcpy(&x.v, at, sizeof(Lanes));
    return x;
  }
  MOMENTA_INLINE void store(double* at) const { __builtin_memcpy(at, &v, sizeof(Lanes)); }

  friend MOMENTA_INLINE Pack operator+(const Pack& a, const Pack& b) { return of(a.v + b.v); }
  friend MOMENTA_INLINE Pack operator-(const Pack& a, const Pack& b) { return of(a.v - b.v); }
  friend MOMENTA_INLINE Pack operator*(const Pack& a, const Pack& b) { return of(a.v * b.v); }
  friend MOMENTA_INLINE Pack operator/(const Pack& a, const Pack& b) { return of(a.v / b.v); }
  friend MOMENTA_INLINE Pack operator-(const Pack& a) { return of(-a.v); }
  MOMENTA_INLINE Pack& operator+=(const Pack& b) { return *this = *this + b; }
  MOMENTA_INLINE Pack& operator-=(const Pack& b) { return *this = *this - b; }
};

template <int W, int L>
MOMENTA_INLINE Pack<W, L> sqrt(const Pack<W, L>& x) {
  Pack<W, L> root;
  for (int i = 0; i < W; ++i) root.set_lane(i, std::sqrt(x.lane(i)));
  return root;
}

/// The least of the lanes, NaN when one is NaN: for tests of positive pivots.
template <int W, int L>
MOMENTA_INLINE double value_of(const Pack<W, L>& x) {
  double least = x.lane(0);
  for (int i = 1; i < W; ++i)
    if (!(x.lane(i) >= least)) least = x.lane(i);
  return least;
}
/// True when every lane is positive: one comparison and its mask where the target has them.
template <int W, int L>
MOMENTA_INLINE bool all_positive(const Pack<W, L>& x) {
  if constexpr (W == 1) {
    return x.v > 0;
  } else {
    using Lanes = typename Pack<W, L>::Lanes;
#if defined(__AVX512F__)
    if constexpr (W == 8) {
      constexpr int greater = 30, current_rounding = 4;
      return __builtin_ia32_cmppd512_mask(x.v, Lanes{}, greater, -1, current_rounding) == 0xff;
    }
#endif
#if defined(__AVX__)
    if constexpr (W == 4) return __builtin_ia32_movmskpd256((Lanes)(x.v > 0)) == 0xf;
#endif
#if defined(__SSE2__)
    if constexpr (W == 2) return __builtin_ia32_movmskpd((Lanes)(x.v > 0)) == 0x3;
#endif
    for (int i = 0; i < W; ++i)
      if (!(x.v[i] > 0)) return false;
    return true;
  }
}

}  // namespace momenta
