#pragma once
// The way from body to body in space: poses, and 𝒯ⱽ and 𝒯ᶠ of motions, wrenches and inertias.
//
// Frames are canonical: the joint axis is z of its body, and the way from a parent frame to a joint
// is a chain of screws about coordinate axes (turn and shift along the same axis, which commute):
//   about z by (γ, δ), about x by (α, a), about y by β (only where two axes are nearly parallel),
//   then the joint: about z by (θ, d), with q in θ for a revolute and in d for a prismatic joint.
// Each screw touches two of three components: transfers and congruences cost about half.

#include <momenta/core/kernel/spatial_algebra.h>
#include <momenta/core/scene/joint_kind.h>

#include <type_traits>

namespace momenta {

template <class S>
struct UserMotion;

struct Spatial : SpatialAlgebra {
  /// Constants of the way from the parent's frame to the joint.
  struct EdgeConstants {
    double cos_gamma = 1, sin_gamma = 0, delta = 0;
    double cos_alpha = 1, sin_alpha = 0, a = 0;
    double cos_beta = 1, sin_beta = 0;
    bool about_z = false, about_x = false, about_y = false;
  };

  /// That way at one configuration: constants, then the joint's screw or, for spherical, free and
  /// user joints, rotation and position.
  template <class S>
  struct Edge {
    S cos_theta{1.0}, sin_theta{}, d{};
    Mat3<S> rotation;  ///< spherical, free, user: child components to joint-frame components
    Vec3<S> position;  ///< spherical, free, user: child origin after the constant screws
    UserMotion<S>* own = nullptr;  ///< user joints: E and Ω_t here; owned beside the edges
  };

  template <class S>
  struct Pose {
    Mat3<S> axes;    ///< columns: the body's axes in ground components
    Vec3<S> origin;  ///< [m]
  };

  // One screw about axis X: turn (c, s), shift t.

  template <int X, class S, class C>
  static void motion_outward(Motion<S>& m, const C& c, const C& s, const C& t) {
    constexpr int Y = (X + 1) % 3, Z = (X + 2) % 3;
    m.v[Y] += t * m.w[Z];
    m.v[Z] -= t * m.w[Y];
    turn_back<X>(m.v, c, s);
    turn_back<X>(m.w, c, s);
  }
  template <int X, class S, class C>
  static void force_inward(Force<S>& f, const C& c, const C& s, const C& t) {
    constexpr int Y = (X + 1) % 3, Z = (X + 2) % 3;
    turn<X>(f.f, c, s);
    turn<X>(f.n, c, s);
    f.n[Y] -= t * f.f[Z];
    f.n[Z] += t * f.f[Y];
  }
  /// Moves the reference point by −t along X: H' = H − A r̃, I' = I − Hᵀ r̃ + r̃ H', r = t x̂.
  template <int X, class S, class C>
  static void shift_inward(ArticulatedInertia<S>& m, const C& t) {
    constexpr int Y = (X + 1) % 3, Z = (X + 2) % 3;
    m.I(X, Y) -= t * m.H(Z, X);
    m.I(X, Z) += t * m.H(Y, X);
    m.I(Y, Y) -= t * m.H(Z, Y);
    m.I(Z, Z) += t * m.H(Y, Z);
    m.I(Y, Z) += t * m.H(Y, Y);
    for (int i = 0; i < 3; ++i) {
      m.H(i, Y) -= t * m.A(i, Z);
      m.H(i, Z) += t * m.A(i, Y);
    }
    m.I(Y, Y) -= t * m.H(Z, Y);
    m.I(Z, Z) += t * m.H(Y, Z);
    m.I(Y, Z) -= t * m.H(Z, Z);
  }
  template <int X, class S, class C>
  static void inertia_inward(ArticulatedInertia<S>& m, const C& c, const C& s, const C& t) {
    turn<X>(m.A, c, s);
    turn<X>(m.H, c, s);
    turn<X>(m.I, c, s);
    shift_inward<X>(m, t);
  }
  template <int X, class S, class C>
  static void pose_outward(Pose<S>& p, const C& c, const C& s, const C& t) {
    constexpr int Y = (X + 1) % 3, Z = (X + 2) % 3;
    for (int i = 0; i < 3; ++i) {
      p.origin[i] += t * p.axes(i, X);
      const S y = c * p.axes(i, Y) + s * p.axes(i, Z);
      p.axes(i, Z) = c * p.axes(i, Z) - s * p.axes(i, Y);
      p.axes(i, Y) = y;
    }
  }

  // The whole edge.

  /// The constant screws outward, of a motion and of a direction. Constants: EdgeConstants, or
  /// several side by side (BranchLink).
  template <class Constants, class S>
  static void constants_outward(const Constants& k, Motion<S>& m) {
    if (k.about_z) motion_outward<2>(m, k.cos_gamma, k.sin_gamma, k.delta);
    if (k.about_x) motion_outward<0>(m, k.cos_alpha, k.sin_alpha, k.a);
    if (k.about_y) motion_outward<1>(m, k.cos_beta, k.sin_beta, decltype(k.cos_beta)(0.0));
  }
  template <class Constants, class S>
  static void constants_outward(const Constants& k, Vec3<S>& g) {
    if (k.about_z) turn_back<2>(g, k.cos_gamma, k.sin_gamma);
    if (k.about_x) turn_back<0>(g, k.cos_alpha, k.sin_alpha);
    if (k.about_y) turn_back<1>(g, k.cos_beta, k.sin_beta);
  }

  /// Parent velocity to the child's frame: the first term of (23), without the joint's own motion.
  template <class Constants, class S>
  static Motion<S> to_child(const Constants& k, JointKind kind, const Edge<S>& e, Motion<S> m) {
    constants_outward(k, m);
    if (moves_freely(kind)) {
      m.v += cross(m.w, e.position);
      m.v = transpose_times(e.rotation, m.v);
      m.w = transpose_times(e.rotation, m.w);
    } else {
      motion_outward<2>(m, e.cos_theta, e.sin_theta, e.d);
    }
    return m;
  }

  /// Wrench or momentum on the child to the parent's frame: ᴷ𝒯ᶠ of (22), (26), (27).
  template <class S>
  static Force<S> to_parent(const EdgeConstants& k, JointKind kind, const Edge<S>& e, Force<S> f) {
    if (moves_freely(kind)) {
      f.f = e.rotation * f.f;
      f.n = e.rotation * f.n;
      f.n += cross(e.position, f.f);
    } else {
      force_inward<2>(f, e.cos_theta, e.sin_theta, e.d);
    }
    constants_inward(k, f);
    return f;
  }
  /// The constant screws of that way alone.
  template <class Constants, class S>
  static void constants_inward(const Constants& k, Force<S>& f) {
    if (k.about_y) force_inward<1>(f, k.cos_beta, k.sin_beta, decltype(k.cos_beta)(0.0));
    if (k.about_x) force_inward<0>(f, k.cos_alpha, k.sin_alpha, k.a);
    if (k.about_z) force_inward<2>(f, k.cos_gamma, k.sin_gamma, k.delta);
  }

  /// 𝒯ᶠ M' 𝒯ⱽ of (43).
  template <class S>
  static ArticulatedInertia<S> to_parent(const EdgeConstants& k, JointKind kind, const Edge<S>& e,
                                         ArticulatedInertia<S> m) {
    if (moves_freely(kind)) {
      m = turned(e.rotation, m);
      shift_inward<0>(m, e.position[0]);
      shift_inward<1>(m, e.position[1]);
      shift_inward<2>(m, e.position[2]);
    } else {
      inertia_inward<2>(m, e.cos_theta, e.sin_theta, e.d);
    }
    if (k.about_y) inertia_inward<1>(m, k.cos_beta, k.sin_beta, 0.0);
    if (k.about_x) inertia_inward<0>(m, k.cos_alpha, k.sin_alpha, k.a);
    if (k.about_z) inertia_inward<2>(m, k.cos_gamma, k.sin_gamma, k.delta);
    return m;
  }

  /// A direction fixed in the parent's frame in child axes (no shift): for gravity, outward.
  template <class Constants, class S>
  static Vec3<S> direction_to_child(const Constants& k, JointKind kind, const Edge<S>& e,
                                    Vec3<S> g) {
    constants_outward(k, g);
    if (moves_freely(kind)) return transpose_times(e.rotation, g);
    turn_back<2>(g, e.cos_theta, e.sin_theta);
    return g;
  }

  /// First moment of the mass m of a subtree, taken about the child's origin, to the parent's.
  template <class S>
  static Vec3<S> moment_to_parent(const EdgeConstants& k, JointKind kind, const Edge<S>& e,
                                  Vec3<S> mc, double m) {
    const auto screw = [m](auto axis, Vec3<S>& v, const auto& c, const auto& s, const auto& t) {
      turn<decltype(axis)::value>(v, c, s);
      v[decltype(axis)::value] += m * t;
    };
    if (moves_freely(kind))
      mc = e.rotation * mc + S(m) * e.position;
    else
      screw(std::integral_constant<int, 2>(), mc, e.cos_theta, e.sin_theta, e.d);
    if (k.about_y) screw(std::integral_constant<int, 1>(), mc, k.cos_beta, k.sin_beta, 0.0);
    if (k.about_x) screw(std::integral_constant<int, 0>(), mc, k.cos_alpha, k.sin_alpha, k.a);
    if (k.about_z) screw(std::integral_constant<int, 2>(), mc, k.cos_gamma, k.sin_gamma, k.delta);
    return mc;
  }

  template <class Constants, class S>
  static Pose<S> pose_outward(const Constants& k, JointKind kind, const Edge<S>& e, Pose<S> p) {
    if (k.about_z) pose_outward<2>(p, k.cos_gamma, k.sin_gamma, k.delta);
    if (k.about_x) pose_outward<0>(p, k.cos_alpha, k.sin_alpha, k.a);
    if (k.about_y) pose_outward<1>(p, k.cos_beta, k.sin_beta, decltype(k.cos_beta)(0.0));
    if (moves_freely(kind)) {
      p.origin += p.axes * e.position;
      p.axes = p.axes * e.rotation;
    } else {
      pose_outward<2>(p, e.cos_theta, e.sin_theta, e.d);
    }
    return p;
  }

  /// dΩ_K/dt (body axes) less 𝒯ⱽ dΩ_L/dt and E u̇: Ω_K × (E u), `joint` = E u + Ω_t.
  template <class S>
  static Motion<S> velocity_product(const Edge<S>&, const Motion<S>* /*parent*/,
                                    const Motion<S>& body, const Motion<S>& joint) {
    return cross_motion(body, joint);
  }
  /// Whether a joint's own transform is a rotation (and position) instead of a screw about z.
  static constexpr bool moves_freely(JointKind kind) {
    return kind == JointKind::spherical || kind == JointKind::free || kind == JointKind::user;
  }

 private:
  template <class S>
  static ArticulatedInertia<S> turned(const Mat3<S>& r, const ArticulatedInertia<S>& m) {
    Mat3<S> full_a, full_i;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        full_a(i, j) = m.A(i, j);
        full_i(i, j) = m.I(i, j);
      }
    const Mat3<S> rt = transpose(r);
    full_a = r * full_a * rt;
    full_i = r * full_i * rt;
    ArticulatedInertia<S> t;
    t.H = r * m.H * rt;
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j) {
        t.A(i, j) = full_a(i, j);
        t.I(i, j) = full_i(i, j);
      }
    return t;
  }
};

}  // namespace momenta
