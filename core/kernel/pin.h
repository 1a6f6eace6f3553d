#pragma once
// How pins pass mass matrices and remainders to their parents, and motions to their children:
// shared by the momentum and the acceleration recursion.

#include <momenta/core/kernel/general_joint.h>
#include <momenta/core/kernel/link.h>

namespace momenta {

/// What bodies pass on inward: M*, D, G; outward: Ω, g.
template <class S>
struct Cargo {
  Full<S> M;
  S Dfx, Dfy, Dfz, Dnx, Dny, Dnz, Gx, Gy, Gz;
};
template <class S>
struct OutwardCargo {
  S vx, vy, vz, ox, oy, oz, gx, gy, gz;
};

/// D += a wrench, in the body's axes.
template <class S>
MOMENTA_INLINE void add_remainder(Cargo<S>& a, const Spatial::Force<S>& D) {
  a.Dfx = a.Dfx + D.f[0];
  a.Dfy = a.Dfy + D.f[1];
  a.Dfz = a.Dfz + D.f[2];
  a.Dnx = a.Dnx + D.n[0];
  a.Dny = a.Dny + D.n[1];
  a.Dnz = a.Dnz + D.n[2];
}
/// V += a motion, in the body's axes.
template <class S>
MOMENTA_INLINE void add_motion(OutwardCargo<S>& a, const Spatial::Motion<S>& V) {
  a.vx = a.vx + V.v[0];
  a.vy = a.vy + V.v[1];
  a.vz = a.vz + V.v[2];
  a.ox = a.ox + V.w[0];
  a.oy = a.oy + V.w[1];
  a.oz = a.oz + V.w[2];
}

/// What is left of a body once its pin is eliminated: M', and D' and G in its frame.
template <class S>
struct Eliminated {
  Reduced<S> M;
  S fx, fy, fz, nx, ny, nz, Gx, Gy, Gz;
};

/// f(number of a, the same number of b) for all numbers of two cargos, one by one: copies of whole
/// records would be read back in other pieces than they were written in, and wait for memory.
template <bool Gravity = true, class A, class B, class F>
MOMENTA_INLINE void in_pairs(Cargo<A>& a, const Cargo<B>& b, F&& f) {
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
MOMENTA_INLINE void add(Cargo<S>& a, const Cargo<S>& b) {
  in_pairs<Gravity>(a, b, [](S& x, const S& y) { x = x + y; });
}

/// + the body itself and the constant part of its first moment.
template <bool Gravity, class Link, class S>
MOMENTA_INLINE void add_body(Cargo<S>& cargo, const Link& l) {
  add_body(cargo.M, l);
  if constexpr (Gravity) {
    cargo.Gx = cargo.Gx + l.moment[0];
    cargo.Gy = cargo.Gy + l.moment[1];
    cargo.Gz = cargo.Gz + l.moment[2];
  }
}

/// What a child beside the first leaves in its parent's slot.
template <bool Gravity, class Link, class S>
MOMENTA_INLINE void leave(const Link& l, Cargo<S>& slot, const Cargo<S>& cargo) {
  if (l.opens)
    in_pairs<Gravity>(slot, cargo, [](S& a, const S& b) { a = b; });
  else
    add<Gravity>(slot, cargo);
}

template <class S>
MOMENTA_INLINE void set_tip(const Tip& tip, PinColumn<S>& h, Reduced<S>& m) {
  m = {S(tip.M.Axx), S(tip.M.Axy), S(tip.M.Axz), S(tip.M.Ayy), S(tip.M.Ayz),
       S(tip.M.Azz), S(tip.M.Hxx), S(tip.M.Hxy), S(tip.M.Hyx), S(tip.M.Hyy),
       S(tip.M.Hzx), S(tip.M.Hzy), S(tip.M.Ixx), S(tip.M.Ixy), S(tip.M.Iyy)};
  h = {S(tip.h[0]), S(tip.h[1]), S(tip.h[2]), S(tip.h[3]), S(tip.h[4])};
}

/// A screw about z; of G the turn.
template <bool Gravity, class S, class C>
MOMENTA_INLINE void screw_inward(const C& c, const C& s, const C& d, Cargo<S>& cargo) {
  turn_and_shift_z(cargo.M, c, s, d);
  S x = c * cargo.Dfx - s * cargo.Dfy;
  cargo.Dfy = s * cargo.Dfx + c * cargo.Dfy;
  cargo.Dfx = x;
  x = c * cargo.Dnx - s * cargo.Dny;
  cargo.Dny = s * cargo.Dnx + c * cargo.Dny + d * cargo.Dfx;
  cargo.Dnx = x - d * cargo.Dfy;
  if constexpr (Gravity) {
    x = c * cargo.Gx - s * cargo.Gy;
    cargo.Gy = s * cargo.Gx + c * cargo.Gy;
    cargo.Gx = x;
  }
}

/// The screw about x to the parent.
template <Turn turn, bool Gravity, class Link, class S>
MOMENTA_INLINE void carry(const Eliminated<S>& r, const Link& l, Cargo<S>& cargo) {
  const auto &ca = l.ca, &sa = l.sa, &a = l.a;
  cargo.Dfx = r.fx;
  cargo.Dnx = r.nx;
  if constexpr (Gravity) cargo.Gx = r.Gx;
  if constexpr (turn == Turn::general) {
    turn_x(r.M, l, cargo.M);
    shift_x(cargo.M, a);
    cargo.Dfy = ca * r.fy - sa * r.fz;
    cargo.Dfz = sa * r.fy + ca * r.fz;
    cargo.Dny = ca * r.ny - sa * r.nz - a * cargo.Dfz;
    cargo.Dnz = sa * r.ny + ca * r.nz + a * cargo.Dfy;
    if constexpr (Gravity) {
      cargo.Gy = ca * r.Gy - sa * r.Gz;
      cargo.Gz = sa * r.Gy + ca * r.Gz;
    }
  } else if constexpr (turn == Turn::right) {
    right_turn_and_shift_x(r.M, a, cargo.M);
    cargo.Dfy = -r.fz;
    cargo.Dfz = r.fy;
    cargo.Dny = -(r.nz + a * r.fy);
    cargo.Dnz = r.ny - a * r.fz;
    if constexpr (Gravity) {
      cargo.Gy = -r.Gz;
      cargo.Gz = r.Gy;
    }
  } else {
    parallel_turn_and_shift_x(r.M, ca, a, cargo.M);
    cargo.Dfy = ca * r.fy;
    cargo.Dfz = ca * r.fz;
    cargo.Dny = ca * r.ny - a * cargo.Dfz;
    cargo.Dnz = ca * r.nz + a * cargo.Dfy;
    if constexpr (Gravity) {
      cargo.Gy = ca * r.Gy;
      cargo.Gz = ca * r.Gz;
    }
  }
}

/// A right turn changes signs. A chain carries these numbers with those they had before it, so that
/// the next body's sums subtract them: no sign is changed by itself.
template <Turn turn, class S>
MOMENTA_INLINE void change_signs(Cargo<S>& cargo) {
  if constexpr (turn == Turn::right) {
    cargo.M.Axy = -cargo.M.Axy;
    cargo.M.Ayz = -cargo.M.Ayz;
    cargo.M.Hyx = -cargo.M.Hyx;
    cargo.Dfy = -cargo.Dfy;
    cargo.Dny = -cargo.Dny;
  }
}

/// To the parent where a chain ends.
template <Turn turn, bool Gravity, class Link, class S>
__attribute__((noinline)) void carry_last(const Eliminated<S>& r, const Link& l, Cargo<S>& cargo) {
  carry<turn, Gravity>(r, l, cargo);
}

template <class S>
Spatial::Force<S> remainder_of(const Cargo<S>& c) {
  return {{{c.Dfx, c.Dfy, c.Dfz}}, {{c.Dnx, c.Dny, c.Dnz}}};
}
template <class S>
MOMENTA_INLINE void set_cargo(Cargo<S>& c, const Spatial::ArticulatedInertia<S>& M,
                              const Spatial::Force<S>& D, const Vec3<S>& G) {
  in_pairs(c, Cargo<S>{full(M), D.f[0], D.f[1], D.f[2], D.n[0], D.n[1], D.n[2], G[0], G[1], G[2]},
           [](S& a, const S& b) { a = b; });
}
template <class S>
void set_cargo(OutwardCargo<S>& c, const Spatial::Motion<S>& V, const Vec3<S>& g) {
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

/// All constant screws of a pin, in order.
template <bool Gravity, class Link, class Edge, class S>
MOMENTA_INLINE void carry_any(const Link& l, const Edge& e, const Eliminated<S>& r,
                              Cargo<S>& cargo) {
  switch (l.turn) {
    case Turn::general:
      carry<Turn::general, Gravity>(r, l, cargo);
      break;
    case Turn::right:
      carry<Turn::right, Gravity>(r, l, cargo);
      break;
    case Turn::parallel:
      carry<Turn::parallel, Gravity>(r, l, cargo);
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
      set_cargo(cargo, M, D, G);
      break;
    }
  }
  if (l.screwed) screw_inward<Gravity>(e.cos_gamma, e.sin_gamma, e.delta, cargo);
}

/// Two components across z in axes turned by the angle of (c, s).
template <class C, class S>
MOMENTA_INLINE void turn_outward(const C& c, const C& s, S& x, S& y) {
  const S turned = c * x + s * y;
  y = c * y - s * x;
  x = turned;
}
/// A screw about z outward, 𝒯ⱽ of (23): of a motion the rows across z; those along it stay.
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
