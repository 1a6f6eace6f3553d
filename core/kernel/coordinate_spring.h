#pragma once
// Springs and dampers along a sum of joint coordinates, l = Σ rᵢ qᵢ:
//
//   f = −k s(l − rest) − c l̇,   Qᵢ = rᵢ f,   s(x) = x, V = ½ k (l − rest)²
//
// or, with a dead band, s and V of dead_band.h. Stops at limits of l: joint_stop.h.
//
// Q_i acts as opposite wrenches on the bodies on either side of joint i, along its axis: forces for
// a slide, couples for an angle. Eᵀ of such a pair is Q_i at joint i and zero elsewhere, so these
// springs go wherever wrenches on bodies do.

#include <momenta/core/kernel/dead_band.h>
#include <momenta/core/kernel/points.h>

namespace momenta {

/// l − rest and l̇. Needs poses, and velocities for the rate.
template <class Space, class S>
S coordinate_stretch(const Workspace<Space, S>& w,
                     const typename Model<Space>::CoordinateSpring& spring) {
  S stretch(-spring.rest);
  for (const auto& term : spring.terms)
    stretch += term.ratio * w.sprung[static_cast<std::size_t>(term.place)].coordinate;
  return stretch;
}
template <class Space, class S>
S coordinate_stretch_rate(const Workspace<Space, S>& w,
                          const typename Model<Space>::CoordinateSpring& spring) {
  S rate{};
  for (const auto& term : spring.terms)
    rate += term.ratio * w.sprung[static_cast<std::size_t>(term.place)].rate;
  return rate;
}

/// Adds a generalised force at the joint of body k to body[k].T, and the reaction to the parent's.
template <class Space, class S>
void add_along_joint(Workspace<Space, S>& w, int k, const S& value) {
  const auto& b = w.model->bodies[static_cast<std::size_t>(k)];
  auto& s = w.body[static_cast<std::size_t>(k)];
  const auto act = [&](int on, const S& amount) {
    if (on < 0) return;
    auto& T = w.body[static_cast<std::size_t>(on)].T;
    if constexpr (Space::dimension == 3) {
      if (b.kind == JointKind::prismatic)
        add_force(w, on, s.pose.origin, amount * s.edge.prismatic, T);
      else
        add_couple(w, on, amount * s.edge.sign, T);
    } else {
      const Vec3<S> along = amount * to_ground(w, k, Vec3<double>{{0, 0, 1}});
      if (b.kind == JointKind::prismatic)
        add_force(w, on, s.pose.origin, along, T);
      else
        add_couple(w, on, along, T);
    }
  };
  act(k, value);
  act(b.parent, -value);
}

/// Adds the forces of coordinate springs to body[k].T. Needs poses and velocities.
template <class Space, class S>
void add_coordinate_springs(Workspace<Space, S>& w) {
  for (const auto& spring : w.model->coordinate_springs) {
    const S stretch = coordinate_stretch(w, spring), rate = coordinate_stretch_rate(w, spring);
    S tension = spring.stiffness * stretched(spring.band, stretch) + spring.damping * rate;
    if (spring.stop.acts()) tension -= stop_force(spring.stop, S(stretch + spring.rest), rate);
    for (const auto& term : spring.terms) add_along_joint(w, term.body, S((-term.ratio) * tension));
  }
}

/// V of all coordinate springs [J].
template <class Space, class S>
S coordinate_spring_energy(const Workspace<Space, S>& w) {
  S energy{};
  for (const auto& spring : w.model->coordinate_springs) {
    const S stretch = coordinate_stretch(w, spring);
    energy += spring.stiffness * stretched_energy(spring.band, stretch);
    if (spring.stop.acts()) energy += stored_energy(spring.stop, S(stretch + spring.rest));
  }
  return energy;
}

/// −c l̇² of all coordinate springs, less the loss of dampers of stops [W].
template <class Space, class S>
S coordinate_spring_power(const Workspace<Space, S>& w) {
  S power{};
  for (const auto& spring : w.model->coordinate_springs) {
    const S rate = coordinate_stretch_rate(w, spring);
    power -= spring.damping * (rate * rate);
    if (spring.stop.acts())
      power -= stop_loss(spring.stop, S(coordinate_stretch(w, spring) + spring.rest), rate);
  }
  return power;
}

}  // namespace momenta
