#pragma once
// Sines and cosines of many angles at once. Argument reduction by three constants that add up to
// π/2 (Cody and Waite), then polynomials of degree 13 and 14 on |r| ≤ π/4: 2.3e-16 absolute error
// for |x| below `reducible`; packs with a larger angle, NaN or infinity go to the library lane by
// lane.

#include <momenta/core/scalar/dual.h>

#include <cstddef>
#include <vector>

namespace momenta {

constexpr double reducible =
    1e6;  ///< k < 2²⁰: its products with the first two parts are exact [rad]

template <int W, int L>
MOMENTA_INLINE void sine_cosine_reduced(const Pack<W, L>& x, Pack<W, L>& sine, Pack<W, L>& cosine) {
  using V = typename Pack<W, L>::Lanes;
  using I = typename Register<W>::Integers;
  // Adding 1.5·2⁵² rounds to the nearest integer, left in the low bits.
  const double to_integer = 6755399441055744.0;
  V k = x.v * 0.63661977236758134308 + to_integer;
  const I quadrant = (I)k;
  k = k - to_integer;
  // Three parts of π/2, the first two with trailing zeros: products with k are exact without a
  // fused multiply-add.
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
    const Pack<W, L> room = Pack<W, L>(reducible * reducible) - x * x;  // NaN has none
    if (__builtin_expect(all_positive(room), 1)) return sine_cosine_reduced(x, sine, cosine);
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
template <class S, int N>
MOMENTA_INLINE void sine_cosine(const Dual<S, N>& x, Dual<S, N>& sine, Dual<S, N>& cosine) {
  S s, c;
  sine_cosine(x.a, s, c);
  sine = Dual<S, N>::chain(x, s, c);
  cosine = Dual<S, N>::chain(x, c, -s);
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

/// Doubles that fit the widest register of a level.
template <int Level>
constexpr int native_width = Level >= 4   ? 8
                             : Level >= 3 ? 4
                                          : 2;

/// Angles of one sweep, their sines and cosines. For a single state at a level, joints are turned
/// side by side, padded to whole registers.
template <class S>
class Angles {
 public:
  explicit Angles(std::size_t n) : size_(n), angle_(n), sine_(n), cosine_(n) {}
  MOMENTA_INLINE void set(std::size_t i, const S& x) { angle_[i] = x; }
  MOMENTA_INLINE const S& operator[](std::size_t i) const { return angle_[i]; }
  MOMENTA_INLINE const S& sine(std::size_t i) const { return sine_[i]; }
  MOMENTA_INLINE const S& cosine(std::size_t i) const { return cosine_[i]; }
  std::size_t size() const { return size_; }
  MOMENTA_INLINE void turn() { turn(size_); }
  /// Turns the first n alone.
  MOMENTA_INLINE void turn(std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) sine_cosine(angle_[i], sine_[i], cosine_[i]);
  }

 private:
  std::size_t size_;
  std::vector<S> angle_, sine_, cosine_;
};
template <int L>
class Angles<Pack<1, L>> {
  /// Eight at once save nothing: they wait for more angles, and registers of eight take one
  /// execution unit from single numbers.
  static constexpr int width = native_width<L> < 4 ? native_width<L> : 4;
  using One = Pack<1, L>;
  using Wide = Pack<width, L>;

 public:
  explicit Angles(std::size_t n)
      : size_(n), angle_((n + width - 1) / width), sine_(angle_.size()), cosine_(angle_.size()) {}
  MOMENTA_INLINE void set(std::size_t i, const One& x) {
    reinterpret_cast<double*>(angle_.data())[i] = x.v;
  }
  MOMENTA_INLINE One operator[](std::size_t i) const { return at(angle_, i); }
  MOMENTA_INLINE One sine(std::size_t i) const { return at(sine_, i); }
  MOMENTA_INLINE One cosine(std::size_t i) const { return at(cosine_, i); }
  std::size_t size() const { return size_; }
  MOMENTA_INLINE void turn() { turn(size_); }
  MOMENTA_INLINE void turn(std::size_t n) {
    for (std::size_t i = 0; i * width < n; ++i) sine_cosine(gathered(i), sine_[i], cosine_[i]);
  }

 private:
  /// One by one: the angles were just stored singly, and a wide load would wait until the last has
  /// left the store buffer.
  MOMENTA_INLINE Wide gathered(std::size_t i) const {
    const double* const a = reinterpret_cast<const double*>(angle_.data() + i);
    if constexpr (width == 4)
      return Wide::of((typename Wide::Lanes){a[0], a[1], a[2], a[3]});
    else
      return Wide::of((typename Wide::Lanes){a[0], a[1]});
  }
  static MOMENTA_INLINE One at(const std::vector<Wide>& packs, std::size_t i) {
    One x;
    __builtin_memcpy(&x, reinterpret_cast<const char*>(packs.data()) + 8 * i, 8);
    return x;
  }
  std::size_t size_;
  std::vector<Wide> angle_, sine_, cosine_;
};
/// Values equal in all lanes are turned once, side by side with those of other joints.
template <int W, int L>
class Angles<Directions<W, L>> {
  using S = Directions<W, L>;
  using Lanes = Pack<W, L>;

 public:
  explicit Angles(std::size_t n) : values_(n), slopes_(n) {}
  MOMENTA_INLINE void set(std::size_t i, const S& x) {
    values_.set(i, Pack<1, L>(x.a.lane(0)));
    slopes_[i] = x.b[0];
  }
  MOMENTA_INLINE S operator[](std::size_t i) const { return with(values_[i], slopes_[i]); }
  MOMENTA_INLINE S sine(std::size_t i) const {
    return with(values_.sine(i), Lanes(values_.cosine(i).v) * slopes_[i]);
  }
  MOMENTA_INLINE S cosine(std::size_t i) const {
    return with(values_.cosine(i), Lanes(-values_.sine(i).v) * slopes_[i]);
  }
  std::size_t size() const { return slopes_.size(); }
  MOMENTA_INLINE void turn() { values_.turn(); }
  MOMENTA_INLINE void turn(std::size_t n) { values_.turn(n); }

 private:
  static MOMENTA_INLINE S with(const Pack<1, L>& value, const Lanes& slope) {
    S x;
    x.a = Lanes(value.v);
    x.b[0] = slope;
    return x;
  }
  Angles<Pack<1, L>> values_;
  std::vector<Lanes> slopes_;
};

}  // namespace momenta
