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

#include <momenta/dae/mechanism/loop/loop_levels.h>

#include <utility>

namespace momenta {

template <class Space, class S>
class LoopRows : public LoopLevels<Space, S> {
 public:
  using Levels = LoopLevels<Space, S>;
  using Levels::Levels;
  using Levels::ratio;
  using typename Levels::Angular;
  using typename Levels::Force;
  using typename Levels::Loop;
  using typename Levels::Vector;

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

  /// Unit wrench of a row on its bodies, zero for couplers, in the axes of the sweeps: the start of
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

  /// Calls act(body, wrench) for the unit impulse of an equation on each body with points of it;
  /// not for other loops.
  template <class Act>
  void each_point_wrench(const Loop& l, Act&& act) const {
    if (l.is_equation()) equation(l).each_wrench(w_, S(1.0), false, act);
  }

 private:
  using Levels::at_;
  using Levels::curve;
  using Levels::curves_;
  using Levels::equation;
  using Levels::in_space;
  using Levels::model_;
  using Levels::pair;
  using Levels::w_;
  using Levels::wheel;
  using typename Levels::At;
  using typename Levels::Pair;

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
};

}  // namespace momenta
