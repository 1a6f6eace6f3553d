#pragma once
// A loop in space at one state, in the axes of poses (loop_plan.h): its points and axes, the force
// F at x_A and the couple c of every row's unit impulse on body A (on B acts the exact negative),
// and what its equations need of velocities. Rows as in dae/mechanism/loop/loop_rows.h.

#include <momenta/core/kernel/spatial.h>
#include <momenta/dae/mechanism/loop/loop_model.h>

namespace momenta {

/// A body that carries an end of a loop, or lies on the way to one; axes of poses.
template <class S>
struct LoopBody {
  Spatial::Pose<S> pose;
  Vec3<S> step;  ///< from the parent's O to its own: without the digits their places have in common
  Vec3<S> v, w;  ///< velocity of O, angular velocity
};

/// `v`: constant in the body; a pack for mechanisms side by side.
template <class S, class Constant>
Vec3<S> in_ground(const LoopBody<S>* body, const Vec3<Constant>& v) {
  Vec3<S> r;
  for (int i = 0; i < 3; ++i)
    r[i] = body ? body->pose.axes(i, 0) * v[0] + body->pose.axes(i, 1) * v[1] +
                      body->pose.axes(i, 2) * v[2]
                : S(v[i]);
  return r;
}

/// Prescribed motion of a loop, ground axes (LoopModel::Motion).
template <class S>
struct PrescribedMotion {
  Vec3<S> v, a;                                                  ///< velocity, acceleration of x_B
  Vec3<S> turning_a, turning_a_rate, turning_b, turning_b_rate;  ///< turning of the axes
  S given{}, given_rate{};                                       ///< l l̇ / l₀, its derivative

  void place(const LoopModel<Spatial>::Loop& l, const LoopModel<Spatial>::Motion& m,
             const LoopBody<S>* A, const LoopBody<S>* B) {
    v = in_ground(B, m.v);
    a = in_ground(B, m.a);
    turning_a = in_ground(A, m.turning_a);
    turning_a_rate = in_ground(A, m.turning_a_rate);
    turning_b = in_ground(B, m.turning_b);
    turning_b_rate = in_ground(B, m.turning_b_rate);
    given = S(l.given * m.given_rate * l.per_length);
    given_rate = S((m.given_rate * m.given_rate + l.given * m.given_second) * l.per_length);
  }
};

template <class S>
struct SpatialLoopPlace {
  Vec3<S> ra, rb, gap;  ///< x_A − O_A, x_A − O_B, D = x_A − x_B
  Vec3<S> F[3];         ///< rows of points
  Vec3<S> c[6];         ///< rows of axes
  Vec3<S> a[3], b[3];

  template <class Loop>
  void place(const Loop& l, const LoopBody<S>* A, const LoopBody<S>* B) {
    ra = in_ground(A, l.at_a);
    const Vec3<S> arm_b = in_ground(B, l.at_b);
    Vec3<S> between{};
    if (A) between += A->pose.origin;
    if (B) between -= B->pose.origin;
    rb = between + ra;
    gap = rb - arm_b;
    if (l.is_distance()) {
      F[0] = S(l.per_length) * gap;
      return;
    }
    if (l.n_axes == 0) {  // rows of axes alone need a and b
      for (int j = 0; j < l.n_points; ++j)
        F[j] =
            in_ground(B, l.axis_b[static_cast<std::size_t>(l.points[static_cast<std::size_t>(j)])]);
      return;
    }
    for (std::size_t j = 0; j < 3; ++j) {
      b[j] = in_ground(B, l.axis_b[j]);
      a[j] = in_ground(A, l.axis_a[j]);
    }
    for (int j = 0; j < l.n_points; ++j) F[j] = b[l.points[static_cast<std::size_t>(j)]];
    for (int j = 0; j < l.n_axes; ++j) {
      const auto [x, y] = l.axes[static_cast<std::size_t>(j)];
      c[l.n_points + j] = cross(a[x], b[y]);
    }
  }

  template <class Loop>
  S position(const Loop& l, int row) const {
    if (l.is_distance()) return (dot(gap, gap) - S(l.given * l.given)) * (0.5 * l.per_length);
    if (row < l.n_points) return dot(F[row], gap);
    const auto [x, y] = l.axes[static_cast<std::size_t>(row - l.n_points)];
    return dot(a[x], b[y]) - l.gamma;
  }

  /// Velocities of x_A on A and of the points of B at x_A and at x_B.
  struct Rates {
    Vec3<S> wa{}, wb{}, u{}, at_a{}, at_b{}, vb{};
    S given{};  ///< l l̇ / l₀
  };
  /// All rates but those of the points of B.
  MOMENTA_INLINE Rates motion(const LoopBody<S>* A, const LoopBody<S>* B) const {
    Rates r;
    if (A) {
      r.wa = A->w;
      r.u = A->v + cross(A->w, ra);
    }
    if (B) {
      r.wb = B->w;
      r.vb = B->v;
    }
    return r;
  }
  MOMENTA_INLINE void add_points(const LoopBody<S>* B, Rates& r) const {
    if (!B) return;
    r.at_a = B->v + cross(B->w, rb);
    r.at_b = B->v + cross(B->w, rb - gap);
  }

  /// The frame of B moves on B, that of A turns on A.
  void add_prescribed(const PrescribedMotion<S>& p, Rates& r) const {
    r.wa += p.turning_a;
    r.wb += p.turning_b;
    r.at_a += p.v + cross(p.turning_b, gap);
    r.at_b += p.v;
    r.given = p.given;
  }

  template <class Loop>
  S velocity(const Loop& l, const Rates& r, int row) const {
    const S along = row < l.first_rows() ? dot(F[row], r.u - r.at_a) : dot(c[row], r.wa - r.wb);
    return along - r.given;
  }
  /// Φ_t
  template <class Loop>
  S moving_rate(const Loop& l, const PrescribedMotion<S>& p, int row) const {
    Rates r;
    add_prescribed(p, r);
    return velocity(l, r, row);
  }
  /// J̇ V + d/dt Φ_t; `r` with what is prescribed.
  template <class Loop>
  S moving_bias(const Loop& l, const LoopBody<S>* A, const LoopBody<S>* B,
                const PrescribedMotion<S>& p, const Rates& r, int row) const {
    Vec3<S> apart{}, alpha_a = p.turning_a_rate, alpha_b = p.turning_b_rate;
    if (A) {
      apart += cross(A->w, cross(A->w, ra));
      alpha_a += cross(A->w, p.turning_a);
    }
    if (B) {
      apart -= cross(B->w, cross(B->w, rb - gap)) + S(2.0) * cross(B->w, p.v);
      alpha_b += cross(B->w, p.turning_b);
    }
    apart -= p.a;
    const Vec3<S> u = r.u - r.at_b;
    if (l.is_distance()) return dot(u, u) * l.per_length + dot(F[row], apart) - p.given_rate;
    if (row >= l.n_points)
      return dot(axis_rate(l, r, row), r.wa - r.wb) + dot(c[row], alpha_a - alpha_b);
    const Vec3<S> turning = cross(r.wb, F[row]);
    return dot(F[row], apart) + S(2.0) * dot(turning, u) +
           dot(cross(r.wb, turning) + cross(alpha_b, F[row]), gap);
  }
  /// Vector whose part along b_j is J̇ V of a point: (ω_B × b)·x = b·(x × ω_B).
  Vec3<S> apart_bias(const Rates& r) const {
    return cross(r.wa, cross(r.wa, ra)) - cross(r.wb, r.u - r.vb) + cross(r.u - r.at_a, r.wb);
  }
  /// J̇ V: Φ̈ without the accelerations of the two bodies; `apart` as above.
  template <class Loop>
  S bias(const Loop& l, const Rates& r, const Vec3<S>& apart, int row) const {
    if (l.is_distance()) {
      const Vec3<S> u = r.u - r.at_b;
      return dot(u, u) * l.per_length +
             dot(F[row], cross(r.wa, cross(r.wa, ra)) - cross(r.wb, cross(r.wb, rb - gap)));
    }
    return row < l.n_points ? dot(F[row], apart) : dot(axis_rate(l, r, row), r.wa - r.wb);
  }
  /// d/dt (a_i × b_j)
  template <class Loop>
  Vec3<S> axis_rate(const Loop& l, const Rates& r, int row) const {
    const auto [x, y] = l.axes[static_cast<std::size_t>(row - l.n_points)];
    return cross(cross(r.wa, a[x]), b[y]) + cross(a[x], cross(r.wb, b[y]));
  }

  /// N − κ w of the impulses σ(row), as force at x_A and couple on A.
  template <class Loop, class Sigma>
  MOMENTA_INLINE void inertial_rate(const Loop& l, const Rates& r, const Sigma& sigma, double leak,
                                    Vec3<S>& force, Vec3<S>& couple) const {
    Vec3<S> f{}, n{}, turning{};
    for (int row = 0; row < l.rows; ++row) {
      const S s = sigma(row);
      if (row < l.n_points || l.is_distance()) {
        f += s * F[row];
      } else {
        n += s * c[row];
        turning += s * axis_rate(l, r, row);
      }
    }
    force = l.is_distance() ? (sigma(0) * l.per_length) * (r.u - r.at_b) : cross(r.wb, f);
    couple = turning + cross(r.u, f);
    if (leak != 0) {
      force -= S(leak) * f;
      couple -= S(leak) * n;
    }
  }
};

}  // namespace momenta
