#pragma once
// Revolute joints in the inward sweep of the articulated recursion: inside a chain, and elsewhere.

#include <momenta/core/kernel/acceleration_sweeps.h>

namespace momenta {

/// D += the body's bias wrench.
template <class S>
MOMENTA_INLINE void add_bias(Articulated<S>& articulated, const RevoluteAcceleration<S>& w) {
  articulated.Dfx = articulated.Dfx + w.bfx;
  articulated.Dfy = articulated.Dfy + w.bfy;
  articulated.Dfz = articulated.Dfz + w.bfz;
  articulated.Dnx = articulated.Dnx + w.bnx;
  articulated.Dny = articulated.Dny + w.bny;
  articulated.Dnz = articulated.Dnz + w.bnz;
}
template <class S>
MOMENTA_INLINE void set_bias(Articulated<S>& articulated, const RevoluteAcceleration<S>& w) {
  articulated.Dfx = w.bfx;
  articulated.Dfy = w.bfy;
  articulated.Dfz = w.bfz;
  articulated.Dnx = w.bnx;
  articulated.Dny = w.bny;
  articulated.Dnz = w.bnz;
}
/// D' once the revolute joint is eliminated.
template <class S>
MOMENTA_INLINE void eliminate_bias(const Articulated<S>& articulated, const S& tau,
                                   const S& inverse, RevoluteAcceleration<S>& w, Eliminated<S>& r) {
  const S e = tau - articulated.Dnz;
  w.y0 = e * inverse;
  r.fx = articulated.Dfx + w.h.fx * e;
  r.fy = articulated.Dfy + w.h.fy * e;
  r.fz = articulated.Dfz + w.h.fz * e;
  r.nx = articulated.Dnx + w.h.nx * e;
  r.ny = articulated.Dny + w.h.ny * e;
  r.nz = tau;
}
/// The revolute joint's screw for M' and D', then D' += M' c.
template <class S, class C>
MOMENTA_INLINE void turn_revolute(Eliminated<S>& r, const S& c, const S& s, const C& d,
                                  const RevoluteAcceleration<S>& w) {
  turn_and_shift_z(r.M, turning_of(r.M), c, s, d);
  S x = c * r.fx - s * r.fy;
  r.fy = s * r.fx + c * r.fy;
  r.fx = x;
  x = c * r.nx - s * r.ny;
  r.ny = s * r.nx + c * r.ny;
  r.nx = x - d * r.fy;
  r.ny = r.ny + d * r.fx;
  const Reduced<S>& m = r.M;
  r.fx = r.fx + (m.Axx * w.clx + m.Axy * w.cly + m.Axz * w.clz + m.Hxx * w.cox + m.Hxy * w.coy);
  r.fy = r.fy + (m.Axy * w.clx + m.Ayy * w.cly + m.Ayz * w.clz + m.Hyx * w.cox + m.Hyy * w.coy);
  r.fz = r.fz + (m.Axz * w.clx + m.Ayz * w.cly + m.Azz * w.clz + m.Hzx * w.cox + m.Hzy * w.coy);
  r.nx = r.nx + (m.Hxx * w.clx + m.Hyx * w.cly + m.Hzx * w.clz + m.Ixx * w.cox + m.Ixy * w.coy);
  r.ny = r.ny + (m.Hxy * w.clx + m.Hyy * w.cly + m.Hzy * w.clz + m.Ixy * w.cox + m.Iyy * w.coy);
}

/// Share of a rotor's k, turned, in D'_nz = … + (M' c)_nz.
template <class S>
MOMENTA_INLINE S rotor_bias(const Spatial::Force<S>& k, const RevoluteAcceleration<S>& w) {
  return k.f[0] * w.clx + k.f[1] * w.cly + k.f[2] * w.clz + k.n[0] * w.cox + k.n[1] * w.coy;
}

/// M' and D' of a revolute joint from complete M*, D.
template <class S>
MOMENTA_INLINE void eliminate_revolute(const Articulated<S>& articulated, const S& tau,
                                       RevoluteAcceleration<S>& w, Eliminated<S>& r) {
  const S inverse = S(1.0) / articulated.M.Izz;
  RevoluteColumn<S> h;
  eliminate_revolute(articulated.M, inverse, h, r.M);
  w.h = h;
  eliminate_bias(articulated, tau, inverse, w, r);
}

template <class S>
template <Turn turn, class InTau>
std::size_t AccelerationSweeps<Spatial, S>::chain_inward(std::size_t end, const InTau& tau,
                                                         Articulated<S>& from) {
  Articulated<S> articulated;
  Eliminated<S> r;
  const Link* links = tree_->links.data();
  std::size_t k = end - 1;
  if (links[k].leaf) {
    const Leaf& leaf = tree_->leaves[static_cast<std::size_t>(links[k].record)];
    RevoluteAcceleration<S>& w = revolutes_[k];
    set_bias(articulated, w);
    RevoluteColumn<S> h;
    set_leaf(leaf, h, r.M);
    w.h = h;
    eliminate_bias(articulated, S(tau[links[k].u]), S(leaf.inverse), w, r);
  } else {
    articulated = from;
    add_body(articulated.M, links[k]);
    add_bias(articulated, revolutes_[k]);
    if (!all_positive(articulated.M.Izz)) {
      singular_joint_ = static_cast<int>(k);
      return k;
    }
    eliminate_revolute(articulated, S(tau[links[k].u]), revolutes_[k], r);
  }
  for (;;) {
    const Link& l = links[k];
    turn_revolute(r, angles_.cosine(k), angles_.sine(k), l.d, revolutes_[k]);
    const Path next = links[k - 1].path;
    if (next != static_cast<Path>(turn) && next != Path::root) {
      const Eliminated<S> last = r;  // `last`: its address is taken, r stays in registers
      carry_last<turn, false>(last, l, from);
      return k;
    }
    carry<turn, false>(r, l, articulated);
    --k;
    add_body(articulated.M, links[k]);
    add_bias(articulated, revolutes_[k]);
    if (!all_positive(articulated.M.Izz)) {
      singular_joint_ = static_cast<int>(k);
      return k;
    }
    eliminate_revolute(articulated, S(tau[links[k].u]), revolutes_[k], r);
    if (next == Path::root) return k;  // nothing is passed on
  }
}

template <class S>
template <class InTau>
std::size_t AccelerationSweeps<Spatial, S>::revolutes_inward(std::size_t end, const InTau& tau,
                                                             Articulated<S>& from) {
  Articulated<S> articulated;
  const Link* links = tree_->links.data();
  if (!links[end - 1].leaf && !links[end - 1].carries_branches_alone) articulated = from;
  std::size_t k = end;
  do {
    --k;
    const Link& l = links[k];
    RevoluteAcceleration<S>& w = revolutes_[k];
    Eliminated<S> r;
    RevoluteColumn<S> h;
    S inverse;
    if (l.leaf) {
      set_bias(articulated, w);
      const Leaf& leaf = tree_->leaves[static_cast<std::size_t>(l.record)];
      set_leaf(leaf, h, r.M);
      inverse = S(leaf.inverse);
    } else {
      if (l.carries_branches_alone) articulated = {};
      add_body(articulated.M, l);
      add_bias(articulated, w);
      if (l.slot >= 0) add<false>(articulated, slots_[static_cast<std::size_t>(l.slot)]);
      const S pivot = pivot_of(l, articulated.M.Izz);
      if (!all_positive(pivot)) {
        singular_joint_ = static_cast<int>(k);
        return k;
      }
      inverse = S(1.0) / pivot;
      eliminate_revolute(articulated.M, inverse, h, r.M);
    }
    w.h = h;
    eliminate_bias(articulated, S(tau[l.u]), inverse, w, r);
    if (l.parent < 0) continue;
    const S c = angles_.cosine(k), s = angles_.sine(k);
    turn_revolute(r, c, s, l.d, w);
    Spatial::Force<S> column;
    if (l.has_rotor) [[unlikely]] {
      w.inverse = inverse;
      column = turned_rotor(l, h, inverse, c, s);
      r.nz = tau[l.u] - l.rotor * w.y0 + rotor_bias(column, w);
    }
    carry_any<false>(l, body(k).edge, r, articulated);
    if (l.has_rotor) [[unlikely]]
      hand_on_rotor(body(k).edge, column, articulated);
    if (!l.first) leave<false>(l, slot_of_parent(l), articulated);
  } while (k > 0 && alone(links[k - 1]) && links[k - 1].kind == LinkKind::revolute);
  if (k > 0) from = articulated;
  return k;
}

}  // namespace momenta
