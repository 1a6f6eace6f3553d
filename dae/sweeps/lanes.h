#pragma once
// One number for each open loop equation of a front. Every loop keeps its lanes from its ends to
// the body that closes it, so fronts are merged by plain addition and lanes of no open loop hold
// zero.
//
// For one state the lanes fill registers, as many as the level's registers take; for a pack of
// states each lane is a pack of its own.

#include <momenta/core/scalar/sine_cosine.h>

/// Of a lambda whose captures must stay in registers.
#define MOMENTA_INLINED __attribute__((always_inline))

namespace momenta {

template <class S, int Rows>
struct Lanes {
  S v[Rows]{};

  MOMENTA_INLINE S operator[](int i) const { return v[i]; }
  MOMENTA_INLINE void set(int i, const S& x) { v[i] = x; }
  MOMENTA_INLINE void add(int i, const S& x) { v[i] = v[i] + x; }
  /// To lanes i, i + 1; i is even.
  MOMENTA_INLINE void add_pair(int i, const S& x, const S& y) {
    v[i] = v[i] + x;
    v[i + 1] = v[i + 1] + y;
  }

  MOMENTA_INLINE Lanes& operator+=(const Lanes& b) {
    for (int i = 0; i < Rows; ++i) v[i] = v[i] + b.v[i];
    return *this;
  }
  MOMENTA_INLINE Lanes& operator-=(const Lanes& b) {
    for (int i = 0; i < Rows; ++i) v[i] = v[i] - b.v[i];
    return *this;
  }
  friend MOMENTA_INLINE Lanes operator*(Lanes a, const S& s) {
    for (int i = 0; i < Rows; ++i) a.v[i] = a.v[i] * s;
    return a;
  }
  friend MOMENTA_INLINE Lanes operator*(Lanes a, const Lanes& b) {
    for (int i = 0; i < Rows; ++i) a.v[i] = a.v[i] * b.v[i];
    return a;
  }
  friend MOMENTA_INLINE S dot(const Lanes& a, const Lanes& b) {
    S sum = a.v[0] * b.v[0];
    for (int i = 1; i < Rows; ++i) sum = sum + a.v[i] * b.v[i];
    return sum;
  }
};

template <int Level, int Rows>
struct Lanes<Pack<1, Level>, Rows> {
  using S = Pack<1, Level>;
  static constexpr int width = Rows < native_width<Level> ? Rows : native_width<Level>;
  static constexpr int parts = Rows / width;
  using Part = typename Register<width>::Doubles;
  using Places = typename Register<width>::Integers;
  Part v[parts]{};

  MOMENTA_INLINE S operator[](int i) const { return S(v[i / width][i % width]); }
  /// Lanes are chosen by comparison: writing one number into a register would go through memory.
  MOMENTA_INLINE void set(int i, const S& x) {
    for (int k = 0; k < parts; ++k) v[k] = places(k) == i ? all(x) : v[k];
  }
  MOMENTA_INLINE void add(int i, const S& x) {
    for (int k = 0; k < parts; ++k) v[k] += places(k) == i ? all(x) : Part{};
  }
  MOMENTA_INLINE void add_pair(int i, const S& x, const S& y) {
    for (int k = 0; k < parts; ++k) {
      Part both;
      for (int j = 0; j < width; j += 2) {
        both[j] = x.v;
        both[j + 1] = y.v;
      }
      v[k] += (places(k) & ~1) == i ? both : Part{};
    }
  }

  MOMENTA_INLINE Lanes& operator+=(const Lanes& b) {
    for (int k = 0; k < parts; ++k) v[k] += b.v[k];
    return *this;
  }
  MOMENTA_INLINE Lanes& operator-=(const Lanes& b) {
    for (int k = 0; k < parts; ++k) v[k] -= b.v[k];
    return *this;
  }
  friend MOMENTA_INLINE Lanes operator*(Lanes a, const S& s) {
    for (int k = 0; k < parts; ++k) a.v[k] *= s.v;
    return a;
  }
  friend MOMENTA_INLINE Lanes operator*(Lanes a, const Lanes& b) {
    for (int k = 0; k < parts; ++k) a.v[k] *= b.v[k];
    return a;
  }
  friend MOMENTA_INLINE S dot(const Lanes& a, const Lanes& b) {
    Part sum = a.v[0] * b.v[0];
    for (int k = 1; k < parts; ++k) sum += a.v[k] * b.v[k];
    if constexpr (width == 8)
      return S(((sum[0] + sum[4]) + (sum[2] + sum[6])) + ((sum[1] + sum[5]) + (sum[3] + sum[7])));
    else if constexpr (width == 4)
      return S((sum[0] + sum[2]) + (sum[1] + sum[3]));
    else
      return S(sum[0] + sum[1]);
  }

 private:
  static MOMENTA_INLINE Part all(const S& x) { return Pack<width, Level>(x.v).v; }
  static MOMENTA_INLINE Places places(int part) {
    Places at{};
    for (int i = 0; i < width; ++i) at[i] = part * width + i;
    return at;
  }
};

template <class S, int Rows>
MOMENTA_INLINE Lanes<S, Rows> operator+(Lanes<S, Rows> a, const Lanes<S, Rows>& b) {
  return a += b;
}
template <class S, int Rows>
MOMENTA_INLINE Lanes<S, Rows> operator-(Lanes<S, Rows> a, const Lanes<S, Rows>& b) {
  return a -= b;
}

/// x where the condition a > b holds, else y; state by state.
template <int W, int L>
MOMENTA_INLINE Pack<W, L> where_greater(const Pack<W, L>& a, const Pack<W, L>& b,
                                        const Pack<W, L>& x, const Pack<W, L>& y) {
  if constexpr (W == 1)
    return a.v > b.v ? x : y;
  else
    return Pack<W, L>::of(a.v > b.v ? x.v : y.v);
}

}  // namespace momenta
