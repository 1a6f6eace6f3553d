#pragma once
// What a joint does in each algebra: its place at q, its motion E u, and the projection Eᵀ F. All E
// but those of user joints are constant in body axes (revolute, prismatic: z; helical: z twice, E =
// (0, 0, pitch; 0, 0, 1); spherical, free: unit matrices), so Ė of eq. (35) vanishes. A user joint
// brings E and Ė with its formula. Other kinds are chains of these.

#include <momenta/core/kernel/model.h>
#include <momenta/core/kernel/user_motion.h>

#include <limits>

namespace momenta {

template <class Space>
struct Joint;

template <>
struct Joint<Spatial> {
  using Body = Model<Spatial>::Body;

  /// `value`: q of a one-dof joint or its prescribed position; `q`: block of a spherical or free
  /// joint.
  template <class S>
  static void place(const Body& b, const Spatial::Edge<S>* /*parent*/, const S& value, const S* q,
                    Spatial::Edge<S>& e) {
    using std::cos, std::sin;
    switch (b.kind) {
      case JointKind::revolute: {
        const S theta = value + b.theta0;
        e.cos_theta = cos(theta);
        e.sin_theta = sin(theta);
        e.d = S(b.d0);
        break;
      }
      case JointKind::prismatic:
        e.cos_theta = S(std::cos(b.theta0));
        e.sin_theta = S(std::sin(b.theta0));
        e.d = value + b.d0;
        break;
      case JointKind::helical: {
        const S theta = value + b.theta0;
        e.cos_theta = cos(theta);
        e.sin_theta = sin(theta);
        e.d = b.pitch * value + b.d0;
        break;
      }
      case JointKind::weld:
        e.cos_theta = S(std::cos(b.theta0));
        e.sin_theta = S(std::sin(b.theta0));
        e.d = S(b.d0);
        break;
      case JointKind::spherical:
      case JointKind::free: {
        const double c = std::cos(b.theta0), s = std::sin(b.theta0);
        e.rotation = rotation_of(b.kind == JointKind::free ? q + 3 : q);
        if (b.kind == JointKind::free)
          e.position = {{c * q[0] - s * q[1], s * q[0] + c * q[1], q[2] + b.d0}};
        else
          e.position = {{S(0.0), S(0.0), S(b.d0)}};
        if (b.theta0 != 0)
          for (int j = 0; j < 3; ++j) {
            Vec3<S> column = e.rotation.column(j);
            turn<2>(column, c, s);
            e.rotation.set_column(j, column);
          }
        break;
      }
      default:
        break;
    }
  }

  /// The pose, E and Ω_t of a user joint at (t, q) into `own`, which the edge points to from now
  /// on.
  template <class S>
  static void place(const Body& b, const S& t, const S* q, UserMotion<S>& own,
                    Spatial::Edge<S>& e) {
    own.t = t;
    for (int i = 0; i < b.nq; ++i) own.q[i] = q[i];
    user_motion(*b.law, static_cast<const S*>(nullptr), own);
    e.own = &own;
    const double c = std::cos(b.theta0), s = std::sin(b.theta0);
    e.rotation = own.rotation;
    e.position = own.position;
    turn<2>(e.position, c, s);
    e.position[2] += S(b.d0);
    for (int j = 0; j < 3; ++j) {
      Vec3<S> column = e.rotation.column(j);
      turn<2>(column, c, s);
      e.rotation.set_column(j, column);
    }
  }
  /// Ė and dΩ_t/dt along (u, 1) of a user joint that is in its place.
  template <class S>
  static void move(const Body& b, const Spatial::Edge<S>& e, const S* u) {
    user_motion(*b.law, u, *e.own);
  }
  /// V += Ė u + dΩ_t/dt; after move.
  template <class S>
  static void add_motion_rate(const Body& b, const Spatial::Edge<S>& e, const S* u,
                              Spatial::Motion<S>& v) {
    v += e.own->drift_rate;
    for (int j = 0; j < b.nv; ++j)
      for (int i = 0; i < 6; ++i) v[i] += e.own->E_rate[j][i] * u[j];
  }
  /// ṗ += Ėᵀ P of (35); after move.
  template <class S>
  static void add_axis_rate(const Body& b, const Spatial::Edge<S>& e, const Spatial::Force<S>& P,
                            S* pdot) {
    for (int j = 0; j < b.nv; ++j) pdot[j] += Spatial::power(P, e.own->E_rate[j]);
  }

  /// V += E u
  template <class S>
  static void add_motion(const Body& b, const Spatial::Edge<S>& e, const S* u,
                         Spatial::Motion<S>& v) {
    switch (b.kind) {
      case JointKind::revolute:
        v.w[2] += u[0];
        break;
      case JointKind::prismatic:
        v.v[2] += u[0];
        break;
      case JointKind::helical:
        v.v[2] += b.pitch * u[0];
        v.w[2] += u[0];
        break;
      case JointKind::spherical:
        for (int i = 0; i < 3; ++i) v.w[i] += u[i];
        break;
      case JointKind::free:
        for (int i = 0; i < 6; ++i) v[i] += u[i];
        break;
      case JointKind::user:
        for (int j = 0; j < b.nv; ++j)
          for (int i = 0; i < 6; ++i) v[i] += e.own->E[j][i] * u[j];
        break;
      default:  // weld
        break;
    }
  }

  /// p = Eᵀ F, eq. (34).
  template <class S>
  static void project(const Body& b, const Spatial::Edge<S>& e, const Spatial::Force<S>& f, S* p) {
    switch (b.kind) {
      case JointKind::revolute:
        p[0] = f.n[2];
        break;
      case JointKind::prismatic:
        p[0] = f.f[2];
        break;
      case JointKind::helical:
        p[0] = b.pitch * f.f[2] + f.n[2];
        break;
      case JointKind::spherical:
        for (int i = 0; i < 3; ++i) p[i] = f.n[i];
        break;
      case JointKind::free:
        for (int i = 0; i < 6; ++i) p[i] = f[i];
        break;
      case JointKind::user:
        for (int j = 0; j < b.nv; ++j) p[j] = Spatial::power(f, e.own->E[j]);
        break;
      default:  // weld
        break;
    }
  }

  /// Eᵀ F of a one-dof joint.
  template <class S>
  static S along(const Body& b, const Spatial::Edge<S>&, const Spatial::Force<S>& f) {
    if (b.kind == JointKind::helical) return b.pitch * f.f[2] + f.n[2];
    return b.kind == JointKind::revolute ? f.n[2] : f.f[2];
  }

  /// U = M* E of a one-dof joint.
  template <class S>
  static Spatial::Force<S> column(const Body& b, const Spatial::Edge<S>&,
                                  const Spatial::ArticulatedInertia<S>& m) {
    const Spatial::Force<S> turning{m.H.column(2), {{m.I(0, 2), m.I(1, 2), m.I(2, 2)}}};
    if (b.kind == JointKind::revolute) return turning;
    Spatial::Force<S> U{{{m.A(0, 2), m.A(1, 2), m.A(2, 2)}}, {{m.H(2, 0), m.H(2, 1), m.H(2, 2)}}};
    if (b.kind == JointKind::helical)
      for (int i = 0; i < 6; ++i) U[i] = b.pitch * U[i] + turning[i];
    return U;
  }

  /// Positive where a one-dof joint has inertia to move. M_j itself for a pin, whose M' is free of
  /// dust; less what rounding may leave of all the mass carried where a slide or a screw is
  /// eliminated: behind two slides there is no mass along a third in their plane, but for rounding.
  template <class S>
  static S inertia_margin(const Body& b, const Spatial::ArticulatedInertia<S>& m,
                          const S& joint_mass) {
    constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();
    if (b.kind == JointKind::revolute) return joint_mass;
    const S least(rounding * b.subtree_mass);
    if (b.kind == JointKind::prismatic) return joint_mass - least;
    const S turning = m.I(0, 0) + m.I(1, 1) + m.I(2, 2);
    return joint_mass - (b.pitch * b.pitch * least + rounding * turning);
  }

  /// M* − U hᵀ with h = U / M_j, eq. (47). The joint's own row and column vanish exactly: dust left
  /// there would pass for the inertia of a joint that has none. See reduce_screw for helical ones.
  template <class S>
  static void reduce(const Body& b, Spatial::ArticulatedInertia<S>& m, const Spatial::Force<S>& u,
                     const Spatial::Force<S>& h) {
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j) {
        m.A(i, j) -= u.f[i] * h.f[j];
        m.I(i, j) -= u.n[i] * h.n[j];
      }
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) m.H(i, j) -= u.f[i] * h.n[j];
    if (b.kind == JointKind::helical) return reduce_screw(b.pitch, m);
    for (int i = 0; i < 3; ++i)
      if (b.kind == JointKind::revolute)
        m.H(i, 2) = m.I(i, 2) = S(0.0);
      else
        m.H(2, i) = m.A(i, 2) = S(0.0);
  }

 private:
  /// M' E = 0 ties two rows and columns of M' together: pitch M'(·, v_z) + M'(·, ω_z) = 0. One of
  /// them is made from the other, so that this holds as written and M' stays symmetric; the one
  /// that is then multiplied by a number below one.
  template <class S>
  static void reduce_screw(double pitch, Spatial::ArticulatedInertia<S>& m) {
    if (std::abs(pitch) <= 1) {
      for (int i = 0; i < 3; ++i) m.H(i, 2) = -pitch * m.A(i, 2);
      for (int i = 0; i < 2; ++i) m.I(i, 2) = -pitch * m.H(2, i);
      m.I(2, 2) = -pitch * m.H(2, 2);
    } else {
      const double inverse = 1 / pitch;
      for (int i = 0; i < 3; ++i) m.H(2, i) = -inverse * m.I(i, 2);
      for (int i = 0; i < 2; ++i) m.A(i, 2) = -inverse * m.H(i, 2);
      m.A(2, 2) = -inverse * m.H(2, 2);
    }
  }
};

template <>
struct Joint<Planar> {
  using Body = Model<Planar>::Body;

  template <class S>
  static void place(const Body& b, const Planar::Edge<S>* parent, const S& value, const S* /*q*/,
                    Planar::Edge<S>& e) {
    using std::cos, std::sin;
    const auto turned = [&](double x, double y) -> Vec2<S> {
      if (!parent) return {{S(x), S(y)}};
      return {{parent->c * x - parent->s * y, parent->s * x + parent->c * y}};
    };
    e.r = turned(b.edge.x, b.edge.y);
    if (b.kind == JointKind::revolute) {
      e.angle = b.edge.sign * value;
      if (parent) e.angle += parent->angle;
      e.c = cos(e.angle);
      e.s = sin(e.angle);
      e.sign = S(b.edge.sign);
      return;
    }
    if (parent) {
      e.angle = parent->angle;
      e.c = parent->c;
      e.s = parent->s;
    }
    if (b.kind == JointKind::prismatic) {
      e.slide = turned(b.edge.slide_x, b.edge.slide_y);
      e.r += value * e.slide;
    }
  }

  template <class S>
  static void add_motion(const Body& b, const Planar::Edge<S>& e, const S* u,
                         Planar::Motion<S>& v) {
    if (b.kind == JointKind::revolute)
      v.w += b.edge.sign * u[0];
    else if (b.kind == JointKind::prismatic)
      v.v += u[0] * e.slide;
  }

  template <class S>
  static void project(const Body& b, const Planar::Edge<S>& e, const Planar::Force<S>& f, S* p) {
    if (b.kind == JointKind::revolute)
      p[0] = b.edge.sign * f.n;
    else if (b.kind == JointKind::prismatic)
      p[0] = dot(e.slide, f.f);
  }

  template <class S>
  static S along(const Body& b, const Planar::Edge<S>& e, const Planar::Force<S>& f) {
    return b.kind == JointKind::revolute ? S(b.edge.sign * f.n) : dot(e.slide, f.f);
  }

  template <class S>
  static Planar::Force<S> column(const Body& b, const Planar::Edge<S>& e,
                                 const Planar::ArticulatedInertia<S>& m) {
    if (b.kind == JointKind::revolute) return {e.sign * m.H, e.sign * m.I};
    const Vec2<S>& s = e.slide;
    return {{{m.xx * s[0] + m.xy * s[1], m.xy * s[0] + m.yy * s[1]}}, dot(m.H, s)};
  }

  template <class S>
  static S inertia_margin(const Body& b, const Planar::ArticulatedInertia<S>&,
                          const S& joint_mass) {
    constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();
    return b.kind == JointKind::revolute ? joint_mass : joint_mass - S(rounding * b.subtree_mass);
  }

  template <class S>
  static void reduce(const Body& b, Planar::ArticulatedInertia<S>& m, const Planar::Force<S>& u,
                     const Planar::Force<S>& h) {
    m.xx -= u.f[0] * h.f[0];
    m.xy -= u.f[0] * h.f[1];
    m.yy -= u.f[1] * h.f[1];
    m.H[0] -= u.f[0] * h.n;
    m.H[1] -= u.f[1] * h.n;
    m.I -= u.n * h.n;
    if (b.kind == JointKind::revolute) {
      m.H = {};
      m.I = S(0.0);
    }
  }
};

/// Rates of the coordinates of one joint: q̇ = u, or the kinematics of position and quaternion.
/// q̇_quaternion = ½ q ∘ (0, ω), position rate = R v, with ω and v in child axes.
template <class S>
void coordinate_rates(JointKind kind, const S* q, const S* u, S* qdot) {
  switch (kind) {
    case JointKind::revolute:
    case JointKind::prismatic:
    case JointKind::helical:
      qdot[0] = u[0];
      return;
    default:  // weld
      return;
    case JointKind::free: {
      const Vec3<S> v = rotation_of(q + 3) * Vec3<S>{{u[0], u[1], u[2]}};
      for (int i = 0; i < 3; ++i) qdot[i] = v[i];
      q += 3;
      u += 3;
      qdot += 3;
      [[fallthrough]];
    }
    case JointKind::spherical:
      qdot[0] = -0.5 * (q[1] * u[0] + q[2] * u[1] + q[3] * u[2]);
      qdot[1] = 0.5 * (q[0] * u[0] + q[2] * u[2] - q[3] * u[1]);
      qdot[2] = 0.5 * (q[0] * u[1] + q[3] * u[0] - q[1] * u[2]);
      qdot[3] = 0.5 * (q[0] * u[2] + q[1] * u[1] - q[2] * u[0]);
      return;
  }
}

/// The inverse: rates u from q̇; for a quaternion ω = 2 vec(q* ∘ q̇) / |q|².
template <class S>
void joint_rates(JointKind kind, const S* q, const S* qdot, S* u) {
  switch (kind) {
    case JointKind::revolute:
    case JointKind::prismatic:
    case JointKind::helical:
      u[0] = qdot[0];
      return;
    default:  // weld
      return;
    case JointKind::free: {
      const Vec3<S> v = transpose_times(rotation_of(q + 3), Vec3<S>{{qdot[0], qdot[1], qdot[2]}});
      for (int i = 0; i < 3; ++i) u[i] = v[i];
      q += 3;
      u += 3;
      qdot += 3;
      [[fallthrough]];
    }
    case JointKind::spherical: {
      const S two = S(2.0) / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
      u[0] = two * (q[0] * qdot[1] - q[1] * qdot[0] - q[2] * qdot[3] + q[3] * qdot[2]);
      u[1] = two * (q[0] * qdot[2] - q[2] * qdot[0] - q[3] * qdot[1] + q[1] * qdot[3]);
      u[2] = two * (q[0] * qdot[3] - q[3] * qdot[0] - q[1] * qdot[2] + q[2] * qdot[1]);
      return;
    }
  }
}

}  // namespace momenta
