#pragma once
// Motions, forces and inertias in space, in body axes. Linear before angular, as in the paper: Ω =
// (v, ω), eq. (13), v the velocity of the frame's origin O; P = (p_l, p_a), eq. (11), p_a about O;
// wrenches T = (f, t), eq. (17).

#include <momenta/core/kernel/vector3.h>

namespace momenta {

struct SpatialAlgebra {
  static constexpr int dimension = 6;

  template <class S>
  using Vector = Vec3<S>;  ///< a point or direction

  template <class S>
  struct Motion {
    Vec3<S> v, w;
    Motion& operator+=(const Motion& b) {
      v += b.v;
      w += b.w;
      return *this;
    }
    S& operator[](int i) { return i < 3 ? v[i] : w[i - 3]; }
    const S& operator[](int i) const { return i < 3 ? v[i] : w[i - 3]; }
  };

  template <class S>
  struct Force {
    Vec3<S> f, n;
    Force& operator+=(const Force& b) {
      f += b.f;
      n += b.n;
      return *this;
    }
    Force& operator-=(const Force& b) {
      f -= b.f;
      n -= b.n;
      return *this;
    }
    S& operator[](int i) { return i < 3 ? f[i] : n[i - 3]; }
    const S& operator[](int i) const { return i < 3 ? f[i] : n[i - 3]; }
  };

  /// Mass matrix of a rigid body about its frame's origin, eq. (11): mass, first moment m·OG,
  /// inertia about O.
  template <class S>
  struct RigidInertia {
    S m{};
    Vec3<S> mc;
    Sym3<S> J;
  };

  /// Articulated mass matrix ((A, H), (Hᵀ, I)): p_l = A v + H ω, p_a = Hᵀ v + I ω. Eqs. (43), (47).
  template <class S>
  struct ArticulatedInertia {
    Sym3<S> A;
    Mat3<S> H;
    Sym3<S> I;
    ArticulatedInertia& operator+=(const ArticulatedInertia& b) {
      A += b.A;
      H += b.H;
      I += b.I;
      return *this;
    }
  };

  /// P = M Ω, eq. (11).
  template <class S, class C>
  static Force<S> momentum(const RigidInertia<C>& b, const Motion<S>& m) {
    Force<S> p;
    for (int X = 0; X < 3; ++X) {
      const int Y = (X + 1) % 3, Z = (X + 2) % 3;
      p.f[X] = b.m * m.v[X] + (m.w[Y] * b.mc[Z] - m.w[Z] * b.mc[Y]);
      p.n[X] = b.J(X, 0) * m.w[0] + b.J(X, 1) * m.w[1] + b.J(X, 2) * m.w[2] +
               (b.mc[Y] * m.v[Z] - b.mc[Z] * m.v[Y]);
    }
    return p;
  }
  template <class S>
  static Force<S> momentum(const ArticulatedInertia<S>& b, const Motion<S>& m) {
    return {b.A * m.v + b.H * m.w, transpose_times(b.H, m.v) + b.I * m.w};
  }
  template <class S, class C>
  static void add(ArticulatedInertia<S>& a, const RigidInertia<C>& b) {
    for (int X = 0; X < 3; ++X) {
      const int Y = (X + 1) % 3, Z = (X + 2) % 3;
      a.A(X, X) += b.m;
      a.H(X, Y) += b.mc[Z];  // H = −(m c)~
      a.H(X, Z) -= b.mc[Y];
    }
    for (int i = 0; i < 6; ++i) a.I.x[i] += b.J.x[i];
  }
  /// Weight of mass m with first moment mc in the field g (body axes), about O.
  template <class S>
  static Force<S> weight(const S& m, const Vec3<S>& mc, const Vec3<S>& g) {
    return {m * g, cross(mc, g)};
  }
  /// Ω × P, eq. (16): (ω × p_l, v × p_l + ω × p_a).
  template <class S>
  static Force<S> cross_force(const Motion<S>& m, const Force<S>& p) {
    return {cross(m.w, p.f), cross(m.v, p.f) + cross(m.w, p.n)};
  }
  /// Ω × Ω₂, the velocity product (ω × v₂ + v × ω₂, ω × ω₂): the negative transpose of (16).
  template <class S>
  static Motion<S> cross_motion(const Motion<S>& m, const Motion<S>& b) {
    return {cross(m.w, b.v) + cross(m.v, b.w), cross(m.w, b.w)};
  }
  /// Wrench of a body whose A vanishes: Ω × (M Ω), eq. (17).
  template <class S, class C>
  static Force<S> velocity_wrench(const RigidInertia<C>& b, const Motion<S>& m) {
    return cross_force(m, momentum(b, m));
  }
  template <class S>
  static S power(const Force<S>& f, const Motion<S>& m) {
    return dot(f.f, m.v) + dot(f.n, m.w);
  }
};

}  // namespace momenta
