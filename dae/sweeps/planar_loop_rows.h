#pragma once
// Loops in a plane at one state: where they stand, what their rows are, how their ends enter a
// front. Part of planar_loop_sweeps.h.

#include <momenta/dae/sweeps/planar_loop_sweeps.h>

namespace momenta {

/// Points, axes and rows of all loops.
template <class S, int Rows, bool Momentum>
void LoopSweeps<Planar, S, Rows, Momentum>::place_loops() {
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Loop& l = loops_->loops[i];
    Place& s = places_[i];
    if (l.is_coupler()) continue;
    if (l.motion >= 0) place_moving(l);
    const auto in_ground = [&](int body, const Vec2<double>& v) {
      if (body < 0) return Vec2<S>{{S(v[0]), S(v[1])}};
      const auto k = static_cast<std::size_t>(body);
      const S c = angles_.cosine(k), e = angles_.sine(k);
      return Vec2<S>{{c * v[0] - e * v[1], e * v[0] + c * v[1]}};
    };
    const auto origin = [&](int body) {
      if (body < 0) return Vec2<S>{};
      const auto k = static_cast<std::size_t>(body);
      return Vec2<S>{{origin_x_[k], origin_y_[k]}};
    };
    const Vec2<S> arm_a = in_ground(l.a, l.at_a), arm_b = in_ground(l.b, l.at_b);
    const Vec2<S> between = origin(l.a) - origin(l.b);
    const Vec2<S> from_b = between + arm_a, gap = from_b - arm_b;
    s.ax = arm_a[0];
    s.ay = arm_a[1];
    s.bx = from_b[0];
    s.by = from_b[1];
    s.gap_x = gap[0];
    s.gap_y = gap[1];
    if (plan_->pair[i]) {  // the second axis stands across the first
      const Vec2<S> b = in_ground(l.b, l.axis_b[0]);
      s.Fx[0] = b[0];
      s.Fy[0] = b[1];
      s.Fx[1] = -b[1];
      s.Fy[1] = b[0];
      s.c[0] = s.c[1] = S(0.0);
      continue;
    }
    if (l.is_distance()) {
      const S inverse(l.per_length);
      s.Fx[0] = inverse * gap[0];
      s.Fy[0] = inverse * gap[1];
      s.c[0] = S(0.0);
      continue;
    }
    for (int j = 0; j < l.n_points; ++j) {
      const Vec2<S> b =
          in_ground(l.b, l.axis_b[static_cast<std::size_t>(l.points[static_cast<std::size_t>(j)])]);
      s.Fx[j] = b[0];
      s.Fy[j] = b[1];
      s.c[j] = S(0.0);
    }
    for (int j = 0; j < l.n_axes; ++j) {
      const auto [x, y] = l.axes[static_cast<std::size_t>(j)];
      const Vec2<S> a = in_ground(l.a, l.axis_a[static_cast<std::size_t>(x)]),
                    b = in_ground(l.b, l.axis_b[static_cast<std::size_t>(y)]);
      s.Fx[l.n_points + j] = s.Fy[l.n_points + j] = S(0.0);
      s.c[l.n_points + j] = cross(a, b);
      s.turn[l.n_points + j] = dot(a, b);
    }
  }
}

/// Prescribed motion of x_B in ground axes.
template <class S, int Rows, bool Momentum>
void LoopSweeps<Planar, S, Rows, Momentum>::place_moving(const Loop& l) {
  MovingPoint& to = moving_[static_cast<std::size_t>(l.motion)];
  const Motion& m = motion(l);
  const auto in_ground = [&](const Vec2<double>& v) {
    if (l.b < 0) return Vec2<S>{{S(v[0]), S(v[1])}};
    const auto k = static_cast<std::size_t>(l.b);
    const S c = angles_.cosine(k), e = angles_.sine(k);
    return Vec2<S>{{c * v[0] - e * v[1], e * v[0] + c * v[1]}};
  };
  to = {in_ground(m.v), in_ground(m.a)};
}

/// d of couplers: −ċ, Φ, or in the acceleration form −c̈ and the feedback.
template <class S, int Rows, bool Momentum>
template <class In>
void LoopSweeps<Planar, S, Rows, Momentum>::place_couplers(const In& q, const In& x,
                                                           const RightSide<S>& right) {
  for (std::size_t i = 0; i < places_.size(); ++i)
    if (const Loop& l = loops_->loops[i]; l.is_coupler())
      coupled_[i] = coupler_bias<Momentum>(*loops_, l, q, x, right);
}

/// Φ_t of a row.
template <class S, int Rows, bool Momentum>
S LoopSweeps<Planar, S, Rows, Momentum>::moving_rate(const Loop& l, const Place& s, int row) const {
  const Motion& m = motion(l);
  const Vec2<S>& v = moving_point(l).v;
  const S along = s.Fx[row] * v[0] + s.Fy[row] * v[1];
  if (l.is_distance()) return S(-(l.given * m.given_rate * l.per_length)) - along;
  if (row >= l.n_points) return (m.turning_a - m.turning_b) * s.c[row];
  return m.turning_b * (s.Fx[row] * s.gap_y - s.Fy[row] * s.gap_x) - along;
}

/// J̇ V + d/dt Φ_t and the feedback, from the total velocities of points and axes.
template <class S, int Rows, bool Momentum>
S LoopSweeps<Planar, S, Rows, Momentum>::moving_bias(const Loop& l, const Place& s, int row,
                                                     const RightSide<S>& right,
                                                     const S& phi) const {
  const Motion& m = motion(l);
  const MovingPoint& prescribed = moving_point(l);
  const S Fx = s.Fx[row], Fy = s.Fy[row];
  S aw(0.0), bw(0.0);
  Vec2<S> u{}, accelerated{};  // of x_A − x_B, the bodies' own accelerations left out
  if (l.a >= 0) {
    const LoopedPin<S, Rows>& A = pins_[static_cast<std::size_t>(l.a)];
    aw = A.omega;
    u = {{A.vx - aw * s.ay, A.vy + aw * s.ax}};
    accelerated = {{-(aw * aw * s.ax), -(aw * aw * s.ay)}};
  }
  if (l.b >= 0) {
    const LoopedPin<S, Rows>& B = pins_[static_cast<std::size_t>(l.b)];
    bw = B.omega;
    const Vec2<S> arm{{s.bx - s.gap_x, s.by - s.gap_y}};
    u -= Vec2<S>{{B.vx - bw * arm[1], B.vy + bw * arm[0]}};
    accelerated += (bw * bw) * arm - S(2.0) * cross(bw, prescribed.v);
  }
  u -= prescribed.v;
  accelerated -= prescribed.a;
  const S wa = aw + S(m.turning_a), wb = bw + S(m.turning_b);
  S bias, rate;
  if (l.is_distance()) {
    const S given(l.given * m.given_rate * l.per_length);
    rate = Fx * u[0] + Fy * u[1] - given;
    bias = dot(u, u) * l.per_length + (Fx * accelerated[0] + Fy * accelerated[1]) -
           S((m.given_rate * m.given_rate + l.given * m.given_second) * l.per_length);
  } else if (row < l.n_points) {
    const S across = Fx * s.gap_y - Fy * s.gap_x, along = Fx * s.gap_x + Fy * s.gap_y;
    rate = Fx * u[0] + Fy * u[1] + wb * across;
    bias = Fx * accelerated[0] + Fy * accelerated[1] + 2.0 * (wb * (Fx * u[1] - Fy * u[0])) +
           m.turning_b_rate * across - wb * wb * along;
  } else {
    rate = s.c[row] * (wa - wb);
    bias = (wb - wa) * (wa - wb) * s.turn[row] + (m.turning_a_rate - m.turning_b_rate) * s.c[row];
  }
  return bias + (2 * right.alpha) * rate + (right.beta * right.beta) * phi;
}

/// d of a row before the joints' shares: βΦ + Φ_t, or in the acceleration form J̇ V and the
/// feedback.
template <class S, int Rows, bool Momentum>
S LoopSweeps<Planar, S, Rows, Momentum>::row_bias(const Loop& l, const Place& s, int row,
                                                  const RightSide<S>& right) const {
  const S Fx = s.Fx[row], Fy = s.Fy[row], c = s.c[row];
  S phi(0.0);
  if (right.positions != 0 || right.beta != 0) {
    if (l.is_distance())
      phi = (s.gap_x * s.gap_x + s.gap_y * s.gap_y + (l.across2 - l.given * l.given)) *
            (0.5 * l.per_length);
    else
      phi = row < l.n_points ? Fx * s.gap_x + Fy * s.gap_y : s.turn[row];
  }
  if constexpr (Momentum) {
    const S given = right.positions * phi;
    return l.motion >= 0 && right.drives ? given + moving_rate(l, s, row) : given;
  } else {
    if (l.motion >= 0) return moving_bias(l, s, row, right, phi);
    const S zero(0.0);
    const auto velocity = [&](int body, S& vx, S& vy, S& omega) {
      vx = vy = omega = zero;
      if (body < 0) return;
      const LoopedPin<S, Rows>& w = pins_[static_cast<std::size_t>(body)];
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
      const S sx = s.bx - s.gap_x, sy = s.by - s.gap_y;
      const S rx = ux - (bvx - bw * sy), ry = uy - (bvy + bw * sx);
      bias = (rx * rx + ry * ry) * l.per_length +
             (Fx * (bw * bw * sx - aw * aw * s.ax) + Fy * (bw * bw * sy - aw * aw * s.ay));
    } else if (row < l.n_points) {
      const S turning_x = -(bw * Fy), turning_y = bw * Fx;          // ω_b × b
      const S lag_x = -(bw * (uy - bvy)), lag_y = bw * (ux - bvx);  // ω_b × d/dt (x_A − O_B)
      bias = turning_x * (ux - wx) + turning_y * (uy - wy) -
             (Fx * (aw * aw * s.ax + lag_x) + Fy * (aw * aw * s.ay + lag_y));
    } else {
      bias = (bw - aw) * (aw - bw) * s.turn[row];
    }
    if (right.alpha != 0 || right.beta != 0) {
      const S rate = Fx * (ux - wx) + Fy * (uy - wy) + c * (aw - bw);
      bias = bias + (2 * right.alpha) * rate + (right.beta * right.beta) * phi;
    }
    return bias;
  }
}

/// The loop ends on body k.
template <class S, int Rows, bool Momentum>
void LoopSweeps<Planar, S, Rows, Momentum>::enter(std::size_t k, const RightSide<S>& right,
                                                  PlanarCargo<S>& a, Blocks& o) {
  const LoopPlan::Range range = plan_->ends_of[k];
  for (int i = range.first; i < range.last; ++i) {
    const LoopPlan::End& end = plan_->ends[static_cast<std::size_t>(i)];
    const auto loop = static_cast<std::size_t>(end.loop);
    const Loop& l = loops_->loops[loop];
    const Place& s = places_[loop];
    const int lane = plan_->lane[loop];
    const bool asks =
        end.first && (!Momentum || right.positions != 0 || (l.motion >= 0 && right.drives));
    const S sign(end.on_a ? 1.0 : -1.0);
    const S rx = sign * (end.on_a ? s.ax : s.bx), ry = sign * (end.on_a ? s.ay : s.by);
    if (plan_->pair[loop]) {
      const S Fx = s.Fx[0], Fy = s.Fy[0], fx = sign * Fx, fy = sign * Fy;
      const S n0 = rx * Fy - ry * Fx, n1 = rx * Fx + ry * Fy;
      o.C[0].add_pair(lane, fx, -fy);
      o.C[1].add_pair(lane, fy, fx);
      o.C[2].add_pair(lane, n0, n1);
      if (right.centre) {
        const S first = right.centre[l.row], second = right.centre[l.row + 1];
        a.Dx = a.Dx + (first * fx - second * fy);
        a.Dy = a.Dy + (first * fy + second * fx);
        a.Dn = a.Dn + (first * n0 + second * n1);
      }
      if (asks) o.d.add_pair(lane, row_bias(l, s, 0, right), row_bias(l, s, 1, right));
      continue;
    }
    for (int row = 0; row < l.rows; ++row) {
      const S Fx = s.Fx[row], Fy = s.Fy[row];
      const S fx = sign * Fx, fy = sign * Fy, n = rx * Fy - ry * Fx + sign * s.c[row];
      o.C[0].add(lane + row, fx);
      o.C[1].add(lane + row, fy);
      o.C[2].add(lane + row, n);
      if (right.centre) {
        const S centre = right.centre[l.row + row];
        a.Dx = a.Dx + centre * fx;
        a.Dy = a.Dy + centre * fy;
        a.Dn = a.Dn + centre * n;
      }
      if (asks) o.d.add(lane + row, row_bias(l, s, row, right));
    }
  }
}

}  // namespace momenta
