#pragma once
// A front's blocks of the loops still open at it, and how a loop closes. With P* = M*Ω + C σ + D
// and the loops' residual r = CᵀΩ − W σ + d, closing a row k, pivot w = W_kk, takes σ_k out by r_k
// = 0:
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

#include <momenta/dae/kkt/sweeps/slots/slots.h>

namespace momenta {

/// Blocks of the loops open at a front; `columns`: 3 in a plane, 6 in space.
template <class S, int Rows, int Columns>
struct Front {
  using Here = Slots<S, Rows>;
  Here C[Columns];  ///< wrench of a unit impulse, force before couple
  Here d;
  Here scale;
  Here W[Rows];  ///< symmetric; where slots are apart only the upper triangle

  MOMENTA_INLINE S w(int i, int j) const { return Here::apart && j < i ? W[j][i] : W[i][j]; }
  template <int i, int j>
  MOMENTA_INLINE S w() const {
    if constexpr (Here::apart && j < i)
      return W[j].template at<i>();
    else
      return W[i].template at<j>();
  }

  /// Zeroes the slots that open here: at a leaf all, elsewhere the groups in `fresh`; of `born`
  /// only C and d, as a revolute joint's elimination will write W and scale.
  MOMENTA_INLINE void begin(bool leaf, SlotGroups fresh, SlotGroups born = 0) {
    if constexpr (!Here::apart) {
      if (leaf) *this = {};
    } else {
      const S zero(0.0);
      each_open<S, Rows>(fresh, [&](auto i) MOMENTA_INLINED {
        each<Columns>([&](auto k) MOMENTA_INLINED { C[k].v[i] = zero; });
        d.v[i] = zero;
      });
      each_open<S, Rows>(fresh & ~born, [&](auto i) MOMENTA_INLINED {
        scale.v[i] = zero;
        each<Rows>([&](auto j) MOMENTA_INLINED { (j < i ? W[j].v[i] : W[i].v[j]) = zero; });
      });
    }
  }
  MOMENTA_INLINE void add(const Front& b, SlotGroups open) {
    each_open<S, Rows>(open, [&](auto i) MOMENTA_INLINED {
      each<Columns>([&](auto k) MOMENTA_INLINED { C[k].v[i] = C[k].v[i] + b.C[k].v[i]; });
    });
    add_at_ground(b, open, 0, open);
  }
  /// Adds b without C, as the ground does not move. `fresh`: groups not there before; `all`: groups
  /// that stay.
  MOMENTA_INLINE void add_at_ground(const Front& b, SlotGroups open, SlotGroups fresh,
                                    SlotGroups all) {
    each_open<S, Rows>(open, [&](auto i) MOMENTA_INLINED {
      put(fresh, i, i, d.v[i], b.d.v[i]);
      put(fresh, i, i, scale.v[i], b.scale.v[i]);
    });
    each_entry(open, [&](auto i, auto part)
                         MOMENTA_INLINED { put(fresh, i, part, W[i].v[part], b.W[i].v[part]); });
    if constexpr (Here::apart)
      if (all & ~open)
        each_open<S, Rows>(fresh, [&](auto i) MOMENTA_INLINED {
          each_open<S, Rows>(all & ~open, [&](auto j) MOMENTA_INLINED {
            (j < i ? W[j].v[i] : W[i].v[j]) = S(0.0);
          });
        });
  }
  /// Eliminates a joint's coordinate: W += c (M_j⁻¹ c)ᵀ, d += y c, y = M_j⁻¹ e, g = M_j⁻¹ c. The
  /// caller updates the scale; W of `born` groups is overwritten.
  MOMENTA_INLINE void eliminate(const Here& c, const S& inverse, const S& y, SlotGroups open,
                                SlotGroups born, Here& g) {
    Here local, own;
    each_open<S, Rows>(open, [&](auto i) MOMENTA_INLINED {
      own.v[i] = c.v[i];
      local.v[i] = own.v[i] * Here::all(inverse);
      d.v[i] = d.v[i] + own.v[i] * Here::all(y);
      g.v[i] = local.v[i];
    });
    each_entry(open, [&](auto i, auto part) MOMENTA_INLINED {
      put(born, i, part, W[i].v[part], local.v[part] * own.all(own[i]));
    });
  }
  /// Writes x, where slot i or j is in `fresh`, else adds it.
  template <class I, class J, class Part>
  MOMENTA_INLINE static void put([[maybe_unused]] SlotGroups fresh, I i, J j, Part& to,
                                 const Part& x) {
    if constexpr (Here::apart) {
      if ((fresh >> (i / 2) | fresh >> (j / 2)) & 1) {
        to = x;
        return;
      }
    }
    to = to + x;
  }
  /// W += g cᵀ
  MOMENTA_INLINE void add_product(const Here& g, const Here& c, SlotGroups open) {
    each_entry(open, [&](auto i, auto part) MOMENTA_INLINED {
      W[i].v[part] = W[i].v[part] + g.v[part] * c.all(c[i]);
    });
  }
  /// W −= a bᵀ + x yᵀ
  MOMENTA_INLINE void subtract_products(const Here& a, const Here& b, const Here& x, const Here& y,
                                        SlotGroups open) {
    each_entry(open, [&](auto i, auto part) MOMENTA_INLINED {
      W[i].v[part] = W[i].v[part] - (a.v[part] * a.all(b[i]) + x.v[part] * a.all(y[i]));
    });
  }

 private:
  /// act(row, part of the row) for the entries of W that are kept, of open slots. No lambda in a
  /// lambda: g++ resolves the address of captures that deep too late for registers.
  template <class Act>
  MOMENTA_INLINE static void each_entry(SlotGroups open, Act&& act) {
    if constexpr (Here::apart)
      each_open<S, Rows>(open, [&](auto i) MOMENTA_INLINED {
        each_open<S, Rows>(open, [&](auto j) MOMENTA_INLINED {
          if (j >= i) act(i, j);
        });
      });
    else
      parts_from<0>(act);
  }
  template <int k, class Act>
  MOMENTA_INLINE static void parts_from(Act& act) {
    if constexpr (k < Rows * Here::parts) {
      act(std::integral_constant<int, k / Here::parts>{},
          std::integral_constant<int, k % Here::parts>{});
      parts_from<k + 1>(act);
    }
  }
};

/// Softens the rows of the loop at `slot`, about to close: r −= compliance σ.
template <class S, int Rows, int Columns>
void soften(Front<S, Rows, Columns>& front, int slot, int rows, const S* compliance) {
  for (int i = 0; i < rows; ++i) front.W[slot + i].add(slot + i, compliance[i]);
}

/// A closed row, for the way back.
template <class S, int Rows, int Columns>
struct ClosedRow {
  Slots<S, Rows> G;  ///< f W_k·, zero in the slots closed before and in its own
  S c[Columns];      ///< f c_k
  S d;               ///< f d_k
  S w, tau;          ///< the pivot, and where it fades
  int slot;

  /// σ_k for the motion `omega` of the closing body.
  template <class Motion>
  MOMENTA_INLINE S impulse(const Motion& omega, const Slots<S, Rows>& sigma) const {
    // The term that waits for the σ just found comes last.
    S s = d;
    for (int i = 0; i < Columns; ++i) s = s + c[i] * omega[i];
    return minus_dot(s, G, sigma, ~SlotGroups{});
  }
  MOMENTA_INLINE S impulse_at_ground(const Slots<S, Rows>& sigma) const {
    return minus_dot(d, G, sigma, ~SlotGroups{});
  }
};

/// f(w)
template <class S>
MOMENTA_INLINE S faded_inverse(const S& w, const S& tau) {
  const S zero(0.0), w2 = w * w, t2 = tau * tau;
  const S inverse = (w * w2) / (w2 * w2 + t2 * t2);
  return where_greater(w, zero, inverse, zero);
}

/// Closes the row at `slot`; `weight` takes c f cᵀ and c f d: weight(c, f c, f d).
/// @pre slots of no open loop hold zero
template <class S, int Rows, int Columns, class Weight>
MOMENTA_INLINE void close_row(int slot, Front<S, Rows, Columns>& front, const S& tau,
                              ClosedRow<S, Rows, Columns>& row, Weight&& weight) {
  using Here = Slots<S, Rows>;
  const S zero(0.0);
  Here own = front.W[slot];
  if constexpr (Here::apart)
    for (int i = 1; i < Rows; ++i)
      for (int j = 0; j < i && i == slot; ++j) own.v[j] = front.W[j].v[i];
  const S w = own[slot], f = faded_inverse(w, tau);
  own.set(slot, zero);
  const Here G = own * f;
  S c[Columns];
  const S d = front.d[slot];
  for (int i = 0; i < Columns; ++i) {
    c[i] = front.C[i][slot];
    front.C[i].set(slot, zero);
    front.C[i] -= G * c[i];
    row.c[i] = f * c[i];
  }
  front.d.set(slot, zero);
  front.d -= G * d;
  for (int i = 0; i < Rows; ++i) {
    front.W[i].set(slot, zero);
    front.W[i] -= G * own[i];
  }
  front.W[slot] = {};
  row.G = G;
  row.d = f * d;
  row.w = w;
  row.tau = tau;
  row.slot = slot;
  weight(c, row.c, row.d);
}

/// Loops open beside one that closes. With none, only its own rows that are left are worked on, and
/// nothing after the last; at the ground, which does not move, neither C nor `weight`.
enum class Beside { others, none, none_at_ground };

/// close_row() of a loop of `rows` rows at `first` with no other open; `left`: ones in the slots
/// still to be closed after `slot`. Slots of closed rows are not read again, and hold anything.
template <bool Moves, class S, int Rows, int Columns, class Weight>
MOMENTA_INLINE void close_row_alone(int slot, int first, int rows, const bool* closed, bool last,
                                    const Slots<S, Rows>& left, Front<S, Rows, Columns>& front,
                                    const S& tau, ClosedRow<S, Rows, Columns>& row,
                                    Weight&& weight) {
  using Here = Slots<S, Rows>;
  const S w = front.w(slot, slot), f = faded_inverse(w, tau), d = front.d[slot];
  S c[Columns];
  if constexpr (Moves)
    for (int i = 0; i < Columns; ++i) {
      c[i] = front.C[i][slot];
      row.c[i] = f * c[i];
    }
  if constexpr (Here::apart) {
    row.G = {};
    for (int j = 0; j < rows; ++j) {
      if (closed[j]) continue;
      const int at = first + j;
      const S G = front.w(slot, at) * f;
      row.G.v[at] = G;
      if constexpr (Moves)
        for (int i = 0; i < Columns; ++i) front.C[i].v[at] = front.C[i].v[at] - G * c[i];
      front.d.v[at] = front.d.v[at] - G * d;
      for (int k = j; k < rows; ++k) {
        if (closed[k]) continue;
        S& entry = front.W[at].v[first + k];
        entry = entry - G * front.w(slot, first + k);
      }
    }
  } else {
    const Here own = front.W[slot] * left, G = own * f;
    row.G = G;
    if (!last) {
      if constexpr (Moves)
        for (int i = 0; i < Columns; ++i) front.C[i] -= G * c[i];
      front.d -= G * d;
      for (int j = 0; j < rows; ++j)
        if (!closed[j]) front.W[first + j] -= G * own[first + j];
    }
  }
  row.d = f * d;
  row.w = w;
  row.tau = tau;
  row.slot = slot;
  if constexpr (Moves) weight(c, row.c, row.d);
}

/// Whether a pivot faded: one of 10 τ keeps all but 1e-4 of itself.
inline bool has_faded(double w, double tau) {
  return !(w > 10 * tau);
}

/// Size of a pivot for the choice of the next one: of a pack, over all its states.
template <int W, int L>
double size_of(const Pack<W, L>& x) {
  const Pack<W, L> zero(0.0), positive = where_greater(x, zero, x, zero);
  if constexpr (W == 1)
    return positive.v;
  else
    return sum_of(positive).v;
}

/// Whether S has derivatives along directions, each of which may have its own share in d.
template <class S>
constexpr bool has_directions = false;
template <class S, int N>
constexpr bool has_directions<Dual<S, N>> = true;

/// Whether pivots are kept: for a single state, to report failures and faded rows.
template <class S>
constexpr bool keeps_pivots = true;
template <int W, int L>
constexpr bool keeps_pivots<Pack<W, L>> = W == 1;

/// Closes the rows of one loop: `points` rows at `slot` that share a unit and a scale of at least
/// `least_scale`, then `others`. Records them in closing order. A pack closes all states in one
/// order: false where that takes a pivot of some state that is weak, or below a hundredth of the
/// largest left, so that each should go in its own order.
template <Beside beside = Beside::others, class S, int Rows, int Columns, class Weight>
bool close_loop(Front<S, Rows, Columns>& front, int slot, int points, int others,
                const S& least_scale, double fade, ClosedRow<S, Rows, Columns>* records,
                Weight&& weight) {
  const int rows = points + others;
  S tau[6];
  [[maybe_unused]] S scale[6];
  double per_unit[6];
  for (int first = 0; first < rows; first = points) {
    const int end = first < points ? points : rows;
    S sum(0.0);
    for (int i = first; i < end; ++i) sum += front.scale[slot + i];
    sum = sum * (1.0 / (end - first)) + (first < points ? least_scale : S(0.0));
    const double unit = size_of(sum), inverse = unit > 0 ? 1 / unit : 0;
    for (int i = first; i < end; ++i) {
      tau[i] = sum * fade;
      scale[i] = sum;
      per_unit[i] = inverse;
    }
    if (end == rows) break;
  }
  constexpr double least_share = 1e-2, weak = 1e-4;
  bool closed[6] = {}, even = true;
  [[maybe_unused]] Slots<S, Rows> left{};
  if constexpr (beside != Beside::others && !Slots<S, Rows>::apart)
    for (int i = 0; i < rows; ++i) left.set(slot + i, S(1.0));
  for (int k = 0; k < rows; ++k) {
    int best = -1;
    double largest = -1;
    [[maybe_unused]] S largest_of_each(0.0);
    for (int i = 0; i < rows; ++i) {
      if (closed[i]) continue;
      const S pivot = front.w(slot + i, slot + i);
      const double relative = size_of(pivot) * per_unit[i];
      if constexpr (!keeps_pivots<S>) {
        const S own = pivot * per_unit[i];
        largest_of_each = where_greater(own, largest_of_each, own, largest_of_each);
      }
      if (best < 0 || relative > largest) {
        best = i;
        largest = relative;
      }
    }
    if constexpr (!keeps_pivots<S>) {
      const S pivot = front.w(slot + best, slot + best);
      even = even && per_unit[best] > 0 && all_positive(pivot - weak * scale[best]) &&
             all_positive(pivot * per_unit[best] - least_share * largest_of_each);
    }
    closed[best] = true;
    if constexpr (beside == Beside::others) {
      close_row(slot + best, front, tau[best], records[k], weight);
    } else {
      if constexpr (!Slots<S, Rows>::apart) left.set(slot + best, S(0.0));
      close_row_alone<beside == Beside::none>(slot + best, slot, rows, closed, k + 1 == rows, left,
                                              front, tau[best], records[k], weight);
    }
  }
  if constexpr (beside == Beside::others)
    for (int i = 0; i < rows; ++i) front.scale.set(slot + i, S(0.0));
  else if constexpr (!Slots<S, Rows>::apart)
    front = {};  // slots of no open loop hold zero
  return even;
}

}  // namespace momenta
