#pragma once
// M*_K by named entries, (43): additions of bodies and children, turns and shifts on the way to a
// parent where no row or column is known to vanish.
//
// All scalars stay in registers.

#include <momenta/core/kernel/spatial.h>
#include <momenta/core/scalar/dual.h>
#include <momenta/core/scalar/pack.h>

namespace momenta {

/// M* by named entries.
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
  const auto& A = m.A.x;
  const auto& H = m.H.x;
  const auto& I = m.I.x;
  return {A[0], A[1], A[2], A[3], A[4], A[5], H[0], H[1], H[2], H[3], H[4],
          H[5], H[6], H[7], H[8], I[0], I[1], I[2], I[3], I[4], I[5]};
}
template <class S>
Spatial::ArticulatedInertia<S> blocks(const Full<S>& m) {
  return {{{m.Axx, m.Axy, m.Axz, m.Ayy, m.Ayz, m.Azz}},
          {{m.Hxx, m.Hxy, m.Hxz, m.Hyx, m.Hyy, m.Hyz, m.Hzx, m.Hzy, m.Hzz}},
          {{m.Ixx, m.Ixy, m.Ixz, m.Iyy, m.Iyz, m.Izz}}};
}

// Turns of the full matrix about an axis, here z: of a symmetric block, without its zz …
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

/// The same by +90°, y ← −z, z ← y, without rounding.
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

/// Screw of the full matrix about z: for joints on one axis, and on the way to a joint that is not
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

/// Adds M_K of the body itself.
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

/// Sets M_K of a body that carries nothing.
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
