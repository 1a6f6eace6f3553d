#pragma once
// M*_K of a body on a revolute joint to its parent: (47) and 𝒯ᶠ M' 𝒯ⱽ of (43) in one go.
//
// M' = M* − U hᵀ has no row and no column for ω_z: 15 numbers instead of 21. The joint's screw
// about z turns and shifts them among themselves; the turn about x that follows fills the third
// column from two others, and must come before the shift along x, which needs the full matrix. A
// right angle about x only swaps and signs, and leaves ω_y without row and column before the shift.

#include <momenta/core/kernel/spatial.h>

namespace momenta {

template <class S>
Spatial::ArticulatedInertia<S> carry_revolute(const Spatial::EdgeConstants& k,
                                              const Spatial::Edge<S>& e,
                                              const Spatial::ArticulatedInertia<S>& m,
                                              const Spatial::Force<S>& U,
                                              const Spatial::Force<S>& h) {
  // M' = M* − U hᵀ, (47)
  S Axx = m.A.x[0] - U.f[0] * h.f[0], Axy = m.A.x[1] - U.f[0] * h.f[1];
  S Axz = m.A.x[2] - U.f[0] * h.f[2], Ayy = m.A.x[3] - U.f[1] * h.f[1];
  S Ayz = m.A.x[4] - U.f[1] * h.f[2];
  const S Azz = m.A.x[5] - U.f[2] * h.f[2];
  S Hxx = m.H(0, 0) - U.f[0] * h.n[0], Hxy = m.H(0, 1) - U.f[0] * h.n[1];
  S Hyx = m.H(1, 0) - U.f[1] * h.n[0], Hyy = m.H(1, 1) - U.f[1] * h.n[1];
  S Hzx = m.H(2, 0) - U.f[2] * h.n[0], Hzy = m.H(2, 1) - U.f[2] * h.n[1];
  S Ixx = m.I.x[0] - U.n[0] * h.n[0], Ixy = m.I.x[1] - U.n[0] * h.n[1];
  S Iyy = m.I.x[3] - U.n[1] * h.n[1];

  // Turn about z by θ: 2 × 2 blocks by trace and difference, the rest as vectors.
  const S &c = e.cos_theta, &s = e.sin_theta;
  const S cs = c * s, ss = s * s;
  const auto turn_symmetric = [&](S& xx, S& xy, S& yy) {
    const S difference = xx - yy, twice = xy + xy;
    const S t = ss * difference + cs * twice;
    xy += cs * difference - ss * twice;
    xx -= t;
    yy += t;
  };
  const auto turn_pair = [&](S& x, S& y) {
    const S turned = c * x - s * y;
    y = s * x + c * y;
    x = turned;
  };
  turn_symmetric(Axx, Axy, Ayy);
  turn_pair(Axz, Ayz);
  {
    const S difference = Hxx - Hyy, twice = Hxy + Hyx;
    const S t = ss * difference + cs * twice, u = cs * difference - ss * twice;
    Hxx -= t;
    Hyy += t;
    Hxy += u;
    Hyx += u;
  }
  turn_pair(Hzx, Hzy);
  turn_symmetric(Ixx, Ixy, Iyy);

  // Shift along z by d: H' = H − A r̃, I' = I − Hᵀ r̃ + r̃ H'.
  const S& d = e.d;
  Ixx -= d * Hyx;
  Iyy += d * Hxy;
  Ixy += d * Hxx;
  Hxx -= d * Axy;
  Hyx -= d * Ayy;
  Hzx -= d * Ayz;
  Hxy += d * Axx;
  Hyy += d * Axy;
  Hzy += d * Axz;
  Ixx -= d * Hyx;
  Iyy += d * Hxy;
  Ixy -= d * Hyy;

  Spatial::ArticulatedInertia<S> p;
  if (k.about_y) {  // nearly parallel axes: no structure is left to use
    p.A = {{Axx, Axy, Axz, Ayy, Ayz, Azz}};
    p.H = {{Hxx, Hxy, S(0.0), Hyx, Hyy, S(0.0), Hzx, Hzy, S(0.0)}};
    p.I = {{Ixx, Ixy, S(0.0), Iyy, S(0.0), S(0.0)}};
    Spatial::inertia_inward<1>(p, k.cos_beta, k.sin_beta, 0.0);
    if (k.about_x) Spatial::inertia_inward<0>(p, k.cos_alpha, k.sin_alpha, k.a);
  } else {
    if (k.cos_alpha == 0) {  // α = ±90°: y ← ∓z, z ← ±y
      const double sign = k.sin_alpha;
      p.A = {{Axx, -sign * Axz, sign * Axy, Azz, -Ayz, Ayy}};
      p.H = {{Hxx, S(0.0), sign * Hxy, -sign * Hzx, S(0.0), -Hzy, sign * Hyx, S(0.0), Hyy}};
      p.I = {{Ixx, S(0.0), sign * Ixy, S(0.0), S(0.0), Iyy}};
    } else if (k.sin_alpha == 0) {  // parallel axes
      const double sign = k.cos_alpha;
      p.A = {{Axx, sign * Axy, sign * Axz, Ayy, Ayz, Azz}};
      p.H = {{Hxx, sign * Hxy, S(0.0), sign * Hyx, Hyy, S(0.0), sign * Hzx, Hzy, S(0.0)}};
      p.I = {{Ixx, sign * Ixy, S(0.0), Iyy, S(0.0), S(0.0)}};
    } else {
      const double ca = k.cos_alpha, sa = k.sin_alpha;
      const double cc = ca * sa, square = sa * sa;
      const S difference = Ayy - Azz, twice = Ayz + Ayz;
      const S t = square * difference + cc * twice;
      p.A = {{Axx, ca * Axy - sa * Axz, sa * Axy + ca * Axz, Ayy - t,
              Ayz + (cc * difference - square * twice), Azz + t}};
      const S Ht = square * Hyy + cc * Hzy, Hu = cc * Hyy - square * Hzy;
      p.H = {{Hxx, ca * Hxy, sa * Hxy, ca * Hyx - sa * Hzx, Hyy - Ht, Hu, sa * Hyx + ca * Hzx,
              Hzy + Hu, Ht}};
      p.I = {{Ixx, ca * Ixy, sa * Ixy, (ca * ca) * Iyy, cc * Iyy, square * Iyy}};
    }
    if (k.a != 0) Spatial::shift_inward<0>(p, k.a);
  }
  if (k.about_z) Spatial::inertia_inward<2>(p, k.cos_gamma, k.sin_gamma, k.delta);
  return p;
}

}  // namespace momenta
