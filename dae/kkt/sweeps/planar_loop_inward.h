#pragma once
// The inward sweep in a plane: fronts gathered, loops closed, joints eliminated. Part of
// planar_loop_sweeps.h.

#include <momenta/dae/kkt/sweeps/planar_loop_sweeps.h>

namespace momenta {

/// Adds what a closed row leaves, c f cᵀ and c f d.
template <class S>
struct PlanarWeight {
  PlanarArticulated<S>& a;
  MOMENTA_INLINE void operator()(const S* c, const S* fc, const S& fd) const {
    a.Axx = a.Axx + c[0] * fc[0];
    a.Axy = a.Axy + c[0] * fc[1];
    a.Ayy = a.Ayy + c[1] * fc[1];
    a.Hx = a.Hx + c[0] * fc[2];
    a.Hy = a.Hy + c[1] * fc[2];
    a.I = a.I + c[2] * fc[2];
    a.Dx = a.Dx + c[0] * fd;
    a.Dy = a.Dy + c[1] * fd;
    a.Dn = a.Dn + c[2] * fd;
  }
};

/// Calls pair<slot>() for an even slot.
template <int Rows, int Slot = 0, class Pair>
MOMENTA_INLINE void at_slot(int slot, Pair&& pair) {
  if constexpr (Slot + 2 >= Rows) {
    pair.template operator()<Slot>();
  } else {
    if (slot == Slot)
      pair.template operator()<Slot>();
    else
      at_slot<Rows, Slot + 2>(slot, pair);
  }
}

template <class S, int Rows, bool Momentum>
template <bool Moves>
MOMENTA_INLINE void LoopSweeps<Planar, S, Rows, Momentum>::close(const LoopPlan::Range& range,
                                                                 PlanarArticulated<S>& a, Blocks& o,
                                                                 double fade, SlotGroups all) {
  for (int i = range.first; i < range.last; ++i) {
    const Closing& c = closings_[static_cast<std::size_t>(i)];
    const auto at = static_cast<std::size_t>(c.loop);
    if constexpr (pairs_in_registers)
      if (c.pair) [[likely]] {
        at_slot<Rows>(c.slot, [&]<int Slot>() MOMENTA_INLINED {
          if (compliance_) {
            const S* soft = compliance_ + c.row;
            o.W[Slot].template add_pair<Slot>(soft[0], S(0.0));
            o.W[Slot + 1].template add_pair<Slot>(S(0.0), soft[1]);
          }
          close_pair<Slot, Moves>(o, fade, open_slots_.beside[at], pairs_[at], PlanarWeight<S>{a});
        });
        continue;
      }
    Open copy{a, o};
    close_any(c.loop, copy, fade, all);
    a = copy.articulated;
    o = copy.blocks;
  }
}

template <class S, int Rows, bool Momentum>
void LoopSweeps<Planar, S, Rows, Momentum>::close_any(int loop, Open& open, double fade,
                                                      SlotGroups all) {
  const auto at = static_cast<std::size_t>(loop);
  const Loop& l = loops_->loops[at];
  const int points = l.first_rows();
  open.blocks.begin(false, ~all);
  if (compliance_) soften(open.blocks, plan_->slot[at], l.rows, compliance_ + l.row);
  close_loop(open.blocks, plan_->slot[at], points, l.rows - points, S(l.least_scale), fade,
             &rows_[static_cast<std::size_t>(l.row)], PlanarWeight<S>{open.articulated});
}

/// Enters couplers' rows on joint k; returns the joint's momentum or force without their centre.
template <class S, int Rows, bool Momentum>
template <class In>
S LoopSweeps<Planar, S, Rows, Momentum>::couple(std::size_t k, const In& r,
                                                const RightSide<S>& right, Open& open) {
  const PlanarLink& l = tree_->links[k];
  Blocks& o = open.blocks;
  S own = l.sign < 0 ? -r[l.u] : S(r[l.u]);
  each_coupling(*plan_, k, [&](const LoopPlan::Coupling& j, std::size_t loop, int slot) {
    const double ratio = l.sign < 0 ? -j.ratio : j.ratio;
    o.C[2].add(slot, S(ratio));
    if (j.first) o.d.add(slot, coupled_[loop]);
    if (right.centre) own = own - ratio * right.centre[loops_->loops[loop].row];
  });
  return own;
}
template <class S, int Rows, bool Momentum>
void LoopSweeps<Planar, S, Rows, Momentum>::uncouple(std::size_t k, Open& open) {
  Column& c = open.blocks.C[2];
  const double sign = tree_->links[k].sign;
  each_coupling(*plan_, k, [&](const LoopPlan::Coupling& j, std::size_t, int slot) {
    c.add(slot, S(sign < 0 ? j.ratio : -j.ratio));
  });
}

template <class S, int Rows, bool Momentum>
template <class In>
bool LoopSweeps<Planar, S, Rows, Momentum>::inward(const In& r, const RightSide<S>& right) {
  const PlanarLink* links = tree_->links.data();
  const OpenSlots::Front* fronts = open_slots_.fronts.data();
  const Visit* visits = visits_.data();
  Revolute* records = revolutes_.data();
  const Vec2<double>& g = tree_->model->gravity;
  const bool falls = !Momentum && tree_->model->has_gravity, couples = plan_->couples();
  PlanarArticulated<S> a{};
  // In registers for one state: what takes the address takes a copy. In memory for a pack, as what
  // is open differs from body to body.
  std::conditional_t<Column::apart, Blocks&, Blocks> o = front_;
  Blocks& ground = ground_;
  if constexpr (!Column::apart) ground = {};
  for (std::size_t k = revolutes_.size(); k-- > 0;) {
    const PlanarLink& l = links[k];
    const OpenSlots::Front& front = fronts[k];
    const Visit& visit = visits[k];
    Revolute& w = records[k];
    const S c = angles_.cosine(k), s = angles_.sine(k);
    const S kx = l.cx * c - l.cy * s, ky = l.cx * s + l.cy * c;
    const Vec2<S> way = way_from_parent(l);
    w.rx = way[0];
    w.ry = way[1];
    if (l.leaf) a = {};
    const SlotGroups born = l.revolute ? front.born : 0;
    o.begin(l.leaf, front.fresh, born);
    Base::add_body(a, l, kx, ky);
    if constexpr (!Momentum) {
      const S w2 = w.omega * w.omega;
      a.Dx = a.Dx - w2 * kx;
      a.Dy = a.Dy - w2 * ky;
      if (falls) {
        a.Dx = a.Dx - l.m * g[0];
        a.Dy = a.Dy - l.m * g[1];
        a.Dn = a.Dn - (kx * g[1] - ky * g[0]);
      }
      if (l.forced && right.body_forces) {
        const Planar::Force<S>& T = forces_->on(k);
        a.Dx = a.Dx - T.f[0];
        a.Dy = a.Dy - T.f[1];
        a.Dn = a.Dn - T.n;
      }
    }
    if (l.slot >= 0) {
      const Open& slot = slots_[static_cast<std::size_t>(l.slot)];
      Base::add(a, slot.articulated);
      o.add(slot.blocks, front.slot);
    }
    enter(k, visit.ends, right, a, o);
    const LoopPlan::Range& closing = visit.closings;
    if (closing.first != closing.last) close<true>(closing, a, o, right.fade, front.all);
    if (!l.revolute) [[unlikely]] {
      Open here{a, o};
      if (!general_inward(k, r, right, here)) {
        singular_joint_ = static_cast<int>(k);
        return false;
      }
      a = here.articulated;
      o = here.blocks;
    } else {
      const S pivot = pivot_of(l, a.I);
      if (!all_positive(pivot)) {
        singular_joint_ = static_cast<int>(k);
        return false;
      }
      const S inverse = S(1.0) / pivot;
      w.inverse = inverse;
      S pk;
      if (couples) [[unlikely]] {
        Open here{a, o};
        pk = couple(k, r, right, here);
        a = here.articulated;
        o = here.blocks;
      } else {
        pk = l.sign < 0 ? -r[l.u] : S(r[l.u]);
      }
      const S e = pk - a.Dn;
      const S y0 = e * inverse;
      w.fn = y0;
      o.eliminate(o.C[2], inverse, y0, front.open, born, w.g);
      each_open<S, Rows>(front.open, [&](auto i) MOMENTA_INLINED {
        Blocks::put(born, i, i, o.scale.v[i], o.C[2].v[i] * w.g.v[i]);
      });
      if (l.parent >= 0) {
        const S hx = a.Hx * inverse, hy = a.Hy * inverse;
        w.hx = hx;
        w.hy = hy;
        a.Axx = a.Axx - a.Hx * hx;
        a.Axy = a.Axy - a.Hx * hy;
        a.Ayy = a.Ayy - a.Hy * hy;
        a.Dx = a.Dx + hx * e;
        a.Dy = a.Dy + hy * e;
        const S rx = way[0], ry = way[1];
        const S kept = l.rotor * inverse;
        each_open<S, Rows>(front.open, [&](auto i) MOMENTA_INLINED {
          const auto n = o.C[2].v[i], x = o.C[0].v[i] - n * Column::all(hx),
                     y = o.C[1].v[i] - n * Column::all(hy);
          o.C[0].v[i] = x;
          o.C[1].v[i] = y;
          o.C[2].v[i] = y * Column::all(rx) - x * Column::all(ry);
          if (l.has_rotor) o.C[2].v[i] = o.C[2].v[i] + n * Column::all(kept);
          if constexpr (Momentum) {
            w.Cx.v[i] = x;
            w.Cy.v[i] = y;
          }
        });
        S bias(0.0);  // hᵀ c of a rotor
        if constexpr (Momentum) {
          w.Axx = a.Axx;
          w.Axy = a.Axy;
          w.Ayy = a.Ayy;
          w.fx = a.Dx;
          w.fy = a.Dy;
        } else {
          const Revolute& from = revolutes_[static_cast<std::size_t>(l.parent)];
          const S w2 = from.omega * from.omega, bx = -(w2 * rx), by = -(w2 * ry);
          if (l.has_rotor) bias = hx * bx + hy * by;
          a.Dx = a.Dx + (a.Axx * bx + a.Axy * by);
          a.Dy = a.Dy + (a.Axy * bx + a.Ayy * by);
          each_open<S, Rows>(front.open, [&](auto i) MOMENTA_INLINED {
            o.d.v[i] = o.d.v[i] + (o.C[0].v[i] * Column::all(bx) + o.C[1].v[i] * Column::all(by));
          });
        }
        if (l.has_rotor) [[unlikely]]
          Base::carry_with_rotor(a, l, hx, hy, inverse, rx, ry, pk - l.rotor * (y0 - bias));
        else
          Base::carry(a, rx, ry, pk);
        if (couples) [[unlikely]] {
          Open here{a, o};
          uncouple(k, here);
          a = here.articulated;
          o = here.blocks;
        }
      }
    }
    if (l.parent < 0) {
      ground.add_at_ground(o, front.open, front.gathered_fresh, front.gathered);
      const LoopPlan::Range last = plan_->gathered_closings_of[k];
      if (last.first != last.last) close<false>(last, a, ground, right.fade, front.gathered);
    } else if (!l.first) {
      const auto parent = static_cast<std::size_t>(l.parent);
      Open& slot = slots_[static_cast<std::size_t>(links[parent].slot)];
      if (l.opens) {
        slot.articulated = a;
        slot.blocks.begin(true, fronts[parent].slot);
      } else {
        Base::add(slot.articulated, a);
      }
      slot.blocks.add(o, front.open);
    }
  }
  return true;
}

/// Sliders, driven joints and welds.
template <class S, int Rows, bool Momentum>
template <class In>
bool LoopSweeps<Planar, S, Rows, Momentum>::general_inward(std::size_t k, const In& r,
                                                           const RightSide<S>& right, Open& open) {
  const PlanarLink& l = tree_->links[k];
  const auto& b = Base::body(k);
  auto& x = joints_[static_cast<std::size_t>(l.record)];
  auto& y = looped_[static_cast<std::size_t>(l.record)];
  const Revolute& w = revolutes_[k];
  PlanarArticulated<S>& a = open.articulated;
  Blocks& o = open.blocks;
  const SlotGroups carried = open_slots_.fronts[k].open;
  o.begin(false, ~carried);
  x.M = Base::blocks(a);
  x.D = {{{a.Dx, a.Dy}}, a.Dn};
  for (int i = 0; i < 3; ++i) y.C[i] = o.C[i];
  S own = b.nv == 1 ? S(r[b.u]) : S(0.0);
  if (right.centre)
    each_coupling(*plan_, k, [&](const LoopPlan::Coupling& j, std::size_t loop, int) {
      own = own - j.ratio * right.centre[loops_->loops[loop].row];
    });
  Planar::ArticulatedInertia<S> M;
  if (!eliminate<Planar>(b, x, M)) return false;
  auto D = remainder<Planar>(b, x, &own);
  if (b.nv == 1) {
    Planar::Motion<S> E{};
    const S one(1.0);
    Joint<Planar>::add_motion(b, x.edge, &one, E);
    Column c = o.C[0] * E[0] + o.C[1] * E[1] + o.C[2] * E[2];
    each_coupling(*plan_, k, [&](const LoopPlan::Coupling& j, std::size_t loop, int slot) {
      c.add(slot, S(j.ratio));
      if (j.first) o.d.add(slot, coupled_[loop]);
    });
    o.eliminate(c, x.pivot, x.pivot * x.e, carried, 0, y.g);
    o.scale += c * y.g;
    for (int i = 0; i < 3; ++i) o.C[i] -= c * x.h[i];
  }
  // Ω_t, or the body's acceleration without its parent's and E u̇.
  if constexpr (!Momentum)
    if (b.parent >= 0) {
      const S omega = revolutes_[static_cast<std::size_t>(b.parent)].omega;
      y.V.v -= (omega * omega) * x.edge.r;
    }
  D += Planar::momentum(M, y.V);
  o.d += o.C[0] * y.V.v[0] + o.C[1] * y.V.v[1] + o.C[2] * y.V.w;
  if (b.parent < 0) return true;
  Base::carry(a, x, M, D);
  o.C[2] += o.C[1] * w.rx - o.C[0] * w.ry;
  return true;
}

}  // namespace momenta
