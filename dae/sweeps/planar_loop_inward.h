#pragma once
// The inward sweep in a plane: fronts gathered, loops closed, joints eliminated. Part of
// planar_loop_sweeps.h.

#include <momenta/dae/sweeps/planar_loop_sweeps.h>

namespace momenta {

/// What closing a row adds to the front: c f cᵀ and c f d.
template <class S>
struct PlanarWeight {
  PlanarCargo<S>& a;
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

/// Calls pair<lane>() for an even lane.
template <int Rows, int Lane = 0, class Pair>
MOMENTA_INLINE void at_lane(int lane, Pair&& pair) {
  if constexpr (Lane + 2 >= Rows) {
    pair.template operator()<Lane>();
  } else {
    if (lane == Lane)
      pair.template operator()<Lane>();
    else
      at_lane<Rows, Lane + 2>(lane, pair);
  }
}

template <class S, int Rows, bool Momentum>
template <bool Moves>
MOMENTA_INLINE void LoopSweeps<Planar, S, Rows, Momentum>::close(const LoopPlan::Range& range,
                                                                 PlanarCargo<S>& a, Blocks& o,
                                                                 double fade) {
  for (int i = range.first; i < range.last; ++i) {
    const int loop = plan_->closings[static_cast<std::size_t>(i)];
    const auto at = static_cast<std::size_t>(loop);
    if constexpr (pairs_in_registers)
      if (plan_->pair[at]) {
        at_lane<Rows>(plan_->lane[at], [&]<int Lane>() MOMENTA_INLINED {
          if (compliance_) {
            const S* soft = compliance_ + loops_->loops[at].row;
            o.W[Lane].add(Lane, soft[0]);
            o.W[Lane + 1].add(Lane + 1, soft[1]);
          }
          close_pair<Lane, Moves>(o, fade, pairs_[at], PlanarWeight<S>{a});
        });
        continue;
      }
    Open copy{a, o};
    close_any(loop, copy, fade);
    a = copy.cargo;
    o = copy.blocks;
  }
}

template <class S, int Rows, bool Momentum>
void LoopSweeps<Planar, S, Rows, Momentum>::close_any(int loop, Open& open, double fade) {
  const Loop& l = loops_->loops[static_cast<std::size_t>(loop)];
  const int points = l.first_rows();
  if (compliance_)
    soften(open.blocks, plan_->lane[static_cast<std::size_t>(loop)], l.rows, compliance_ + l.row);
  close_loop(open.blocks, plan_->lane[static_cast<std::size_t>(loop)], points, l.rows - points,
             fade, &rows_[static_cast<std::size_t>(l.row)], PlanarWeight<S>{open.cargo});
}

template <class S, int Rows, bool Momentum>
template <class In>
bool LoopSweeps<Planar, S, Rows, Momentum>::inward(const In& r, const RightSide<S>& right) {
  const PlanarLink* links = tree_->links.data();
  const Vec2<double>& g = tree_->model->gravity;
  const bool falls = !Momentum && tree_->model->has_gravity, couples = plan_->couples();
  PlanarCargo<S> a{};
  Blocks o{}, ground{};
  for (std::size_t k = pins_.size(); k-- > 0;) {
    const PlanarLink& l = links[k];
    LoopedPin<S, Rows>& w = pins_[k];
    const S kx = own_x_[k], ky = own_y_[k];
    if (l.tip) {
      a = {};
      o = {};
    }
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
    }
    if (l.slot >= 0) {
      const Open& slot = slots_[static_cast<std::size_t>(l.slot)];
      Base::add(a, slot.cargo);
      o.add(slot.blocks);
    }
    enter(k, right, a, o);
    const LoopPlan::Range closing = plan_->closings_of[k];
    if (closing.first != closing.last) close<true>(closing, a, o, right.fade);
    if (!l.pin) {
      Open here{a, o};
      if (!general_inward(k, r, right, here)) {
        stuck_ = static_cast<int>(k);
        return false;
      }
      a = here.cargo;
      o = here.blocks;
    } else {
      if (!all_positive(a.I)) {
        stuck_ = static_cast<int>(k);
        return false;
      }
      const S inverse = S(1.0) / a.I;
      S pk = l.sign < 0 ? -r[l.u] : S(r[l.u]);
      if (couples)
        each_coupling(*plan_, k, [&](const LoopPlan::Coupling& j, std::size_t loop, int lane) {
          const double ratio = l.sign < 0 ? -j.ratio : j.ratio;
          o.C[2].add(lane, S(ratio));
          if (j.first) o.d.add(lane, coupled_[loop]);
          if (right.centre) pk = pk - ratio * right.centre[loops_->loops[loop].row];
        });
      const S e = pk - a.Dn;
      w.y0 = e * inverse;
      w.g = o.C[2] * inverse;
      o.d += o.C[2] * w.y0;
      o.scale += o.C[2] * w.g;
      for (int i = 0; i < Rows; ++i) o.W[i] += w.g * o.C[2][i];
      if (l.parent >= 0) {
        w.hx = a.Hx * inverse;
        w.hy = a.Hy * inverse;
        a.Axx = a.Axx - a.Hx * w.hx;
        a.Axy = a.Axy - a.Hx * w.hy;
        a.Ayy = a.Ayy - a.Hy * w.hy;
        a.Dx = a.Dx + w.hx * e;
        a.Dy = a.Dy + w.hy * e;
        o.C[0] -= o.C[2] * w.hx;
        o.C[1] -= o.C[2] * w.hy;
        if constexpr (Momentum) {
          w.Axx = a.Axx;
          w.Axy = a.Axy;
          w.Ayy = a.Ayy;
          w.Dx = a.Dx;
          w.Dy = a.Dy;
          w.Cx = o.C[0];
          w.Cy = o.C[1];
        } else {
          const LoopedPin<S, Rows>& from = pins_[static_cast<std::size_t>(l.parent)];
          const S w2 = from.omega * from.omega, bx = -(w2 * w.rx), by = -(w2 * w.ry);
          a.Dx = a.Dx + (a.Axx * bx + a.Axy * by);
          a.Dy = a.Dy + (a.Axy * bx + a.Ayy * by);
          o.d += o.C[0] * bx + o.C[1] * by;
        }
        Base::carry(a, w.rx, w.ry, pk);
        o.C[2] = o.C[1] * w.rx - o.C[0] * w.ry;
        if (couples)
          each_coupling(*plan_, k, [&](const LoopPlan::Coupling& j, std::size_t, int lane) {
            o.C[2].add(lane, S(l.sign < 0 ? j.ratio : -j.ratio));
          });
      }
    }
    if (l.parent < 0) {
      ground.add_at_ground(o);
      const LoopPlan::Range last = plan_->ground_closings_of[k];
      if (last.first != last.last) close<false>(last, a, ground, right.fade);
    } else if (!l.first) {
      Open& slot = slots_[static_cast<std::size_t>(links[static_cast<std::size_t>(l.parent)].slot)];
      if (l.opens) {
        slot.cargo = a;
        slot.blocks = o;
      } else {
        Base::add(slot.cargo, a);
        slot.blocks.add(o);
      }
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
  LoopedPin<S, Rows>& w = pins_[k];
  PlanarCargo<S>& a = open.cargo;
  Blocks& o = open.blocks;
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
    Lanes<S, Rows> c = o.C[0] * E[0] + o.C[1] * E[1] + o.C[2] * E[2];
    each_coupling(*plan_, k, [&](const LoopPlan::Coupling& j, std::size_t loop, int lane) {
      c.add(lane, S(j.ratio));
      if (j.first) o.d.add(lane, coupled_[loop]);
    });
    y.g = c * x.pivot;
    o.d += y.g * x.e;
    o.scale += c * y.g;
    for (int i = 0; i < Rows; ++i) o.W[i] += y.g * c[i];
    for (int i = 0; i < 3; ++i) o.C[i] -= c * x.h[i];
  }
  // Ω_t, or what the body's acceleration has beside its parent's and E u̇.
  if constexpr (!Momentum)
    if (b.parent >= 0) {
      const S omega = pins_[static_cast<std::size_t>(b.parent)].omega;
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
