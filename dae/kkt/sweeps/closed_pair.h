#pragma once
// Two point rows of a loop closed together, in registers: what front.h does row by row, written out
// for the pair that every hinge in a plane is.

#include <momenta/dae/kkt/sweeps/front.h>

namespace momenta {

/// A pair of point rows at slots A, A + 1 closed in registers; state by state the row with the
/// larger pivot goes first: (a, b) ← (b, −a) where W_bb > W_aa.
template <class S, int Rows, int Columns>
struct ClosedPair {
  struct Nothing {};
  using Beside = std::conditional_t<(Rows > 2), Slots<S, Rows>, Nothing>;
  struct Pivots {
    S w_a, w_b, tau;
  };
  S a[Columns], b[Columns];
  S da, db, l, swap;  ///< l: W_ab f_a; swap: 1 where the rows changed places
  [[no_unique_address]] Beside Ga, Gb;
  [[no_unique_address]] std::conditional_t<keeps_pivots<S>, Pivots, Nothing> pivots;

  template <class Motion>
  MOMENTA_INLINE void impulses(const Motion& omega, const Slots<S, Rows>& sigma, SlotGroups beside,
                               S& x, S& y) const {
    x = da;
    y = db;
    each<Columns>([&](auto i) MOMENTA_INLINED {
      x = x + a[i] * omega[i];
      y = y + b[i] * omega[i];
    });
    unite(sigma, beside, x, y);
  }
  MOMENTA_INLINE void impulses_at_ground(const Slots<S, Rows>& sigma, SlotGroups beside, S& x,
                                         S& y) const {
    x = da;
    y = db;
    unite(sigma, beside, x, y);
  }

 private:
  MOMENTA_INLINE void unite([[maybe_unused]] const Slots<S, Rows>& sigma,
                            [[maybe_unused]] SlotGroups beside, S& x, S& y) const {
    if constexpr (Rows > 2) {
      x = minus_dot(x, Ga, sigma, beside);
      y = minus_dot(y, Gb, sigma, beside);
    }
    const S half(0.5), first = x - l * y;
    x = where_greater(swap, half, -y, first);
    y = where_greater(swap, half, first, y);
  }
};

/// w_a w_b − k² and whether all its digits can be trusted: with a fused multiply-add always, the
/// product's own rounding being taken off (Kahan); else where nothing much cancels.
template <class S>
MOMENTA_INLINE bool exact_determinant(const S& w_a, const S& w_b, const S& k, S& det) {
  const S product = w_a * w_b;
  det = product - k * k;
  return all_positive(8.0 * det - product);
}
#ifdef __FMA__
template <int L>
MOMENTA_INLINE bool exact_determinant(const Pack<1, L>& w_a, const Pack<1, L>& w_b,
                                      const Pack<1, L>& k, Pack<1, L>& det) {
  const double square = k.v * k.v, rounding = __builtin_fma(k.v, k.v, -square);
  det = Pack<1, L>(__builtin_fma(w_a.v, w_b.v, -square) - rounding);
  return true;
}
#endif

/// f of both pivots of a pair, w_a and p = w_b − k² f_a. Where neither is near fading, τ/w below
/// 2⁻¹⁴, f(w) is 1/w to the last digit, p = (w_a w_b − k²)/w_a, and both share a division.
template <class S>
MOMENTA_INLINE void invert_pivots(const S& w_a, const S& w_b, const S& k, const S& tau, S& f_a,
                                  S& f_b, S& p) {
  const S steep = 16384.0 * tau;
  S det;
  const bool exact = exact_determinant(w_a, w_b, k, det);
  if (__builtin_expect(exact && all_positive(w_a - steep) && all_positive(det - steep * w_a), 1)) {
    const S inverse = S(1.0) / (w_a * det);
    f_a = det * inverse;
    f_b = w_a * w_a * inverse;
    p = det * f_a;
  } else {
    f_a = faded_inverse(w_a, tau);
    p = w_b - k * (k * f_a);
    f_b = faded_inverse(p, tau);
  }
}

/// Closes a pair; `beside`: the loops that stay open.
template <int A, bool Moves, class S, int Rows, int Columns, class Weight>
MOMENTA_INLINE void close_pair(Front<S, Rows, Columns>& front, double fade,
                               [[maybe_unused]] SlotGroups beside,
                               ClosedPair<S, Rows, Columns>& pair, Weight&& weight) {
  constexpr int B = A + 1;
  using Here = Slots<S, Rows>;
  const S zero(0.0), one(1.0);
  const S waa = front.template w<A, A>(), wbb = front.template w<B, B>(),
          wab = front.template w<A, B>();
  const S tau = (front.scale.template at<A>() + front.scale.template at<B>()) * (0.5 * fade);
  const auto swapped = [&](const auto& x, const auto& y)
                           MOMENTA_INLINED { return where_greater(wbb, waa, x, y); };
  pair.swap = swapped(one, zero);
  const S first = swapped(wbb, waa), second = swapped(waa, wbb), coupling = swapped(-wab, wab);
  S fa, fb, p;
  invert_pivots(first, second, coupling, tau, fa, fb, p);
  const S l = coupling * fa;
  pair.l = l;
  if constexpr (keeps_pivots<S>) pair.pivots = {first, p, tau};
  const S da = swapped(front.d.template at<B>(), front.d.template at<A>()),
          db = swapped(-front.d.template at<A>(), front.d.template at<B>()) - l * da;
  pair.da = fa * da;
  pair.db = fb * db;
  S ca[Columns], cb[Columns];
  if constexpr (Moves) {
    each<Columns>([&](auto i) MOMENTA_INLINED {
      const S x = front.C[i].template at<A>(), y = front.C[i].template at<B>();
      ca[i] = where_greater(wbb, waa, y, x);
      cb[i] = where_greater(wbb, waa, -x, y) - l * ca[i];
      pair.a[i] = fa * ca[i];
      pair.b[i] = fb * cb[i];
    });
    weight(ca, pair.a, pair.da);
    weight(cb, pair.b, pair.db);
  }
  if constexpr (Rows <= 2) {
    if constexpr (!Here::apart) front = {};
  } else if constexpr (Here::apart) {
    Here ga, gb;
    each_open<S, Rows>(beside, [&](auto i) MOMENTA_INLINED {
      const S x = front.template w<A, i>(), y = front.template w<B, i>();
      ga.v[i] = swapped(y, x);
      gb.v[i] = swapped(-x, y) - ga.v[i] * l;
      pair.Ga.v[i] = ga.v[i] * fa;
      pair.Gb.v[i] = gb.v[i] * fb;
      front.d.v[i] = (front.d.v[i] - pair.Ga.v[i] * da) - pair.Gb.v[i] * db;
      if constexpr (Moves)
        each<Columns>([&](auto k) MOMENTA_INLINED {
          front.C[k].v[i] = (front.C[k].v[i] - pair.Ga.v[i] * ca[k]) - pair.Gb.v[i] * cb[k];
        });
    });
    front.subtract_products(pair.Ga, ga, pair.Gb, gb, beside);
  } else {
    // Blocks are read, changed and written once: a whole register read after a part of it was
    // written waits for the memory.
    Here Ga, Gb, ga, gb;
    each<Here::parts>([&](auto k) MOMENTA_INLINED {
      const auto x = Here::template without<A, k>(front.W[A].v[k]),
                 y = Here::template without<A, k>(front.W[B].v[k]);
      ga.v[k] = x;
      gb.v[k] = y;
    });
    const Here x = swapped(gb, ga), y = swapped(-ga, gb);
    each<Here::parts>([&](auto k) MOMENTA_INLINED {
      ga.v[k] = x.v[k];
      gb.v[k] = y.v[k] - x.v[k] * Here::all(l);
      Ga.v[k] = ga.v[k] * Here::all(fa);
      Gb.v[k] = gb.v[k] * Here::all(fb);
    });
    const auto closed = [&](Here& to, const S& a, const S& b) MOMENTA_INLINED {
      each<Here::parts>([&](auto k) MOMENTA_INLINED {
        to.v[k] = (Here::template without<A, k>(to.v[k]) - Ga.v[k] * Here::all(a)) -
                  Gb.v[k] * Here::all(b);
      });
    };
    closed(front.d, da, db);
    if constexpr (Moves)
      each<Columns>([&](auto i) MOMENTA_INLINED { closed(front.C[i], ca[i], cb[i]); });
    each<Rows>([&](auto i) MOMENTA_INLINED {
      if constexpr (i == A || i == B)
        front.W[i] = {};
      else
        closed(front.W[i], ga.template at<i>(), gb.template at<i>());
    });
    each<Here::parts>([&](auto k) MOMENTA_INLINED {
      front.scale.v[k] = Here::template without<A, k>(front.scale.v[k]);
    });
    pair.Ga = Ga;
    pair.Gb = Gb;
  }
}

}  // namespace momenta
