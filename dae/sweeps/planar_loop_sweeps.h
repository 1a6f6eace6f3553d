#pragma once
// Closed loops in a plane inside the two sweeps: (q, p, t) → (u, σ, ṗ), eqs. (7)-(8), and the
// acceleration form (3) on the same code. No M, Φ_q or Φ_q M⁻¹ Φ_qᵀ is assembled.
//
//   inward    loop ends enter: C = Jᵀ, D = Jᵀ centre, d = what the right-hand side asks of them
//             loops whose lowest common ancestor this is close                       (front.h)
//             M_j⁻¹ = 1/I, h = H/I, c = EᵀC, g = c M_j⁻¹, e = r − EᵀD
//             M' = M* − h (M*E)ᵀ, D' = D + h e, C' = C − h c,  W' = W + c gᵀ, d' = d + g e
//             to the parent as (43), (44); C like a force; d' += C'ᵀ Ω_t
//   outward   V = 𝒯ⱽ Ω_L + Ω_t, u = M_j⁻¹ e − hᵀ V − g σ, Ω = V + E u; then the impulses of the loops
//             closed here
//   inward    T: weights and, at each end of a loop, N − κ w                          (8)
//
// Momentum form: r = p, ṗ = Eᵀ(T* − Ω × P*), P* = M'V + D' + C'σ. N = (d/dt Jᵀ)σ + Ω × w is the
// inertial rate of an impulse: for a row with force F at x_A and couple c on body A (loop_rows.h),
// force F' at x_A, couple c' + u_A × F; on B the exact negative. Acceleration form: r = joint force
// and D = −ω² m c; a joint's velocity product takes the place of Ω_t, J̇ V of d.
//
// A row's D_j has F = b_j, O_ij has c = a_i × b_j, a distance has F = D/l.

#include <momenta/core/kernel/planar_sweeps.h>
#include <momenta/dae/loop/loop_model.h>
#include <momenta/dae/sweeps/front.h>
#include <momenta/dae/sweeps/loop_plan.h>
#include <momenta/dae/sweeps/right_side.h>

namespace momenta {

/// What bodies have for the way out and the last sweep.
template <class S, int Rows>
struct LoopedPin {
  Lanes<S, Rows> Cx, Cy, g;
  S rx, ry;                               ///< O_K − O_L
  S Axx, Axy, Ayy, Dx, Dy, hx, hy, y0;    ///< M', D', h, M_j⁻¹ e
  S vx, vy, omega;                        ///< Ω (momentum form); prescribed ones (acceleration)
};
template <class S, int Rows>
struct LoopedJoint {
  Lanes<S, Rows> C[3], g;
  Planar::Motion<S> V;  ///< Ω_t, or the velocity product and prescribed acceleration of the joint
};

template <class Space, class S, int Rows, bool Momentum>
class LoopSweeps;

template <class S, int Rows, bool Momentum>
class LoopSweeps<Planar, S, Rows, Momentum> : PlanarPlaces<S> {
  using Base = PlanarPlaces<S>;
  using Base::angles_, Base::joints_, Base::stuck_, Base::tree_;
  using Blocks = Front<S, Rows, 3>;
  using Row = ClosedRow<S, Rows, 3>;
  using Pair = ClosedPair<S, Rows, 3>;

 public:
  LoopSweeps(const PlanarTree& tree, const LoopModel<Planar>& loops, const LoopPlan& plan);

  /// Momentum form: u (nv) and σ (m) of (7) from p; with `rate` ṗ (nv) of (8), forces between points
  /// of bodies left out. Acceleration form: u̇, λ from u and joint forces `tau` (nv).
  /// False when a joint's inertia is not positive: stuck(). O(bodies + m).
  template <class In, class Out>
  bool operator()(const S& t, const In& q, const In& x, const In& tau, const RightSide<S>& right,
                  Out u, Out sigma, Out rate);

  using Base::stuck;
  static bool weak_leg() { return false; }  ///< no leg is folded in a plane
  /// Rows that faded in the last solution, as rows of Φ; calls row(index).
  template <class Report>
  void each_faded(Report&& row) const;

 private:
  /// Where a loop stands: the points it ties, seen from both bodies, and its rows.
  struct Place {
    S ax, ay, bx, by;     ///< x_A − O_A and x_A − O_B
    S gap_x, gap_y;       ///< D = x_A − x_B
    S Fx[3], Fy[3], c[3];
    S turn[3];            ///< a_i · b_j of an axis row
  };
  struct Open {
    PlanarCargo<S> cargo;
    Blocks blocks;
  };
  using Loop = LoopModel<Planar>::Loop;

  template <class In>
  void place_bodies(const In& x, const RightSide<S>& right);
  void place_loops();
  S row_bias(const Loop& l, const Place& s, int row, const RightSide<S>& right) const;
  template <class In>
  bool inward(const In& r, const RightSide<S>& right);
  MOMENTA_INLINE void enter(std::size_t k, const RightSide<S>& right, PlanarCargo<S>& a, Blocks& o);
  template <bool Moves>
  MOMENTA_INLINE void close(const LoopPlan::Range& range, PlanarCargo<S>& a, Blocks& o,
                            double fade);
  __attribute__((noinline)) void close_any(int loop, Open& open, double fade);
  template <class In>
  __attribute__((noinline)) bool general_inward(std::size_t k, const In& r, Open& open);
  template <class Out>
  void outward(const RightSide<S>& right, Out u, Out impulse, Out rate);
  template <bool Moves, class Out>
  MOMENTA_INLINE void solve_loops(const LoopPlan::Range& range, const RightSide<S>& right,
                                  const Planar::Motion<S>& motion, Lanes<S, Rows>& sigma, Out& out);
  template <class Out>
  __attribute__((noinline)) void general_outward(std::size_t k, bool rates, Out u, Out rate,
                                                 PlanarMotion<S>& m, const Lanes<S, Rows>& sigma);
  template <class In, class Out>
  void rates_inward(const In& q, const RightSide<S>& right, const Out& u, const Out& impulse,
                    Out rate);


  const LoopModel<Planar>* loops_;  ///< points and axes in the frames of the links
  const LoopPlan* plan_;
  std::vector<LoopedPin<S, Rows>> pins_;
  std::vector<LoopedJoint<S, Rows>> looped_;
  std::vector<Place> places_;
  std::vector<S> origin_x_, origin_y_, own_x_, own_y_;  ///< O_K; own first moments
  std::vector<Open> slots_;
  struct Outward {
    PlanarMotion<S> motion;
    Lanes<S, Rows> sigma;
  };
  std::vector<Outward> outward_slots_;
  struct Wrench {
    S fx, fy, fn;
  };
  std::vector<Wrench> wrenches_;  ///< T, N and leak
  std::vector<Row> rows_;            ///< by row of Φ, in closing order within a loop
  std::vector<Pair> pairs_;          ///< by loop
};

template <class S, int Rows, bool Momentum>
LoopSweeps<Planar, S, Rows, Momentum>::LoopSweeps(const PlanarTree& tree,
                                                  const LoopModel<Planar>& loops,
                                                  const LoopPlan& plan)
    : Base(tree),
      loops_(&loops),
      plan_(&plan),
      pins_(tree.links.size()),
      looped_(static_cast<std::size_t>(tree.records)),
      places_(loops.loops.size()),
      origin_x_(tree.links.size()),
      origin_y_(tree.links.size()),
      own_x_(tree.links.size()),
      own_y_(tree.links.size()),
      slots_(static_cast<std::size_t>(tree.slots)),
      outward_slots_(static_cast<std::size_t>(tree.slots)),
      wrenches_(tree.links.size()),
      rows_(static_cast<std::size_t>(loops.rows)),
      pairs_(loops.loops.size()) {}

template <class S, int Rows, bool Momentum>
template <class In, class Out>
bool LoopSweeps<Planar, S, Rows, Momentum>::operator()(const S& t, const In& q, const In& x,
                                                       const In& tau, const RightSide<S>& right,
                                                       Out u, Out sigma, Out rate) {
  Base::place(t, q);
  stuck_ = -1;
  place_bodies(x, right);
  place_loops();
  if (!inward(Momentum ? x : tau, right)) return false;
  outward(right, u, sigma, rate);
  if (Momentum && right.rates) rates_inward(q, right, u, sigma, rate);
  return true;
}

/// r, O, own first moments; in the acceleration form the velocities of all bodies.
template <class S, int Rows, bool Momentum>
template <class In>
void LoopSweeps<Planar, S, Rows, Momentum>::place_bodies(const In& x, const RightSide<S>& right) {
  const PlanarLink* links = tree_->links.data();
  const std::size_t n = pins_.size();
  for (std::size_t k = 0; k < n; ++k) {
    const PlanarLink& l = links[k];
    LoopedPin<S, Rows>& w = pins_[k];
    const Vec2<S> r =
        l.pin ? Base::step(l) : joints_[static_cast<std::size_t>(l.record)].edge.r;
    w.rx = r[0];
    w.ry = r[1];
    const auto parent = static_cast<std::size_t>(l.parent);
    if (l.parent < 0) {
      origin_x_[k] = w.rx;
      origin_y_[k] = w.ry;
    } else {
      origin_x_[k] = origin_x_[parent] + w.rx;
      origin_y_[k] = origin_y_[parent] + w.ry;
    }
    const S c = angles_.cosine(k), s = angles_.sine(k);
    own_x_[k] = l.cx * c - l.cy * s;
    own_y_[k] = l.cx * s + l.cy * c;
    if constexpr (!Momentum) {
      S vx(0.0), vy(0.0), omega(0.0);
      if (l.parent >= 0) {
        const LoopedPin<S, Rows>& from = pins_[parent];
        omega = from.omega;
        vx = from.vx - omega * w.ry;
        vy = from.vy + omega * w.rx;
      }
      if (l.pin) {
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
    } else if (!l.pin) {
      const auto& b = Base::body(k);
      const auto& j = joints_[static_cast<std::size_t>(l.record)];
      Planar::Motion<S> V{};
      if (b.drive >= 0 && right.drives) Joint<Planar>::add_motion(b, j.edge, &j.drive_rate, V);
      looped_[static_cast<std::size_t>(l.record)].V = V;
    }
  }
}

/// Points, axes and rows of all loops.
template <class S, int Rows, bool Momentum>
void LoopSweeps<Planar, S, Rows, Momentum>::place_loops() {
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Loop& l = loops_->loops[i];
    Place& s = places_[i];
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
    if (l.length > 0) {
      const S inverse(1.0 / l.length);
      s.Fx[0] = inverse * gap[0];
      s.Fy[0] = inverse * gap[1];
      s.c[0] = S(0.0);
      continue;
    }
    for (int j = 0; j < l.n_points; ++j) {
      const Vec2<S> b = in_ground(l.b, l.axis_b[static_cast<std::size_t>(l.points[static_cast<std::size_t>(j)])]);
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

/// d of a row before the joints' shares: Φ, or in the acceleration form J̇ V and the feedback.
template <class S, int Rows, bool Momentum>
S LoopSweeps<Planar, S, Rows, Momentum>::row_bias(const Loop& l, const Place& s, int row,
                                                  const RightSide<S>& right) const {
  const S Fx = s.Fx[row], Fy = s.Fy[row], c = s.c[row];
  S phi(0.0);
  if (right.positions || right.beta != 0) {
    if (l.length > 0)
      phi = (s.gap_x * s.gap_x + s.gap_y * s.gap_y + (l.across2 - l.length * l.length)) *
            (0.5 / l.length);
    else
      phi = row < l.n_points ? Fx * s.gap_x + Fy * s.gap_y : s.turn[row];
  }
  if constexpr (Momentum) {
    return phi;
  } else {
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
    if (l.length > 0) {
      // d/dt (D/l)·(u_A − u_B), u_B at the marker of B: there the arm is x_B − O_B.
      const S sx = s.bx - s.gap_x, sy = s.by - s.gap_y;
      const S rx = ux - (bvx - bw * sy), ry = uy - (bvy + bw * sx);
      bias = (rx * rx + ry * ry) * (1.0 / l.length) +
             (Fx * (bw * bw * sx - aw * aw * s.ax) + Fy * (bw * bw * sy - aw * aw * s.ay));
    } else if (row < l.n_points) {
      const S turning_x = -(bw * Fy), turning_y = bw * Fx;  // ω_b × b
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
    const S sign(end.on_a ? 1.0 : -1.0);
    const S rx = sign * (end.on_a ? s.ax : s.bx), ry = sign * (end.on_a ? s.ay : s.by);
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
      if (end.first && (!Momentum || right.positions))
        o.d.add(lane + row, row_bias(l, s, row, right));
    }
  }
}

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
MOMENTA_INLINE void LoopSweeps<Planar, S, Rows, Momentum>::close(const LoopPlan::Range& range, PlanarCargo<S>& a,
                                                  Blocks& o, double fade) {
  for (int i = range.first; i < range.last; ++i) {
    const int loop = plan_->closings[static_cast<std::size_t>(i)];
    const auto at = static_cast<std::size_t>(loop);
    if (plan_->pair[at]) {
      at_lane<Rows>(plan_->lane[at], [&]<int Lane>() MOMENTA_INLINED {
        close_pair<Lane, Moves>(o, fade, pairs_[at], PlanarWeight<S>{a});
      });
    } else {
      Open copy{a, o};
      close_any(loop, copy, fade);
      a = copy.cargo;
      o = copy.blocks;
    }
  }
}

template <class S, int Rows, bool Momentum>
void LoopSweeps<Planar, S, Rows, Momentum>::close_any(int loop, Open& open, double fade) {
  const Loop& l = loops_->loops[static_cast<std::size_t>(loop)];
  const int points = l.length > 0 ? 1 : l.n_points;
  close_loop(open.blocks, plan_->lane[static_cast<std::size_t>(loop)], points, l.rows - points,
             fade, &rows_[static_cast<std::size_t>(l.row)], PlanarWeight<S>{open.cargo});
}

template <class S, int Rows, bool Momentum>
template <class In>
bool LoopSweeps<Planar, S, Rows, Momentum>::inward(const In& r, const RightSide<S>& right) {
  const PlanarLink* links = tree_->links.data();
  const Vec2<double>& g = tree_->model->gravity;
  const bool falls = !Momentum && tree_->model->has_gravity;
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
      if (!general_inward(k, r, here)) {
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
      const S pk = l.sign < 0 ? -r[l.u] : S(r[l.u]);
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
bool LoopSweeps<Planar, S, Rows, Momentum>::general_inward(std::size_t k, const In& r, Open& open) {
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
  const S own = b.nv == 1 ? S(r[b.u]) : S(0.0);
  Planar::ArticulatedInertia<S> M;
  if (!eliminate<Planar>(b, x, M)) return false;
  auto D = remainder<Planar>(b, x, &own);
  if (b.nv == 1) {
    Planar::Motion<S> E{};
    const S one(1.0);
    Joint<Planar>::add_motion(b, x.edge, &one, E);
    const Lanes<S, Rows> c = o.C[0] * E[0] + o.C[1] * E[1] + o.C[2] * E[2];
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
    if (plan_->pair[at]) {
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
      const Outward& from = outward_slots_[static_cast<std::size_t>(
          links[static_cast<std::size_t>(l.parent)].slot)];
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
    if (l.slot >= 0)
      outward_slots_[static_cast<std::size_t>(l.slot)] = {{vx, vy, omega}, sigma};
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
    S Fx = zero, Fy = zero, c = zero, Nx = zero, Ny = zero, n = zero;
    const S wa = l.a < 0 ? zero : pins_[static_cast<std::size_t>(l.a)].omega;
    const S wb = l.b < 0 ? zero : pins_[static_cast<std::size_t>(l.b)].omega;
    S ux = zero, uy = zero;
    if (l.a >= 0) {
      const LoopedPin<S, Rows>& A = pins_[static_cast<std::size_t>(l.a)];
      ux = A.vx - wa * s.ay;
      uy = A.vy + wa * s.ax;
    }
    for (int row = 0; row < l.rows; ++row) {
      const S x = S(impulse[l.row + row]);
      Fx = Fx + x * s.Fx[row];
      Fy = Fy + x * s.Fy[row];
      c = c + x * s.c[row];
      if (row >= l.n_points && l.length == 0) n = n + x * ((wb - wa) * s.turn[row]);
    }
    if (l.length > 0) {  // F' = (u_A − u_B) σ / l
      S bx = zero, by = zero;
      if (l.b >= 0) {
        const LoopedPin<S, Rows>& B = pins_[static_cast<std::size_t>(l.b)];
        bx = B.vx - wb * (s.by - s.gap_y);
        by = B.vy + wb * (s.bx - s.gap_x);
      }
      const S scaled = (S(impulse[l.row])) * (1.0 / l.length);
      Nx = scaled * (ux - bx);
      Ny = scaled * (uy - by);
    } else {
      Nx = -(wb * Fy);
      Ny = wb * Fx;
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
}

template <class S, int Rows, bool Momentum>
template <class Report>
void LoopSweeps<Planar, S, Rows, Momentum>::each_faded(Report&& report) const {
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Loop& l = loops_->loops[i];
    if (plan_->pair[i]) {
      const Pair& p = pairs_[i];
      const bool swapped = value_of(p.swap) > 0.5;
      if (has_faded(p.kept_a)) report(l.row + (swapped ? 1 : 0));
      if (has_faded(p.kept_b)) report(l.row + (swapped ? 0 : 1));
    } else {
      for (int j = 0; j < l.rows; ++j) {
        const Row& row = rows_[static_cast<std::size_t>(l.row + j)];
        if (has_faded(row.kept)) report(l.row + row.lane - plan_->lane[i]);
      }
    }
  }
}

}  // namespace momenta
