#pragma once
// An equation of a scene, Φ = F(x) of coordinates, positions of markers and the time, in every
// scalar. F and its derivatives F_k, F_kl are tapes (core/expression).
//
//   x = q_i       ẋ = u_i,  ẍ = u̇_i        impulse p_i += F_k s, N: ṗ_i += Ḟ_k s
//   x = e·x_P     ẋ = e·v_P, ẍ = e·a_P     impulse on the body: force F_k s e at x_P
//                                          N: force Ḟ_k s e at x_P, couple v_P × F_k s e
//   x = f(t), t   ẋ = ḟ, ẍ = f̈             none: coordinates that drives prescribe, and the time
//
//   Φ̇ = Σ F_k ẋ_k,  Ḟ_k = Σ F_kl ẋ_l,  Φ̈ = Σ F_k ẍ_k + Σ Ḟ_k ẋ_k
//
// e is an axis of the ground, s the impulse σ of the row; N as in loop_rows.h.
//
// An equation of velocities is F(x, r) = 0, linear in r, the rates of some of these x: A u − b.
//
//   r = u_i       ṙ = u̇_i                  impulse p_i += F_r s, N: ṗ_i += (d/dt F_r) s
//   r = e·v_P     ṙ = e·a_P                impulse on the body: force F_r s e at x_P
//                                          N: force (d/dt F_r) s e at x_P, couple v_P × F_r s e
//   r = ḟ(t)      ṙ = f̈                    none
//
//   d/dt F = Σ F_r ṙ + Σ F_x ẋ,  d/dt F_r = Σ F_rx ẋ
//
// It has no position: Φ = 0. N is Ȧᵀσ, and not (A u)_qᵀσ: docs/theory/higher-pairs.md, section 4.

#include <momenta/core/expression/evaluate.h>
#include <momenta/core/kernel/points.h>
#include <momenta/dae/mechanism/loop/driven_loop.h>

#include <vector>

namespace momenta {

template <class Space>
struct LoopEquation {
  using Vector = typename Space::template Vector<double>;
  enum class Of { time, law, coordinate, point, law_rate, coordinate_rate, point_rate };
  struct Input {
    Of of = Of::time;
    int place = -1;  ///< index into laws, joints or points
  };
  struct Joint {
    int q = 0, u = 0;
  };
  struct Point {
    int body = -1;      ///< −1: ground
    Vector at, along;   ///< body axes; ground axes of the model
    double across = 0;  ///< part of the position across the plane of a planar scene
  };
  Expression formula;  ///< F, all F_k, F_kl for l up to k
  std::vector<Input> inputs;
  std::vector<MotionLaw> laws;
  std::vector<Joint> joints;
  std::vector<int> input_of_joint;  ///< by place among the loop's joints
  std::vector<Point> points;
  std::vector<int> bodies;  ///< bodies with points, each once
  std::vector<int> way;     ///< these, the joints' bodies and all towards the ground, last first
  bool moves = false;       ///< ∂F/∂t may be nonzero, or, of velocities, b
  bool of_rates = false;    ///< an equation of velocities

  LoopEquation(Expression f) : formula(std::move(f)) {}
};

template <class Space, class S>
class EquationRow {
 public:
  using Vector = typename Space::template Vector<S>;
  using Force = typename Space::template Force<S>;

  explicit EquationRow(const LoopEquation<Space>& equation)
      : e_(&equation),
        x_(equation.inputs.size()),
        rate_(x_.size()),
        second_(x_.size()),
        turning_(x_.size()),
        line_(equation.formula.tape().size()),
        values_(equation.formula.outputs().size()),
        at_(equation.points.size()),
        velocity_(at_.size()),
        along_(at_.size()) {}

  /// Needs poses.
  void place(const Workspace<Space, S>& w, double t, const S* q) {
    using Time = typename TimeOf<S>::type;
    const Time now = Moment<Time>::at(t);
    for (std::size_t i = 0; i < at_.size(); ++i) {
      const auto& p = e_->points[i];
      at_[i] = point_position(w, p.body, p.at);
      along_[i] = to_ground(w, -1, p.along);
    }
    for (std::size_t k = 0; k < x_.size(); ++k) {
      const auto place = static_cast<std::size_t>(e_->inputs[k].place);
      switch (e_->inputs[k].of) {
        case Of::time:
          x_[k] = S(now);
          rate_[k] = S(1.0);
          second_[k] = S(0.0);
          break;
        case Of::law: {
          Time f{}, rate{}, second{};
          e_->laws[place].evaluate(now, f, rate, second);
          x_[k] = S(f);
          rate_[k] = S(rate);
          second_[k] = S(second);
          break;
        }
        case Of::coordinate:
          x_[k] = q[e_->joints[place].q];
          break;
        case Of::point:
          x_[k] = S(e_->points[place].across) + dot(along_[place], at_[place]);
          break;
        case Of::law_rate: {
          Time f{}, rate{}, second{};
          e_->laws[place].evaluate(now, f, rate, second);
          x_[k] = S(rate);
          second_[k] = S(second);
          rate_[k] = S(0.0);
          break;
        }
        case Of::coordinate_rate:
        case Of::point_rate:
          x_[k] = rate_[k] = S(0.0);
          break;
      }
    }
    evaluate(e_->formula, x_.data(), line_.data(), values_.data());
  }

  /// Needs velocities. `u` null: zero.
  void move(const Workspace<Space, S>& w, const S* u) {
    for (std::size_t i = 0; i < at_.size(); ++i)
      velocity_[i] = point_velocity(w, e_->points[i].body, at_[i]);
    for (std::size_t k = 0; k < x_.size(); ++k) {
      const auto place = static_cast<std::size_t>(e_->inputs[k].place);
      if (e_->inputs[k].of == Of::coordinate) rate_[k] = u ? u[e_->joints[place].u] : S(0.0);
      if (e_->inputs[k].of == Of::point) rate_[k] = dot(along_[place], velocity_[place]);
      if (e_->inputs[k].of == Of::coordinate_rate) x_[k] = u ? u[e_->joints[place].u] : S(0.0);
      if (e_->inputs[k].of == Of::point_rate) x_[k] = dot(along_[place], velocity_[place]);
    }
    if (e_->of_rates) evaluate(e_->formula, x_.data(), line_.data(), values_.data());
    for (std::size_t k = 0; k < x_.size(); ++k) {
      turning_[k] = S(0.0);
      for (std::size_t l = 0; l < x_.size(); ++l) turning_[k] += bend(k, l) * rate_[l];
    }
  }

  S position() const { return e_->of_rates ? S(0.0) : values_[0]; }
  S rate() const {
    if (e_->of_rates) return values_[0];
    return sum([&](std::size_t k) { return slope(k) * rate_[k]; });
  }
  /// Needs accelerations. `udot` null: zero.
  S second(const Workspace<Space, S>& w, const S* udot) const {
    return sum([&](std::size_t k) {
      const auto place = static_cast<std::size_t>(e_->inputs[k].place);
      const Of of = e_->inputs[k].of;
      if (e_->of_rates && !is_rate(of)) return slope(k) * rate_[k];
      S x = second_[k];
      if (of == Of::coordinate || of == Of::coordinate_rate)
        x = udot ? udot[e_->joints[place].u] : S(0.0);
      if (of == Of::point || of == Of::point_rate)
        x = dot(along_[place], point_acceleration(w, e_->points[place].body, at_[place]));
      if (e_->of_rates) return slope(k) * x;
      return slope(k) * x + turning_[k] * rate_[k];
    });
  }
  /// F_k and Ḟ_k of a coordinate, by place among the joints.
  const S& slope_of(std::size_t joint) const { return slope(input(joint)); }
  const S& turning_of(std::size_t joint) const { return turning_[input(joint)]; }

  /// Calls act(body, force) once for each body with points: the impulse of `s`, or its N.
  template <class Act>
  void each_wrench(const Workspace<Space, S>& w, const S& s, bool rate, Act&& act) const {
    for (const int body : e_->bodies) {
      Force on{};
      for (std::size_t k = 0; k < x_.size(); ++k) {
        if (e_->inputs[k].of != (e_->of_rates ? Of::point_rate : Of::point)) continue;
        const auto place = static_cast<std::size_t>(e_->inputs[k].place);
        if (e_->points[place].body != body) continue;
        const Vector impulse = S(slope(k) * s) * along_[place];
        add_force(w, body, at_[place], rate ? Vector(S(turning_[k] * s) * along_[place]) : impulse,
                  on);
        if (rate) add_couple(w, body, cross(velocity_[place], impulse), on);
      }
      act(body, on);
    }
  }
  bool finite() const {
    double sum = 0;
    for (const S& x : values_) sum += 0 * value_of(x);
    return sum == 0;
  }

 private:
  using Of = typename LoopEquation<Space>::Of;
  static constexpr bool is_rate(Of of) {
    return of == Of::law_rate || of == Of::coordinate_rate || of == Of::point_rate;
  }
  std::size_t input(std::size_t joint) const {
    return static_cast<std::size_t>(e_->input_of_joint[joint]);
  }
  const S& slope(std::size_t k) const { return values_[1 + k]; }
  const S& bend(std::size_t k, std::size_t l) const {
    if (l > k) return bend(l, k);
    return values_[1 + x_.size() + k * (k + 1) / 2 + l];
  }
  template <class Term>
  S sum(Term&& term) const {
    S all(0.0);
    for (std::size_t k = 0; k < x_.size(); ++k) all += term(k);
    return all;
  }

  const LoopEquation<Space>* e_;
  std::vector<S> x_, rate_, second_, turning_, line_, values_;
  std::vector<Vector> at_, velocity_, along_;
};

}  // namespace momenta
