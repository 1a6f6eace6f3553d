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
// A row's D_j has F = b_j, O_ij has c = a_i × b_j, a distance has F = D/l₀; of a tie F' = 0, and
// each end has its own arm: x_B − O_B on B. Where drives move
// points and axes, u_B and the rates of rows have their prescribed velocities in them, and d their
// Φ_t.
//
// A coupler has no wrench: its row enters where one of its joints is eliminated, c = EᵀC + r, and p
// has r σ in it. A revolute joint is eliminated by its absolute rate, of which u is the part beyond
// the parent's: there r joins the couple, and leaves it again with the opposite sign.

#include <momenta/core/kernel/planar_body_forces.h>
#include <momenta/core/kernel/planar_places.h>
#include <momenta/dae/kkt/sweeps/closed_pair.h>
#include <momenta/dae/kkt/sweeps/couplings.h>
#include <momenta/dae/kkt/sweeps/slots/loop_plan.h>
#include <momenta/dae/kkt/sweeps/slots/right_side.h>
#include <momenta/dae/mechanism/loop/loops_in_time.h>

#include <optional>

namespace momenta {

/// Records of bodies for the way out and the last sweep.
template <class S, int Rows, bool Momentum>
struct LoopedRevolute {
  Slots<S, Rows> Cx, Cy, g;
  S rx, ry;           ///< O_K − O_L
  S Axx, Axy, Ayy;    ///< M'
  S hx, hy, inverse;  ///< h, M_j⁻¹
  S fx, fy, fn;       ///< D' and M_j⁻¹ e; once u is known, the body's own T in (8)
  S vx, vy, omega;    ///< Ω, where others ask for it
};
template <class S, int Rows>
struct LoopedRevolute<S, Rows, false> {
  Slots<S, Rows> g;
  S rx, ry, hx, hy, inverse;
  S fn;             ///< M_j⁻¹ e
  S vx, vy, omega;  ///< Ω of the state
};
template <class S, int Rows>
struct LoopedJoint {
  Slots<S, Rows> C[3], g;
  Planar::Motion<S> V;  ///< Ω_t, or the velocity product and prescribed acceleration of the joint
};

template <class Space, class S, int Rows, bool Momentum>
class LoopSweeps;

template <class S, int Rows, bool Momentum>
class LoopSweeps<Planar, S, Rows, Momentum> : PlanarPlaces<S> {
  using Base = PlanarPlaces<S>;
  using Base::angles_, Base::joints_, Base::singular_joint_, Base::tree_;
  using Column = Slots<S, Rows>;
  using Blocks = Front<S, Rows, 3>;
  using Row = ClosedRow<S, Rows, 3>;
  using Revolute = LoopedRevolute<S, Rows, Momentum>;
  using Pair = ClosedPair<S, Rows, 3>;
  /// Wider fronts close pairs row by row.
  static constexpr bool pairs_in_registers = Rows <= 8;

 public:
  static constexpr bool of_momenta = Momentum;

  LoopSweeps(const PlanarTree& tree, const LoopModel<Planar>& loops, const LoopPlan& plan);

  /// Momentum form: u (nv) and σ (m) of (7) from p; with `rate` ṗ (nv) of (8). Acceleration form:
  /// u̇, λ from u and joint forces `tau` (nv). Springs and wrenches at points of bodies as
  /// right.body_forces says. False when a joint's inertia is not positive: singular_joint().
  /// O(bodies + m).
  /// @pre No right.body_forces for states side by side.
  template <class In, class Out>
  bool operator()(const S& t, const In& q, const In& x, const In& tau, const RightSide<S>& right,
                  Out u, Out sigma, Out rate);

  /// Memory that an evaluation goes through [bytes].
  static std::size_t bytes(const PlanarTree& tree, const LoopModel<Planar>& loops) {
    return tree.links.size() * (sizeof(Revolute) + 3 * sizeof(S)) +
           loops.loops.size() * (sizeof(Place) + sizeof(Pair));
  }
  /// Sets what solutions add to d of the second row (m), where S has directions; null: nothing.
  void add_to_rows(const S* besides) { besides_ = besides; }
  using Base::singular_joint;
  static bool weak_looped_branch() { return false; }  ///< no branch is folded in a plane
  /// Pivots of the last solution: calls report(row of Φ, w, τ).
  template <class Report>
  void each_pivot(Report&& report) const;

 private:
  using Loop = LoopModel<Planar>::Loop;
  using Motion = LoopModel<Planar>::Motion;

  /// An end of a loop as all sweeps need it.
  struct End {
    Vec2<double> at;  ///< its point, body axes
    Vec2<double> D;   ///< for the end that begins a tie's D: the part of an end on the ground
    double sign = 1;  ///< −1 on body B
    int loop = 0, row = 0, slot = 0;
    bool pair = false, tie = false;
    bool turns = false;  ///< two point rows along axes of B that no drive moves
    bool on_a = true, first = true, begins = false;
  };
  /// Two point rows along axes of B.
  struct Turning {
    Vec2<double> at_a, at_b, axis;  ///< points, the first axis
    std::size_t a, b, loop;
  };
  struct Visit {
    LoopPlan::Range ends, closings;
  };
  struct Closing {
    int loop, row, slot;
    bool pair;
  };
  /// Place of a loop that is no tie, ground axes.
  struct Place {
    S ax, ay, bx, by;  ///< x_A − O_A and x_A − O_B
    S Fx, Fy;          ///< pair: first axis; the second stands across it
    S dx, dy;          ///< pair: d, where the right-hand side asks for something
  };
  /// A row's unit impulse on body A: force at x_A, couple; of an axis row a_i · b_j too.
  struct RowPlace {
    S Fx, Fy, c, turn;
  };
  /// Velocity and acceleration of x_B on B in a loop with drives, ground axes.
  struct MovingPoint {
    Vec2<S> v, a;
  };
  struct Open {
    PlanarArticulated<S> articulated;
    Blocks blocks;
  };

  template <class In>
  void place_bodies(const In& x, const RightSide<S>& right);
  template <class In>
  void place_revolutes(const In& x, bool velocities);
  MOMENTA_INLINE void place_ends(std::size_t k, bool gap, const S& x, const S& y);
  void place_turning(const RightSide<S>& right);
  __attribute__((noinline)) void place_other_loops(const RightSide<S>& right);
  /// Whether d of rows other than ties' may be nonzero.
  bool biased(const RightSide<S>& right) const {
    return !Momentum || right.positions != 0 || (right.drives && !moving_.empty());
  }
  void place_rows(const Loop& l, std::size_t loop);
  void place_moving(const Loop& l);
  template <class In>
  __attribute__((noinline)) void place_couplers(const In& q, const In& x,
                                                const RightSide<S>& right);
  MOMENTA_INLINE Vec2<S> turned(std::size_t k, const Vec2<double>& v) const {
    const S c = angles_.cosine(k), e = angles_.sine(k);
    return Vec2<S>{{c * v[0] - e * v[1], e * v[0] + c * v[1]}};
  }
  Vec2<S> in_ground(int body, const Vec2<double>& v) const;
  __attribute__((noinline)) void gather_forces();
  /// O_K − O_L
  MOMENTA_INLINE Vec2<S> way_from_parent(const PlanarLink& l) const {
    return l.revolute ? Base::step(l) : joints_[static_cast<std::size_t>(l.record)].edge.r;
  }
  /// D = x_A − x_B
  Vec2<S> gap_of(const Loop& l, const Place& s) const {
    return Vec2<S>{{s.bx, s.by}} - in_ground(l.b, l.at_b);
  }
  RowPlace row_place(std::size_t loop, int row) const;
  S moving_rate(const Loop& l, const Place& s, const RowPlace& r, int row) const;
  S moving_bias(const Loop& l, const Place& s, const RowPlace& r, int row,
                const RightSide<S>& right, const S& phi) const;
  const Motion& motion(const Loop& l) const {
    return loops_->motions[static_cast<std::size_t>(l.motion)];
  }
  const MovingPoint& moving_point(const Loop& l) const {
    return moving_[static_cast<std::size_t>(l.motion)];
  }
  S row_bias(std::size_t loop, int row, const RightSide<S>& right) const;
  static bool asks_for_gaps(const RightSide<S>& right) {
    return right.positions != 0 || right.beta != 0;
  }
  MOMENTA_INLINE bool asks(const End& end, const RightSide<S>& right) const;
  MOMENTA_INLINE Vec2<S> tie_bias(std::size_t k, const End& end, const Vec2<S>& arm,
                                  const RightSide<S>& right) const;
  template <class In>
  bool inward(const In& r, const RightSide<S>& right);
  MOMENTA_INLINE void enter(std::size_t k, const LoopPlan::Range& range, const RightSide<S>& right,
                            PlanarArticulated<S>& a, Blocks& o);
  MOMENTA_INLINE void enter_pair(std::size_t k, std::size_t i, const RightSide<S>& right,
                                 PlanarArticulated<S>& a, Blocks& o);
  __attribute__((noinline)) void enter_rows(std::size_t k, std::size_t i, const RightSide<S>& right,
                                            Open& open);
  template <bool Moves>
  MOMENTA_INLINE void close(const LoopPlan::Range& range, PlanarArticulated<S>& a, Blocks& o,
                            double fade, SlotGroups all);
  __attribute__((noinline)) void close_any(int loop, Open& open, double fade, SlotGroups all);
  template <class In>
  __attribute__((noinline)) S couple(std::size_t k, const In& r, const RightSide<S>& right,
                                     Open& open);
  __attribute__((noinline)) void uncouple(std::size_t k, Open& open);
  template <class In>
  __attribute__((noinline)) bool general_inward(std::size_t k, const In& r,
                                                const RightSide<S>& right, Open& open);
  template <class Out>
  void outward(const RightSide<S>& right, Out u, Out impulse, Out rate);
  template <bool Moves, class Out>
  MOMENTA_INLINE void solve_loops(const LoopPlan::Range& range, const RightSide<S>& right,
                                  const Planar::Motion<S>& motion, Column& sigma, Out& out);
  template <class Out>
  __attribute__((noinline)) void general_outward(std::size_t k, bool rates, Out u, Out rate,
                                                 PlanarMotion<S>& m, const Column& sigma);
  struct Wrench {
    S fx, fy, fn;
  };
  static MOMENTA_INLINE void add(Wrench& a, const Wrench& b) {
    a.fx = a.fx + b.fx;
    a.fy = a.fy + b.fy;
    a.fn = a.fn + b.fn;
  }
  template <class Out>
  MOMENTA_INLINE void own_rates(std::size_t k, const LoopPlan::Range& ends,
                                const RightSide<S>& right, const Out& impulse, const S& vx,
                                const S& vy, const S& omega, Revolute& w);
  template <class Out>
  MOMENTA_INLINE void add_other_rates(const End& end, const RightSide<S>& right, const Out& impulse,
                                      Wrench& T);
  template <class In, class Out>
  void rates_inward(const In& q, const RightSide<S>& right, const Out& u, const Out& impulse,
                    Out rate);
  template <class Out>
  __attribute__((noinline)) void force_of_rows(std::size_t loop, const RightSide<S>& right,
                                               const Out& impulse, const Planar::Motion<S>& of_a,
                                               const Planar::Motion<S>& of_b, Wrench& w,
                                               Wrench& N) const;

  LoopsInTime<Planar> in_time_;
  const LoopModel<Planar>* loops_;  ///< in the frames of the links, at the current time
  const LoopPlan* plan_;
  OpenSlots open_slots_;
  std::vector<Revolute> revolutes_;
  std::vector<LoopedJoint<S, Rows>> looped_;
  std::vector<Visit> visits_;        ///< by body
  std::vector<End> ends_;            ///< as in the plan
  std::vector<Turning> turning_;     ///< loops that turn with B
  std::vector<Closing> closings_;    ///< as in the plan
  std::vector<Vec2<S>> arms_;        ///< by end of a tie: x − O of its body, ground axes
  std::vector<Vec2<S>> gaps_;        ///< by loop, ties: D, where equations ask for it
  std::vector<int> others_;          ///< loops that are neither ties nor turn with B alone
  bool tied_ = true;                 ///< all loops are ties
  bool keeps_motions_ = false;       ///< bodies' Ω are needed later
  std::vector<Place> places_;        ///< by loop
  std::vector<RowPlace> row_at_;     ///< by row of Φ; not of pairs
  std::vector<MovingPoint> moving_;  ///< by motion
  std::vector<S> coupled_;           ///< by loop: d of a coupler
  std::vector<Vec2<S>> origins_;     ///< by body, where loops are no ties: O_K
  struct Weight {
    double fx, fy, along, across;  ///< couple about O: along cos + across sin
  };
  std::vector<Weight> weights_;  ///< by body
  std::vector<Vec2<S>> origin_slots_;
  std::vector<Open> slots_;
  struct Outward {
    PlanarMotion<S> motion;
    Column sigma;
  };
  std::vector<Outward> outward_slots_;
  std::vector<Wrench> wrench_slots_;
  Blocks front_, ground_;
  std::vector<Row> rows_;          ///< by row of Φ, in closing order within a loop
  std::vector<Pair> pairs_;        ///< by loop
  const S* compliance_ = nullptr;  ///< right.compliance of the call under way
  const S* besides_ = nullptr;
  std::optional<PlanarBodyForces<S>> forces_;
};

template <class S, int Rows, bool Momentum>
LoopSweeps<Planar, S, Rows, Momentum>::LoopSweeps(const PlanarTree& tree,
                                                  const LoopModel<Planar>& loops,
                                                  const LoopPlan& plan)
    : Base(tree),
      in_time_(loops),
      loops_(&loops),
      plan_(&plan),
      open_slots_(plan, parents_of(tree), rows_of(loops)),
      revolutes_(tree.links.size()),
      looped_(static_cast<std::size_t>(tree.records)),
      arms_(plan.ends.size()),
      gaps_(loops.loops.size()),
      places_(loops.loops.size()),
      row_at_(static_cast<std::size_t>(loops.rows)),
      moving_(loops.motions.size()),
      coupled_(plan.couples() ? loops.loops.size() : 0),
      origin_slots_(static_cast<std::size_t>(tree.slots)),
      slots_(static_cast<std::size_t>(tree.slots)),
      outward_slots_(static_cast<std::size_t>(tree.slots)),
      wrench_slots_(static_cast<std::size_t>(tree.slots)),
      rows_(static_cast<std::size_t>(loops.rows)),
      pairs_(loops.loops.size()) {
  const auto turns = [&](std::size_t i) {
    const Loop& l = loops.loops[i];
    return plan.pair[i] && !l.is_tie && l.motion < 0 && l.a >= 0 && l.b >= 0 && l.a != l.b;
  };
  for (std::size_t i = 0; i < loops.loops.size(); ++i) {
    tied_ = tied_ && loops.loops[i].is_tie;
    const Loop& l = loops.loops[i];
    if (turns(i))
      turning_.push_back({l.at_a, l.at_b, l.axis_b[0], static_cast<std::size_t>(l.a),
                          static_cast<std::size_t>(l.b), i});
    else if (!l.is_tie)
      others_.push_back(static_cast<int>(i));
  }
  for (const LoopPlan::End& end : plan.ends) {
    const auto i = static_cast<std::size_t>(end.loop);
    const Loop& l = loops.loops[i];
    End e;
    e.at = end.on_a ? l.at_a : l.at_b;
    if (l.is_tie) e.D = l.a < 0 ? l.at_a : l.b < 0 ? -l.at_b : Vec2<double>{};
    e.sign = end.on_a ? 1.0 : -1.0;
    e.loop = end.loop;
    e.row = l.row;
    e.slot = plan.slot[i];
    e.pair = plan.pair[i];
    e.tie = l.is_tie;
    e.turns = turns(i);
    e.on_a = end.on_a;
    e.first = end.first;
    e.begins = l.is_tie && (!end.first || l.a < 0 || l.b < 0);
    ends_.push_back(e);
  }
  for (std::size_t k = 0; k < tree.links.size(); ++k)
    visits_.push_back({plan.ends_of[k], plan.closings_of[k]});
  for (const int loop : plan.closings) {
    const auto i = static_cast<std::size_t>(loop);
    closings_.push_back({loop, loops.loops[i].row, plan.slot[i], plan.pair[i] != 0});
  }
  if (!tied_) origins_.resize(tree.links.size());
  const Vec2<double>& g = tree.model->gravity;
  if (Momentum && tree.model->has_gravity)
    for (const PlanarLink& l : tree.links)
      weights_.push_back(
          {l.m * g[0], l.m * g[1], l.cx * g[1] - l.cy * g[0], -(l.cy * g[1] + l.cx * g[0])});
  if (tree.model->has_body_forces()) forces_.emplace(tree);
  keeps_motions_ = !tied_ || forces_;
}

template <class S, int Rows, bool Momentum>
template <class In, class Out>
bool LoopSweeps<Planar, S, Rows, Momentum>::operator()(const S& t, const In& q, const In& x,
                                                       const In& tau, const RightSide<S>& right,
                                                       Out u, Out sigma, Out rate) {
  Base::place(t, q);
  singular_joint_ = -1;
  compliance_ = right.compliance;
  if (!joints_.empty() || asks_for_gaps(right))
    place_bodies(x, right);
  else if (!Momentum || !tied_)
    place_revolutes(x, !Momentum && (keeps_motions_ || right.alpha != 0));
  loops_ = &in_time_.at(value_of(t));
  if (!turning_.empty()) place_turning(right);
  if (!others_.empty()) place_other_loops(right);
  if (plan_->couples()) place_couplers(q, x, right);
  if (!Momentum && right.body_forces) gather_forces();
  if (!inward(Momentum ? x : tau, right)) return false;
  outward(right, u, sigma, rate);
  if constexpr (Momentum)
    if (right.rates) rates_inward(q, right, u, sigma, rate);
  return true;
}

}  // namespace momenta

#include <momenta/dae/kkt/sweeps/planar_loop_inward.h>
#include <momenta/dae/kkt/sweeps/planar_loop_outward.h>
#include <momenta/dae/kkt/sweeps/planar_loop_place.h>
#include <momenta/dae/kkt/sweeps/planar_loop_rows.h>
