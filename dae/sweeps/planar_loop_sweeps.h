#pragma once
// Closed loops in a plane inside the two sweeps: (q, p, t) → (u, σ, ṗ), eqs. (7)-(8), and the
// acceleration form (3) on the same code. No M, Φ_q or Φ_q M⁻¹ Φ_qᵀ is assembled.
//
//   inward    loop ends enter: C = Jᵀ, D = Jᵀ centre, d = what the right-hand side asks of them
//             loops whose lowest common ancestor this is close                       (front.h)
//             M_j⁻¹ = 1/I, h = H/I, c = EᵀC, g = c M_j⁻¹, e = r − EᵀD
//             M' = M* − h (M*E)ᵀ, D' = D + h e, C' = C − h c,  W' = W + c gᵀ, d' = d + g e
//             to the parent as (43), (44); C like a force; d' += C'ᵀ Ω_t
//   outward   V = 𝒯ⱽ Ω_L + Ω_t, u = M_j⁻¹ e − hᵀ V − g σ, Ω = V + E u
//             then the impulses of the loops closed here
//   inward    T: weights and, at each end of a loop, N − κ w                          (8)
//
// Momentum form: r = p, ṗ = Eᵀ(T* − Ω × P*), P* = M'V + D' + C'σ. N = (d/dt Jᵀ)σ + Ω × w is the
// inertial rate of an impulse: for a row with force F at x_A and couple c on body A (loop_rows.h),
// force F' at x_A, couple c' + u_A × F; on B the exact negative. Acceleration form: r = joint force
// and D = −ω² m c; a joint's velocity product takes the place of Ω_t, J̇ V of d.
//
// A row's D_j has F = b_j, O_ij has c = a_i × b_j, a distance has F = D/l₀. Where drives move
// points and axes, u_B and the rates of rows have their prescribed velocities in them, and d their
// Φ_t.
//
// A coupler has no wrench: its row enters where one of its joints is eliminated, c = EᵀC + r, and p
// has r σ in it. A pin is eliminated by its absolute rate, of which u is the part beyond the
// parent's: there r joins the couple, and leaves it again with the opposite sign.

#include <momenta/core/kernel/planar_places.h>
#include <momenta/dae/loop/loops_in_time.h>
#include <momenta/dae/sweeps/couplings.h>
#include <momenta/dae/sweeps/front.h>
#include <momenta/dae/sweeps/loop_plan.h>
#include <momenta/dae/sweeps/right_side.h>

namespace momenta {

/// What bodies have for the way out and the last sweep.
template <class S, int Rows>
struct LoopedPin {
  Lanes<S, Rows> Cx, Cy, g;
  S rx, ry;                             ///< O_K − O_L
  S Axx, Axy, Ayy, Dx, Dy, hx, hy, y0;  ///< M', D', h, M_j⁻¹ e
  S vx, vy, omega;                      ///< Ω (momentum form); prescribed ones (acceleration)
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
  /// Wider fronts close pairs of rows as they do all others.
  static constexpr bool pairs_in_registers = Rows <= 8;

 public:
  LoopSweeps(const PlanarTree& tree, const LoopModel<Planar>& loops, const LoopPlan& plan);

  /// Momentum form: u (nv) and σ (m) of (7) from p; with `rate` ṗ (nv) of (8), forces between
  /// points of bodies left out. Acceleration form: u̇, λ from u and joint forces `tau` (nv). False
  /// when a joint's inertia is not positive: stuck(). O(bodies + m).
  template <class In, class Out>
  bool operator()(const S& t, const In& q, const In& x, const In& tau, const RightSide<S>& right,
                  Out u, Out sigma, Out rate);

  using Base::stuck;
  static bool weak_leg() { return false; }  ///< no leg is folded in a plane
  /// Pivots of the last solution: calls report(row of Φ, w, τ).
  template <class Report>
  void each_pivot(Report&& report) const;

 private:
  /// Where a loop stands: the points it ties, seen from both bodies, and its rows.
  struct Place {
    S ax, ay, bx, by;  ///< x_A − O_A and x_A − O_B
    S gap_x, gap_y;    ///< D = x_A − x_B
    S Fx[3], Fy[3], c[3];
    S turn[3];  ///< a_i · b_j of an axis row
  };
  /// Of a loop with drives, ground axes: velocity and acceleration of x_B on B.
  struct MovingPoint {
    Vec2<S> v, a;
  };
  struct Open {
    PlanarCargo<S> cargo;
    Blocks blocks;
  };
  using Loop = LoopModel<Planar>::Loop;
  using Motion = LoopModel<Planar>::Motion;

  template <class In>
  void place_bodies(const In& x, const RightSide<S>& right);
  void place_loops();
  __attribute__((noinline)) void place_moving(const Loop& l);
  template <class In>
  __attribute__((noinline)) void place_couplers(const In& q, const In& x,
                                                const RightSide<S>& right);
  __attribute__((noinline)) S moving_rate(const Loop& l, const Place& s, int row) const;
  __attribute__((noinline)) S moving_bias(const Loop& l, const Place& s, int row,
                                          const RightSide<S>& right, const S& phi) const;
  const Motion& motion(const Loop& l) const {
    return loops_->motions[static_cast<std::size_t>(l.motion)];
  }
  const MovingPoint& moving_point(const Loop& l) const {
    return moving_[static_cast<std::size_t>(l.motion)];
  }
  S row_bias(const Loop& l, const Place& s, int row, const RightSide<S>& right) const;
  template <class In>
  bool inward(const In& r, const RightSide<S>& right);
  MOMENTA_INLINE void enter(std::size_t k, const RightSide<S>& right, PlanarCargo<S>& a, Blocks& o);
  template <bool Moves>
  MOMENTA_INLINE void close(const LoopPlan::Range& range, PlanarCargo<S>& a, Blocks& o,
                            double fade);
  __attribute__((noinline)) void close_any(int loop, Open& open, double fade);
  template <class In>
  __attribute__((noinline)) bool general_inward(std::size_t k, const In& r,
                                                const RightSide<S>& right, Open& open);
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

  LoopsInTime<Planar> in_time_;
  const LoopModel<Planar>* loops_;  ///< points and axes in the frames of the links, at the time
  const LoopPlan* plan_;
  std::vector<LoopedPin<S, Rows>> pins_;
  std::vector<LoopedJoint<S, Rows>> looped_;
  std::vector<Place> places_;
  std::vector<MovingPoint> moving_;                     ///< by motion
  std::vector<S> coupled_;                              ///< by loop: d of a coupler
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
  std::vector<Wrench> wrenches_;   ///< T, N and leak
  std::vector<Row> rows_;          ///< by row of Φ, in closing order within a loop
  const S* compliance_ = nullptr;  ///< of the call under way: right.compliance
  std::vector<Pair> pairs_;        ///< by loop
};

template <class S, int Rows, bool Momentum>
LoopSweeps<Planar, S, Rows, Momentum>::LoopSweeps(const PlanarTree& tree,
                                                  const LoopModel<Planar>& loops,
                                                  const LoopPlan& plan)
    : Base(tree),
      in_time_(loops),
      loops_(&loops),
      plan_(&plan),
      pins_(tree.links.size()),
      looped_(static_cast<std::size_t>(tree.records)),
      places_(loops.loops.size()),
      moving_(loops.motions.size()),
      coupled_(plan.couples() ? loops.loops.size() : 0),
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
  compliance_ = right.compliance;
  place_bodies(x, right);
  loops_ = &in_time_.at(value_of(t));
  place_loops();
  if (plan_->couples()) place_couplers(q, x, right);
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
    const Vec2<S> r = l.pin ? Base::step(l) : joints_[static_cast<std::size_t>(l.record)].edge.r;
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

}  // namespace momenta

#include <momenta/dae/sweeps/planar_loop_inward.h>
#include <momenta/dae/sweeps/planar_loop_outward.h>
#include <momenta/dae/sweeps/planar_loop_rows.h>
