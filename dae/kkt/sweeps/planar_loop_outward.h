#pragma once
// The outward sweep in a plane, and the last one inward for ṗ. Part of planar_loop_sweeps.h.

#include <momenta/dae/kkt/sweeps/planar_loop_sweeps.h>

namespace momenta {

/// Impulses of the loops in `range`, last closed first.
template <class S, int Rows, bool Momentum>
template <bool Moves, class Out>
MOMENTA_INLINE void LoopSweeps<Planar, S, Rows, Momentum>::solve_loops(
    const LoopPlan::Range& range, const RightSide<S>& right, const Planar::Motion<S>& motion,
    Column& sigma, Out& out) {
  const auto store = [&](int row, const S& x) {
    out[row] = right.centre ? x + right.centre[row] : x;
  };
  for (int i = range.last; i-- > range.first;) {
    const Closing& c = closings_[static_cast<std::size_t>(i)];
    const auto at = static_cast<std::size_t>(c.loop);
    if (pairs_in_registers && c.pair) {
      S x, y;
      if constexpr (Moves)
        pairs_[at].impulses(motion, sigma, open_slots_.beside[at], x, y);
      else
        pairs_[at].impulses_at_ground(sigma, open_slots_.beside[at], x, y);
      at_slot<Rows>(c.slot,
                    [&]<int Slot>() MOMENTA_INLINED { sigma.template set_pair<Slot>(x, y); });
      store(c.row, x);
      store(c.row + 1, y);
    } else {
      Column here = sigma;
      for (int j = loops_->loops[at].rows; j-- > 0;) {
        const Row& row = rows_[static_cast<std::size_t>(c.row + j)];
        const S x = Moves ? row.impulse(motion, here) : row.impulse_at_ground(here);
        here.set(row.slot, x);
        store(c.row + row.slot - c.slot, x);
      }
      sigma = here;
    }
  }
}

template <class S, int Rows, bool Momentum>
template <class Out>
void LoopSweeps<Planar, S, Rows, Momentum>::outward(const RightSide<S>& right, Out u, Out impulse,
                                                    Out rate) {
  const PlanarLink* links = tree_->links.data();
  const S zero(0.0);
  S vx = zero, vy = zero, omega = zero;
  Column sigma{}, at_ground{};
  const std::size_t n = revolutes_.size();
  Revolute* records = revolutes_.data();
  const OpenSlots::Front* fronts = open_slots_.fronts.data();
  const Visit* visits = visits_.data();
  for (std::size_t k = 0; k < n; ++k) {
    const PlanarLink& l = links[k];
    const SlotGroups open = fronts[k].open;
    Revolute& w = records[k];
    if (l.parent < 0) {
      const LoopPlan::Range last = plan_->gathered_closings_of[k];
      if (last.first != last.last)
        solve_loops<false>(last, right, Planar::Motion<S>{}, at_ground, impulse);
      vx = vy = omega = zero;
      sigma = at_ground;
    } else if (!l.first) {
      const Outward& from =
          outward_slots_[static_cast<std::size_t>(links[static_cast<std::size_t>(l.parent)].slot)];
      vx = from.motion.vx;
      vy = from.motion.vy;
      omega = from.motion.omega;
      sigma = from.sigma;
    }
    if (!l.revolute) {
      PlanarMotion<S> here{vx, vy, omega};
      const Column carried = sigma;  // a copy, as its address is taken
      general_outward(k, Momentum && right.rates, u, rate, here, carried);
      vx = here.vx;
      vy = here.vy;
      omega = here.omega;
    } else {
      S turning = minus_dot(w.fn, w.g, sigma, open), own = turning;
      if (l.parent >= 0) {
        vx = vx - omega * w.ry;
        vy = vy + omega * w.rx;
        if constexpr (!Momentum) {
          const S before = revolutes_[static_cast<std::size_t>(l.parent)].omega,
                  w2 = before * before;
          vx = vx - w2 * w.rx;
          vy = vy - w2 * w.ry;
        }
        turning = turning - (w.hx * vx + w.hy * vy);
        if (l.has_rotor) turning = turning + l.rotor * w.inverse * omega;
        own = turning - omega;
      }
      [[maybe_unused]] const S before = omega;
      omega = turning;
      u[l.u] = l.sign < 0 ? -own : own;
      if constexpr (Momentum)
        if (right.rates) {
          S turned = zero;
          if (l.parent >= 0) {
            const S Px = w.Axx * vx + w.Axy * vy + w.fx, Py = w.Axy * vx + w.Ayy * vy + w.fy;
            turned = plus_cross(vy * Px - vx * Py, vy, w.Cx, vx, w.Cy, sigma, open);
            if (l.has_rotor) turned = turned + l.rotor * before * (vy * w.hx - vx * w.hy);
          }
          rate[l.u] = turned;  // about the plane's normal, until the last sweep
        }
    }
    const LoopPlan::Range& closed = visits[k].closings;
    if (closed.first != closed.last)
      solve_loops<true>(closed, right, Planar::Motion<S>{{{vx, vy}}, omega}, sigma, impulse);
    if constexpr (Momentum)
      if (right.rates) own_rates(k, visits[k].ends, right, impulse, vx, vy, omega, w);
    if (l.slot >= 0) outward_slots_[static_cast<std::size_t>(l.slot)] = {{vx, vy, omega}, sigma};
  }
}

template <class S, int Rows, bool Momentum>
template <class Out>
void LoopSweeps<Planar, S, Rows, Momentum>::general_outward(std::size_t k, bool rates, Out u,
                                                            Out rate, PlanarMotion<S>& m,
                                                            const Column& sigma) {
  const auto& b = Base::body(k);
  const auto& x = joints_[static_cast<std::size_t>(tree_->links[k].record)];
  const auto& y = looped_[static_cast<std::size_t>(tree_->links[k].record)];
  const SlotGroups open = open_slots_.fronts[k].open;
  Planar::Motion<S> V{{{m.vx, m.vy}}, m.omega};
  if (b.parent >= 0) V = Planar::to_child({}, b.kind, x.edge, V);
  V += y.V;
  if (b.nv == 1) {
    const S own = minus_dot(x.pivot * x.e - Planar::power(x.h, V), y.g, sigma, open);
    Joint<Planar>::add_motion(b, x.edge, &own, V);
    u[b.u] = own;
    if (rates) {
      auto P = Planar::momentum(x.M, V);
      P += x.D;
      for (int i = 0; i < 3; ++i) P[i] = plus_dot(P[i], y.C[i], sigma, open);
      Planar::Force<S> net{};
      net -= Planar::cross_force(V, P);
      S along;
      Joint<Planar>::project(b, x.edge, net, &along);
      rate[b.u] = along;
    }
  }
  m = {V.v[0], V.v[1], V.w};
}

/// Sets the body's own share of T: its weight, and at each end of a loop N − κ w; each end of a tie
/// has its own, N = u × F.
template <class S, int Rows, bool Momentum>
template <class Out>
MOMENTA_INLINE void LoopSweeps<Planar, S, Rows, Momentum>::own_rates(
    std::size_t k, const LoopPlan::Range& ends, const RightSide<S>& right, const Out& impulse,
    const S& vx, const S& vy, const S& omega, Revolute& w) {
  const S zero(0.0);
  Wrench T{zero, zero, zero};
  if (!weights_.empty()) {
    const Weight& weight = weights_[k];
    T = {S(weight.fx), S(weight.fy),
         angles_.cosine(k) * weight.along + angles_.sine(k) * weight.across};
  }
  if (keeps_motions_) {
    w.vx = vx;
    w.vy = vy;
    w.omega = omega;
  }
  for (int i = ends.first; i < ends.last; ++i) {
    const End& end = ends_[static_cast<std::size_t>(i)];
    if (!end.tie) {
      if (end.first) add_other_rates(end, right, impulse, T);
      continue;
    }
    const Vec2<S>& r = arms_[static_cast<std::size_t>(i)];
    const S fx = end.sign * S(impulse[end.row]), fy = end.sign * S(impulse[end.row + 1]),
            leak(right.leak);
    const S ux = vx - omega * r[1], uy = vy + omega * r[0];
    T.fx = T.fx - leak * fx;
    T.fy = T.fy - leak * fy;
    T.fn = T.fn + (ux - leak * r[0]) * fy - (uy - leak * r[1]) * fx;
  }
  w.fx = T.fx;
  w.fy = T.fy;
  w.fn = T.fn;
}

/// N − κ w of a loop that is no tie, for both ends at the one met last: the other body's T waits in
/// its record.
template <class S, int Rows, bool Momentum>
template <class Out>
MOMENTA_INLINE void LoopSweeps<Planar, S, Rows, Momentum>::add_other_rates(
    const End& end, const RightSide<S>& right, const Out& impulse, Wrench& T) {
  const auto loop = static_cast<std::size_t>(end.loop);
  const Loop& l = loops_->loops[loop];
  if (l.a == l.b) return;
  const Place& s = places_[loop];
  const S zero(0.0);
  const auto motion_of = [&](int body) MOMENTA_INLINED {
    if (body < 0) return Planar::Motion<S>{};
    const Revolute& w = revolutes_[static_cast<std::size_t>(body)];
    return Planar::Motion<S>{{{w.vx, w.vy}}, w.omega};
  };
  const Planar::Motion<S> A = motion_of(l.a), B = motion_of(l.b);
  Wrench w, N;  // impulses on A about x_A, and their rate
  if (end.turns) {
    const S x = S(impulse[l.row]), y = S(impulse[l.row + 1]);
    w = {x * s.Fx - y * s.Fy, x * s.Fy + y * s.Fx, zero};
    N = {-(B.w * w.fy), B.w * w.fx, zero};
  } else {
    const Planar::Motion<S> of_a = A, of_b = B;  // copies, as their addresses are taken
    Wrench sum, rate;
    force_of_rows(loop, right, impulse, of_a, of_b, sum, rate);
    w = sum;
    N = rate;
  }
  const S ux = A.v[0] - A.w * s.ay, uy = A.v[1] + A.w * s.ax;
  N.fn = N.fn + (ux * w.fy - uy * w.fx);
  N.fx = N.fx - right.leak * w.fx;
  N.fy = N.fy - right.leak * w.fy;
  const Wrench on_a{N.fx, N.fy, N.fn + (s.ax * N.fy - s.ay * N.fx)},
      on_b{-N.fx, -N.fy, -(N.fn + (s.bx * N.fy - s.by * N.fx))};
  add(T, end.on_a ? on_a : on_b);
  const int other = end.on_a ? l.b : l.a;
  if (other < 0) return;
  Revolute& there = revolutes_[static_cast<std::size_t>(other)];
  const Wrench& own = end.on_a ? on_b : on_a;
  there.fx = there.fx + own.fx;
  there.fy = there.fy + own.fy;
  there.fn = there.fn + own.fn;
}

/// ṗ += Eᵀ T*, T with springs and wrenches.
template <class S, int Rows, bool Momentum>
template <class In, class Out>
void LoopSweeps<Planar, S, Rows, Momentum>::rates_inward(const In& q, const RightSide<S>& right,
                                                         const Out& u, const Out& impulse,
                                                         Out rate) {
  const PlanarLink* links = tree_->links.data();
  const S zero(0.0);
  if (right.body_forces) gather_forces();
  Wrench T{zero, zero, zero};
  const Revolute* records = revolutes_.data();
  for (std::size_t k = revolutes_.size(); k-- > 0;) {
    const PlanarLink& l = links[k];
    const Revolute& w = records[k];
    const Wrench own_share{w.fx, w.fy, w.fn};
    if (l.leaf)
      T = own_share;
    else
      add(T, own_share);
    if (l.forced && right.body_forces) {
      const Planar::Force<S>& own = forces_->on(k);
      add(T, {own.f[0], own.f[1], own.n});
    }
    if (l.slot >= 0) add(T, wrench_slots_[static_cast<std::size_t>(l.slot)]);
    if (l.revolute) {
      const S turned = S(rate[l.u]) + T.fn;
      S own = l.sign < 0 ? -turned : turned;
      if (l.has_force) own = own + joint_force(Base::body(k), S(q[l.q]), S(u[l.u]));
      rate[l.u] = own;
    } else if (const auto& b = Base::body(k); b.nv == 1) {
      S along;
      Joint<Planar>::project(b, joints_[static_cast<std::size_t>(l.record)].edge,
                             Planar::Force<S>{{{T.fx, T.fy}}, T.fn}, &along);
      rate[b.u] = S(rate[b.u]) + along + joint_force(b, S(q[b.q]), S(u[b.u]));
    }
    if (l.parent < 0) continue;
    T.fn = T.fn + (w.rx * T.fy - w.ry * T.fx);
    if (l.first) continue;
    Wrench& to =
        wrench_slots_[static_cast<std::size_t>(links[static_cast<std::size_t>(l.parent)].slot)];
    if (l.opens)
      to = T;
    else
      add(to, T);
  }
  if (plan_->couples() && right.leak != 0) leak_of_couplers<S>(*loops_, right.leak, impulse, rate);
}

/// w and N of a loop that is no tie, N without u_A × F, its couple with the leak.
template <class S, int Rows, bool Momentum>
template <class Out>
void LoopSweeps<Planar, S, Rows, Momentum>::force_of_rows(
    std::size_t loop, const RightSide<S>& right, const Out& impulse, const Planar::Motion<S>& of_a,
    const Planar::Motion<S>& of_b, Wrench& w, Wrench& N) const {
  const Loop& l = loops_->loops[loop];
  const Place& s = places_[loop];
  const S zero(0.0);
  w = N = {zero, zero, zero};
  if (l.is_coupler()) return;
  S turning_a = of_a.w, turning_b = of_b.w;  // turning of the axes
  if (l.motion >= 0) {
    turning_a = turning_a + motion(l).turning_a;
    turning_b = turning_b + motion(l).turning_b;
  }
  for (int row = 0; row < l.rows; ++row) {
    const RowPlace r = row_place(loop, row);
    const S x = S(impulse[l.row + row]);
    w.fx = w.fx + x * r.Fx;
    w.fy = w.fy + x * r.Fy;
    w.fn = w.fn + x * r.c;
    if (row >= l.n_points && !l.is_distance()) N.fn = N.fn + x * ((turning_b - turning_a) * r.turn);
  }
  N.fn = N.fn - right.leak * w.fn;
  if (!l.is_distance()) {
    N.fx = -(turning_b * w.fy);
    N.fy = turning_b * w.fx;
    return;
  }
  // F' = (u_A − u_B) σ / l₀
  const Vec2<S> gap = gap_of(l, s);
  S bx = of_b.v[0] - of_b.w * (s.by - gap[1]), by = of_b.v[1] + of_b.w * (s.bx - gap[0]);
  if (l.motion >= 0) {
    bx = bx + moving_point(l).v[0];
    by = by + moving_point(l).v[1];
  }
  const S scaled = S(impulse[l.row]) * l.per_length;
  N.fx = scaled * ((of_a.v[0] - of_a.w * s.ay) - bx);
  N.fy = scaled * ((of_a.v[1] + of_a.w * s.ax) - by);
}

template <class S, int Rows, bool Momentum>
template <class Report>
void LoopSweeps<Planar, S, Rows, Momentum>::each_pivot(Report&& report) const {
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Loop& l = loops_->loops[i];
    if (pairs_in_registers && plan_->pair[i]) {
      const Pair& p = pairs_[i];
      const bool swapped = value_of(p.swap) > 0.5;
      report(l.row + (swapped ? 1 : 0), value_of(p.pivots.w_a), value_of(p.pivots.tau));
      report(l.row + (swapped ? 0 : 1), value_of(p.pivots.w_b), value_of(p.pivots.tau));
    } else {
      for (int j = 0; j < l.rows; ++j) {
        const Row& row = rows_[static_cast<std::size_t>(l.row + j)];
        report(l.row + row.slot - plan_->slot[i], value_of(row.w), value_of(row.tau));
      }
    }
  }
}

}  // namespace momenta
