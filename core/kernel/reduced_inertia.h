#pragma once
// M*_K of a body on a revolute joint, taken to its parent: (47) and 𝒯ᶠ M' 𝒯ⱽ of (43), entry by
// entry.
//
// M' = M* − U hᵀ has no row and no column for ω_z: 15 numbers instead of 21. The joint's screw
// about z turns and shifts them among themselves. The turn about x that follows fills the third
// column from two others and must come before the shift along x, which needs the full matrix. A
// right angle about x only swaps and changes signs, leaving ω_y without row and column for the
// shift.

#include <momenta/core/kernel/full_inertia.h>

namespace momenta {

/// M' in the revolute joint's frame: A = (Axx … Azz), H without its last column, I without its last
/// row.
template <class S>
struct Reduced {
  S Axx, Axy, Axz, Ayy, Ayz, Azz, Hxx, Hxy, Hyx, Hyy, Hzx, Hzy, Ixx, Ixy, Iyy;
};

/// h = M*E M_j⁻¹ of a revolute joint; its last entry is 1.
template <class S>
struct RevoluteColumn {
  S fx, fy, fz, nx, ny;
};

/// (47), with inverse = M_j⁻¹ = 1 / I_zz.
template <class S>
MOMENTA_INLINE void eliminate_revolute(const Full<S>& m, const S& inverse, RevoluteColumn<S>& h,
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

/// Entries of M' in Eᵀ(Ω × P*) of a revolute joint, P* = M' W + D'. About the axis W serves for Ω,
/// as E u adds nothing there, and the quadratic form Eᵀ(W × M' W), collected, has ten numbers
/// instead of eighteen in four rows of M'; the joint's turn needs the sums and differences anyway.
template <class S>
struct RevoluteTurning {
  S A, Axy, Axz, Ayz;  ///< Axx − Ayy, …
  S Hd, Hs, Hzx, Hzy;  ///< Hxx − Hyy, Hxy + Hyx, …
  S I, Ixy;            ///< Ixx − Iyy, …
};
template <class S>
MOMENTA_INLINE RevoluteTurning<S> turning_of(const Reduced<S>& m) {
  return {m.Axx - m.Ayy, m.Axy, m.Axz, m.Ayz,         m.Hxx - m.Hyy,
          m.Hxy + m.Hyx, m.Hzx, m.Hzy, m.Ixx - m.Iyy, m.Ixy};
}

/// −Eᵀ(W × (M' W + D')).
template <class S>
MOMENTA_INLINE S turning_rate(const RevoluteTurning<S>& m, const S& Dfx, const S& Dfy, const S& Dnx,
                              const S& Dny, const S& vx, const S& vy, const S& vz, const S& ox,
                              const S& oy) {
  return vy * (m.A * vx + m.Axy * vy + m.Axz * vz + m.Hd * ox + m.Hs * oy + Dfx) -
         vx * (m.Axy * vx + m.Ayz * vz - m.Hd * oy + m.Hs * ox + Dfy) +
         oy * (m.I * ox + m.Ixy * oy + m.Hzx * vz + Dnx) - ox * (m.Ixy * ox + m.Hzy * vz + Dny);
}

/// The revolute joint's own screw: turn by θ, 2 × 2 blocks by their trace and difference, `m` =
/// turning_of(r), then shift along z by d: H' = H − A r̃, I' = I − Hᵀ r̃ + r̃ H'.
template <class S, class C>
MOMENTA_INLINE void turn_and_shift_z(Reduced<S>& r, const RevoluteTurning<S>& m, const S& c,
                                     const S& s, const C& d) {
  const S ss = s * s, cs = c * s, ss2 = ss + ss, cs2 = cs + cs;
  {
    const S t = ss * m.A + cs2 * r.Axy, u = cs * m.A - ss2 * r.Axy;
    r.Axx = r.Axx - t;
    r.Ayy = r.Ayy + t;
    r.Axy = r.Axy + u;
    const S xz = c * r.Axz - s * r.Ayz;
    r.Ayz = s * r.Axz + c * r.Ayz;
    r.Axz = xz;
  }
  {
    const S t = ss * m.Hd + cs * m.Hs, u = cs * m.Hd - ss * m.Hs;
    r.Hxx = r.Hxx - t;
    r.Hyy = r.Hyy + t;
    r.Hxy = r.Hxy + u;
    r.Hyx = r.Hyx + u;
    const S zx = c * r.Hzx - s * r.Hzy;
    r.Hzy = s * r.Hzx + c * r.Hzy;
    r.Hzx = zx;
  }
  {
    const S t = ss * m.I + cs2 * r.Ixy, u = cs * m.I - ss2 * r.Ixy;
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
  const auto &ca = l.ca, &sa = l.sa;
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

/// Shift of the full matrix along x by a.
template <class S, class C>
MOMENTA_INLINE void shift_x(Full<S>& m, const C& a) {
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
template <class S, class C>
MOMENTA_INLINE void right_turn_and_shift_x(const Reduced<S>& r, const C& a, Full<S>& m) {
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
template <class S, class C>
MOMENTA_INLINE void parallel_turn_and_shift_x(const Reduced<S>& r, const C& sign, const C& a,
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

}  // namespace momenta
