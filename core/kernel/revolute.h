#pragma once
// Revolute joints pass mass matrices and remainders to parents, and motions to children: shared by
// the momentum and the acceleration recursion.

#include <momenta/core/kernel/general_joint.h>
#include <momenta/core/kernel/link.h>

namespace momenta {

/// Quantities passed inward: M*, D, G; outward: Ω, g.
template <class S>
struct Articulated {
  Full<S> M;
  S Dfx, Dfy, Dfz, Dnx, Dny, Dnz, Gx, Gy, Gz;
};
template <class S>
struct OutwardMotion {
  S vx, vy, vz, ox, oy, oz, gx, gy, gz;
};

/// D += a wrench, in the body's axes.
template <class S>
MOMENTA_INLINE void add_remainder(Articulated<S>& a, const Spatial::Force<S>& D) {
  a.Dfx = a.Dfx + D.f[0];
  a.Dfy = a.Dfy + D.f[1];
  a.Dfz = a.Dfz + D.f[2];
  a.Dnx = a.Dnx + D.n[0];
  a.Dny = a.Dny + D.n[1];
  a.Dnz = a.Dnz + D.n[2];
}
/// V += a motion, in the body's axes.
template <class S>
MOMENTA_INLINE void add_motion(OutwardMotion<S>& a, const Spatial::Motion<S>& V) {
  a.vx = a.vx + V.v[0];
  a.vy = a.vy + V.v[1];
  a.vz = a.vz + V.v[2];
  a.ox = a.ox + V.w[0];
  a.oy = a.oy + V.w[1];
  a.oz = a.oz + V.w[2];
}

/// A body once its revolute joint is eliminated: M', and D' and G in its frame.
template <class S>
struct Eliminated {
  Reduced<S> M;
  S fx, fy, fz, nx, ny, nz, Gx, Gy, Gz;
};

/// Calls f(number of a, number of b) for all numbers of two articulated quantities, one by one:
/// copies of whole records would be read in other pieces than written, and wait for memory.
template <bool Gravity = true, class A, class B, class F>
MOMENTA_INLINE void in_pairs(Articulated<A>& a, const Articulated<B>& b, F&& f) {
  Full<A>& m = a.M;
  const Full<B>& n = b.M;
  f(m.Axx, n.Axx), f(m.Axy, n.Axy), f(m.Axz, n.Axz);
  f(m.Ayy, n.Ayy), f(m.Ayz, n.Ayz), f(m.Azz, n.Azz);
  f(m.Hxx, n.Hxx), f(m.Hxy, n.Hxy), f(m.Hxz, n.Hxz);
  f(m.Hyx, n.Hyx), f(m.Hyy, n.Hyy), f(m.Hyz, n.Hyz);
  f(m.Hzx, n.Hzx), f(m.Hzy, n.Hzy), f(m.Hzz, n.Hzz);
  f(m.Ixx, n.Ixx), f(m.Ixy, n.Ixy), f(m.Ixz, n.Ixz);
  f(m.Iyy, n.Iyy), f(m.Iyz, n.Iyz), f(m.Izz, n.Izz);
  f(a.Dfx, b.Dfx), f(a.Dfy, b.Dfy), f(a.Dfz, b.Dfz);
  f(a.Dnx, b.Dnx), f(a.Dny, b.Dny), f(a.Dnz, b.Dnz);
  if constexpr (Gravity) f(a.Gx, b.Gx), f(a.Gy, b.Gy), f(a.Gz, b.Gz);
}
template <bool Gravity, class S>
MOMENTA_INLINE void add(Articulated<S>& a, const Articulated<S>& b) {
  in_pairs<Gravity>(a, b, [](S& x, const S& y) { x = x + y; });
}

/// Adds the body itself and the constant part of its first moment.
template <bool Gravity, class Link, class S>
MOMENTA_INLINE void add_body(Articulated<S>& articulated, const Link& l) {
  add_body(articulated.M, l);
  if constexpr (Gravity) {
    articulated.Gx = articulated.Gx + l.moment[0];
    articulated.Gy = articulated.Gy + l.moment[1];
    articulated.Gz = articulated.Gz + l.moment[2];
  }
}

/// Leaves the share of a child beside the first in its parent's slot.
template <bool Gravity, class Link, class S>
MOMENTA_INLINE void leave(const Link& l, Articulated<S>& slot, const Articulated<S>& articulated) {
  if (l.opens)
    in_pairs<Gravity>(slot, articulated, [](S& a, const S& b) { a = b; });
  else
    add<Gravity>(slot, articulated);
}

template <class S>
MOMENTA_INLINE void set_leaf(const Leaf& leaf, RevoluteColumn<S>& h, Reduced<S>& m) {
  m = {S(leaf.M.Axx), S(leaf.M.Axy), S(leaf.M.Axz), S(leaf.M.Ayy), S(leaf.M.Ayz),
       S(leaf.M.Azz), S(leaf.M.Hxx), S(leaf.M.Hxy), S(leaf.M.Hyx), S(leaf.M.Hyy),
       S(leaf.M.Hzx), S(leaf.M.Hzy), S(leaf.M.Ixx), S(leaf.M.Ixy), S(leaf.M.Iyy)};
  h = {S(leaf.h[0]), S(leaf.h[1]), S(leaf.h[2]), S(leaf.h[3]), S(leaf.h[4])};
}

/// A screw about z; G is turned.
template <bool Gravity, class S, class C>
MOMENTA_INLINE void screw_inward(const C& c, const C& s, const C& d, Articulated<S>& articulated) {
  turn_and_shift_z(articulated.M, c, s, d);
  S x = c * articulated.Dfx - s * articulated.Dfy;
  articulated.Dfy = s * articulated.Dfx + c * articulated.Dfy;
  articulated.Dfx = x;
  x = c * articulated.Dnx - s * articulated.Dny;
  articulated.Dny = s * articulated.Dnx + c * articulated.Dny + d * articulated.Dfx;
  articulated.Dnx = x - d * articulated.Dfy;
  if constexpr (Gravity) {
    x = c * articulated.Gx - s * articulated.Gy;
    articulated.Gy = s * articulated.Gx + c * articulated.Gy;
    articulated.Gx = x;
  }
}

/// The screw about x to the parent.
template <Turn turn, bool Gravity, class Link, class S>
MOMENTA_INLINE void carry(const Eliminated<S>& r, const Link& l, Articulated<S>& articulated) {
  const auto &ca = l.ca, &sa = l.sa, &a = l.a;
  articulated.Dfx = r.fx;
  articulated.Dnx = r.nx;
  if constexpr (Gravity) articulated.Gx = r.Gx;
  if constexpr (turn == Turn::general) {
    turn_x(r.M, l, articulated.M);
    shift_x(articulated.M, a);
    articulated.Dfy = ca * r.fy - sa * r.fz;
    articulated.Dfz = sa * r.fy + ca * r.fz;
    articulated.Dny = ca * r.ny - sa * r.nz - a * articulated.Dfz;
    articulated.Dnz = sa * r.ny + ca * r.nz + a * articulated.Dfy;
    if constexpr (Gravity) {
      articulated.Gy = ca * r.Gy - sa * r.Gz;
      articulated.Gz = sa * r.Gy + ca * r.Gz;
    }
  } else if constexpr (turn == Turn::right) {
    right_turn_and_shift_x(r.M, a, articulated.M);
    articulated.Dfy = -r.fz;
    articulated.Dfz = r.fy;
    articulated.Dny = -(r.nz + a * r.fy);
    articulated.Dnz = r.ny - a * r.fz;
    if constexpr (Gravity) {
      articulated.Gy = -r.Gz;
      articulated.Gz = r.Gy;
    }
  } else {
    parallel_turn_and_shift_x(r.M, ca, a, articulated.M);
    articulated.Dfy = ca * r.fy;
    articulated.Dfz = ca * r.fz;
    articulated.Dny = ca * r.ny - a * articulated.Dfz;
    articulated.Dnz = ca * r.nz + a * articulated.Dfy;
    if constexpr (Gravity) {
      articulated.Gy = ca * r.Gy;
      articulated.Gz = ca * r.Gz;
    }
  }
}

/// carry() where a chain ends.
template <Turn turn, bool Gravity, class Link, class S>
__attribute__((noinline)) void carry_last(const Eliminated<S>& r, const Link& l,
                                          Articulated<S>& articulated) {
  carry<turn, Gravity>(r, l, articulated);
}

template <class S>
Spatial::Force<S> remainder_of(const Articulated<S>& c) {
  return {{{c.Dfx, c.Dfy, c.Dfz}}, {{c.Dnx, c.Dny, c.Dnz}}};
}
template <class S>
MOMENTA_INLINE void set_articulated(Articulated<S>& c, const Spatial::ArticulatedInertia<S>& M,
                                    const Spatial::Force<S>& D, const Vec3<S>& G) {
  in_pairs(
      c, Articulated<S>{full(M), D.f[0], D.f[1], D.f[2], D.n[0], D.n[1], D.n[2], G[0], G[1], G[2]},
      [](S& a, const S& b) { a = b; });
}
template <class S>
void set_articulated(OutwardMotion<S>& c, const Spatial::Motion<S>& V, const Vec3<S>& g) {
  c = {V.v[0], V.v[1], V.v[2], V.w[0], V.w[1], V.w[2], g[0], g[1], g[2]};
}

/// Nearly parallel axes: a turn about y and the screw about x.
template <class Edge, class S>
__attribute__((noinline)) void tilt_inward(const Edge& e, Spatial::ArticulatedInertia<S>& M,
                                           Spatial::Force<S>& D, Vec3<S>& G) {
  if (e.about_y) {
    const decltype(e.cos_beta) no_shift(0.0);
    Spatial::inertia_inward<1>(M, e.cos_beta, e.sin_beta, no_shift);
    Spatial::force_inward<1>(D, e.cos_beta, e.sin_beta, no_shift);
    momenta::turn<1>(G, e.cos_beta, e.sin_beta);
  }
  if (e.about_x) {
    Spatial::inertia_inward<0>(M, e.cos_alpha, e.sin_alpha, e.a);
    Spatial::force_inward<0>(D, e.cos_alpha, e.sin_alpha, e.a);
    momenta::turn<0>(G, e.cos_alpha, e.sin_alpha);
  }
}

/// All constant screws of a revolute joint, in order.
template <bool Gravity, class Link, class Edge, class S>
MOMENTA_INLINE void carry_any(const Link& l, const Edge& e, const Eliminated<S>& r,
                              Articulated<S>& articulated) {
  switch (l.turn) {
    case Turn::general:
      carry<Turn::general, Gravity>(r, l, articulated);
      break;
    case Turn::right:
      carry<Turn::right, Gravity>(r, l, articulated);
      break;
    case Turn::parallel:
      carry<Turn::parallel, Gravity>(r, l, articulated);
      break;
    case Turn::tilted: {
      const S zero(0.0);
      const Reduced<S>& m = r.M;
      Spatial::ArticulatedInertia<S> M{
          {{m.Axx, m.Axy, m.Axz, m.Ayy, m.Ayz, m.Azz}},
          {{m.Hxx, m.Hxy, zero, m.Hyx, m.Hyy, zero, m.Hzx, m.Hzy, zero}},
          {{m.Ixx, m.Ixy, zero, m.Iyy, zero, zero}}};
      Spatial::Force<S> D{{{r.fx, r.fy, r.fz}}, {{r.nx, r.ny, r.nz}}};
      Vec3<S> G{};
      if constexpr (Gravity) G = {{r.Gx, r.Gy, r.Gz}};
      tilt_inward(e, M, D, G);
      set_articulated(articulated, M, D, G);
      break;
    }
  }
  if (l.screwed) screw_inward<Gravity>(e.cos_gamma, e.sin_gamma, e.delta, articulated);
}

/// Components across z in axes turned by the angle of (c, s).
template <class C, class S>
MOMENTA_INLINE void turn_outward(const C& c, const C& s, S& x, S& y) {
  const S turned = c * x + s * y;
  y = c * y - s * x;
  x = turned;
}
/// A screw about z outward, 𝒯ⱽ of (23): rows of a motion across z; those along it stay.
template <class C, class D, class S>
MOMENTA_INLINE void screw_outward(const C& c, const C& s, const D& d, S& vx, S& vy, S& ox, S& oy) {
  vx = vx + d * oy;
  vy = vy - d * ox;
  turn_outward(c, s, vx, vy);
  turn_outward(c, s, ox, oy);
}

// The constant screws outward, for a direction and for a motion; nearly parallel axes out of line.
template <class Edge, class S>
__attribute__((noinline)) void tilt_outward(const Edge& e, Vec3<S>& g) {
  Spatial::constants_outward(e, g);
}
template <class Edge, class S>
__attribute__((noinline)) void tilt_outward(const Edge& e, Spatial::Motion<S>& m) {
  Spatial::constants_outward(e, m);
}
template <class Link, class Edge, class S>
MOMENTA_INLINE void constants_outward(const Link& l, const Edge& e, S& gx, S& gy, S& gz) {
  S x;
  if (l.turn == Turn::tilted) {
    Vec3<S> g{{gx, gy, gz}};
    tilt_outward(e, g);
    gx = g[0];
    gy = g[1];
    gz = g[2];
    return;
  }
  if (l.screwed) turn_outward(e.cos_gamma, e.sin_gamma, gx, gy);
  if (l.turn == Turn::right) {
    x = gz;
    gz = -gy;
    gy = x;
  } else {
    x = l.ca * gy + l.sa * gz;
    gz = l.ca * gz - l.sa * gy;
    gy = x;
  }
}
template <class Link, class Edge, class S>
MOMENTA_INLINE void constants_outward(const Link& l, const Edge& e, S& vx, S& vy, S& vz, S& ox,
                                      S& oy, S& oz) {
  if (l.turn == Turn::tilted) {
    Spatial::Motion<S> m{{{vx, vy, vz}}, {{ox, oy, oz}}};
    tilt_outward(e, m);
    vx = m.v[0];
    vy = m.v[1];
    vz = m.v[2];
    ox = m.w[0];
    oy = m.w[1];
    oz = m.w[2];
    return;
  }
  S x;
  if (l.screwed) screw_outward(e.cos_gamma, e.sin_gamma, e.delta, vx, vy, ox, oy);
  vy = vy + l.a * oz;
  vz = vz - l.a * oy;
  if (l.turn == Turn::right) {
    x = vz;
    vz = -vy;
    vy = x;
    x = oz;
    oz = -oy;
    oy = x;
  } else {
    x = l.ca * vy + l.sa * vz;
    vz = l.ca * vz - l.sa * vy;
    vy = x;
    x = l.ca * oy + l.sa * oz;
    oz = l.ca * oz - l.sa * oy;
    oy = x;
  }
}

}  // namespace momenta
