#pragma once
// The loop equations at three levels, their impulses and the inertial rates of those, for one
// algebra and one scalar. u_A, u_B: velocities of the two points; w_a, w_b: angular velocities of
// the axes; both with what drives prescribe relative to the bodies; s: the impulse σ of the row.
//
//   D_j   Φ̇ = b·(u_A − u_B) + (w_b × b)·D            impulse on A: force b s at x_A
//         N on A: force (w_b × b) s at x_A, couple u_A × b s
//   O_ij  Φ̇ = (a × b)·(w_a − w_b)                    impulse on A: couple (a × b) s
//         N on A: couple [(w_a × a) × b + a × (w_b × b)] s
//   L     Φ̇ = (D·(u_A − u_B) − l l̇)/l₀               impulse on A: force D s/l₀ at x_A
//         N on A: force (u_A − u_B) s/l₀ at x_A, couple u_A × D s/l₀
//   Q     Φ̇ = Σ rᵢ uᵢ − ċ                            no impulse on bodies: pᵢ += rᵢ s
//         N: none; where rᵢ depends on qᵢ (LoopModel::Coupled): ṗᵢ += ṙᵢ s
//   F     Φ̇ = Σ F_k ẏ_k, Φ̈ = Σ F_k ÿ_k + Σ F_kl ẏ_k ẏ_l, F_k = ∂F/∂y_k, y of D_j and O_ij
//         impulse on A: those of its measures, with s_k = F_k s
//         N on A: those of its measures, and the impulses of ṡ_k = Σ F_kl ẏ_l s
//   E, V  loop_equation.h
//   R     rolling_wheel.h
//
// N is the inertial rate of the impulse at fixed σ.
//
// On B act the exact negatives, with the same line of action. Of a tie, b fixed in the ground, they
// act at x_B instead: force −b s, N −u_B × b s. N = (d/dt Jᵀ)σ + Ω × w: it is added
// to the applied wrenches T, because Ω × P* in (35) takes the part Ω × w away again. With this, p =
// EᵀP*_aug + Σ r σ is row 1 of (7) and (35) is (8), without M or Φ_q. Φ̇_qᵀσ has its part from
// moving rows in it, Φ_qt σ, because u_B, w_a and w_b have the prescribed motion in them.

#include <momenta/core/kernel/points.h>
#include <momenta/core/scalar/dual.h>
#include <momenta/dae/loop/driven_loop.h>
#include <momenta/dae/loop/higher_pair.h>
#include <momenta/dae/loop/loop_equation.h>
#include <momenta/dae/loop/lost_places.h>
#include <momenta/dae/loop/rolling_wheel.h>

namespace momenta {

// In the plane angular quantities are numbers; products read alike in both algebras.
template <class S>
S inner(const Vec3<S>& a, const Vec3<S>& b) {
  return dot(a, b);
}
template <class S>
S inner(const S& a, const S& b) {
  return a * b;
}

template <class Space, class S>
class LoopRows {
 public:
  using Vector = typename Space::template Vector<S>;
  using Force = typename Space::template Force<S>;
  using Angular = decltype(cross(Vector{}, Vector{}));  ///< Vec3 in space, S in the plane
  using Loop = typename LoopModel<Space>::Loop;

  LoopRows(const LoopModel<Space>& model, Workspace<Space, S>& w)
      : model_(&model),
        w_(w),
        at_(model.loops.size()),
        curves_(static_cast<std::size_t>(model.curves)),
        pairs_(model.pairs.size()),
        wheels_(model.wheels.size()),
        driven_(model.motions.size()),
        lost_(w.body.size()) {
    for (const auto& equation : model.equations) equations_.emplace_back(*equation);
    for (std::size_t i = 0; i < pairs_.size(); ++i)
      pairs_[i].measures = model.pairs[i]->turns() ? 4 : 2;
  }

  /// Points and axes in ground components; needs poses at (t, q).
  void place(double t, const S* q) {
    for (std::size_t i = 0; i < driven_.size(); ++i)
      driven_[i].move(model_->motions[i], Moment<Time>::at(t));
    if constexpr (rounded) lost_.outward(w_);
    for (std::size_t i = 0; i < at_.size(); ++i) {
      const auto& l = model_->loops[i];
      auto& s = at_[i];
      if (l.is_equation()) {
        EquationRow<Space, S>& row = equation(l);
        row.place(w_, t, q);
        s.position = row.position();
        for (std::size_t j = 0; j < l.joints.size(); ++j)
          curve(l.joints[j]).slope = row.slope_of(j);
        continue;
      }
      if (l.is_coupler()) {
        s.position = -S(given(l));
        for (const auto& c : l.joints) {
          s.position += c.value(q[c.q]);
          if (c.curve >= 0) curve(c) = {c.slope(q[c.q]), c.bend(q[c.q]), S(0.0)};
        }
        continue;
      }
      const Vector arm_a = to_ground(w_, l.a, l.at_a);
      const Vector arm_b =
          l.motion < 0 ? to_ground(w_, l.b, l.at_b) : to_ground(w_, l.b, motion(l).at_b);
      s.x_a = origin(w_, l.a) + arm_a;
      s.x_b = origin(w_, l.b) + arm_b;
      s.D = s.x_a - s.x_b;
      if constexpr (rounded)
        s.D += lost_.of_point(w_, l.a, arm_a, s.x_a) - lost_.of_point(w_, l.b, arm_b, s.x_b);
      for (std::size_t j = 0; j < (Space::dimension == 3 ? 2u : 3u); ++j) {
        s.a[j] = l.motion < 0 ? to_ground(w_, l.a, l.axis_a[j])
                              : to_ground(w_, l.a, motion(l).axis_a[j]);
        s.b[j] = l.motion < 0 ? to_ground(w_, l.axes_of_b(), l.axis_b[j])
                              : to_ground(w_, l.b, motion(l).axis_b[j]);
      }
      if constexpr (in_space)
        if (l.is_wheel()) wheel(l).place(law_of_wheel(l), s.b, s.a[2], s.x_a, s.D);
      if (l.is_pair())
        law(l).evaluate(
            {dot(s.b[0], s.D), dot(s.b[1], s.D), dot(s.a[0], s.b[0]), dot(s.a[0], s.b[1])},
            pair(l).place, pair(l).terms);
    }
  }

  /// The first pair or equation that the last place() found no numbers of, by place among the
  /// loops; −1: none.
  int lost_loop() const {
    if (pairs_.empty() && equations_.empty() && wheels_.empty()) return -1;
    for (std::size_t i = 0; i < at_.size(); ++i) {
      const auto& l = model_->loops[i];
      if ((l.is_pair() && pair(l).place.lost != PairPlace::Lost::no) ||
          (l.is_equation() && !equation(l).finite()) ||
          (l.is_wheel() && !wheel(l).touches(law_of_wheel(l))))
        return static_cast<int>(i);
    }
    return -1;
  }
  /// Calls act(body, wrench) for the unit impulse of an equation on each body with points of it;
  /// of other loops nothing.
  template <class Act>
  void each_point_wrench(const Loop& l, Act&& act) const {
    if (l.is_equation()) equation(l).each_wrench(w_, S(1.0), false, act);
  }
  /// Where the curves of a pair touched at the last place(), by place of its loop.
  const PairPlace& pair_place(std::size_t loop) const { return pair(model_->loops[loop]).place; }

  /// Point and angular velocities; needs velocities. `u` null: zero rates.
  void move(const S* u) {
    for (std::size_t i = 0; i < at_.size(); ++i) {
      const auto& l = model_->loops[i];
      auto& s = at_[i];
      if (l.is_equation()) {
        EquationRow<Space, S>& row = equation(l);
        row.move(w_, u);
        s.rate = row.rate();
        for (std::size_t j = 0; j < l.joints.size(); ++j)
          curve(l.joints[j]).turning = row.turning_of(j);
        continue;
      }
      if (l.is_coupler()) {
        s.rate = -S(given_rate(l));
        s.bending = S(0.0);
        for (const auto& c : l.joints) {
          if (u) s.rate += ratio(c) * u[c.u];
          if (c.curve < 0) continue;
          curve(c).turning = u ? curve(c).bend * u[c.u] : S(0.0);
          if (u) s.bending += curve(c).turning * u[c.u];
        }
        continue;
      }
      s.u_a = point_velocity(w_, l.a, s.x_a);
      s.u_b = point_velocity(w_, l.b, s.x_b);
      s.w_a = angular_velocity(w_, l.a);
      s.w_b = angular_velocity(w_, l.axes_of_b());
      if (l.motion >= 0) {
        const auto& m = motion(l);
        s.u_b += to_ground(w_, l.b, m.v);
        s.w_a += turning_in_ground(l.a, m.turning_a);
        s.w_b += turning_in_ground(l.b, m.turning_b);
      }
      if (l.is_pair()) move_pair(l, s);
      if constexpr (in_space)
        if (l.is_wheel()) {
          auto& rolls = wheel(l);
          rolls.move(law_of_wheel(l), s.u_a, s.w_a, s.w_b);
          rolls.v_a = point_velocity(w_, l.a, rolls.at);
          rolls.v_b = point_velocity(w_, l.b, rolls.at);
        }
    }
  }

  /// Accelerations of couplers and equations; `udot` null: zero. The latter need accelerations.
  void accelerate(const S* udot) {
    for (std::size_t i = 0; i < at_.size(); ++i) {
      const auto& l = model_->loops[i];
      if (!l.is_coupler()) continue;
      S& second = at_[i].second;
      if (l.is_equation()) {
        second = equation(l).second(w_, udot);
        continue;
      }
      second = l.motion < 0 ? S(0.0) : -S(motion(l).given_second);
      second += at_[i].bending;
      for (const auto& c : l.joints)
        if (udot) second += ratio(c) * udot[c.u];
    }
  }

  /// Φ (m)
  void positions(S* phi) const {
    each_row(
        [&](int row, const auto&, const At& s, const Vector& b) { phi[row] = dot(b, s.D); },
        [&](int row, const auto& l, const At&, const Vector& a, const Vector& b) {
          phi[row] = dot(a, b) - l.gamma;
        },
        [&](int row, const auto& l, const At& s) {
          phi[row] = (dot(s.D, s.D) + (l.across2 - given(l) * given(l))) * (0.5 * l.per_length);
        },
        [&](int row, const At& s) { phi[row] = s.position; },
        [&](int row, const auto& l, const At&) { phi[row] = pair(l).terms.value; },
        [&](int row, std::size_t k, const auto& l) { phi[row] = k == 0 ? wheel(l).gap : S(0.0); });
  }

  /// Φ̇ (m) for the velocities of the last move().
  void velocities(S* rate) const {
    each_row(
        [&](int row, const auto&, const At& s, const Vector& b) { rate[row] = point_rate(s, b); },
        [&](int row, const auto&, const At& s, const Vector& a, const Vector& b) {
          rate[row] = axes_rate(s, a, b);
        },
        [&](int row, const auto& l, const At& s) {
          rate[row] = (dot(s.D, s.u_a - s.u_b) - given(l) * given_rate(l)) * l.per_length;
        },
        [&](int row, const At& s) { rate[row] = s.rate; },
        [&](int row, const auto& l, const At&) {
          const Pair& p = pair(l);
          rate[row] = S(0.0);
          for (std::size_t k = 0; k < p.measures; ++k) rate[row] += p.terms.slope[k] * p.rate[k];
        },
        [&](int row, std::size_t k, const auto& l) { rate[row] = wheel(l).rate(k); });
  }

  /// Φ̈ (m) for the accelerations body[k].A and of accelerate(): with u̇ = 0 the bias (d/dt Φ_q) u +
  /// d/dt Φ_t.
  void accelerations(S* rate) const {
    each_row([&](int row, const auto& l, const At& s,
                 const Vector& b) { rate[row] = point_second(l, s, b); },
             [&](int row, const auto& l, const At& s, const Vector& a, const Vector& b) {
               rate[row] = axes_second(l, s, a, b);
             },
             [&](int row, const auto& l, const At& s) {
               const Vector rel = s.u_a - s.u_b;
               S second = dot(s.D, acceleration_apart(l, s)) + dot(rel, rel);
               if (l.motion >= 0) {
                 const auto& m = motion(l);
                 second -= S(m.given_rate * m.given_rate + m.given * m.given_second);
               }
               rate[row] = second * l.per_length;
             },
             [&](int row, const At& s) { rate[row] = s.second; },
             [&](int row, const auto& l, const At& s) {
               const Pair& p = pair(l);
               S second = p.terms.slope[0] * point_second(l, s, s.b[0]) +
                          p.terms.slope[1] * point_second(l, s, s.b[1]);
               if (p.measures == 4)
                 second += p.terms.slope[2] * axes_second(l, s, s.a[0], s.b[0]) +
                           p.terms.slope[3] * axes_second(l, s, s.a[0], s.b[1]);
               for (std::size_t k = 0; k < p.measures; ++k) second += p.slope_rate[k] * p.rate[k];
               rate[row] = second;
             },
             [&](int row, std::size_t k, const auto& l) {
               const auto& rolls = wheel(l);
               rate[row] = rolls.second(k, point_acceleration(w_, l.a, rolls.at),
                                        point_acceleration(w_, l.b, rolls.at));
             });
  }

  /// Adds the wrenches of the impulses `sigma`, times `factor`, to the bodies' forces chosen by
  /// `field`.
  template <class Field>
  void add_wrenches(const S* sigma, double factor, Field field) {
    each_loop_wrench(
        sigma, factor, field,
        [](const At&, const Vector& b) {
          return std::pair<Vector, Vector>{b, Vector{}};
        },
        [](const At&, const Vector& a, const Vector& b) { return cross(a, b); }, false);
  }

  /// Adds the inertial rates N of the impulses to body[k].T; needs move().
  void add_inertial_rates(const S* sigma) {
    each_loop_wrench(
        sigma, 1.0, [](auto& body) -> Force& { return body.T; },
        [](const At& s, const Vector& b) {
          return std::pair<Vector, Vector>{cross(s.w_b, b), b};
        },
        [](const At& s, const Vector& a, const Vector& b) {
          return cross(cross(s.w_a, a), b) + cross(a, cross(s.w_b, b));
        },
        true);
  }

  /// Adds the impulses of couplers and equations on coordinates, times `factor`, to the momenta or
  /// forces of joints (nv).
  void add_couplings(const S* sigma, double factor, S* on_joints) const {
    for (const auto& l : model_->loops)
      for (const auto& c : l.joints) on_joints[c.u] += (factor * ratio(c)) * sigma[l.row];
  }

  /// Adds ṙ σ of coordinates whose ratios change; needs move().
  void add_coupling_rates(const S* sigma, S* on_joints) const {
    if (curves_.empty()) return;
    for (const auto& l : model_->loops)
      for (const auto& c : l.joints)
        if (c.curve >= 0) on_joints[c.u] += curve(c).turning * sigma[l.row];
  }

  /// ∂Φ/∂q of a coupler: what its joint is multiplied by at the last place().
  S ratio(const typename LoopModel<Space>::Coupled& c) const {
    return c.curve < 0 ? S(c.ratio) : curve(c).slope;
  }

  /// Unit wrench of a row on its bodies, none of couplers, in the axes of the sweeps: the start of
  /// a row of Φ_q.
  void unit_wrench(std::size_t loop, int row_of_loop, Force& on_a, Force& on_b) const {
    const auto& l = model_->loops[loop];
    const At& s = at_[loop];
    on_a = {};
    on_b = {};
    const auto push = [&](const Vector& f) {
      if (l.a >= 0) add_force(w_, l.a, s.x_a, f, on_a);
      if (l.b >= 0) add_force(w_, l.b, l.is_tie ? s.x_b : s.x_a, -f, on_b);
    };
    if (l.is_coupler()) return;
    if constexpr (in_space)
      if (l.is_wheel()) {
        const auto& rolls = wheel(l);
        const Vector& e = rolls.along[static_cast<std::size_t>(row_of_loop)];
        if (l.a >= 0) add_force(w_, l.a, rolls.at, e, on_a);
        if (l.b >= 0) add_force(w_, l.b, rolls.at, Vector(-e), on_b);
        return;
      }
    const auto twist = [&](const Angular& c) {
      if (l.a >= 0) add_couple(w_, l.a, c, on_a);
      if (l.b >= 0) add_couple(w_, l.b, Angular(-c), on_b);
    };
    if (l.is_distance()) {
      push(S(l.per_length) * s.D);
    } else if (row_of_loop < l.n_points) {
      push(s.b[static_cast<std::size_t>(l.points[static_cast<std::size_t>(row_of_loop)])]);
    } else if (l.is_pair()) {
      const auto& slope = pair(l).terms.slope;
      push(slope[0] * s.b[0] + slope[1] * s.b[1]);
      if (pair(l).measures == 4)
        twist(slope[2] * cross(s.a[0], s.b[0]) + slope[3] * cross(s.a[0], s.b[1]));
    } else {
      const auto [i, j] = l.axes[static_cast<std::size_t>(row_of_loop - l.n_points)];
      twist(cross(s.a[static_cast<std::size_t>(i)], s.b[static_cast<std::size_t>(j)]));
    }
  }

  const LoopModel<Space>& model() const { return *model_; }

 private:
  struct At {
    Vector x_a, x_b, D, u_a, u_b;
    Angular w_a{}, w_b{};
    std::array<Vector, 3> a, b;
    S position{}, rate{}, second{};  ///< of a coupler
    S bending{};  ///< of a coupler: what of Φ̈ has no u̇ in it, drives left out
  };
  /// Of a coordinate with powers: r, dr/dq and ṙ.
  struct Curve {
    S slope{}, bend{}, turning{};
  };
  /// Of a higher pair: F and its derivatives, ẏ, and d/dt ∂F/∂y.
  struct Pair {
    PairPlace place;
    PairTerms<S> terms;
    std::array<S, 4> rate{}, slope_rate{};
    std::size_t measures = 0;  ///< that F depends on
  };
  Curve& curve(const typename LoopModel<Space>::Coupled& c) {
    return curves_[static_cast<std::size_t>(c.curve)];
  }
  const Curve& curve(const typename LoopModel<Space>::Coupled& c) const {
    return curves_[static_cast<std::size_t>(c.curve)];
  }
  EquationRow<Space, S>& equation(const Loop& l) {
    return equations_[static_cast<std::size_t>(l.equation)];
  }
  const EquationRow<Space, S>& equation(const Loop& l) const {
    return equations_[static_cast<std::size_t>(l.equation)];
  }
  static constexpr bool in_space = Space::dimension == 6;
  RollingWheel<S>& wheel(const Loop& l) { return wheels_[static_cast<std::size_t>(l.wheel)]; }
  const RollingWheel<S>& wheel(const Loop& l) const {
    return wheels_[static_cast<std::size_t>(l.wheel)];
  }
  const Wheel& law_of_wheel(const Loop& l) const {
    return model_->wheels[static_cast<std::size_t>(l.wheel)];
  }
  Pair& pair(const Loop& l) { return pairs_[static_cast<std::size_t>(l.pair)]; }
  const Pair& pair(const Loop& l) const { return pairs_[static_cast<std::size_t>(l.pair)]; }
  const HigherPair& law(const Loop& l) const {
    return *model_->pairs[static_cast<std::size_t>(l.pair)];
  }

  /// Derivatives are right to their own size.
  static constexpr bool rounded = std::is_same_v<S, double>;
  using Time = typename TimeOf<S>::type;
  using Driven = DrivenLoop<Space, Time>;

  const Driven& motion(const Loop& l) const { return driven_[static_cast<std::size_t>(l.motion)]; }
  Time given(const Loop& l) const { return l.motion < 0 ? Time(l.given) : motion(l).given; }
  Time given_rate(const Loop& l) const { return l.motion < 0 ? Time(0.0) : motion(l).given_rate; }
  Angular turning_in_ground(int k, const typename Driven::Angular& w) const {
    if constexpr (Space::dimension == 3)
      return S(w);
    else
      return to_ground(w_, k, w);
  }
  /// Angular acceleration of axes on body k that turn by `w` relative to it, ẇ in body axes.
  Angular turning(int k, const typename Driven::Angular& w,
                  const typename Driven::Angular& rate) const {
    Angular sum = angular_acceleration(w_, k) + turning_in_ground(k, rate);
    if constexpr (Space::dimension == 6)
      sum += cross(angular_velocity(w_, k), turning_in_ground(k, w));
    return sum;
  }
  Angular turning_a(const Loop& l) const {
    if (l.motion < 0) return angular_acceleration(w_, l.a);
    return turning(l.a, motion(l).turning_a, motion(l).turning_a_rate);
  }
  Angular turning_b(const Loop& l) const {
    if (l.motion < 0) return angular_acceleration(w_, l.axes_of_b());
    return turning(l.b, motion(l).turning_b, motion(l).turning_b_rate);
  }
  /// d/dt (u_A − u_B); x_B moves on B with v and a: its own + 2 ω × v + a.
  Vector acceleration_apart(const Loop& l, const At& s) const {
    Vector apart = point_acceleration(w_, l.a, s.x_a) - point_acceleration(w_, l.b, s.x_b);
    if (l.motion < 0) return apart;
    const auto& m = motion(l);
    apart -=
        2.0 * cross(angular_velocity(w_, l.b), to_ground(w_, l.b, m.v)) + to_ground(w_, l.b, m.a);
    return apart;
  }

  /// Φ̇ and Φ̈ of D_j and O_ij.
  S point_rate(const At& s, const Vector& b) const {
    return dot(b, s.u_a - s.u_b) + dot(cross(s.w_b, b), s.D);
  }
  S axes_rate(const At& s, const Vector& a, const Vector& b) const {
    return inner(cross(a, b), s.w_a - s.w_b);
  }
  S point_second(const Loop& l, const At& s, const Vector& b) const {
    const Vector bdot = cross(s.w_b, b);
    const Vector bddot = cross(s.w_b, bdot) + cross(turning_b(l), b);
    return dot(b, acceleration_apart(l, s)) + 2.0 * dot(bdot, s.u_a - s.u_b) + dot(bddot, s.D);
  }
  S axes_second(const Loop& l, const At& s, const Vector& a, const Vector& b) const {
    const Vector adot = cross(s.w_a, a), bdot = cross(s.w_b, b);
    return inner(cross(a, b), turning_a(l) - turning_b(l)) + dot(cross(s.w_a, adot), b) +
           2.0 * dot(adot, bdot) + dot(a, cross(s.w_b, bdot));
  }

  void move_pair(const Loop& l, const At& s) {
    Pair& p = pair(l);
    p.rate[0] = point_rate(s, s.b[0]);
    p.rate[1] = point_rate(s, s.b[1]);
    if (p.measures == 4) {
      p.rate[2] = axes_rate(s, s.a[0], s.b[0]);
      p.rate[3] = axes_rate(s, s.a[0], s.b[1]);
    }
    for (std::size_t k = 0; k < p.measures; ++k) {
      p.slope_rate[k] = S(0.0);
      for (std::size_t j = 0; j < p.measures; ++j)
        p.slope_rate[k] += p.terms.bend[k][j] * p.rate[j];
    }
  }

  template <class Point, class Axes, class Distance, class Coupling, class Higher, class Rolling>
  void each_row(Point&& point, Axes&& axes, Distance&& distance, Coupling&& coupling,
                Higher&& higher, Rolling&& rolling) const {
    for (std::size_t i = 0; i < at_.size(); ++i) {
      const auto& l = model_->loops[i];
      const At& s = at_[i];
      int row = l.row;
      if (l.is_distance()) {
        distance(row, l, s);
        continue;
      }
      if (l.is_coupler()) {
        coupling(row, s);
        continue;
      }
      if constexpr (in_space)
        if (l.is_wheel()) {
          for (std::size_t k = 0; k < 3; ++k) rolling(row++, k, l);
          continue;
        }
      for (int j = 0; j < l.n_points; ++j)
        point(row++, l, s, s.b[static_cast<std::size_t>(l.points[static_cast<std::size_t>(j)])]);
      if (l.is_pair()) higher(row++, l, s);
      for (int j = 0; j < l.n_axes; ++j) {
        const auto [x, y] = l.axes[static_cast<std::size_t>(j)];
        axes(row++, l, s, s.a[static_cast<std::size_t>(x)], s.b[static_cast<std::size_t>(y)]);
      }
    }
  }

  /// Sums the rows of each loop into one force at x_A and one couple, then acts on A and, negated,
  /// on B.
  template <class Field, class Point, class Axes>
  void each_loop_wrench(const S* sigma, double factor, Field field, Point&& point, Axes&& axes,
                        bool rate) {
    for (std::size_t i = 0; i < at_.size(); ++i) {
      const auto& l = model_->loops[i];
      const At& s = at_[i];
      if (l.is_equation())
        equation(l).each_wrench(w_, S(factor * sigma[l.row]), rate, [&](int body, const Force& on) {
          field(w_.body[static_cast<std::size_t>(body)]) += on;
        });
      if (l.is_coupler()) continue;
      if constexpr (in_space)
        if (l.is_wheel()) {
          add_wrench_of_wheel(l, sigma, factor, field, rate);
          continue;
        }
      Vector force{}, impulse{};
      Angular couple{};
      int row = l.row;
      if (l.is_distance()) {
        const S scaled = sigma[row] * (factor * l.per_length);
        if (rate) {
          force = scaled * (s.u_a - s.u_b);
          impulse = scaled * s.D;
        } else {
          force = scaled * s.D;
        }
      } else {
        for (int j = 0; j < l.n_points; ++j, ++row) {
          const auto [f, w] =
              point(s, s.b[static_cast<std::size_t>(l.points[static_cast<std::size_t>(j)])]);
          const S scaled = factor * sigma[row];
          force += scaled * f;
          if (rate) impulse += scaled * w;
        }
        if (l.is_pair()) {
          const Pair& p = pair(l);
          const S given = factor * sigma[row++];
          for (std::size_t k = 0; k < 2; ++k) {
            const auto [f, w] = point(s, s.b[k]);
            const S scaled = given * p.terms.slope[k];
            force += scaled * f;
            if (!rate) continue;
            impulse += scaled * w;
            force += (given * p.slope_rate[k]) * s.b[k];
          }
          for (std::size_t k = 2; k < p.measures; ++k) {
            const Vector& b = s.b[k - 2];
            couple += (given * p.terms.slope[k]) * axes(s, s.a[0], b);
            if (rate) couple += (given * p.slope_rate[k]) * cross(s.a[0], b);
          }
        }
        for (int j = 0; j < l.n_axes; ++j, ++row) {
          const auto [x, y] = l.axes[static_cast<std::size_t>(j)];
          couple += S(factor * sigma[row]) *
                    axes(s, s.a[static_cast<std::size_t>(x)], s.b[static_cast<std::size_t>(y)]);
        }
      }
      const Vector& u_on_b = l.is_tie ? s.u_b : s.u_a;
      if (l.a >= 0) {
        Force& on = field(w_.body[static_cast<std::size_t>(l.a)]);
        add_force(w_, l.a, s.x_a, force, on);
        add_couple(w_, l.a, rate ? couple + cross(s.u_a, impulse) : couple, on);
      }
      if (l.b >= 0) {
        Force& on = field(w_.body[static_cast<std::size_t>(l.b)]);
        add_force(w_, l.b, l.is_tie ? s.x_b : s.x_a, Vector(-force), on);
        add_couple(w_, l.b, Angular(rate ? -(couple + cross(u_on_b, impulse)) : -couple), on);
      }
    }
  }

  template <class Field>
  void add_wrench_of_wheel(const Loop& l, const S* sigma, double factor, Field field, bool rate) {
    const auto& rolls = wheel(l);
    Vector impulse{}, force{};
    for (std::size_t k = 0; k < 3; ++k)
      impulse += S(factor * sigma[l.row + static_cast<int>(k)]) * rolls.along[k];
    Angular couple{};
    if (rate) {
      force = cross(rolls.w_b, impulse);
      couple = cross(rolls.moving, impulse);
    } else {
      force = impulse;
    }
    const auto act = [&](int body, const Vector& f, const Angular& c) {
      if (body < 0) return;
      Force& on = field(w_.body[static_cast<std::size_t>(body)]);
      add_force(w_, body, rolls.at, f, on);
      if (rate) add_couple(w_, body, c, on);
    };
    act(l.a, force, couple);
    act(l.b, Vector(-force), Angular(-couple));
  }

  const LoopModel<Space>* model_;
  Workspace<Space, S>& w_;
  std::vector<At> at_;
  std::vector<Curve> curves_;
  std::vector<Pair> pairs_;
  std::vector<RollingWheel<S>> wheels_;
  std::vector<EquationRow<Space, S>> equations_;
  std::vector<Driven> driven_;  ///< at the time of place()
  LostPlaces<Space> lost_;
};

}  // namespace momenta
