#pragma once
// What a front carries of the loops still open at it, and how a loop closes. With P* = M*Ω + C σ +
// D and the loops' residual r = CᵀΩ − W σ + d, closing a row k, pivot w = W_kk, takes σ_k out by
// r_k = 0:
//
//   σ_k = f(w) (c_kᵀΩ + d_k − W_k· σ)
//   M* += c_k f c_kᵀ,  D += c_k f d_k,  C −= c_k f W_k·,  d −= d_k f W_k·,  W −= W_·k f W_k·
//
// Rows of one loop are closed one after the other, the largest remaining pivot first, each with its
// vector as it stands: a solved column never meets an original one. In that form the error of the
// rates is about ε/δ near a pose where a singular value δ of Φ_q M^(−1/2) vanishes, as with dense
// factorisations; solving a block first and subtracting then costs ε/δ².
//
// f(w) = w³/(w⁴ + τ⁴), 0 for w ≤ 0: exact to (τ/w)⁴ above τ, fading below. τ is relative to what
// the rows' W would be without other loops: `scale` gathers, joint by joint, the mobility along a
// row's whole moment, and no closing takes from it. It is a measure even where a row is redundant
// and W nothing but rounding.

#include <momenta/dae/sweeps/lanes.h>

namespace momenta {

/// Blocks of the loops open at a front; `columns`: 3 in a plane, 6 in space.
template <class S, int Rows, int Columns>
struct Front {
  Lanes<S, Rows> C[Columns];  ///< wrench of a unit impulse, force before couple
  Lanes<S, Rows> d;
  Lanes<S, Rows> scale;
  Lanes<S, Rows> W[Rows];

  MOMENTA_INLINE void add(const Front& b) {
    for (int i = 0; i < Columns; ++i) C[i] += b.C[i];
    add_at_ground(b);
  }
  /// The ground does not move: C no longer matters.
  MOMENTA_INLINE void add_at_ground(const Front& b) {
    d += b.d;
    scale += b.scale;
    for (int i = 0; i < Rows; ++i) W[i] += b.W[i];
  }
};

/// Rows of the loop at `lane`, about to close, give way: r −= compliance σ.
template <class S, int Rows, int Columns>
void soften(Front<S, Rows, Columns>& front, int lane, int rows, const S* compliance) {
  for (int i = 0; i < rows; ++i) front.W[lane + i].add(lane + i, compliance[i]);
}

/// A closed row, for the way back.
template <class S, int Rows, int Columns>
struct ClosedRow {
  Lanes<S, Rows> G;  ///< f W_k·, zero in the lanes closed before and in its own
  S c[Columns];      ///< f c_k
  S d;               ///< f d_k
  S w, tau;          ///< the pivot, and where it fades
  int lane;

  /// σ_k for the motion `omega` of the closing body.
  template <class Motion>
  MOMENTA_INLINE S impulse(const Motion& omega, const Lanes<S, Rows>& sigma) const {
    S s = d - dot(G, sigma);
    for (int i = 0; i < Columns; ++i) s = s + c[i] * omega[i];
    return s;
  }
  MOMENTA_INLINE S impulse_at_ground(const Lanes<S, Rows>& sigma) const {
    return d - dot(G, sigma);
  }
};

/// f(w)
template <class S>
MOMENTA_INLINE S faded_inverse(const S& w, const S& tau) {
  const S zero(0.0), w2 = w * w, t2 = tau * tau;
  const S inverse = (w * w2) / (w2 * w2 + t2 * t2);
  return where_greater(w, zero, inverse, zero);
}

/// Closes the row at `lane`; `weight` takes c f cᵀ and c f d: weight(c, f c, f d).
template <class S, int Rows, int Columns, class Weight>
MOMENTA_INLINE void close_row(int lane, Front<S, Rows, Columns>& front, const S& tau,
                              ClosedRow<S, Rows, Columns>& row, Weight&& weight) {
  const S zero(0.0);
  Lanes<S, Rows> own = front.W[lane];
  const S w = front.W[lane][lane], f = faded_inverse(w, tau);
  own.set(lane, zero);
  const Lanes<S, Rows> G = own * f;
  S c[Columns];
  const S d = front.d[lane];
  for (int i = 0; i < Columns; ++i) {
    c[i] = front.C[i][lane];
    front.C[i].set(lane, zero);
    front.C[i] -= G * c[i];
    row.c[i] = f * c[i];
  }
  front.d.set(lane, zero);
  front.d -= G * d;
  for (int i = 0; i < Rows; ++i) {
    front.W[i].set(lane, zero);
    front.W[i] -= G * own[i];
  }
  front.W[lane] = {};
  row.G = G;
  row.d = f * d;
  row.w = w;
  row.tau = tau;
  row.lane = lane;
  weight(c, row.c, row.d);
}

/// Whether a pivot faded: one of 10 τ keeps all but 1e-4 of itself.
inline bool has_faded(double w, double tau) {
  return !(w > 10 * tau);
}

/// What tells the size of a pivot to the choice of the next one: of a pack, all its states.
template <int W, int L>
double size_of(const Pack<W, L>& x) {
  double sum = 0;
  for (int i = 0; i < W; ++i) sum += x.lane(i) > 0 ? x.lane(i) : 0;
  return sum;
}

/// Closes the rows of one loop: `points` rows at `lane` that share a unit, then `others`.
/// Records them in closing order.
template <class S, int Rows, int Columns, class Weight>
void close_loop(Front<S, Rows, Columns>& front, int lane, int points, int others, double fade,
                ClosedRow<S, Rows, Columns>* records, Weight&& weight) {
  const int rows = points + others;
  S tau[6];
  double unit[6];
  for (int first = 0; first < rows; first = points) {
    const int end = first < points ? points : rows;
    S sum(0.0);
    for (int i = first; i < end; ++i) sum += front.scale[lane + i];
    sum = sum * (1.0 / (end - first));
    for (int i = first; i < end; ++i) {
      tau[i] = sum * fade;
      unit[i] = size_of(sum);
    }
    if (end == rows) break;
  }
  bool closed[6] = {};
  for (int k = 0; k < rows; ++k) {
    int best = -1;
    double largest = -1;
    for (int i = 0; i < rows; ++i) {
      if (closed[i]) continue;
      const double w = size_of(front.W[lane + i][lane + i]);
      const double relative = unit[i] > 0 ? w / unit[i] : 0;
      if (best < 0 || relative > largest) {
        best = i;
        largest = relative;
      }
    }
    closed[best] = true;
    close_row(lane + best, front, tau[best], records[k], weight);
  }
  for (int i = 0; i < rows; ++i) front.scale.set(lane + i, S(0.0));
}

/// A pair of point rows at lane A, A + 1 closed in registers; state by state the row with the
/// larger pivot goes first: (a, b) ← (b, −a) where W_bb > W_aa.
template <class S, int Rows, int Columns>
struct ClosedPair {
  Lanes<S, Rows> Ga, Gb;
  S a[Columns], b[Columns];
  S da, db, l, swap;  ///< l: W_ab f_a; swap: 1 where the rows changed places
  S w_a, w_b, tau;

  template <class Motion>
  MOMENTA_INLINE void impulses(const Motion& omega, const Lanes<S, Rows>& sigma, S& x, S& y) const {
    x = da - dot(Ga, sigma);
    y = db - dot(Gb, sigma);
    for (int i = 0; i < Columns; ++i) {
      x = x + a[i] * omega[i];
      y = y + b[i] * omega[i];
    }
    unite(x, y);
  }
  MOMENTA_INLINE void impulses_at_ground(const Lanes<S, Rows>& sigma, S& x, S& y) const {
    x = da - dot(Ga, sigma);
    y = db - dot(Gb, sigma);
    unite(x, y);
  }

 private:
  MOMENTA_INLINE void unite(S& x, S& y) const {
    const S half(0.5), first = x - l * y;
    x = where_greater(swap, half, -y, first);
    y = where_greater(swap, half, first, y);
  }
};

template <int A, bool Moves, class S, int Rows, int Columns, class Weight>
MOMENTA_INLINE void close_pair(Front<S, Rows, Columns>& front, double fade,
                               ClosedPair<S, Rows, Columns>& pair, Weight&& weight) {
  constexpr int B = A + 1;
  const S zero(0.0), one(1.0);
  Lanes<S, Rows> Wa = front.W[A], Wb = front.W[B];
  const S waa = Wa[A], wbb = Wb[B];
  const S tau = (front.scale[A] + front.scale[B]) * (0.5 * fade);
  const auto swapped = [&](const S& x, const S& y) { return where_greater(wbb, waa, x, y); };
  pair.swap = swapped(one, zero);
  const S first = swapped(wbb, waa), second = swapped(waa, wbb), coupling = swapped(-Wa[B], Wa[B]);
  const S fa = faded_inverse(first, tau), l = coupling * fa, p = second - l * coupling,
          fb = faded_inverse(p, tau);
  pair.l = l;
  pair.w_a = first;
  pair.w_b = p;
  pair.tau = tau;
  S da = swapped(front.d[B], front.d[A]), db = swapped(-front.d[A], front.d[B]) - l * da;
  pair.da = fa * da;
  pair.db = fb * db;
  if constexpr (Rows > 2) {
    Wa.set(A, zero);
    Wa.set(B, zero);
    Wb.set(A, zero);
    Wb.set(B, zero);
    Lanes<S, Rows> ga, gb;
    if constexpr (requires { Wa.v[0].v; }) {
      for (int i = 0; i < Rows; ++i) {
        ga.v[i] = swapped(Wb.v[i], Wa.v[i]);
        gb.v[i] = swapped(-Wa.v[i], Wb.v[i]);
      }
    } else {
      const S s = pair.swap, k = one - s;
      ga = Wa * k + Wb * s;
      gb = Wb * k - Wa * s;
    }
    gb -= ga * l;
    pair.Ga = ga * fa;
    pair.Gb = gb * fb;
    front.d.set(A, zero);
    front.d.set(B, zero);
    front.d -= pair.Ga * da + pair.Gb * db;
    for (int i = 0; i < Rows; ++i) {
      if (i == A || i == B) {
        front.W[i] = {};
        continue;
      }
      front.W[i].set(A, zero);
      front.W[i].set(B, zero);
      front.W[i] -= pair.Ga * ga[i] + pair.Gb * gb[i];
    }
    if constexpr (Moves) {
      S ca[Columns], cb[Columns];
      for (int i = 0; i < Columns; ++i) {
        const S x = front.C[i][A], y = front.C[i][B];
        ca[i] = swapped(y, x);
        cb[i] = swapped(-x, y) - l * ca[i];
        pair.a[i] = fa * ca[i];
        pair.b[i] = fb * cb[i];
        front.C[i].set(A, zero);
        front.C[i].set(B, zero);
        front.C[i] -= pair.Ga * ca[i] + pair.Gb * cb[i];
      }
      weight(ca, pair.a, pair.da);
      weight(cb, pair.b, pair.db);
    }
    front.scale.set(A, zero);
    front.scale.set(B, zero);
  } else {
    if constexpr (Moves) {
      for (int i = 0; i < Columns; ++i) {
        const S x = front.C[i][A], y = front.C[i][B];
        pair.a[i] = swapped(y, x);
        pair.b[i] = swapped(-x, y) - l * pair.a[i];
      }
      S fca[Columns], fcb[Columns];
      for (int i = 0; i < Columns; ++i) {
        fca[i] = fa * pair.a[i];
        fcb[i] = fb * pair.b[i];
      }
      weight(pair.a, fca, pair.da);
      weight(pair.b, fcb, pair.db);
      for (int i = 0; i < Columns; ++i) {
        pair.a[i] = fca[i];
        pair.b[i] = fcb[i];
      }
    }
    pair.Ga = pair.Gb = {};
    front = {};
  }
}

}  // namespace momenta
