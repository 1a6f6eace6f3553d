#pragma once
// The outward sweep in a plane, and the last one inward for ṗ. Part of planar_loop_sweeps.h.

#include <momenta/dae/sweeps/planar_loop_sweeps.h>

namespace momenta {

/// Impulses of the loops in `range`, last closed first.
template <class S, int Rows, bool Momentum>
template <bool Moves, class Out>
void LoopSweeps<Planar, S, Rows, Momentum>::solve_loops(const LoopPlan::Range& range,
                                                        const RightSide<S>& right,
                                                        const Planar::Motion<S>& motion,
                                                        Lanes<S, Rows>& sigma, Out& out) {
  const auto store = [&](int row, const S& x) {
    out[row] = right.centre ? x + right.centre[row] : x;
  };
  for (int i = range.last; i-- > range.first;) {
    const auto at = static_cast<std::size_t>(plan_->closings[static_cast<std::size_t>(i)]);
    const Loop& l = loops_->loops[at];
    const int lane = plan_->lane[at];
    if (pairs_in_registers && plan_->pair[at]) {
      S x, y;
      if constexpr (Moves)
        pairs_[at].impulses(motion, sigma, x, y);
      else
        pairs_[at].impulses_at_ground(sigma, x, y);
      sigma.set(lane, x);
      sigma.set(lane + 1, y);
      store(l.row, x);
      store(l.row + 1, y);
    } else {
      for (int j = l.rows; j-- > 0;) {
        const Row& row = rows_[static_cast<std::size_t>(l.row + j)];
        const S x = Moves ? row.impulse(motion, sigma) : row.impulse_at_ground(sigma);
        sigma.set(row.lane, x);
        store(l.row + row.lane - lane, x);
      }
    }
  }
}

template <class S, int Rows, bool Momentum>
template <class Out>
void LoopSweeps<Planar, S, Rows, Momentum>::outward(const RightSide<S>& right, Out u, Out impulse,
                                                    Out rate) {
  const PlanarLink* links = tree_->links.data();
  const bool rates = Momentum && right.rates;
  const S zero(0.0);
  S vx = zero, vy = zero, omega = zero;
  Lanes<S, Rows> sigma{}, at_ground{};
  for (std::size_t k = 0; k < pins_.size(); ++k) {
    const PlanarLink& l = links[k];
    LoopedPin<S, Rows>& w = pins_[k];
    if (l.parent < 0) {
      const LoopPlan::Range last = plan_->ground_closings_of[k];
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
    if (!l.pin) {
      PlanarMotion<S> here{vx, vy, omega};
      general_outward(k, rates, u, rate, here, sigma);
      vx = here.vx;
      vy = here.vy;
      omega = here.omega;
    } else {
      S turning = w.y0 - dot(w.g, sigma), own = turning;
      if (l.parent >= 0) {
        vx = vx - omega * w.ry;
        vy = vy + omega * w.rx;
        if constexpr (!Momentum) {
          const S before = pins_[static_cast<std::size_t>(l.parent)].omega, w2 = before * before;
          vx = vx - w2 * w.rx;
          vy = vy - w2 * w.ry;
        }
        turning = turning - (w.hx * vx + w.hy * vy);
        own = turning - omega;
      }
      omega = turning;
      u[l.u] = l.sign < 0 ? -own : own;
      if (rates) {
        S turned = zero;
        if (l.parent >= 0) {
          const S Px = w.Axx * vx + w.Axy * vy + w.Dx + dot(w.Cx, sigma),
                  Py = w.Axy * vx + w.Ayy * vy + w.Dy + dot(w.Cy, sigma);
          turned = vy * Px - vx * Py;
        }
        rate[l.u] = turned;  // about the plane's normal, until the last sweep
      }
    }
    const LoopPlan::Range closed = plan_->closings_of[k];
    if (closed.first != closed.last)
      solve_loops<true>(closed, right, Planar::Motion<S>{{{vx, vy}}, omega}, sigma, impulse);
    if constexpr (Momentum) {
      w.vx = vx;
      w.vy = vy;
      w.omega = omega;
    }
    if (l.slot >= 0) outward_slots_[static_cast<std::size_t>(l.slot)] = {{vx, vy, omega}, sigma};
  }
}

template <class S, int Rows, bool Momentum>
template <class Out>
void LoopSweeps<Planar, S, Rows, Momentum>::general_outward(std::size_t k, bool rates, Out u,
                                                            Out rate, PlanarMotion<S>& m,
                                                            const Lanes<S, Rows>& sigma) {
  const auto& b = Base::body(k);
  const auto& x = joints_[static_cast<std::size_t>(tree_->links[k].record)];
  const auto& y = looped_[static_cast<std::size_t>(tree_->links[k].record)];
  Planar::Motion<S> V{{{m.vx, m.vy}}, m.omega};
  if (b.parent >= 0) V = Planar::to_child({}, b.kind, x.edge, V);
  V += y.V;
  if (b.nv == 1) {
    const S own = x.pivot * x.e - Planar::power(x.h, V) - dot(y.g, sigma);
    Joint<Planar>::add_motion(b, x.edge, &own, V);
    u[b.u] = own;
    if (rates) {
      auto P = Planar::momentum(x.M, V);
      P += x.D;
      P += Planar::Force<S>{{{dot(y.C[0], sigma), dot(y.C[1], sigma)}}, dot(y.C[2], sigma)};
      Planar::Force<S> net{};
      net -= Planar::cross_force(V, P);
      S along;
      Joint<Planar>::project(b, x.edge, net, &along);
      rate[b.u] = along;
    }
  }
  m = {V.v[0], V.v[1], V.w};
}

/// ṗ += Eᵀ T*: weights, N and leak.
template <class S, int Rows, bool Momentum>
template <class In, class Out>
void LoopSweeps<Planar, S, Rows, Momentum>::rates_inward(const In& q, const RightSide<S>& right,
                                                         const Out& u, const Out& impulse,
                                                         Out rate) {
  const PlanarLink* links = tree_->links.data();
  const Vec2<double>& g = tree_->model->gravity;
  const bool falls = tree_->model->has_gravity;
  const S zero(0.0);
  for (std::size_t k = 0; k < pins_.size(); ++k) {
    Wrench& T = wrenches_[k];
    if (falls)
      T = {S(links[k].m * g[0]), S(links[k].m * g[1]), own_x_[k] * g[1] - own_y_[k] * g[0]};
    else
      T = {zero, zero, zero};
  }
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Loop& l = loops_->loops[i];
    const Place& s = places_[i];
    if (l.is_coupler()) continue;
    S Fx = zero, Fy = zero, c = zero, Nx = zero, Ny = zero, n = zero;
    const S wa = l.a < 0 ? zero : pins_[static_cast<std::size_t>(l.a)].omega;
    const S wb = l.b < 0 ? zero : pins_[static_cast<std::size_t>(l.b)].omega;
    S ux = zero, uy = zero;
    if (l.a >= 0) {
      const LoopedPin<S, Rows>& A = pins_[static_cast<std::size_t>(l.a)];
      ux = A.vx - wa * s.ay;
      uy = A.vy + wa * s.ax;
    }
    S turning_a = wa, turning_b = wb;  // of the axes
    if (l.motion >= 0) {
      turning_a = turning_a + motion(l).turning_a;
      turning_b = turning_b + motion(l).turning_b;
    }
    for (int row = 0; row < l.rows; ++row) {
      const S x = S(impulse[l.row + row]);
      Fx = Fx + x * s.Fx[row];
      Fy = Fy + x * s.Fy[row];
      c = c + x * s.c[row];
      if (row >= l.n_points && !l.is_distance())
        n = n + x * ((turning_b - turning_a) * s.turn[row]);
    }
    if (l.is_distance()) {  // F' = (u_A − u_B) σ / l₀
      S bx = zero, by = zero;
      if (l.b >= 0) {
        const LoopedPin<S, Rows>& B = pins_[static_cast<std::size_t>(l.b)];
        bx = B.vx - wb * (s.by - s.gap_y);
        by = B.vy + wb * (s.bx - s.gap_x);
      }
      if (l.motion >= 0) {
        bx = bx + moving_point(l).v[0];
        by = by + moving_point(l).v[1];
      }
      const S scaled = (S(impulse[l.row])) * l.per_length;
      Nx = scaled * (ux - bx);
      Ny = scaled * (uy - by);
    } else {
      Nx = -(turning_b * Fy);
      Ny = turning_b * Fx;
    }
    n = n + (ux * Fy - uy * Fx) - right.leak * c;
    Nx = Nx - right.leak * Fx;
    Ny = Ny - right.leak * Fy;
    if (l.a >= 0) {
      Wrench& T = wrenches_[static_cast<std::size_t>(l.a)];
      T.fx = T.fx + Nx;
      T.fy = T.fy + Ny;
      T.fn = T.fn + (n + (s.ax * Ny - s.ay * Nx));
    }
    if (l.b >= 0) {
      Wrench& T = wrenches_[static_cast<std::size_t>(l.b)];
      T.fx = T.fx - Nx;
      T.fy = T.fy - Ny;
      T.fn = T.fn - (n + (s.bx * Ny - s.by * Nx));
    }
  }
  Wrench from{};
  for (std::size_t k = pins_.size(); k-- > 0;) {
    const PlanarLink& l = links[k];
    Wrench T = wrenches_[k];
    if (!l.tip) {
      T.fx = T.fx + from.fx;
      T.fy = T.fy + from.fy;
      T.fn = T.fn + from.fn;
    }
    if (l.pin) {
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
    const LoopedPin<S, Rows>& w = pins_[k];
    T.fn = T.fn + (w.rx * T.fy - w.ry * T.fx);
    if (l.first) {
      from = T;
    } else {
      Wrench& to = wrenches_[static_cast<std::size_t>(l.parent)];
      to.fx = to.fx + T.fx;
      to.fy = to.fy + T.fy;
      to.fn = to.fn + T.fn;
    }
  }
  if (plan_->couples() && right.leak != 0) leak_of_couplers<S>(*loops_, right.leak, impulse, rate);
}

template <class S, int Rows, bool Momentum>
template <class Report>
void LoopSweeps<Planar, S, Rows, Momentum>::each_pivot(Report&& report) const {
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Loop& l = loops_->loops[i];
    if (pairs_in_registers && plan_->pair[i]) {
      const Pair& p = pairs_[i];
      const bool swapped = value_of(p.swap) > 0.5;
      report(l.row + (swapped ? 1 : 0), value_of(p.w_a), value_of(p.tau));
      report(l.row + (swapped ? 0 : 1), value_of(p.w_b), value_of(p.tau));
    } else {
      for (int j = 0; j < l.rows; ++j) {
        const Row& row = rows_[static_cast<std::size_t>(l.row + j)];
        report(l.row + row.lane - plan_->lane[i], value_of(row.w), value_of(row.tau));
      }
    }
  }
}

}  // namespace momenta
