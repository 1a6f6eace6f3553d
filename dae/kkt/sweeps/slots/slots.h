#pragma once
// One number for each open loop equation of a front. Every loop keeps its slots from its ends to
// the body that closes it, so fronts are merged by plain addition.
//
// For one state the slots fill registers, as many as the level's registers take, and slots of no
// open loop hold zero. For a pack of states each slot is a pack of its own, and work on slots of no
// open loop would be work for nothing: there slots stand in groups of two, a mask has a bit for
// every group, and groups outside the mask hold anything.

#include <momenta/core/scalar/sine_cosine.h>
#include <momenta/dae/kkt/sweeps/slots/open_slots.h>

#include <type_traits>

/// For lambdas whose captures must stay in registers.
#define MOMENTA_INLINED __attribute__((always_inline))

namespace momenta {

/// act(0) … act(n − 1), with constants: what they index may stay in registers.
template <int n, class Act>
MOMENTA_INLINE void each(Act&& act) {
  if constexpr (n > 0) {
    each<n - 1>(act);
    act(std::integral_constant<int, n - 1>{});
  }
}

template <class S, int Rows>
struct Slots {
  using Part = S;  ///< what one operation works on
  static constexpr int parts = Rows;
  static constexpr bool apart = true;  ///< a part holds one slot
  S v[Rows]{};

  static MOMENTA_INLINE const S& all(const S& x) { return x; }
  MOMENTA_INLINE S operator[](int i) const { return v[i]; }
  template <int i>
  MOMENTA_INLINE S at() const {
    return v[i];
  }
  template <int i>
  MOMENTA_INLINE S operator[](std::integral_constant<int, i>) const {
    return at<i>();
  }
  MOMENTA_INLINE void set(int i, const S& x) { v[i] = x; }
  MOMENTA_INLINE void add(int i, const S& x) { v[i] = v[i] + x; }
  MOMENTA_INLINE void add_at(int i, const S& x) { add(i, x); }
  MOMENTA_INLINE void add_pair(int i, const S& x, const S& y) {
    add(i, x);
    add(i + 1, y);
  }
  template <int i>
  MOMENTA_INLINE void set_pair(const S& x, const S& y) {
    v[i] = x;
    v[i + 1] = y;
  }
  template <int i>
  MOMENTA_INLINE void add_pair(const S& x, const S& y) {
    v[i] = v[i] + x;
    v[i + 1] = v[i + 1] + y;
  }
};

template <int Level, int Rows>
struct Slots<Pack<1, Level>, Rows> {
  using S = Pack<1, Level>;
  static constexpr int width = Rows < native_width<Level> ? Rows : native_width<Level>;
  using Part = Pack<width, Level>;
  static constexpr int parts = Rows / width;
  static constexpr bool apart = false;
  using Places = typename Register<width>::Integers;
  Part v[parts]{};

  static MOMENTA_INLINE Part all(const S& x) { return Part(x.v); }
  MOMENTA_INLINE S operator[](int i) const { return S(v[i / width].v[i % width]); }
  /// Slot i, known here: the register it is read from stays one. An index that is constant only
  /// after inlining reads memory, and whatever it is part of lives there.
  template <int i>
  MOMENTA_INLINE S at() const {
    constexpr int part = i / width, place = i % width;
    return S(v[part].v[place]);
  }
  template <int i>
  MOMENTA_INLINE S operator[](std::integral_constant<int, i>) const {
    return at<i>();
  }
  /// Slots are chosen by comparison: writing one number into a register would go through memory.
  MOMENTA_INLINE void set(int i, const S& x) {
    for (int k = 0; k < parts; ++k) v[k].v = places(k) == i ? Part(x.v).v : v[k].v;
  }
  MOMENTA_INLINE void add(int i, const S& x) {
    for (int k = 0; k < parts; ++k) v[k].v += places(k) == i ? Part(x.v).v : Part(0.0).v;
  }
  /// Adds by unit vectors, which cost less than a choice where i is not known here.
  MOMENTA_INLINE void add_at(int i, const S& x) {
    const double* const at = units.of[i];
    each<parts>([&](auto k) MOMENTA_INLINED { v[k] = v[k] + Part::load(at + k * width) * all(x); });
  }
  MOMENTA_INLINE void add_pair(int i, const S& x, const S& y) {
    const double *const at = units.of[i], *const next = units.of[i + 1];
    each<parts>([&](auto k) MOMENTA_INLINED {
      v[k] = v[k] + Part::load(at + k * width) * all(x) + Part::load(next + k * width) * all(y);
    });
  }
  template <int i>
  MOMENTA_INLINE void set_pair(const S& x, const S& y) {
    auto& part = v[i / width].v;
    part = (places(i / width) & ~1) == i ? both(x, y) : part;
  }
  /// Part k without the pair at slot i.
  template <int i, int k>
  static MOMENTA_INLINE Part without(Part part) {
    if constexpr (i / width == k) part.v = (places(k) & ~1) == i ? Part(0.0).v : part.v;
    return part;
  }
  template <int i>
  MOMENTA_INLINE void add_pair(const S& x, const S& y) {
    auto& part = v[i / width].v;
    part += (places(i / width) & ~1) == i ? both(x, y) : Part(0.0).v;
  }

 private:
  struct Units {
    alignas(64) double of[Rows][Rows];
  };
  static constexpr Units units = [] {
    Units u{};
    for (int i = 0; i < Rows; ++i) u.of[i][i] = 1;
    return u;
  }();
  static MOMENTA_INLINE typename Part::Lanes both(const S& x, const S& y) {
    Part p;
    for (int j = 0; j < width; j += 2) {
      p.v[j] = x.v;
      p.v[j + 1] = y.v;
    }
    return p.v;
  }
  static MOMENTA_INLINE Places places(int part) {
    Places at{};
    for (int i = 0; i < width; ++i) at[i] = part * width + i;
    return at;
  }
};

template <class S, int Rows>
MOMENTA_INLINE Slots<S, Rows>& operator+=(Slots<S, Rows>& a, const Slots<S, Rows>& b) {
  each<Slots<S, Rows>::parts>([&](auto k) MOMENTA_INLINED { a.v[k] = a.v[k] + b.v[k]; });
  return a;
}
template <class S, int Rows>
MOMENTA_INLINE Slots<S, Rows>& operator-=(Slots<S, Rows>& a, const Slots<S, Rows>& b) {
  each<Slots<S, Rows>::parts>([&](auto k) MOMENTA_INLINED { a.v[k] = a.v[k] - b.v[k]; });
  return a;
}
template <class S, int Rows>
MOMENTA_INLINE Slots<S, Rows> operator*(Slots<S, Rows> a, const std::type_identity_t<S>& s) {
  each<Slots<S, Rows>::parts>([&](auto k) MOMENTA_INLINED { a.v[k] = a.v[k] * a.all(s); });
  return a;
}
template <class S, int Rows>
MOMENTA_INLINE Slots<S, Rows> operator*(Slots<S, Rows> a, const Slots<S, Rows>& b) {
  each<Slots<S, Rows>::parts>([&](auto k) MOMENTA_INLINED { a.v[k] = a.v[k] * b.v[k]; });
  return a;
}
template <class S, int Rows>
MOMENTA_INLINE Slots<S, Rows> operator+(Slots<S, Rows> a, const Slots<S, Rows>& b) {
  return a += b;
}
template <class S, int Rows>
MOMENTA_INLINE Slots<S, Rows> operator-(Slots<S, Rows> a, const Slots<S, Rows>& b) {
  return a -= b;
}

/// act(part) for the parts that hold slots of open loops.
template <class S, int Rows, class Act>
MOMENTA_INLINE void each_open([[maybe_unused]] SlotGroups open, Act&& act) {
  using Here = Slots<S, Rows>;
  if constexpr (!Here::apart) {
    each<Here::parts>(act);
  } else if constexpr (Rows > 8) {
    for (int i = 0; i < Rows; ++i)
      if (open >> (i / 2) & 1) act(i);
  } else {
    each<Rows / 2>([&](auto group) MOMENTA_INLINED {
      if (open >> group & 1) {
        act(std::integral_constant<int, 2 * group>{});
        act(std::integral_constant<int, 2 * group + 1>{});
      }
    });
  }
}

/// Σ of a packed register's slots.
template <int W, int L>
MOMENTA_INLINE Pack<1, L> sum_of(const Pack<W, L>& x) {
  const auto& v = x.v;
  if constexpr (W == 8)
    return sum_of(Pack<4, L>::of(__builtin_shufflevector(v, v, 0, 1, 2, 3) +
                                 __builtin_shufflevector(v, v, 4, 5, 6, 7)));
  else if constexpr (W == 4)
    return sum_of(
        Pack<2, L>::of(__builtin_shufflevector(v, v, 0, 1) + __builtin_shufflevector(v, v, 2, 3)));
  else
    return Pack<1, L>(v[0] + v[1]);
}

/// a·b of one state's slots.
template <int L, int Rows>
MOMENTA_INLINE Pack<1, L> dot(const Slots<Pack<1, L>, Rows>& a, const Slots<Pack<1, L>, Rows>& b) {
  auto sum = a.v[0] * b.v[0];
  for (int k = 1; k < Slots<Pack<1, L>, Rows>::parts; ++k) sum = sum + a.v[k] * b.v[k];
  return sum_of(sum);
}
/// x + a·b over the open slots.
template <class S, int Rows>
MOMENTA_INLINE S plus_dot(S x, const Slots<S, Rows>& a, const Slots<S, Rows>& b,
                          [[maybe_unused]] SlotGroups open) {
  if constexpr (Slots<S, Rows>::apart) {
    each_open<S, Rows>(open, [&](auto i) MOMENTA_INLINED { x = x + a.v[i] * b.v[i]; });
    return x;
  } else {
    return x + dot(a, b);
  }
}
/// x + (y a − z b)·c over the open slots.
template <class S, int Rows>
MOMENTA_INLINE S plus_cross(S x, const S& y, const Slots<S, Rows>& a, const S& z,
                            const Slots<S, Rows>& b, const Slots<S, Rows>& c,
                            [[maybe_unused]] SlotGroups open) {
  using Here = Slots<S, Rows>;
  if constexpr (Here::apart) {
    return plus_dot(S(0.0), a, c, open) * y - plus_dot(S(0.0), b, c, open) * z + x;
  } else {
    Here across;
    each<Here::parts>([&](auto k) MOMENTA_INLINED {
      across.v[k] = a.v[k] * Here::all(y) - b.v[k] * Here::all(z);
    });
    return x + dot(across, c);
  }
}
/// x − a·b over the open slots.
template <class S, int Rows>
MOMENTA_INLINE S minus_dot(S x, const Slots<S, Rows>& a, const Slots<S, Rows>& b,
                           [[maybe_unused]] SlotGroups open) {
  if constexpr (Slots<S, Rows>::apart) {
    each_open<S, Rows>(open, [&](auto i) MOMENTA_INLINED { x = x - a.v[i] * b.v[i]; });
    return x;
  } else {
    return x - dot(a, b);
  }
}

template <int L, int Rows>
MOMENTA_INLINE Slots<Pack<1, L>, Rows> operator-(Slots<Pack<1, L>, Rows> a) {
  for (auto& part : a.v) part = -part;
  return a;
}

// Values are chosen: x or y itself would be chosen by address, and live in memory with all it is
// part of.

/// x where the condition a > b holds, else y; state by state.
template <int W, int L>
MOMENTA_INLINE Pack<W, L> where_greater(const Pack<W, L>& a, const Pack<W, L>& b,
                                        const Pack<W, L>& x, const Pack<W, L>& y) {
  if constexpr (W == 1)
    return Pack<W, L>(a.v > b.v ? x.v : y.v);
  else
    return Pack<W, L>::of(a.v > b.v ? x.v : y.v);
}

/// All slots of one state at once.
template <int L, int Rows>
MOMENTA_INLINE Slots<Pack<1, L>, Rows> where_greater(const Pack<1, L>& a, const Pack<1, L>& b,
                                                     const Slots<Pack<1, L>, Rows>& x,
                                                     const Slots<Pack<1, L>, Rows>& y) {
  const bool greater = a.v > b.v;
  Slots<Pack<1, L>, Rows> chosen;
  each<Slots<Pack<1, L>, Rows>::parts>(
      [&](auto k) MOMENTA_INLINED { chosen.v[k].v = greater ? x.v[k].v : y.v[k].v; });
  return chosen;
}

}  // namespace momenta
