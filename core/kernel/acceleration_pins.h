#pragma once
// Pins on the inward way of the articulated recursion: inside a chain, and anywhere else.

#include <momenta/core/kernel/acceleration_sweeps.h>

namespace momenta {

/// + the body's bias wrench.
template <class S>
MOMENTA_INLINE void add_bias(Cargo<S>& cargo, const PinAcceleration<S>& w) {
  cargo.Dfx = cargo.Dfx + w.bfx;
  cargo.Dfy = cargo.Dfy + w.bfy;
  cargo.Dfz = cargo.Dfz + w.bfz;
  cargo.Dnx = cargo.Dnx + w.bnx;
  cargo.Dny = cargo.Dny + w.bny;
  cargo.Dnz = cargo.Dnz + w.bnz;
}
template <class S>
MOMENTA_INLINE void set_bias(Cargo<S>& cargo, const PinAcceleration<S>& w) {
  cargo.Dfx = w.bfx;
  cargo.Dfy = w.bfy;
  cargo.Dfz = w.bfz;
  cargo.Dnx = w.bnx;
  cargo.Dny = w.bny;
  cargo.Dnz = w.bnz;
}
/// D' after the pin is eliminated.
template <class S>
MOMENTA_INLINE void eliminate_bias(const Cargo<S>& cargo, const S& tau, const S& inverse,
                                   PinAcceleration<S>& w, Eliminated<S>& r) {
  const S e = tau - cargo.Dnz;
  w.y0 = e * inverse;
  r.fx = cargo.Dfx + w.h.fx * e;
  r.fy = cargo.Dfy + w.h.fy * e;
  r.fz = cargo.Dfz + w.h.fz * e;
  r.nx = cargo.Dnx + w.h.nx * e;
  r.ny = cargo.Dny + w.h.ny * e;
  r.nz = tau;
}
/// The pin's screw for M' and D', then D' += M' c.
template <class S, class C>
MOMENTA_INLINE void turn_pin(Eliminated<S>& r, const S& c, const S& s, const C& d,
                             const PinAcceleration<S>& w) {
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

template <class S>
template <Turn turn, class InTau>
std::size_t AccelerationSweeps<Spatial, S>::chain_inward(std::size_t end, const InTau& tau,
                                                         Cargo<S>& from) {
  Cargo<S> cargo = from;
  const Link* links = tree_->links.data();
  std::size_t k = end - 1;
  add_body(cargo.M, links[k]);
  add_bias(cargo, pins_[k]);
  change_signs<turn>(cargo);
  for (;;) {
    const Link& l = links[k];
    PinAcceleration<S>& w = pins_[k];
    change_signs<turn>(cargo);
    if (!all_positive(cargo.M.Izz)) {
      stuck_ = static_cast<int>(k);
      return k;
    }
    Eliminated<S> r;
    const S inverse = S(1.0) / cargo.M.Izz;
    PinColumn<S> h;
    eliminate_pin(cargo.M, inverse, h, r.M);
    w.h = h;
    eliminate_bias(cargo, S(tau[l.u]), inverse, w, r);
    turn_pin(r, angles_.cosine(k), angles_.sine(k), l.d, w);
    if (links[k - 1].path != static_cast<Path>(turn)) {
      const Eliminated<S> last = r;  // whose address is taken
      carry_last<turn, false>(last, l, from);
      return k;
    }
    carry<turn, false>(r, l, cargo);
    --k;
    add_body(cargo.M, links[k]);
    add_bias(cargo, pins_[k]);
    change_signs<turn>(cargo);
  }
}

template <class S>
template <class InTau>
std::size_t AccelerationSweeps<Spatial, S>::pins_inward(std::size_t end, const InTau& tau,
                                                        Cargo<S>& from) {
  Cargo<S> cargo = from;
  const Link* links = tree_->links.data();
  std::size_t k = end;
  do {
    --k;
    const Link& l = links[k];
    PinAcceleration<S>& w = pins_[k];
    Eliminated<S> r;
    PinColumn<S> h;
    S inverse;
    if (l.tip) {
      set_bias(cargo, w);
      const Tip& tip = tree_->tips[static_cast<std::size_t>(l.record)];
      set_tip(tip, h, r.M);
      inverse = S(tip.inverse);
    } else {
      if (l.carries_limbs_alone) cargo = {};
      add_body(cargo.M, l);
      add_bias(cargo, w);
      if (l.slot >= 0) add<false>(cargo, slots_[static_cast<std::size_t>(l.slot)]);
      if (!all_positive(cargo.M.Izz)) {
        stuck_ = static_cast<int>(k);
        return k;
      }
      inverse = S(1.0) / cargo.M.Izz;
      eliminate_pin(cargo.M, inverse, h, r.M);
    }
    w.h = h;
    eliminate_bias(cargo, S(tau[l.u]), inverse, w, r);
    if (l.parent < 0) continue;
    turn_pin(r, angles_.cosine(k), angles_.sine(k), l.d, w);
    carry_any<false>(l, body(k).edge, r, cargo);
    if (!l.first) leave<false>(l, slot_of_parent(l), cargo);
  } while (k > 0 && links[k - 1].path == Path::any && links[k - 1].kind == LinkKind::pin);
  from = cargo;
  return k;
}

}  // namespace momenta
