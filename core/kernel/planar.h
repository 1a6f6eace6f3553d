#pragma once
// The algebra of motion in a plane: 3-component velocities (v_x, v_y, ω) and momenta (p_x, p_y,
// p_a), in ground axes of the plane, moments about each body's own joint origin. With absolute
// angles no matrix is turned: the way to the parent is a shift, and one rotation of com and joint
// vectors per body replaces all congruences. Body frames are parallel to the plane's axes when
// every joint is at zero.

#include <momenta/core/scene/joint_kind.h>

namespace momenta {

template <class S>
struct Vec2 {
  S x[2]{};
  S& operator[](int i) { return x[i]; }
  const S& operator[](int i) const { return x[i]; }
  Vec2& operator+=(const Vec2& b) {
    x[0] += b.x[0];
    x[1] += b.x[1];
    return *this;
  }
  Vec2& operator-=(const Vec2& b) {
    x[0] -= b.x[0];
    x[1] -= b.x[1];
    return *this;
  }
  friend Vec2 operator+(Vec2 a, const Vec2& b) { return a += b; }
  friend Vec2 operator-(Vec2 a, const Vec2& b) { return a -= b; }
  friend Vec2 operator-(const Vec2& a) { return {{-a.x[0], -a.x[1]}}; }
  friend Vec2 operator*(const S& s, const Vec2& a) { return {{s * a.x[0], s * a.x[1]}}; }
};
template <class S>
S dot(const Vec2<S>& a, const Vec2<S>& b) {
  return a[0] * b[0] + a[1] * b[1];
}
/// Component of a × b normal to the plane.
template <class S>
S cross(const Vec2<S>& a, const Vec2<S>& b) {
  return a[0] * b[1] - a[1] * b[0];
}
/// ω × a for ω normal to the plane.
template <class S>
Vec2<S> cross(const S& w, const Vec2<S>& a) {
  return {{-(w * a[1]), w * a[0]}};
}

struct Planar {
  static constexpr int dimension = 3;

  template <class S>
  using Vector = Vec2<S>;

  template <class S>
  struct Motion {
    Vec2<S> v;
    S w{};
    Motion& operator+=(const Motion& b) {
      v += b.v;
      w += b.w;
      return *this;
    }
    S& operator[](int i) { return i < 2 ? v[i] : w; }
    const S& operator[](int i) const { return i < 2 ? v[i] : w; }
  };
  template <class S>
  struct Force {
    Vec2<S> f;
    S n{};
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
    S& operator[](int i) { return i < 2 ? f[i] : n; }
    const S& operator[](int i) const { return i < 2 ? f[i] : n; }
  };
  template <class S>
  struct RigidInertia {
    S m{};
    Vec2<S> mc;  ///< ground axes once turned
    S J{};       ///< about O
  };
  /// p_l = A v + H ω, p_a = H·v + I ω.
  template <class S>
  struct ArticulatedInertia {
    S xx{}, xy{}, yy{};
    Vec2<S> H;
    S I{};
    ArticulatedInertia& operator+=(const ArticulatedInertia& b) {
      xx += b.xx;
      xy += b.xy;
      yy += b.yy;
      H += b.H;
      I += b.I;
      return *this;
    }
  };

  struct EdgeConstants {
    double x = 0, y = 0;  ///< joint in the parent's frame
    double sign = 1;      ///< revolute: +1 when its axis is the plane's normal, −1 when opposite
    double prismatic_x = 0, prismatic_y = 0;  ///< prismatic: direction in the parent's frame
  };

  /// A body at one configuration: absolute angle, joint as seen from the parent's, slide direction.
  template <class S>
  struct Edge {
    S angle{}, c{1.0}, s{};  ///< angle of the body
    Vec2<S> r;               ///< O_K − O_L, ground axes
    Vec2<S> prismatic;       ///< unit vector, ground axes
    S sign{1.0};             ///< E of a revolute joint is (0, 0, sign)
  };

  template <class S>
  struct Pose {
    S c{1.0}, s{};
    Vec2<S> origin;
  };

  template <class S>
  static Motion<S> to_child(const EdgeConstants&, JointKind, const Edge<S>& e, Motion<S> m) {
    m.v += cross(m.w, e.r);
    return m;
  }
  template <class S>
  static Force<S> to_parent(const EdgeConstants&, JointKind, const Edge<S>& e, Force<S> f) {
    f.n += cross(e.r, f.f);
    return f;
  }
  /// H' = H + A ρ, I' = I + H·ρ + ρ·H', ρ = (−r_y, r_x).
  template <class S>
  static ArticulatedInertia<S> to_parent(const EdgeConstants&, JointKind, const Edge<S>& e,
                                         ArticulatedInertia<S> m) {
    const S px = -e.r[1], py = e.r[0];
    const S half = m.H[0] * px + m.H[1] * py;
    m.H[0] += m.xx * px + m.xy * py;
    m.H[1] += m.xy * px + m.yy * py;
    m.I += half + (m.H[0] * px + m.H[1] * py);
    return m;
  }
  template <class S>
  static Vec2<S> direction_to_child(const EdgeConstants&, JointKind, const Edge<S>&, Vec2<S> g) {
    return g;
  }
  template <class S>
  static Vec2<S> moment_to_parent(const EdgeConstants&, JointKind, const Edge<S>& e,
                                  const Vec2<S>& mc, double m) {
    return mc + S(m) * e.r;
  }
  template <class S>
  static Pose<S> pose_outward(const EdgeConstants&, JointKind, const Edge<S>& e, const Pose<S>& p) {
    return {e.c, e.s, p.origin + e.r};
  }

  template <class S>
  static RigidInertia<S> turned(const RigidInertia<double>& b, const Edge<S>& e) {
    return {S(b.m), {{e.c * b.mc[0] - e.s * b.mc[1], e.s * b.mc[0] + e.c * b.mc[1]}}, S(b.J)};
  }

  template <class S>
  static Force<S> momentum(const RigidInertia<S>& b, const Motion<S>& m) {
    return {{{b.m * m.v[0] - m.w * b.mc[1], b.m * m.v[1] + m.w * b.mc[0]}},
            cross(b.mc, m.v) + b.J * m.w};
  }
  template <class S>
  static Force<S> momentum(const ArticulatedInertia<S>& b, const Motion<S>& m) {
    return {{{b.xx * m.v[0] + b.xy * m.v[1] + b.H[0] * m.w,
              b.xy * m.v[0] + b.yy * m.v[1] + b.H[1] * m.w}},
            dot(b.H, m.v) + b.I * m.w};
  }
  template <class S>
  static void add(ArticulatedInertia<S>& a, const RigidInertia<S>& b) {
    a.xx += b.m;
    a.yy += b.m;
    a.H[0] -= b.mc[1];
    a.H[1] += b.mc[0];
    a.I += b.J;
  }
  template <class S>
  static Force<S> weight(const S& m, const Vec2<S>& mc, const Vec2<S>& g) {
    return {m * g, cross(mc, g)};
  }
  template <class S>
  static Force<S> cross_force(const Motion<S>& m, const Force<S>& p) {
    return {cross(m.w, p.f), cross(m.v, p.f)};
  }
  /// In ground axes A = (acceleration of O, dω/dt). Beyond 𝒯ⱽ A_L and E u̇: −ω_L² r and Coriolis 2 ω
  /// × E u.
  template <class S>
  static Motion<S> velocity_product(const Edge<S>& e, const Motion<S>* parent,
                                    const Motion<S>& body, const Motion<S>& joint) {
    Motion<S> c;
    if (parent) c.v -= (parent->w * parent->w) * e.r;
    c.v += cross(S(2.0) * body.w, joint.v);
    return c;
  }
  /// Wrench of a body whose A vanishes: the centripetal force of its com.
  template <class S>
  static Force<S> velocity_wrench(const RigidInertia<S>& b, const Motion<S>& m) {
    return {-((m.w * m.w) * b.mc), S(0.0)};
  }
  template <class S>
  static S power(const Force<S>& f, const Motion<S>& m) {
    return dot(f.f, m.v) + f.n * m.w;
  }
};

}  // namespace momenta
