#pragma once
// Rows of loops in a plane: their right-hand sides, and how their ends enter a front. Part of
// planar_loop_sweeps.h.

#include <momenta/dae/kkt/sweeps/planar_loop_sweeps.h>

namespace momenta {

template <class S, int Rows, bool Momentum>
typename LoopSweeps<Planar, S, Rows, Momentum>::RowPlace
LoopSweeps<Planar, S, Rows, Momentum>::row_place(std::size_t loop, int row) const {
  const S zero(0.0), one(1.0);
  if (loops_->loops[loop].is_tie)
    return row == 0 ? RowPlace{one, zero, zero, zero} : RowPlace{zero, one, zero, zero};
  if (!plan_->pair[loop]) return row_at_[static_cast<std::size_t>(loops_->loops[loop].row + row)];
  const Place& s = places_[loop];
  return row == 0 ? RowPlace{s.Fx, s.Fy, zero, zero} : RowPlace{-s.Fy, s.Fx, zero, zero};
}

/// Φ_t of a row.
template <class S, int Rows, bool Momentum>
S LoopSweeps<Planar, S, Rows, Momentum>::moving_rate(const Loop& l, const Place& s,
                                                     const RowPlace& r, int row) const {
  const Motion& m = motion(l);
  const Vec2<S>& v = moving_point(l).v;
  const S along = r.Fx * v[0] + r.Fy * v[1];
  if (l.is_distance()) return S(-(l.given * m.given_rate * l.per_length)) - along;
  if (row >= l.n_points) return (m.turning_a - m.turning_b) * r.c;
  const Vec2<S> gap = gap_of(l, s);
  return m.turning_b * (r.Fx * gap[1] - r.Fy * gap[0]) - along;
}

/// J̇ V + d/dt Φ_t and the feedback, from the total velocities of points and axes.
template <class S, int Rows, bool Momentum>
S LoopSweeps<Planar, S, Rows, Momentum>::moving_bias(const Loop& l, const Place& s,
                                                     const RowPlace& r, int row,
                                                     const RightSide<S>& right,
                                                     const S& phi) const {
  const Motion& m = motion(l);
  const MovingPoint& prescribed = moving_point(l);
  const Vec2<S> gap = gap_of(l, s);
  S aw(0.0), bw(0.0);
  Vec2<S> u{}, accelerated{};  // rates of x_A − x_B, the bodies' own accelerations left out
  if (l.a >= 0) {
    const Revolute& A = revolutes_[static_cast<std::size_t>(l.a)];
    aw = A.omega;
    u = {{A.vx - aw * s.ay, A.vy + aw * s.ax}};
    accelerated = {{-(aw * aw * s.ax), -(aw * aw * s.ay)}};
  }
  if (l.b >= 0) {
    const Revolute& B = revolutes_[static_cast<std::size_t>(l.b)];
    bw = B.omega;
    const Vec2<S> arm{{s.bx - gap[0], s.by - gap[1]}};
    u -= Vec2<S>{{B.vx - bw * arm[1], B.vy + bw * arm[0]}};
    accelerated += (bw * bw) * arm - S(2.0) * cross(bw, prescribed.v);
  }
  u -= prescribed.v;
  accelerated -= prescribed.a;
  const S wa = aw + S(m.turning_a), wb = bw + S(m.turning_b);
  S bias, rate;
  if (l.is_distance()) {
    const S given(l.given * m.given_rate * l.per_length);
    rate = r.Fx * u[0] + r.Fy * u[1] - given;
    bias = dot(u, u) * l.per_length + (r.Fx * accelerated[0] + r.Fy * accelerated[1]) -
           S((m.given_rate * m.given_rate + l.given * m.given_second) * l.per_length);
  } else if (row < l.n_points) {
    const S across = r.Fx * gap[1] - r.Fy * gap[0], along = r.Fx * gap[0] + r.Fy * gap[1];
    rate = r.Fx * u[0] + r.Fy * u[1] + wb * across;
    bias = r.Fx * accelerated[0] + r.Fy * accelerated[1] +
           2.0 * (wb * (r.Fx * u[1] - r.Fy * u[0])) + m.turning_b_rate * across - wb * wb * along;
  } else {
    rate = r.c * (wa - wb);
    bias = (wb - wa) * (wa - wb) * r.turn + (m.turning_a_rate - m.turning_b_rate) * r.c;
  }
  return bias + (2 * right.alpha) * rate + (right.beta * right.beta) * phi;
}

/// Whether an end adds to d: both ends of a tie have their share of J̇ V.
template <class S, int Rows, bool Momentum>
MOMENTA_INLINE bool LoopSweeps<Planar, S, Rows, Momentum>::asks(const End& end,
                                                                const RightSide<S>& right) const {
  if (end.tie) return Momentum ? end.first && right.positions != 0 : true;
  if (!end.first) return false;
  return biased(right);
}

/// Share of one end on body k in d of both rows of a tie: βΦ; in the acceleration form its own J̇ V
/// = ∓ω² a, and of the feedback 2α times its point's velocity.
template <class S, int Rows, bool Momentum>
MOMENTA_INLINE Vec2<S> LoopSweeps<Planar, S, Rows, Momentum>::tie_bias(
    std::size_t k, const End& end, const Vec2<S>& arm, const RightSide<S>& right) const {
  const Vec2<S>& D = gaps_[static_cast<std::size_t>(end.loop)];
  if constexpr (Momentum) {
    return S(right.positions) * D;
  } else {
    const Revolute& w = revolutes_[k];
    const S centripetal = -end.sign * (w.omega * w.omega);
    Vec2<S> bias{{centripetal * arm[0], centripetal * arm[1]}};
    if (right.alpha != 0) {
      const double damping = 2 * right.alpha * end.sign;
      bias += S(damping) * Vec2<S>{{w.vx - w.omega * arm[1], w.vy + w.omega * arm[0]}};
    }
    if (right.beta != 0 && end.first) bias += S(right.beta * right.beta) * D;
    return bias;
  }
}

/// d of a row that is no tie's, before the joints' shares: βΦ + Φ_t, or in the acceleration form J̇
/// V and the feedback.
template <class S, int Rows, bool Momentum>
S LoopSweeps<Planar, S, Rows, Momentum>::row_bias(std::size_t loop, int row,
                                                  const RightSide<S>& right) const {
  const Loop& l = loops_->loops[loop];
  const Place& s = places_[loop];
  const RowPlace r = row_place(loop, row);
  S phi(0.0);
  if (right.positions != 0 || right.beta != 0) {
    const Vec2<S> gap = gap_of(l, s);
    if (l.is_distance())
      phi = (dot(gap, gap) + (l.across2 - l.given * l.given)) * (0.5 * l.per_length);
    else
      phi = row < l.n_points ? r.Fx * gap[0] + r.Fy * gap[1] : r.turn;
  }
  if constexpr (Momentum) {
    const S given = right.positions * phi;
    return l.motion >= 0 && right.drives ? given + moving_rate(l, s, r, row) : given;
  } else {
    if (l.motion >= 0) return moving_bias(l, s, r, row, right, phi);
    const S zero(0.0);
    const auto velocity = [&](int body, S& vx, S& vy, S& omega) {
      vx = vy = omega = zero;
      if (body < 0) return;
      const Revolute& w = revolutes_[static_cast<std::size_t>(body)];
      vx = w.vx;
      vy = w.vy;
      omega = w.omega;
    };
    S avx, avy, aw, bvx, bvy, bw;
    velocity(l.a, avx, avy, aw);
    velocity(l.b, bvx, bvy, bw);
    // Velocity of x_A on A, and of the point of B that is there.
    const S ux = avx - aw * s.ay, uy = avy + aw * s.ax, wx = bvx - bw * s.by, wy = bvy + bw * s.bx;
    S bias;
    if (l.is_distance()) {
      // d/dt (D/l)·(u_A − u_B), u_B at the marker of B: there the arm is x_B − O_B.
      const Vec2<S> gap = gap_of(l, s);
      const S sx = s.bx - gap[0], sy = s.by - gap[1];
      const S rx = ux - (bvx - bw * sy), ry = uy - (bvy + bw * sx);
      bias = (rx * rx + ry * ry) * l.per_length +
             (r.Fx * (bw * bw * sx - aw * aw * s.ax) + r.Fy * (bw * bw * sy - aw * aw * s.ay));
    } else if (row < l.n_points) {
      const S turning_x = -(bw * r.Fy), turning_y = bw * r.Fx;      // ω_b × b
      const S lag_x = -(bw * (uy - bvy)), lag_y = bw * (ux - bvx);  // ω_b × d/dt (x_A − O_B)
      bias = turning_x * (ux - wx) + turning_y * (uy - wy) -
             (r.Fx * (aw * aw * s.ax + lag_x) + r.Fy * (aw * aw * s.ay + lag_y));
    } else {
      bias = (bw - aw) * (aw - bw) * r.turn;
    }
    if (right.alpha != 0 || right.beta != 0) {
      const S rate = r.Fx * (ux - wx) + r.Fy * (uy - wy) + r.c * (aw - bw);
      bias = bias + (2 * right.alpha) * rate + (right.beta * right.beta) * phi;
    }
    return bias;
  }
}

/// Enters the loop ends on body k.
template <class S, int Rows, bool Momentum>
MOMENTA_INLINE void LoopSweeps<Planar, S, Rows, Momentum>::enter(std::size_t k,
                                                                 const LoopPlan::Range& range,
                                                                 const RightSide<S>& right,
                                                                 PlanarArticulated<S>& a,
                                                                 Blocks& o) {
  for (int n = range.first; n < range.last; ++n) {
    const auto i = static_cast<std::size_t>(n);
    if constexpr (pairs_in_registers)
      if (ends_[i].pair) [[likely]] {
        enter_pair(k, i, right, a, o);
        continue;
      }
    Open copy{a, o};
    enter_rows(k, i, right, copy);
    a = copy.articulated;
    o = copy.blocks;
  }
}

/// Inlined: a call would make whatever stays in registers leave them.
template <class S, int Rows, bool Momentum>
MOMENTA_INLINE void LoopSweeps<Planar, S, Rows, Momentum>::enter_pair(std::size_t k, std::size_t i,
                                                                      const RightSide<S>& right,
                                                                      PlanarArticulated<S>& a,
                                                                      Blocks& o) {
  const End& end = ends_[i];
  const S sign(end.sign);
  if (end.tie) {
    const Vec2<S> arm = turned(k, end.at);
    arms_[i] = arm;
    const S nx = sign * arm[0], ny = sign * arm[1];
    o.C[0].add_at(end.slot, sign);
    o.C[1].add_at(end.slot + 1, sign);
    o.C[2].add_pair(end.slot, -ny, nx);
    if (right.centre) {
      const S *centre = right.centre + end.row, x = centre[0], y = centre[1];
      a.Dx = a.Dx + sign * x;
      a.Dy = a.Dy + sign * y;
      a.Dn = a.Dn + (nx * y - ny * x);
    }
    if constexpr (has_directions<S>)
      if (besides_ && end.first) o.d.add_pair(end.slot, besides_[end.row], besides_[end.row + 1]);
    if (!asks(end, right)) return;
    const Vec2<S> d = tie_bias(k, end, arm, right);
    o.d.add_pair(end.slot, d[0], d[1]);
    return;
  }
  // (fx, fy) and (−fy, fx) with their couples.
  const Place& s = places_[static_cast<std::size_t>(end.loop)];
  const S ax = end.on_a ? s.ax : s.bx, ay = end.on_a ? s.ay : s.by;
  const S fx = sign * s.Fx, fy = sign * s.Fy;
  const S n0 = ax * fy - ay * fx, n1 = ax * fx + ay * fy;
  o.C[0].add_pair(end.slot, fx, -fy);
  o.C[1].add_pair(end.slot, fy, fx);
  o.C[2].add_pair(end.slot, n0, n1);
  if (right.centre) {
    const S *centre = right.centre + end.row, x = centre[0], y = centre[1];
    a.Dx = a.Dx + (x * fx - y * fy);
    a.Dy = a.Dy + (x * fy + y * fx);
    a.Dn = a.Dn + (x * n0 + y * n1);
  }
  if constexpr (has_directions<S>)
    if (besides_ && end.first) o.d.add_pair(end.slot, besides_[end.row], besides_[end.row + 1]);
  if (end.first && biased(right)) o.d.add_pair(end.slot, s.dx, s.dy);
}

template <class S, int Rows, bool Momentum>
void LoopSweeps<Planar, S, Rows, Momentum>::enter_rows(std::size_t k, std::size_t i,
                                                       const RightSide<S>& right, Open& open) {
  const End& end = ends_[i];
  const auto loop = static_cast<std::size_t>(end.loop);
  const Loop& l = loops_->loops[loop];
  const bool asked = asks(end, right);
  Vec2<S> arm, d;
  if (end.tie) {
    arms_[i] = arm = turned(k, end.at);
    if (asked) d = tie_bias(k, end, arm, right);
  } else {
    const Place& s = places_[loop];
    arm = end.on_a ? Vec2<S>{{s.ax, s.ay}} : Vec2<S>{{s.bx, s.by}};
  }
  const int slot = end.slot;
  const S sign(end.sign);
  PlanarArticulated<S>& a = open.articulated;
  Blocks& o = open.blocks;
  for (int row = 0; row < l.rows; ++row) {
    const RowPlace r = row_place(loop, row);
    const S fx = sign * r.Fx, fy = sign * r.Fy, n = arm[0] * fy - arm[1] * fx + sign * r.c;
    o.C[0].add(slot + row, fx);
    o.C[1].add(slot + row, fy);
    o.C[2].add(slot + row, n);
    if (right.centre) {
      const S centre = right.centre[l.row + row];
      a.Dx = a.Dx + centre * fx;
      a.Dy = a.Dy + centre * fy;
      a.Dn = a.Dn + centre * n;
    }
    if constexpr (has_directions<S>)
      if (besides_ && end.first) o.d.add(slot + row, besides_[l.row + row]);
    if (asked) o.d.add(slot + row, end.tie ? d[row] : row_bias(loop, row, right));
  }
}

}  // namespace momenta
