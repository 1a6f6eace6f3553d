#pragma once
// Slots of one state and one direction: values and derivatives fill registers each, as the values
// of one state do (dae/kkt/sweeps/slots/slots.h). Sweeps choose by values, and derivatives come
// along.

#include <momenta/core/scalar/dual.h>
#include <momenta/dae/kkt/sweeps/slots/slots.h>

namespace momenta {

template <int L, int Rows>
struct Slots<Directions<1, L>, Rows> {
  using S = Directions<1, L>;
  using Plain = Slots<Pack<1, L>, Rows>;
  using Part = Directions<Plain::width, L>;  ///< lanes are slots
  static constexpr int parts = Plain::parts;
  static constexpr bool apart = false;
  Part v[parts]{};

  static MOMENTA_INLINE Part all(const S& x) { return part(Plain::all(x.a), Plain::all(x.b[0])); }
  MOMENTA_INLINE S operator[](int i) const { return one(values()[i], slopes()[i]); }
  template <int i>
  MOMENTA_INLINE S at() const {
    return one(values().template at<i>(), slopes().template at<i>());
  }
  template <int i>
  MOMENTA_INLINE S operator[](std::integral_constant<int, i>) const {
    return at<i>();
  }
  MOMENTA_INLINE void set(int i, const S& x) {
    both([&](Plain& of, const Pack<1, L>& y) MOMENTA_INLINED { of.set(i, y); }, x);
  }
  MOMENTA_INLINE void add(int i, const S& x) {
    both([&](Plain& of, const Pack<1, L>& y) MOMENTA_INLINED { of.add(i, y); }, x);
  }
  MOMENTA_INLINE void add_at(int i, const S& x) {
    both([&](Plain& of, const Pack<1, L>& y) MOMENTA_INLINED { of.add_at(i, y); }, x);
  }
  MOMENTA_INLINE void add_pair(int i, const S& x, const S& y) {
    Plain a = values(), b = slopes();
    a.add_pair(i, x.a, y.a);
    b.add_pair(i, x.b[0], y.b[0]);
    take(a, b);
  }
  template <int i>
  MOMENTA_INLINE void set_pair(const S& x, const S& y) {
    Plain a = values(), b = slopes();
    a.template set_pair<i>(x.a, y.a);
    b.template set_pair<i>(x.b[0], y.b[0]);
    take(a, b);
  }
  template <int i>
  MOMENTA_INLINE void add_pair(const S& x, const S& y) {
    Plain a = values(), b = slopes();
    a.template add_pair<i>(x.a, y.a);
    b.template add_pair<i>(x.b[0], y.b[0]);
    take(a, b);
  }
  template <int i, int k>
  static MOMENTA_INLINE Part without(const Part& x) {
    return part(Plain::template without<i, k>(x.a), Plain::template without<i, k>(x.b[0]));
  }

  MOMENTA_INLINE Plain values() const {
    Plain of;
    each<parts>([&](auto k) MOMENTA_INLINED { of.v[k] = v[k].a; });
    return of;
  }
  MOMENTA_INLINE Plain slopes() const {
    Plain of;
    each<parts>([&](auto k) MOMENTA_INLINED { of.v[k] = v[k].b[0]; });
    return of;
  }
  MOMENTA_INLINE void take(const Plain& a, const Plain& b) {
    each<parts>([&](auto k) MOMENTA_INLINED {
      v[k].a = a.v[k];
      v[k].b[0] = b.v[k];
    });
  }
  static MOMENTA_INLINE S one(const Pack<1, L>& a, const Pack<1, L>& b) {
    S x;
    x.a = a;
    x.b[0] = b;
    return x;
  }

 private:
  static MOMENTA_INLINE Part part(const typename Plain::Part& a, const typename Plain::Part& b) {
    Part x;
    x.a = a;
    x.b[0] = b;
    return x;
  }
  template <class Act>
  MOMENTA_INLINE void both(Act&& act, const S& x) {
    Plain a = values(), b = slopes();
    act(a, x.a);
    act(b, x.b[0]);
    take(a, b);
  }
};

template <int L, int Rows>
MOMENTA_INLINE Directions<1, L> dot(const Slots<Directions<1, L>, Rows>& a,
                                    const Slots<Directions<1, L>, Rows>& b) {
  using Here = Slots<Directions<1, L>, Rows>;
  auto sum = a.v[0] * b.v[0];
  for (int k = 1; k < Here::parts; ++k) sum = sum + a.v[k] * b.v[k];
  return Here::one(sum_of(sum.a), sum_of(sum.b[0]));
}
template <int L, int Rows>
MOMENTA_INLINE Slots<Directions<1, L>, Rows> operator-(Slots<Directions<1, L>, Rows> a) {
  for (auto& part : a.v) part = -part;
  return a;
}

/// x where a > b, else y.
template <int L>
MOMENTA_INLINE Directions<1, L> where_greater(const Directions<1, L>& a, const Directions<1, L>& b,
                                              const Directions<1, L>& x,
                                              const Directions<1, L>& y) {
  Directions<1, L> chosen;
  chosen.a = where_greater(a.a, b.a, x.a, y.a);
  chosen.b[0] = where_greater(a.a, b.a, x.b[0], y.b[0]);
  return chosen;
}
template <int L, int Rows>
MOMENTA_INLINE Slots<Directions<1, L>, Rows> where_greater(const Directions<1, L>& a,
                                                           const Directions<1, L>& b,
                                                           const Slots<Directions<1, L>, Rows>& x,
                                                           const Slots<Directions<1, L>, Rows>& y) {
  Slots<Directions<1, L>, Rows> chosen;
  chosen.take(where_greater(a.a, b.a, x.values(), y.values()),
              where_greater(a.a, b.a, x.slopes(), y.slopes()));
  return chosen;
}
/// Size of a pivot, to choose the next one.
template <int L>
MOMENTA_INLINE double size_of(const Directions<1, L>& x) {
  return x.a.v > 0 ? x.a.v : 0;
}

}  // namespace momenta
