#pragma once
// Points and axes of the loops at one place and one motion, for one algebra and one scalar, from
// which their rows (loop_levels.h) and the impulses of these (loop_rows.h) are made. On body A x_A
// and a_i, on B x_B and b_j, D = x_A − x_B; u_A, u_B, w_a, w_b as there. Couplers, equations, pairs
// and wheels have numbers of their own.

#include <momenta/core/kernel/points.h>
#include <momenta/core/scalar/dual.h>
#include <momenta/dae/mechanism/loop/compensated_positions.h>
#include <momenta/dae/mechanism/loop/driven_loop.h>
#include <momenta/dae/mechanism/loop/higher_pair.h>
#include <momenta/dae/mechanism/loop/loop_equation.h>
#include <momenta/dae/mechanism/loop/rolling_wheel.h>

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
class LoopPlaces {
 public:
  using Vector = typename Space::template Vector<S>;
  using Force = typename Space::template Force<S>;
  using Angular = decltype(cross(Vector{}, Vector{}));  ///< Vec3 in space, S in the plane
  using Loop = typename LoopModel<Space>::Loop;

  LoopPlaces(const LoopModel<Space>& model, Workspace<Space, S>& w)
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

  /// Index of the first loop whose pair, equation or wheel has no value at the last place(); −1:
  /// none.
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
  /// Where the curves of the pair of a loop touched at the last place().
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

  /// Accelerations of couplers and equations; `udot` null: zero. Equations need accelerations.
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

  /// Factor of a coupler on its joint's rate in Φ̇, at the last place().
  S ratio(const typename LoopModel<Space>::Coupled& c) const {
    return c.curve < 0 ? S(c.ratio) : curve(c).slope;
  }

  const LoopModel<Space>& model() const { return *model_; }

 protected:
  struct At {
    Vector x_a, x_b, D, u_a, u_b;
    Angular w_a{}, w_b{};
    std::array<Vector, 3> a, b;
    S position{}, rate{}, second{};  ///< Φ, Φ̇, Φ̈ of a coupler
    S bending{};                     ///< Φ̈ of a coupler at u̇ = 0, drives left out
  };
  /// r, dr/dq and ṙ of a coordinate with powers.
  struct Curve {
    S slope{}, bend{}, turning{};
  };
  /// F of a higher pair and its derivatives, ẏ, and d/dt ∂F/∂y.
  struct Pair {
    PairPlace place;
    PairTerms<S> terms;
    std::array<S, 4> rate{}, slope_rate{};
    std::size_t measures = 0;  ///< number that F depends on
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

  /// Whether lost places are added; derivatives are right to their own size.
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

  /// Φ̇ of D_j and O_ij.
  S point_rate(const At& s, const Vector& b) const {
    return dot(b, s.u_a - s.u_b) + dot(cross(s.w_b, b), s.D);
  }
  S axes_rate(const At& s, const Vector& a, const Vector& b) const {
    return inner(cross(a, b), s.w_a - s.w_b);
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

  const LoopModel<Space>* model_;
  Workspace<Space, S>& w_;
  std::vector<At> at_;
  std::vector<Curve> curves_;
  std::vector<Pair> pairs_;
  std::vector<RollingWheel<S>> wheels_;
  std::vector<EquationRow<Space, S>> equations_;
  std::vector<Driven> driven_;  ///< at the time of place()
  CompensatedPositions<Space> lost_;
};

}  // namespace momenta
