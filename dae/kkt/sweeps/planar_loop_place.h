#pragma once
// Places of bodies and loops in a plane at one state. Part of planar_loop_sweeps.h.

#include <momenta/dae/kkt/sweeps/planar_loop_sweeps.h>

namespace momenta {

/// Places the ends of loops; in the acceleration form also finds the velocities of all bodies.
template <class S, int Rows, bool Momentum>
template <class In>
void LoopSweeps<Planar, S, Rows, Momentum>::place_bodies(const In& x, const RightSide<S>& right) {
  const PlanarLink* links = tree_->links.data();
  const std::size_t n = revolutes_.size();
  const bool gap = asks_for_gaps(right);
  S ox(0.0), oy(0.0);
  for (std::size_t k = 0; k < n; ++k) {
    const PlanarLink& l = links[k];
    Revolute& w = revolutes_[k];
    const Vec2<S> r = way_from_parent(l);
    w.rx = r[0];
    w.ry = r[1];
    const auto parent = static_cast<std::size_t>(l.parent);
    if (l.parent < 0) {
      ox = oy = S(0.0);
    } else if (!l.first) {
      const Vec2<S>& from = origin_slots_[static_cast<std::size_t>(links[parent].slot)];
      ox = from[0];
      oy = from[1];
    }
    ox = ox + r[0];
    oy = oy + r[1];
    if (l.slot >= 0) origin_slots_[static_cast<std::size_t>(l.slot)] = {{ox, oy}};
    if (!origins_.empty()) origins_[k] = {{ox, oy}};
    place_ends(k, gap, ox, oy);
    if constexpr (!Momentum) {
      S vx(0.0), vy(0.0), omega(0.0);
      if (l.parent >= 0) {
        const Revolute& from = revolutes_[parent];
        omega = from.omega;
        vx = from.vx - omega * r[1];
        vy = from.vy + omega * r[0];
      }
      if (l.revolute) {
        omega = l.sign < 0 ? omega - x[l.u] : omega + x[l.u];
      } else {
        const auto& b = Base::body(k);
        auto& j = joints_[static_cast<std::size_t>(l.record)];
        Planar::Motion<S> V{}, product{};
        const S own = b.drive >= 0 ? j.drive_rate : b.nv == 1 ? S(x[b.u]) : S(0.0);
        Joint<Planar>::add_motion(b, j.edge, &own, V);
        omega += V.w;
        vx += V.v[0];
        vy += V.v[1];
        // Coriolis 2 ω × E u, and what a drive prescribes.
        product.v = cross(S(2.0) * omega, V.v);
        if (b.drive >= 0) Joint<Planar>::add_motion(b, j.edge, &j.drive_acceleration, product);
        looped_[static_cast<std::size_t>(l.record)].V = product;
      }
      w.vx = vx;
      w.vy = vy;
      w.omega = omega;
    } else if (!l.revolute) {
      const auto& b = Base::body(k);
      const auto& j = joints_[static_cast<std::size_t>(l.record)];
      Planar::Motion<S> V{};
      if (b.drive >= 0 && right.drives) Joint<Planar>::add_motion(b, j.edge, &j.drive_rate, V);
      looped_[static_cast<std::size_t>(l.record)].V = V;
    }
  }
}

/// place_bodies() where all joints are revolute and no tie needs D.
template <class S, int Rows, bool Momentum>
template <class In>
void LoopSweeps<Planar, S, Rows, Momentum>::place_revolutes([[maybe_unused]] const In& x,
                                                            bool velocities) {
  const PlanarLink* links = tree_->links.data();
  Revolute* records = revolutes_.data();
  const std::size_t n = revolutes_.size();
  if constexpr (!Momentum) {
    S omega(0.0);
    for (std::size_t k = 0; k < n; ++k) {
      const PlanarLink& l = links[k];
      if (l.parent < 0)
        omega = S(0.0);
      else if (!l.first)
        omega = records[l.parent].omega;
      omega = omega + l.sign * x[l.u];
      records[k].omega = omega;
    }
  }
  if (tied_ && !velocities) return;
  Vec2<S>* origins = origins_.data();
  Vec2<S> o{}, v{};
  for (std::size_t k = 0; k < n; ++k) {
    const PlanarLink& l = links[k];
    const Vec2<S> r = Base::step(l);
    if (l.parent < 0)
      o = v = {};
    else if (!l.first) {
      if (!tied_) o = origins[l.parent];
      if constexpr (!Momentum) v = {{records[l.parent].vx, records[l.parent].vy}};
    }
    if (!tied_) {
      o += r;
      origins[k] = o;
    }
    if constexpr (!Momentum) {
      Revolute& w = records[k];
      w.rx = r[0];
      w.ry = r[1];
      if (l.parent >= 0) v += cross(records[l.parent].omega, r);
      w.vx = v[0];
      w.vy = v[1];
    }
  }
}

/// Ends on body k with its joint at (x, y). A tie's D begins with the end that is placed first.
template <class S, int Rows, bool Momentum>
MOMENTA_INLINE void LoopSweeps<Planar, S, Rows, Momentum>::place_ends(std::size_t k, bool gap,
                                                                      const S& x, const S& y) {
  const LoopPlan::Range range = plan_->ends_of[k];
  for (int i = range.first; i < range.last; ++i) {
    const End& end = ends_[static_cast<std::size_t>(i)];
    if (!end.tie || !gap) continue;
    const Vec2<S> arm = turned(k, end.at);
    Vec2<S>& D = gaps_[static_cast<std::size_t>(end.loop)];
    if (end.begins) D = Vec2<S>{{S(end.D[0]), S(end.D[1])}};
    D[0] = D[0] + end.sign * (x + arm[0]);
    D[1] = D[1] + end.sign * (y + arm[1]);
  }
}

/// Places pairs of rows along axes of B.
template <class S, int Rows, bool Momentum>
void LoopSweeps<Planar, S, Rows, Momentum>::place_turning(const RightSide<S>& right) {
  const bool asked = biased(right);
  for (const Turning& l : turning_) {
    const std::size_t a = l.a, b = l.b;
    Place& s = places_[l.loop];
    const Vec2<S> arm = turned(a, l.at_a), axis = turned(b, l.axis);
    s.ax = arm[0];
    s.ay = arm[1];
    s.bx = (origins_[a][0] - origins_[b][0]) + arm[0];
    s.by = (origins_[a][1] - origins_[b][1]) + arm[1];
    s.Fx = axis[0];
    s.Fy = axis[1];
    if (!asked) continue;
    Vec2<S> d{}, rate{};
    if constexpr (!Momentum) {
      // b_j turn with B, and x_A − O_B by what A's point is faster than O_B.
      const Revolute &A = revolutes_[a], &B = revolutes_[b];
      const Vec2<S> u{{A.vx - A.omega * s.ay - B.vx, A.vy + A.omega * s.ax - B.vy}};
      rate = u - cross(B.omega, Vec2<S>{{s.bx, s.by}});
      d = cross(B.omega, u + rate) + (A.omega * A.omega) * arm;
      d = -d;
      if (right.alpha != 0) d += S(2 * right.alpha) * rate;
    }
    const double positions = Momentum ? right.positions : right.beta * right.beta;
    if (positions != 0) d += S(positions) * (Vec2<S>{{s.bx, s.by}} - turned(b, l.at_b));
    s.dx = s.Fx * d[0] + s.Fy * d[1];
    s.dy = s.Fx * d[1] - s.Fy * d[0];
  }
}

template <class S, int Rows, bool Momentum>
Vec2<S> LoopSweeps<Planar, S, Rows, Momentum>::in_ground(int body, const Vec2<double>& v) const {
  if (body < 0) return Vec2<S>{{S(v[0]), S(v[1])}};
  return turned(static_cast<std::size_t>(body), v);
}

/// Places loops that need both their bodies' places at once.
template <class S, int Rows, bool Momentum>
void LoopSweeps<Planar, S, Rows, Momentum>::place_other_loops(const RightSide<S>& right) {
  const auto origin = [&](int body) {
    return body < 0 ? Vec2<S>{} : origins_[static_cast<std::size_t>(body)];
  };
  for (const int i : others_) {
    const auto loop = static_cast<std::size_t>(i);
    const Loop& l = loops_->loops[loop];
    if (l.is_coupler()) continue;
    if (l.motion >= 0) place_moving(l);
    const Vec2<S> arm = in_ground(l.a, l.at_a), from_b = origin(l.a) - origin(l.b) + arm;
    Place& s = places_[loop];
    s = {arm[0], arm[1], from_b[0], from_b[1], S(0.0), S(0.0), S(0.0), S(0.0)};
    if (plan_->pair[loop]) {
      const Vec2<S> b = in_ground(l.b, l.axis_b[0]);
      s.Fx = b[0];
      s.Fy = b[1];
      if (biased(right)) {
        s.dx = row_bias(loop, 0, right);
        s.dy = row_bias(loop, 1, right);
      }
    } else {
      place_rows(l, loop);
    }
  }
}

template <class S, int Rows, bool Momentum>
void LoopSweeps<Planar, S, Rows, Momentum>::place_rows(const Loop& l, std::size_t loop) {
  const S zero(0.0);
  RowPlace* rows = &row_at_[static_cast<std::size_t>(l.row)];
  if (l.is_distance()) {
    const Vec2<S> F = S(l.per_length) * gap_of(l, places_[loop]);
    rows[0] = {F[0], F[1], zero, zero};
    return;
  }
  for (int j = 0; j < l.n_points; ++j) {
    const Vec2<S> b =
        in_ground(l.b, l.axis_b[static_cast<std::size_t>(l.points[static_cast<std::size_t>(j)])]);
    rows[j] = {b[0], b[1], zero, zero};
  }
  for (int j = 0; j < l.n_axes; ++j) {
    const auto [x, y] = l.axes[static_cast<std::size_t>(j)];
    const Vec2<S> a = in_ground(l.a, l.axis_a[static_cast<std::size_t>(x)]),
                  b = in_ground(l.b, l.axis_b[static_cast<std::size_t>(y)]);
    rows[l.n_points + j] = {zero, zero, cross(a, b), dot(a, b)};
  }
}

/// Springs and wrenches at points of bodies; needs all velocities.
template <class S, int Rows, bool Momentum>
void LoopSweeps<Planar, S, Rows, Momentum>::gather_forces() {
  forces_->gather([&](std::size_t k) -> typename PlanarBodyForces<S>::Known {
    const Revolute& w = revolutes_[k];
    return {angles_.cosine(k), angles_.sine(k), w.rx, w.ry, w.vx, w.vy, w.omega};
  });
}

/// Prescribed motion of x_B in ground axes.
template <class S, int Rows, bool Momentum>
void LoopSweeps<Planar, S, Rows, Momentum>::place_moving(const Loop& l) {
  const Motion& m = motion(l);
  moving_[static_cast<std::size_t>(l.motion)] = {in_ground(l.b, m.v), in_ground(l.b, m.a)};
}

/// d of couplers: −ċ, Φ, or in the acceleration form −c̈ and the feedback.
template <class S, int Rows, bool Momentum>
template <class In>
void LoopSweeps<Planar, S, Rows, Momentum>::place_couplers(const In& q, const In& x,
                                                           const RightSide<S>& right) {
  for (std::size_t i = 0; i < places_.size(); ++i)
    if (const Loop& l = loops_->loops[i]; l.is_coupler()) {
      coupled_[i] = coupler_bias<Momentum>(*loops_, l, q, x, right);
      if constexpr (has_directions<S>)
        if (besides_) coupled_[i] = coupled_[i] + besides_[l.row];
    }
}

}  // namespace momenta
