#pragma once
// Slopes of forces between points of bodies and along sums of coordinates by their own numbers, and
// their wrenches on the bodies where places move. With the virtual motion b, z = −b the direction,
// a force Q has −bᵀ ∂Q/∂n. For a line of length l under the tension f(l, l̇), bᵀQ = −f D_b l, so
//
//   −bᵀ ∂Q/∂n = D_b(f̄ ∂l/∂n) + (f_l D_b l) ∂l/∂n + (f_l̇ D_b l) ∂l̇/∂n + (D_b l) ∂f/∂n,      (15)
//
// f̄ held: what −∫ f dl has along z, f_l̇ left out of its derivative, and an impulse f_l̇ D_b l of no
// value, only of a derivative, along the line. So dampers, dead bands and stops cost no more than
// springs. A force in the axes of its body turns with it, which is a couple F × D_z x. A couple τ
// that stays in ground axes has no potential: with θ_z its body's turn along z it has a couple
// θ_z × τ besides; one that turns with its body has none.

#include <momenta/core/kernel/bushing.h>
#include <momenta/core/kernel/dead_band.h>
#include <momenta/core/kernel/joint_stop.h>
#include <momenta/core/kernel/signals.h>
#include <momenta/dae/gradient/levels/placed_along.h>
#include <momenta/dae/gradient/levels/tangent_sweeps.h>

#include <algorithm>

namespace momenta {

/// k s(l − rest) + c l̇, less the push of stops, of springs of both kinds.
template <class Spring, class S>
S elastic_tension(const Spring& spring, const S& length) {
  return spring.stiffness * stretched(spring.band, S(length - spring.rest));
}
template <class Spring, class S>
S whole_tension(const Spring& spring, const S& length, const S& rate) {
  S tension = elastic_tension(spring, length);
  if (spring.damping != 0) tension += spring.damping * rate;
  if (spring.stop.acts()) tension -= stop_force(spring.stop, length, rate);
  return tension;
}

template <class Space, class S>
class ForceNumbers {
  static constexpr int axes = Space::dimension == 3 ? 2 : 3;
  using Vector = typename Space::template Vector<S>;
  using Angular = decltype(cross(Vector{}, Vector{}));
  using Spring = typename Model<Space>::Spring;
  using Wrench = typename Model<Space>::Wrench;

 public:
  ForceNumbers(const Model<Space>& model, Workspace<Space, S>& w) : model_(model), w_(w) {}

  /// Whether forces choose by values (dead bands, stops, turns of bushings): all lanes need the
  /// same.
  bool choose() const {
    return model_.has_corners || !model_.bushings.empty() ||
           std::any_of(model_.coordinate_springs.begin(), model_.coordinate_springs.end(),
                       [](const auto& spring) { return spring.band != 0; });
  }

  /// Adds wrenches and the impulses of (15) to T and P of the bodies. Needs poses and velocities.
  void hand_to_bodies() {
    for (const Spring& spring : model_.springs) {
      const Line line(w_, spring);
      if (!line.has_direction()) continue;
      line.pull(w_, spring, S(line.tension / line.length));
      if (!line.damps) continue;
      hand_over(w_, spring.child, line.child, line.u_child, line.impulse, line.impulse_rate);
      hand_over(w_, spring.parent, line.parent, line.u_parent, Vector(-line.impulse),
                Vector(-line.impulse_rate));
    }
    for (const Wrench& wrench : model_.wrenches) {
      const Held held(w_, wrench);
      auto& T = w_.body[static_cast<std::size_t>(wrench.body)].T;
      add_force(w_, wrench.body, held.x, held.force, T);
      add_couple(w_, wrench.body, held.couple, T);
    }
  }

  /// Springs between points: ends, k, rest, c, square of the offset; springs of coordinates: k,
  /// rest, c; wrenches: point, force, couple; bushings: k, c, k_r, c_r.
  template <class Put>
  void each(Put&& put) const {
    for (const Spring& spring : model_.springs) {
      const Line line(w_, spring);
      if (!line.has_direction()) {
        put.skip(NumberPlaces<Space>::of_spring);
        continue;
      }
      const Vector pull = S(line.tension / line.length) * line.D;
      const auto end = [&](int body) {
        return Vector(line.impulse_rate - cross(angular_velocity(w_, body), line.impulse));
      };
      put_vector(put, in_body_axes(w_, spring.parent, Vector(pull - end(spring.parent))));
      put_vector(put, in_body_axes(w_, spring.child, Vector(end(spring.child) - pull)));
      put.along(S(-stretched(spring.band, S(line.length - spring.rest))), line.length);
      put(elastic_tension(spring, line.length));
      put.along(S(-line.speed), line.length);
      put(-0.5 * (line.tension / line.length) -
          (0.5 * line.by_rate) * (line.speed / (line.length * line.length)));
    }
    for (const auto& spring : model_.coordinate_springs) {
      S length(0.0), rate(0.0);
      for (const auto& term : spring.terms) {
        const auto& joint = w_.sprung[static_cast<std::size_t>(term.place)];
        length += term.ratio * joint.coordinate;
        rate += term.ratio * joint.rate;
      }
      put.along(S(-stretched(spring.band, S(length - spring.rest))), length);
      put(elastic_tension(spring, length));
      put.along(S(-rate), length);
    }
    for (const Wrench& wrench : model_.wrenches) {
      const Held held(w_, wrench);
      const auto in_own = [&](const Vector& v) {
        return wrench.in_body_axes ? in_body_axes(w_, wrench.body, v) : v;
      };
      put_vector(put, in_body_axes(w_, wrench.body, held.force));
      put_vector(put, in_own(changes(held.x)));
      if constexpr (axes == 3)
        put_vector(put, in_own(as_changes(turned_along(w_, wrench.body))));
      else
        put(as_change(turned_along(w_, wrench.body)));
    }
    for (const auto& bushing : model_.bushings) {
      auto turning = bushing;  // θ whether it is asked for or not
      turning.rotational_stiffness = 1;
      const BushingMotion<Space, S> motion(w_, turning);
      const Angular of_parent = turned_along(w_, bushing.parent),
                    turn = turned_along(w_, bushing.child) - of_parent;
      Vector moved;
      for (int i = 0; i < axes; ++i) moved[i] = change_alone(motion.D[i]);
      put(-0.5 * dot(motion.D, motion.D));
      put(as_change(S(-dot(motion.velocity(), Vector(moved - cross(of_parent, motion.D))))));
      put(-0.5 * bushing_square(motion.turn()));
      put(as_change(S(-product(motion.spin(), turn))));
    }
  }

 private:
  static S product(const S& a, const S& b) { return a * b; }
  static S product(const Vec3<S>& a, const Vec3<S>& b) { return dot(a, b); }
  /// The change of x along the direction, of no value.
  static Vector changes(const Vector& x) {
    Vector all;
    for (int i = 0; i < axes; ++i) all[i].b[0] = x[i].b[0];
    return all;
  }
  static Vector as_changes(const Vector& x) {
    Vector all;
    for (int i = 0; i < axes; ++i) all[i] = as_change(x[i]);
    return all;
  }
  template <class Put>
  static void put_vector(Put& put, const Vector& v) {
    for (const S& x : v.x) put(x);
  }

  /// A spring's line, with (15).
  struct Line : SpringLine<Space, S> {
    bool damps;
    S speed{}, tension{}, by_rate{};  ///< l̇, f; f_l̇ D_b l of no value
    Vector u_child{}, u_parent{}, impulse{}, impulse_rate{};

    Line(const Workspace<Space, S>& w, const Spring& spring)
        : SpringLine<Space, S>(w, spring), damps(spring.damping != 0 || spring.stop.acts()) {
      if (!this->has_direction()) return;
      const S& l = this->length;
      u_child = point_velocity(w, spring.child, this->child);
      u_parent = point_velocity(w, spring.parent, this->parent);
      const Vector apart = u_child - u_parent;
      speed = value_alone(S(dot(this->D, apart) / l));
      tension = whole_tension(spring, l, speed);
      if (!damps) return;
      S moved = speed;
      moved.b[0] = l.b[0];
      by_rate.b[0] = -whole_tension(spring, value_alone(l), moved).b[0];
      const S inverse = S(1.0) / l;
      const Vector along = inverse * this->D;
      impulse = by_rate * along;
      impulse_rate = S(by_rate * inverse) * Vector(apart - speed * along);
    }
  };
  /// A wrench whose force stays where the direction leads, and its couple there.
  struct Held {
    Vector x, force;
    Angular couple{};

    Held(const Workspace<Space, S>& w, const Wrench& wrench)
        : x(point_position(w, wrench.body, wrench.at)) {
      const int axes_of = wrench.in_body_axes ? wrench.body : -1;
      force = to_ground(w, axes_of, wrench.force);
      Vector moved;
      for (int i = 0; i < axes; ++i) {
        force[i] = value_alone(force[i]);
        moved[i].b[0] = x[i].b[0];
      }
      if constexpr (axes == 3) {
        couple = to_ground(w, axes_of, wrench.torque);
        for (int i = 0; i < 3; ++i) couple[i] = value_alone(couple[i]);
        couple += wrench.in_body_axes ? cross(force, moved)
                                      : cross(as_changes(turned_along(w, wrench.body)), couple);
      } else {
        couple = S(wrench.normal_torque);
        if (wrench.in_body_axes) couple += cross(force, moved);
      }
    }
  };

  const Model<Space>& model_;
  Workspace<Space, S>& w_;
};

}  // namespace momenta
