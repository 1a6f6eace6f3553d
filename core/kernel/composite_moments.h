#pragma once
// First and second moments of subtrees, and their way over a revolute joint: for
// composite_sweeps.h.

#include <momenta/core/kernel/acceleration_field.h>

namespace momenta {

/// c and Σ of a subtree about O, without its mass.
template <class S>
struct CompositeMoments {
  S x, y, z, xx, xy, xz, yy, yz, zz;
};
template <class S>
MOMENTA_INLINE void add(CompositeMoments<S>& a, const CompositeMoments<S>& b) {
  a.x = a.x + b.x;
  a.y = a.y + b.y;
  a.z = a.z + b.z;
  a.xx = a.xx + b.xx;
  a.xy = a.xy + b.xy;
  a.xz = a.xz + b.xz;
  a.yy = a.yy + b.yy;
  a.yz = a.yz + b.yz;
  a.zz = a.zz + b.zz;
}
/// Adds the body's own moments; on a revolute joint c_z = Σ_zz = 0.
template <bool revolute, class S>
MOMENTA_INLINE void add_body(CompositeMoments<S>& a, const MassMoments<S>& b) {
  a.x = a.x + b.c[0];
  a.y = a.y + b.c[1];
  a.xx = a.xx + b.s[0];
  a.xy = a.xy + b.s[1];
  a.xz = a.xz + b.s[2];
  a.yy = a.yy + b.s[3];
  a.yz = a.yz + b.s[4];
  if constexpr (!revolute) {
    a.z = a.z + b.c[2];
    a.zz = a.zz + b.s[5];
  }
}
template <class S>
MOMENTA_INLINE void set_body(CompositeMoments<S>& a, const MassMoments<S>& b) {
  a = {S(b.c[0]), S(b.c[1]), S(b.c[2]), S(b.s[0]), S(b.s[1]),
       S(b.s[2]), S(b.s[3]), S(b.s[4]), S(b.s[5])};
}

/// The revolute joint's own screw, inward.
template <class S>
MOMENTA_INLINE void screw_z(CompositeMoments<S>& m, const S& c, const S& s, double d) {
  const S ss = s * s, cs = c * s;
  const S difference = m.xx - m.yy, twice = m.xy + m.xy;
  const S t = ss * difference + cs * twice, u = cs * difference - ss * twice;
  m.xx = m.xx - t;
  m.yy = m.yy + t;
  m.xy = m.xy + u;
  turn_inward_z(c, s, m.xz, m.yz);
  turn_inward_z(c, s, m.x, m.y);
  const S dz = d * m.z;
  m.xz = m.xz + d * m.x;
  m.yz = m.yz + d * m.y;
  m.zz = m.zz + (dz + dz);
}
/// The screw about x to the parent.
template <class S>
MOMENTA_INLINE void screw_x(CompositeMoments<S>& m, const Link& l) {
  switch (l.turn) {
    case Turn::right: {
      const S yy = m.yy;
      m.yy = m.zz;
      m.zz = yy;
      m.yz = -m.yz;
      break;
    }
    case Turn::parallel:  // by 0 or 180°
      break;
    default: {
      const S difference = m.yy - m.zz;
      const S t = l.ss * difference + l.cs2 * m.yz, u = l.cs * difference - l.ss2 * m.yz;
      m.yy = m.yy - t;
      m.zz = m.zz + t;
      m.yz = m.yz + u;
    }
  }
  turn_inward_x(l, m.xy, m.xz);
  turn_inward_x(l, m.y, m.z);
  const S ax = l.a * m.x;
  m.xx = m.xx + (ax + ax);
  m.xy = m.xy + l.a * m.y;
  m.xz = m.xz + l.a * m.z;
}

}  // namespace momenta
