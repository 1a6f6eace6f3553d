#pragma once
// Sines and cosines of many angles at once. Argument reduction by three constants that add up to
// π/2 (Cody and Waite), then polynomials of degree 13 and 14 on |r| ≤ π/4: 2.3e-16 absolute error
// for |x| below `reducible`; a pack that holds a larger angle, or none at all (NaN, infinity), goes
// to the library lane by lane.

#include <momenta/core/scalar/pack.h>

#include <cstddef>

namespace momenta {

constexpr double reducible =
    1e6;  ///< k < 2²⁰: its products with the first two parts are exact [rad]

template <int W, int L>
MOMENTA_INLINE void sine_cosine_reduced(const Pack<W, L>& x, Pack<W, L>& sine, Pack<W, L>& cosine) {
  using V = typename Pack<W, L>::Lanes;
  using I = typename Register<W>::Integers;
  // Adding 1.5·2⁵² rounds to the nearest integer and leaves it in the low bits.
  const double to_integer = 6755399441055744.0;
  V k = x.v * 0.63661977236758134308 + to_integer;
  const I quadrant = (I)k;
  k = k - to_integer;
  // Three parts of π/2, the first two with trailing zeros: their products with k are exact without
  // a fused multiply-add.
  V r = ((x.v - k * 1.57079632673412561417e+00) - k * 6.07710050630396597660e-11) -
        k * 2.02226624879595063154e-21;
  const V z = r * r;
  V s = z * 1.58962301576546568060e-10 - 2.50507477628578072866e-8;
  s = s * z + 2.75573136213857245213e-6;
  s = s * z - 1.98412698295895385996e-4;
  s = s * z + 8.33333333332211858878e-3;
  s = s * z - 1.66666666666666307295e-1;
  s = r + r * z * s;
  V c = z * -1.13585365213876817300e-11 + 2.08757008419747316778e-9;
  c = c * z - 2.75573141792967388112e-7;
  c = c * z + 2.48015872888517045348e-5;
  c = c * z - 1.38888888888730564116e-3;
  c = c * z + 4.16666666666665929218e-2;
  c = 1.0 - 0.5 * z + z * z * c;
  const I odd = (quadrant & 1) != 0;
  const V s_value = odd ? c : s, c_value = odd ? s : c;
  const I s_sign = (quadrant & 2) << 62, c_sign = ((quadrant + 1) & 2) << 62;
  sine.v = (V)((I)s_value ^ s_sign);
  cosine.v = (V)((I)c_value ^ c_sign);
}

template <int W, int L>
MOMENTA_INLINE void sine_cosine(const Pack<W, L>& x, Pack<W, L>& sine, Pack<W, L>& cosine) {
  if constexpr (W == 1) {
    sine = Pack<W, L>(std::sin(x.v));
    cosine = Pack<W, L>(std::cos(x.v));
  } else {
    const auto near = (x.v < reducible) & (x.v > -reducible);
    long long all = -1;
    for (int i = 0; i < W; ++i) all &= near[i];
    if (__builtin_expect(all != 0, 1)) return sine_cosine_reduced(x, sine, cosine);
    for (int i = 0; i < W; ++i) {
      sine.set_lane(i, std::sin(x.lane(i)));
      cosine.set_lane(i, std::cos(x.lane(i)));
    }
  }
}
template <class S>
MOMENTA_INLINE void sine_cosine(const S& x, S& sine, S& cosine) {
  using std::cos, std::sin;
  sine = sin(x);
  cosine = cos(x);
}
template <int W, int L>
MOMENTA_INLINE Pack<W, L> sin(const Pack<W, L>& x) {
  Pack<W, L> s, c;
  sine_cosine(x, s, c);
  return s;
}
template <int W, int L>
MOMENTA_INLINE Pack<W, L> cos(const Pack<W, L>& x) {
  Pack<W, L> s, c;
  sine_cosine(x, s, c);
  return c;
}

/// Doubles that fit the widest register of a level: joints of one state are turned side by side.
template <int Level>
constexpr int native_width = Level >= 4   ? 8
                             : Level >= 3 ? 4
                                          : 2;

/// cosine[i], sine[i] of angle[i], i < n. For a single state at a level the joints fill the lanes.
template <class S>
MOMENTA_INLINE void sines_and_cosines(const S* angle, S* sine, S* cosine, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) sine_cosine(angle[i], sine[i], cosine[i]);
}
template <int L>
MOMENTA_INLINE void sines_and_cosines(const Pack<1, L>* angle, Pack<1, L>* sine, Pack<1, L>* cosine,
                                      std::size_t n) {
  constexpr int width = native_width<L>;
  using Wide = Pack<width, L>;
  Wide s, c;
  std::size_t i = 0;
  for (; i + width <= n; i += width) {
    sine_cosine(Wide::load(&angle[i].v), s, c);
    s.store(&sine[i].v);
    c.store(&cosine[i].v);
  }
  if (i == n) return;
  double rest[width]{}, rest_s[width], rest_c[width];
  for (std::size_t j = 0; i + j < n; ++j) rest[j] = angle[i + j].v;
  sine_cosine(Wide::load(rest), s, c);
  s.store(rest_s);
  c.store(rest_c);
  for (std::size_t j = 0; i + j < n; ++j) {
    sine[i + j] = rest_s[j];
    cosine[i + j] = rest_c[j];
  }
}

}  // namespace momenta
