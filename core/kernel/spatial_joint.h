#pragma once
// Joints in space: Joint<Spatial> of joint.h.

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

  /// Pose, E and Ω_t of a user joint at (t, q) into `own`, which the edge points to.
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
  /// Ė and dΩ_t/dt along (u, 1) of a user joint. @pre place()
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

  /// Positive where a one-dof joint has inertia. For a revolute joint M_j itself, as its M' has no
  /// rounding left; for a prismatic joint or a screw M_j less the rounding of all the mass carried:
  /// behind two slides no mass is left along a third in their plane but rounding.
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

  /// M* − U hᵀ with h = U / M_j, eq. (47). Without a rotor the joint's row and column vanish
  /// exactly: rounding there would pass for inertia. Helical joints: reduce_screw.
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
    if (b.has_rotor()) return;
    if (b.kind == JointKind::helical) return reduce_screw(b.pitch, m);
    for (int i = 0; i < 3; ++i)
      if (b.kind == JointKind::revolute)
        m.H(i, 2) = m.I(i, 2) = S(0.0);
      else
        m.H(2, i) = m.A(i, 2) = S(0.0);
  }

 private:
  /// M' E = 0 ties two rows and columns of M' together: pitch M'(·, v_z) + M'(·, ω_z) = 0. One is
  /// computed from the other, by a factor of at most one, so that this holds exactly and M' stays
  /// symmetric.
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

}  // namespace momenta
