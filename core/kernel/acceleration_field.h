#pragma once
// Field of accelerations a + K r of a body, K = α~ + ω~ ω~, the wrench it takes, and the turns of
// both over a revolute joint: for inverse_dynamics_sweeps.h.

#include <momenta/core/kernel/mass_moments.h>

namespace momenta {

/// Entries of K.
template <class S>
struct AccelerationField {
  S xx, xy, xz, yx, yy, yz, zx, zy, zz;
};
template <class S>
MOMENTA_INLINE AccelerationField<S> acceleration_field(const S& ox, const S& oy, const S& oz,
                                                       const S& ex, const S& ey, const S& ez) {
  const S x2 = ox * ox, y2 = oy * oy, z2 = oz * oz, xy = ox * oy, xz = ox * oz, yz = oy * oz;
  return {-(y2 + z2), xy - ez, xz + ey, xy + ez, -(x2 + z2), yz - ex, xz - ey, yz + ex, -(x2 + y2)};
}

/// Wrench on a body: f without m a, n about O.
template <class S>
struct PlainWrench {
  S fx, fy, fz, nx, ny, nz;
};
/// Wrench of the body itself; on a revolute joint c_z = Σ_zz = 0.
template <bool revolute, class S>
MOMENTA_INLINE void own_wrench(const MassMoments<S>& b, const AccelerationField<S>& K, const S& ax,
                               const S& ay, const S& az, PlainWrench<S>& w) {
  const double *c = b.c, *s = b.s;
  w.fx = K.xx * c[0] + K.xy * c[1];
  w.fy = K.yx * c[0] + K.yy * c[1];
  w.fz = K.zx * c[0] + K.zy * c[1];
  w.nx = (K.zz - K.yy) * s[4] + K.zy * s[3] + K.zx * s[1] - K.yx * s[2] + c[1] * az;
  w.ny = (K.xx - K.zz) * s[2] + K.xy * s[4] - K.zx * s[0] - K.zy * s[1] - c[0] * az;
  w.nz = (K.yy - K.xx) * s[1] + K.yx * s[0] - K.xy * s[3] + K.yz * s[2] - K.xz * s[4] +
         (c[0] * ay - c[1] * ax);
  if constexpr (!revolute) {
    w.fx = w.fx + K.xz * c[2];
    w.fy = w.fy + K.yz * c[2];
    w.fz = w.fz + K.zz * c[2];
    w.nx = w.nx - K.yz * s[5] - c[2] * ay;
    w.ny = w.ny + K.xz * s[5] + c[2] * ax;
  }
}
template <class S>
MOMENTA_INLINE void add(PlainWrench<S>& a, const PlainWrench<S>& b) {
  a.fx = a.fx + b.fx;
  a.fy = a.fy + b.fy;
  a.fz = a.fz + b.fz;
  a.nx = a.nx + b.nx;
  a.ny = a.ny + b.ny;
  a.nz = a.nz + b.nz;
}

/// Quantities passed outward: ω, a, α and the first column of K.
template <class S>
struct Spin {
  S ox, oy, oz, ax, ay, az, ex, ey, ez, kx, ky, kz;
};

// The turn about x by the link's α: parent components to the child's, and back.
template <class S>
MOMENTA_INLINE void turn_outward_x(const Link& l, S& y, S& z) {
  const S before = y;
  switch (l.turn) {
    case Turn::right:
      y = z;
      z = -before;
      break;
    case Turn::parallel:
      y = l.ca * y;
      z = l.ca * z;
      break;
    default:
      y = l.ca * y + l.sa * z;
      z = l.ca * z - l.sa * before;
  }
}
template <class S>
MOMENTA_INLINE void turn_inward_x(const Link& l, S& y, S& z) {
  const S before = y;
  switch (l.turn) {
    case Turn::right:
      y = -z;
      z = before;
      break;
    case Turn::parallel:
      y = l.ca * y;
      z = l.ca * z;
      break;
    default:
      y = l.ca * y - l.sa * z;
      z = l.sa * before + l.ca * z;
  }
}
/// (x, y) = (c x + s y, c y − s x)
template <class S>
MOMENTA_INLINE void turn_outward_z(const S& c, const S& s, S& x, S& y) {
  const S before = x;
  x = c * x + s * y;
  y = c * y - s * before;
}
template <class S>
MOMENTA_INLINE void turn_inward_z(const S& c, const S& s, S& x, S& y) {
  const S before = x;
  x = c * x - s * y;
  y = s * before + c * y;
}

/// Whether a revolute joint is on the ground, or its way from the parent a screw about x.
MOMENTA_INLINE bool is_plain_revolute(const Link& l) {
  return l.kind == LinkKind::revolute && (l.parent < 0 || !(l.screwed || l.turn == Turn::tilted));
}

}  // namespace momenta
