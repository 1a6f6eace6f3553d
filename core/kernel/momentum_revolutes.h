#pragma once
// Revolute joints in the inward sweep of the momentum recursion, (46)-(48), (43), (44): inside a
// chain, where everything passed on stays in registers, and elsewhere.

#include <momenta/core/kernel/momentum_sweeps.h>

namespace momenta {

/// (46)-(48) of a revolute joint with complete M*, D, G.
template <bool Gravity, class S>
MOMENTA_INLINE void eliminate_revolute(const Articulated<S>& articulated, const S& p,
                                       const S& inverse, RevoluteRecord<S>& w, Eliminated<S>& r) {
  const S e = p - articulated.Dnz;
  w.inverse = inverse;
  w.y0 = e * inverse;
  RevoluteColumn<S> h;
  eliminate_revolute(articulated.M, inverse, h, r.M);
  w.h = h;
  r.fx = articulated.Dfx + h.fx * e;
  r.fy = articulated.Dfy + h.fy * e;
  r.fz = articulated.Dfz + h.fz * e;
  r.nx = articulated.Dnx + h.nx * e;
  r.ny = articulated.Dny + h.ny * e;
  r.nz = p;
  if constexpr (Gravity) {
    w.Gx = r.Gx = articulated.Gx;
    w.Gy = r.Gy = articulated.Gy;
    r.Gz = articulated.Gz;
  }
}

/// (46)-(48) of a revolute joint that carries nothing: h, M' and M_j⁻¹ are constants; `moment`: m c
/// of the body.
template <bool Gravity, class S, class C>
MOMENTA_INLINE void hand_on_leaf(const RevoluteColumn<S>& h, const Reduced<S>& M, const S& inverse,
                                 const C (&moment)[3], const S& p, RevoluteRecord<S>& w,
                                 Eliminated<S>& r) {
  w.h = h;
  r.M = M;
  w.inverse = inverse;
  w.y0 = p * inverse;
  r.fx = p * h.fx;
  r.fy = p * h.fy;
  r.fz = p * h.fz;
  r.nx = p * h.nx;
  r.ny = p * h.ny;
  r.nz = p;
  if constexpr (Gravity) {
    w.Gx = r.Gx = S(moment[0]);
    w.Gy = r.Gy = S(moment[1]);
    r.Gz = S(moment[2]);
  }
}

/// The revolute joint's own screw, after storing what the outward sweep needs.
template <bool Gravity, class S, class C>
MOMENTA_INLINE void turn_revolute(Eliminated<S>& r, const S& c, const S& s, const C& d,
                                  RevoluteRecord<S>& w) {
  w.M = turning_of(r.M);
  w.Dfx = r.fx;
  w.Dfy = r.fy;
  w.Dnx = r.nx;
  w.Dny = r.ny;
  turn_and_shift_z(r.M, w.M, c, s, d);
  S x = c * r.fx - s * r.fy;
  r.fy = s * r.fx + c * r.fy;
  r.fx = x;
  x = c * r.nx - s * r.ny;
  r.ny = s * r.nx + c * r.ny;
  r.nx = x - d * r.fy;
  r.ny = r.ny + d * r.fx;
  if constexpr (Gravity) {
    x = c * r.Gx - s * r.Gy;
    r.Gy = s * r.Gx + c * r.Gy;
    r.Gx = x;
  }
}

/// A revolute joint on the ground: nothing is passed on.
template <bool Gravity, class S>
MOMENTA_INLINE void eliminate_root(const Articulated<S>& articulated, const S& p, const S& pivot,
                                   RevoluteRecord<S>& w) {
  w.inverse = S(1.0) / pivot;
  w.y0 = (p - articulated.Dnz) * w.inverse;
  if constexpr (Gravity) {
    w.Gx = articulated.Gx;
    w.Gy = articulated.Gy;
  }
}

/// (46)-(48) of a joint that carries nothing, from its link.
template <bool Gravity, class S>
MOMENTA_INLINE void hand_on_leaf(const LinkTree& tree, const Link& l, const S& p,
                                 RevoluteRecord<S>& w, Eliminated<S>& r) {
  const Leaf& leaf = tree.leaves[static_cast<std::size_t>(l.record)];
  RevoluteColumn<S> h;
  Reduced<S> M;
  set_leaf(leaf, h, M);
  hand_on_leaf<Gravity>(h, M, S(leaf.inverse), l.moment, p, w, r);
}

/// Revolute joints inside a chain from `end` − 1 down, while their turns are of one kind, and the
/// joint on the ground at its end; returns the end of the rest. Everything passed on stays in
/// registers, and products and signs of a turn go straight into the sums of the next body.
template <class S>
template <Turn turn, bool Gravity, class In>
std::size_t MomentumSweeps<Spatial, S>::chain_inward(std::size_t end, const In& p,
                                                     Articulated<S>& from) {
  Articulated<S> articulated;
  Eliminated<S> r;
  const Link* links = tree_->links.data();
  std::size_t k = end - 1;
  if (links[k].leaf) {
    hand_on_leaf<Gravity, S>(*tree_, links[k], p[links[k].u], revolutes_[k], r);
  } else {
    articulated = from;
    add_body<Gravity>(articulated, links[k]);
    if (!all_positive(articulated.M.Izz)) {
      singular_joint_ = static_cast<int>(k);
      return k;
    }
    eliminate_revolute<Gravity, S>(articulated, p[links[k].u], S(1.0) / articulated.M.Izz,
                                   revolutes_[k], r);
  }
  for (;;) {
    const Link& l = links[k];
    turn_revolute<Gravity>(r, angles_.cosine(k), angles_.sine(k), l.d, revolutes_[k]);
    const Path next = links[k - 1].path;
    if (next != static_cast<Path>(turn)) {
      if (next == Path::root) {
        carry<turn, Gravity>(r, l, articulated);
        add_body<Gravity>(articulated, links[--k]);
        if (all_positive(articulated.M.Izz))
          eliminate_root<Gravity, S>(articulated, p[links[k].u], articulated.M.Izz, revolutes_[k]);
        else
          singular_joint_ = static_cast<int>(k);
        return k;
      }
      const Eliminated<S> last = r;  // `last`: its address is taken, r stays in registers
      carry_last<turn, Gravity>(last, l, from);
      return k;
    }
    carry<turn, Gravity>(r, l, articulated);
    add_body<Gravity>(articulated, links[--k]);
    if (!all_positive(articulated.M.Izz)) {
      singular_joint_ = static_cast<int>(k);
      return k;
    }
    eliminate_revolute<Gravity, S>(articulated, p[links[k].u], S(1.0) / articulated.M.Izz,
                                   revolutes_[k], r);
  }
}

/// Other revolute joints from `end` − 1 down, one by one: at branches, on the ground, beside a
/// first child. A first child's share stays in registers here too.
template <class S>
template <bool Gravity, class In>
std::size_t MomentumSweeps<Spatial, S>::revolutes_inward(std::size_t end, const In& p,
                                                         Articulated<S>& from) {
  Articulated<S> articulated;
  const Link* links = tree_->links.data();
  if (!links[end - 1].leaf && !links[end - 1].carries_branches_alone) articulated = from;
  std::size_t k = end;
  do {
    --k;
    const Link& l = links[k];
    RevoluteRecord<S>& w = revolutes_[k];
    const S pk = p[l.u];
    Eliminated<S> r;
    if (l.leaf) {
      hand_on_leaf<Gravity>(*tree_, l, pk, w, r);
      if (l.parent < 0) continue;
    } else {
      if (l.carries_branches_alone) articulated = {};
      add_body<Gravity>(articulated, l);
      if (l.slot >= 0) add<Gravity>(articulated, slots_[static_cast<std::size_t>(l.slot)]);
      const S pivot = pivot_of(l, articulated.M.Izz);
      if (!all_positive(pivot)) {
        singular_joint_ = static_cast<int>(k);
        return k;
      }
      if (l.parent < 0) {
        eliminate_root<Gravity>(articulated, pk, pivot, w);
        continue;
      }
      eliminate_revolute<Gravity>(articulated, pk, S(1.0) / pivot, w, r);
    }
    const S c = angles_.cosine(k), s = angles_.sine(k);
    if (l.has_rotor) r.nz = pk - l.rotor * w.y0;
    turn_revolute<Gravity>(r, c, s, l.d, w);
    carry_any<Gravity>(l, body(k).edge, r, articulated);
    if (l.has_rotor) [[unlikely]]
      hand_on_rotor(body(k).edge, turned_rotor(l, w.h, w.inverse, c, s), articulated);
    if (!l.first) leave<Gravity>(l, slot_of_parent(l), articulated);
  } while (k > 0 && alone(links[k - 1]) && links[k - 1].kind == LinkKind::revolute);
  if (k > 0) from = articulated;
  return k;
}

}  // namespace momenta
