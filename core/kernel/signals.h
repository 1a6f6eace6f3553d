#pragma once
// Signals (core/scene/formula.h) of a model at one state, in every scalar: s and ṡ, and a
// generalised force f along s handed to the bodies as wrenches, whose power is f ṡ:
//
//   Σ ratios q   along each joint, ratio · f                        coordinates, coordinate springs
//   eᵀx          the force f e at the point x                       positions of markers
//   l = |D|      the forces f D/l on the child, −f D/l on the parent
//   eᵀv, eᵀω     the force f e at a point, the couple f e           components of wrenches
//
// The last have rates alone. A force along s acts along ṡ, since ∂ṡ/∂u = ∂s/∂q.

#include <momenta/core/kernel/coordinate_spring.h>
#include <momenta/core/scalar/dual.h>

namespace momenta {

/// The line between two points: D = x_child − x_parent and its length, with an offset across the
/// plane.
template <class Space, class S>
struct SpringLine {
  typename Space::template Vector<S> parent, child, D;
  S length;
  SpringLine(const Workspace<Space, S>& w, const typename Model<Space>::Spring& spring)
      : parent(point_position(w, spring.parent, spring.at_parent)),
        child(point_position(w, spring.child, spring.at_child)),
        D(child - parent) {
    using std::sqrt;
    length = sqrt(dot(D, D) + spring.offset2);
  }
  /// Whether the points are apart.
  bool has_direction() const { return value_of(length) != 0; }
  /// dl/dt. Needs velocities. @pre has_direction()
  S rate(const Workspace<Space, S>& w, const typename Model<Space>::Spring& spring) const {
    return dot(D,
               point_velocity(w, spring.child, child) - point_velocity(w, spring.parent, parent)) /
           length;
  }
  /// Adds opposite forces on both bodies that pull them together.
  void pull(Workspace<Space, S>& w, const typename Model<Space>::Spring& spring,
            const S& by_length) const {
    const auto f = by_length * D;
    if (spring.child >= 0)
      add_force(w, spring.child, child, -f, w.body[static_cast<std::size_t>(spring.child)].T);
    if (spring.parent >= 0)
      add_force(w, spring.parent, parent, f, w.body[static_cast<std::size_t>(spring.parent)].T);
  }
};

/// The direction of a signal at a point, ground axes.
template <class Space, class S>
auto direction_of(const Workspace<Space, S>& w, const typename Model<Space>::Signal& s) {
  return to_ground(w, s.in_body_axes ? s.ends.child : -1, s.along);
}

/// s. Needs poses; w.time for the time. @pre no turn
template <class Space, class S>
S signal_place(const Workspace<Space, S>& w, const typename Model<Space>::Signal& s) {
  using Of = typename Model<Space>::Signal::Of;
  switch (s.of) {
    case Of::time:
      return w.time;
    case Of::sum: {
      S sum{};
      for (const auto& term : s.terms)
        sum += term.ratio * w.sprung[static_cast<std::size_t>(term.place)].coordinate;
      return sum;
    }
    case Of::point:
      return S(s.across) +
             dot(direction_of(w, s), point_position(w, s.ends.child, s.ends.at_child));
    case Of::distance:
      return SpringLine<Space, S>(w, s.ends).length;
    case Of::turn:
      break;
  }
  return S{};
}

/// ṡ. Needs poses and velocities.
template <class Space, class S>
S signal_rate(const Workspace<Space, S>& w, const typename Model<Space>::Signal& s) {
  using Of = typename Model<Space>::Signal::Of;
  switch (s.of) {
    case Of::time:
      return S(1.0);
    case Of::sum: {
      S sum{};
      for (const auto& term : s.terms)
        sum += term.ratio * w.sprung[static_cast<std::size_t>(term.place)].rate;
      return sum;
    }
    case Of::point: {
      const auto x = point_position(w, s.ends.child, s.ends.at_child);
      return dot(direction_of(w, s), point_velocity(w, s.ends.child, x));
    }
    case Of::distance: {
      const SpringLine<Space, S> line(w, s.ends);
      return line.has_direction() ? line.rate(w, s.ends) : S(0.0);
    }
    case Of::turn:
      if constexpr (Space::dimension == 3)
        return s.across * angular_velocity(w, s.ends.child);
      else
        return dot(direction_of(w, s), angular_velocity(w, s.ends.child));
  }
  return S{};
}

/// Value of the signal in a formula: s, or ṡ where it is a rate.
template <class Space, class S>
S signal_value(const Workspace<Space, S>& w, const typename Model<Space>::Signal& s) {
  return s.is_rate ? signal_rate(w, s) : signal_place(w, s);
}

/// Adds the generalised force f along s to body[k].T. Needs poses.
template <class Space, class S>
void add_along_signal(Workspace<Space, S>& w, const typename Model<Space>::Signal& s, const S& f) {
  using Of = typename Model<Space>::Signal::Of;
  const int k = s.ends.child;
  switch (s.of) {
    case Of::time:
      return;
    case Of::sum:
      for (const auto& term : s.terms) add_along_joint(w, term.body, S(term.ratio * f));
      return;
    case Of::point:
      if (k >= 0)
        add_force(w, k, point_position(w, k, s.ends.at_child), f * direction_of(w, s),
                  w.body[static_cast<std::size_t>(k)].T);
      return;
    case Of::distance: {
      const SpringLine<Space, S> line(w, s.ends);
      if (line.has_direction()) line.pull(w, s.ends, S(-f / line.length));
      return;
    }
    case Of::turn:
      if (k < 0) return;
      if constexpr (Space::dimension == 3)
        add_couple(w, k, S(s.across * f), w.body[static_cast<std::size_t>(k)].T);
      else
        add_couple(w, k, f * direction_of(w, s), w.body[static_cast<std::size_t>(k)].T);
      return;
  }
}

}  // namespace momenta
