#pragma once
// M*_K of a body on a pin to its parent: (47) and 𝒯ᶠ M' 𝒯ⱽ of (43), entry by entry.
//
// M' = M* − U hᵀ has no row and no column for ω_z: 15 numbers instead of 21. The joint's screw
// about z turns and shifts them among themselves. The turn about x that follows fills the third
// column from two others and must come before the shift along x, which needs the full matrix. A
// right angle about x only swaps and signs, and leaves ω_y without row and column for the shift.
//
// Every function works on scalars that stay in registers.

#include <momenta/core/kernel/spatial.h>
#include <momenta/core/scalar/dual.h>
#include <momenta/core/scalar/pack.h>

namespace momenta {

/// M' in the frame of the pin: A = (Axx … Azz), H without its last column, I without its last row.
template <class S>
struct Reduced {
  S Axx, Axy, Axz, Ayy, Ayz, Azz, Hxx, Hxy, Hyx, Hyy, Hzx, Hzy, Ixx, Ixy, Iyy;
};

/// M* with every entry by its name.
template <class S>
struct Full {
  S Axx, Axy, Axz, Ayy, Ayz, Azz, Hxx, Hxy, Hxz, Hyx, Hyy, Hyz, Hzx, Hzy, Hzz, Ixx, Ixy, Ixz, Iyy,
      Iyz, Izz;
};
template <class S>
MOMENTA_INLINE void add(Full<S>& a, const Full<S>& b) {
  a.Axx = a.Axx + b.Axx;
  a.Axy = a.Axy + b.Axy;
  a.Axz = a.Axz + b.Axz;
  a.Ayy = a.Ayy + b.Ayy;
  a.Ayz = a.Ayz + b.Ayz;
  a.Azz = a.Azz + b.Azz;
  a.Hxx = a.Hxx + b.Hxx;
  a.Hxy = a.Hxy + b.Hxy;
  a.Hxz = a.Hxz + b.Hxz;
  a.Hyx = a.Hyx + b.Hyx;
  a.Hyy = a.Hyy + b.Hyy;
  a.Hyz = a.Hyz + b.Hyz;
  a.Hzx = a.Hzx + b.Hzx;
  a.Hzy = a.Hzy + b.Hzy;
  a.Hzz = a.Hzz + b.Hzz;
  a.Ixx = a.Ixx + b.Ixx;
  a.Ixy = a.Ixy + b.Ixy;
  a.Ixz = a.Ixz + b.Ixz;
  a.Iyy = a.Iyy + b.Iyy;
  a.Iyz = a.Iyz + b.Iyz;
  a.Izz = a.Izz + b.Izz;
}
template <class S>
Full<S> full(const Spatial::ArticulatedInertia<S>& m) {
  const auto &A = m.A.x, &H = m.H.x, &I = m.I.x;
  return {A[0], A[1], A[2], A[3], A[4], A[5], H[0], H[1], H[2], H[3], H[4],
          H[5], H[6], H[7], H[8], I[0], I[1], I[2], I[3], I[4], I[5]};
}
template <class S>
Spatial::ArticulatedInertia<S> blocks(const Full<S>& m) {
  return {{{m.Axx, m.Axy, m.Axz, m.Ayy, m.Ayz, m.Azz}},
          {{m.Hxx, m.Hxy, m.Hxz, m.Hyx, m.Hyy, m.Hyz, m.Hzx, m.Hzy, m.Hzz}},
          {{m.Ixx, m.Ixy, m.Ixz, m.Iyy, m.Iyz, m.Izz}}};
}

/// h = M*E M_j⁻¹ of a pin; its last entry is 1.
template <class S>
struct PinColumn {
  S fx, fy, fz, nx, ny;
};

/// (47), with inverse = M_j⁻¹ = 1 / I_zz.
template <class S>
MOMENTA_INLINE void eliminate_pin(const Full<S>& m, const S& inverse, PinColumn<S>& h,
                                  Reduced<S>& r) {
  const S &Ux = m.Hxz, &Uy = m.Hyz, &Uz = m.Hzz, &Unx = m.Ixz, &Uny = m.Iyz;
  h.fx = Ux * inverse;
  h.fy = Uy * inverse;
  h.fz = Uz * inverse;
  h.nx = Unx * inverse;
  h.ny = Uny * inverse;
  r.Axx = m.Axx - Ux * h.fx;
  r.Axy = m.Axy - Ux * h.fy;
  r.Axz = m.Axz - Ux * h.fz;
  r.Ayy = m.Ayy - Uy * h.fy;
  r.Ayz = m.Ayz - Uy * h.fz;
  r.Azz = m.Azz - Uz * h.fz;
  r.Hxx = m.Hxx - Ux * h.nx;
  r.Hxy = m.Hxy - Ux * h.ny;
  r.Hyx = m.Hyx - Uy * h.nx;
  r.Hyy = m.Hyy - Uy * h.ny;
  r.Hzx = m.Hzx - Uz * h.nx;
  r.Hzy = m.Hzy - Uz * h.ny;
  r.Ixx = m.Ixx - Unx * h.nx;
  r.Ixy = m.Ixy - Unx * h.ny;
  r.Iyy = m.Iyy - Uny * h.ny;
}

/// The pin's own screw: turn by θ, 2 × 2 blocks by their trace and difference, then shift along z
/// by d: H' = H − A r̃, I' = I − Hᵀ r̃ + r̃ H'.
template <class S>
MOMENTA_INLINE void turn_and_shift_z(Reduced<S>& r, const S& c, const S& s, double d) {
  const S ss = s * s, cs = c * s, ss2 = ss + ss, cs2 = cs + cs;
  {
    const S difference = r.Axx - r.Ayy;
    const S t = ss * difference + cs2 * r.Axy, u = cs * difference - ss2 * r.Axy;
    r.Axx = r.Axx - t;
    r.Ayy = r.Ayy + t;
    r.Axy = r.Axy + u;
    const S xz = c * r.Axz - s * r.Ayz;
    r.Ayz = s * r.Axz + c * r.Ayz;
    r.Axz = xz;
  }
  {
    const S difference = r.Hxx - r.Hyy, sum = r.Hxy + r.Hyx;
    const S t = ss * difference + cs * sum, u = cs * difference - ss * sum;
    r.Hxx = r.Hxx - t;
    r.Hyy = r.Hyy + t;
    r.Hxy = r.Hxy + u;
    r.Hyx = r.Hyx + u;
    const S zx = c * r.Hzx - s * r.Hzy;
    r.Hzy = s * r.Hzx + c * r.Hzy;
    r.Hzx = zx;
  }
  {
    const S difference = r.Ixx - r.Iyy;
    const S t = ss * difference + cs2 * r.Ixy, u = cs * difference - ss2 * r.Ixy;
    r.Ixx = r.Ixx - t;
    r.Iyy = r.Iyy + t;
    r.Ixy = r.Ixy + u;
  }
  const S hxx = r.Hxx, hxy = r.Hxy, hyx = r.Hyx;
  const S x = d * r.Axy;
  r.Hxx = r.Hxx - x;
  r.Hyx = r.Hyx - d * r.Ayy;
  r.Hzx = r.Hzx - d * r.Ayz;
  r.Hxy = r.Hxy + d * r.Axx;
  r.Hyy = r.Hyy + x;
  r.Hzy = r.Hzy + d * r.Axz;
  r.Ixx = r.Ixx - d * (r.Hyx + hyx);
  r.Iyy = r.Iyy + d * (r.Hxy + hxy);
  r.Ixy = r.Ixy + d * (hxx - r.Hyy);
}

/// Turn about x by the link's α.
template <class Link, class S>
MOMENTA_INLINE void turn_x(const Reduced<S>& r, const Link& l, Full<S>& m) {
  const double ca = l.ca, sa = l.sa;
  const S difference = r.Ayy - r.Azz;
  const S t = l.ss * difference + l.cs2 * r.Ayz, u = l.cs * difference - l.ss2 * r.Ayz;
  m.Axx = r.Axx;
  m.Ayy = r.Ayy - t;
  m.Azz = r.Azz + t;
  m.Ayz = r.Ayz + u;
  m.Axy = ca * r.Axy - sa * r.Axz;
  m.Axz = sa * r.Axy + ca * r.Axz;
  m.Hxx = r.Hxx;
  m.Hyx = ca * r.Hyx - sa * r.Hzx;
  m.Hzx = sa * r.Hyx + ca * r.Hzx;
  m.Hxy = ca * r.Hxy;
  m.Hxz = sa * r.Hxy;
  const S yy = l.cc * r.Hyy, yz = l.cs * r.Hyy, zy = l.cs * r.Hzy, zz = l.cc * r.Hzy;
  m.Hyy = yy - zy;
  m.Hzz = r.Hyy - m.Hyy;
  m.Hzy = yz + zz;
  m.Hyz = m.Hzy - r.Hzy;
  m.Ixx = r.Ixx;
  m.Ixy = ca * r.Ixy;
  m.Ixz = sa * r.Ixy;
  m.Iyy = l.cc * r.Iyy;
  m.Iyz = l.cs * r.Iyy;
  m.Izz = r.Iyy - m.Iyy;
}

/// Shift along x by a, the matrix full.
template <class S>
MOMENTA_INLINE void shift_x(Full<S>& m, double a) {
  const S hzy = m.Hzy, hyz = m.Hyz, hyy = m.Hyy;
  const S x = a * m.Ayz;
  m.Hxy = m.Hxy - a * m.Axz;
  m.Hyy = m.Hyy - x;
  m.Hzy = m.Hzy - a * m.Azz;
  m.Hxz = m.Hxz + a * m.Axy;
  m.Hyz = m.Hyz + a * m.Ayy;
  m.Hzz = m.Hzz + x;
  m.Iyy = m.Iyy - a * (m.Hzy + hzy);
  m.Izz = m.Izz + a * (m.Hyz + hyz);
  m.Iyz = m.Iyz + a * (hyy - m.Hzz);
  m.Ixy = m.Ixy - a * m.Hzx;
  m.Ixz = m.Ixz + a * m.Hyx;
}

/// Turn about x by +90° (y ← −z, z ← y) and shift along x by a: ω_y has no row and no column before
/// the shift.
template <class S>
MOMENTA_INLINE void right_turn_and_shift_x(const Reduced<S>& r, double a, Full<S>& m) {
  m.Axx = r.Axx;
  m.Axy = -r.Axz;
  m.Axz = r.Axy;
  m.Ayy = r.Azz;
  m.Ayz = -r.Ayz;
  m.Azz = r.Ayy;
  const S x = a * r.Ayz;
  m.Hxx = r.Hxx;
  m.Hyx = -r.Hzx;
  m.Hzx = r.Hyx;
  m.Hxy = -(a * r.Axy);
  m.Hyy = x;
  m.Hzy = -(a * r.Ayy);
  m.Hxz = r.Hxy - a * r.Axz;
  m.Hyz = a * r.Azz - r.Hzy;
  m.Hzz = r.Hyy - x;
  m.Ixx = r.Ixx;
  m.Ixy = -(a * r.Hyx);
  m.Ixz = r.Ixy - a * r.Hzx;
  m.Iyy = -(a * m.Hzy);
  m.Iyz = -(a * m.Hzz);
  m.Izz = r.Iyy + a * (m.Hyz - r.Hzy);
}

/// Parallel axes: α = 0 or 180°, sign = cos α. ω_z has no row and no column before the shift.
template <class S>
MOMENTA_INLINE void parallel_turn_and_shift_x(const Reduced<S>& r, double sign, double a,
                                              Full<S>& m) {
  m.Axx = r.Axx;
  m.Axy = sign * r.Axy;
  m.Axz = sign * r.Axz;
  m.Ayy = r.Ayy;
  m.Ayz = r.Ayz;
  m.Azz = r.Azz;
  m.Hxx = r.Hxx;
  m.Hyx = sign * r.Hyx;
  m.Hzx = sign * r.Hzx;
  const S x = a * r.Ayz;
  m.Hxy = sign * r.Hxy - a * m.Axz;
  m.Hyy = r.Hyy - x;
  m.Hzy = r.Hzy - a * r.Azz;
  m.Hxz = a * m.Axy;
  m.Hyz = a * r.Ayy;
  m.Hzz = x;
  m.Ixx = r.Ixx;
  m.Ixy = sign * r.Ixy - a * m.Hzx;
  m.Ixz = a * m.Hyx;
  m.Iyy = r.Iyy - a * (m.Hzy + r.Hzy);
  m.Iyz = a * m.Hyy;
  m.Izz = a * m.Hyz;
}

// Turns of the full matrix about an axis, here called z: of a symmetric block, without its zz …
template <class S, class C>
MOMENTA_INLINE void turn_symmetric(const C& c, const C& s, S& xx, S& xy, S& xz, S& yy, S& yz) {
  const C cs = c * s, ss = s * s;
  const S difference = xx - yy;
  const S t = ss * difference + (cs + cs) * xy, u = cs * difference - (ss + ss) * xy;
  xx = xx - t;
  yy = yy + t;
  xy = xy + u;
  const S x = c * xz - s * yz;
  yz = s * xz + c * yz;
  xz = x;
}
// … and of a general one.
template <class S, class C>
MOMENTA_INLINE void turn_general(const C& c, const C& s, S& xx, S& xy, S& xz, S& yx, S& yy, S& yz,
                                 S& zx, S& zy) {
  const C cs = c * s, ss = s * s;
  const S difference = xx - yy, sum = xy + yx;
  const S t = ss * difference + cs * sum, u = cs * difference - ss * sum;
  xx = xx - t;
  yy = yy + t;
  xy = xy + u;
  yx = yx + u;
  S x = c * zx - s * zy;
  zy = s * zx + c * zy;
  zx = x;
  x = c * xz - s * yz;
  yz = s * xz + c * yz;
  xz = x;
}

/// The turn of the full matrix about x.
template <class S, class C>
MOMENTA_INLINE void turn_x(Full<S>& m, const C& c, const C& s) {
  turn_symmetric(c, s, m.Ayy, m.Ayz, m.Axy, m.Azz, m.Axz);
  turn_symmetric(c, s, m.Iyy, m.Iyz, m.Ixy, m.Izz, m.Ixz);
  turn_general(c, s, m.Hyy, m.Hyz, m.Hyx, m.Hzy, m.Hzz, m.Hzx, m.Hxy, m.Hxz);
}

/// The same by +90°, y ← −z, z ← y: nothing is rounded.
template <class S>
MOMENTA_INLINE void right_turn_x(Full<S>& m) {
  const Full<S> r = m;
  m.Axy = -r.Axz;
  m.Axz = r.Axy;
  m.Ayy = r.Azz;
  m.Ayz = -r.Ayz;
  m.Azz = r.Ayy;
  m.Hxy = -r.Hxz;
  m.Hxz = r.Hxy;
  m.Hyx = -r.Hzx;
  m.Hzx = r.Hyx;
  m.Hyy = r.Hzz;
  m.Hyz = -r.Hzy;
  m.Hzy = -r.Hyz;
  m.Hzz = r.Hyy;
  m.Ixy = -r.Ixz;
  m.Ixz = r.Ixy;
  m.Iyy = r.Izz;
  m.Iyz = -r.Iyz;
  m.Izz = r.Iyy;
}

/// A screw about z of the full matrix: of a joint on one axis, and the way to a joint that is not
/// its parent's first.
template <class S, class C>
MOMENTA_INLINE void turn_and_shift_z(Full<S>& m, const C& c, const C& s, const C& d) {
  turn_symmetric(c, s, m.Axx, m.Axy, m.Axz, m.Ayy, m.Ayz);
  turn_symmetric(c, s, m.Ixx, m.Ixy, m.Ixz, m.Iyy, m.Iyz);
  turn_general(c, s, m.Hxx, m.Hxy, m.Hxz, m.Hyx, m.Hyy, m.Hyz, m.Hzx, m.Hzy);
  const S hxx = m.Hxx, hxy = m.Hxy, hyx = m.Hyx;
  const S x = d * m.Axy;
  m.Hxx = m.Hxx - x;
  m.Hyx = m.Hyx - d * m.Ayy;
  m.Hzx = m.Hzx - d * m.Ayz;
  m.Hxy = m.Hxy + d * m.Axx;
  m.Hyy = m.Hyy + x;
  m.Hzy = m.Hzy + d * m.Axz;
  m.Ixx = m.Ixx - d * (m.Hyx + hyx);
  m.Iyy = m.Iyy + d * (m.Hxy + hxy);
  m.Ixy = m.Ixy + d * (hxx - m.Hyy);
  m.Ixz = m.Ixz - d * m.Hyz;
  m.Iyz = m.Iyz + d * m.Hxz;
}

/// + M_K of the body itself.
template <class Link, class S>
MOMENTA_INLINE void add_body(Full<S>& m, const Link& l) {
  m.Axx = m.Axx + l.m;
  m.Ayy = m.Ayy + l.m;
  m.Azz = m.Azz + l.m;
  m.Hxy = m.Hxy + l.c[2];
  m.Hyx = m.Hyx - l.c[2];
  m.Hxz = m.Hxz - l.c[1];
  m.Hzx = m.Hzx + l.c[1];
  m.Hyz = m.Hyz + l.c[0];
  m.Hzy = m.Hzy - l.c[0];
  m.Ixx = m.Ixx + l.J[0];
  m.Ixy = m.Ixy + l.J[1];
  m.Ixz = m.Ixz + l.J[2];
  m.Iyy = m.Iyy + l.J[3];
  m.Iyz = m.Iyz + l.J[4];
  m.Izz = m.Izz + l.J[5];
}

/// M_K of a body that carries nothing.
template <class Link, class S>
MOMENTA_INLINE void set_body(Full<S>& m, const Link& l) {
  m.Axy = m.Axz = m.Ayz = m.Hxx = m.Hyy = m.Hzz = S(0.0);
  m.Axx = m.Ayy = m.Azz = S(l.m);
  m.Hxy = S(l.c[2]);
  m.Hyx = S(-l.c[2]);
  m.Hxz = S(-l.c[1]);
  m.Hzx = S(l.c[1]);
  m.Hyz = S(l.c[0]);
  m.Hzy = S(-l.c[0]);
  m.Ixx = S(l.J[0]);
  m.Ixy = S(l.J[1]);
  m.Ixz = S(l.J[2]);
  m.Iyy = S(l.J[3]);
  m.Iyz = S(l.J[4]);
  m.Izz = S(l.J[5]);
}

}  // namespace momenta
