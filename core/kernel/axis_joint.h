#pragma once
// Joints on one axis other than revolute: prismatic, screws, driven, welds. With E = (e_f ẑ; e_n
// ẑ), (0, 1) of a revolute joint, (1, 0) of a prismatic joint, (pitch, 1) of a screw, and U = M*E:
//
//   free      M_j = EᵀU + I_r, h = U / M_j, M' = M* − U hᵀ, D' = D + h (r − Eᵀ D)   (46)-(48);
//             I_r: rotor.h
//   driven    M' = M*, D' = D + U f', of momenta, f the law of motion          (44)
//   welded    M' = M*, D' = D
//
// then the screw (θ, d) about z and the constant ones. One piece of code without calls, every
// intermediate in registers; by kind: general_joint.h.

#include <momenta/core/kernel/revolute.h>

namespace momenta {

/// Components of a motion or a wrench.
template <class S>
struct AxisColumn {
  S fx, fy, fz, nx, ny, nz;
};

// Body, Link and edge constants: those of Model<Spatial>, or those of several mechanisms side by
// side under the same names (BranchLink).

/// U = M*E.
template <class Body, class S>
MOMENTA_INLINE AxisColumn<S> axis_column(const Body& b, const Full<S>& m) {
  if (b.kind == JointKind::prismatic) return {m.Axz, m.Ayz, m.Azz, m.Hzx, m.Hzy, m.Hzz};
  const double pitch = b.kind == JointKind::helical ? b.pitch : 0;
  return {pitch * m.Axz + m.Hxz, pitch * m.Ayz + m.Hyz, pitch * m.Azz + m.Hzz,
          pitch * m.Hzx + m.Ixz, pitch * m.Hzy + m.Iyz, pitch * m.Hzz + m.Izz};
}

/// (46)-(48) of a free prismatic joint or screw: M*, D become M', D' for the right-hand side r.
/// False when M_j is not positive to rounding: Joint::inertia_margin, reduce.
template <class Body, class S>
MOMENTA_INLINE bool eliminate_axis(const Body& b, const S& r, Articulated<S>& articulated,
                                   JointRecord<Spatial, S>& x) {
  constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();
  Full<S>& m = articulated.M;
  const bool slides = b.kind == JointKind::prismatic;
  const AxisColumn<S> U = axis_column(b, m);
  const S mass = (slides ? U.fz : b.pitch * U.fz + U.nz) + b.rotor;
  const S along = slides ? articulated.Dfz : b.pitch * articulated.Dfz + articulated.Dnz;
  const auto least = rounding * b.subtree_mass;
  if (!all_positive(slides
                        ? mass - least
                        : mass - (b.pitch * b.pitch * least + rounding * (m.Ixx + m.Iyy + m.Izz))))
    return false;
  const S inverse = S(1.0) / mass, e = r - along;
  const AxisColumn<S> h{inverse * U.fx, inverse * U.fy, inverse * U.fz,
                        inverse * U.nx, inverse * U.ny, inverse * U.nz};
  x.pivot = inverse;
  x.e = e;
  x.h = {{{h.fx, h.fy, h.fz}}, {{h.nx, h.ny, h.nz}}};
  m.Axx = m.Axx - U.fx * h.fx;
  m.Axy = m.Axy - U.fx * h.fy;
  m.Ayy = m.Ayy - U.fy * h.fy;
  m.Hxx = m.Hxx - U.fx * h.nx;
  m.Hxy = m.Hxy - U.fx * h.ny;
  m.Hyx = m.Hyx - U.fy * h.nx;
  m.Hyy = m.Hyy - U.fy * h.ny;
  m.Ixx = m.Ixx - U.nx * h.nx;
  m.Ixy = m.Ixy - U.nx * h.ny;
  m.Iyy = m.Iyy - U.ny * h.ny;
  if (b.has_rotor()) {
    m.Axz = m.Axz - U.fx * h.fz;
    m.Ayz = m.Ayz - U.fy * h.fz;
    m.Azz = m.Azz - U.fz * h.fz;
    m.Hxz = m.Hxz - U.fx * h.nz;
    m.Hyz = m.Hyz - U.fy * h.nz;
    m.Hzx = m.Hzx - U.fz * h.nx;
    m.Hzy = m.Hzy - U.fz * h.ny;
    m.Hzz = m.Hzz - U.fz * h.nz;
    m.Ixz = m.Ixz - U.nx * h.nz;
    m.Iyz = m.Iyz - U.ny * h.nz;
    m.Izz = m.Izz - U.nz * h.nz;
  } else if (slides) {
    m.Hxz = m.Hxz - U.fx * h.nz;
    m.Hyz = m.Hyz - U.fy * h.nz;
    m.Ixz = m.Ixz - U.nx * h.nz;
    m.Iyz = m.Iyz - U.ny * h.nz;
    m.Izz = m.Izz - U.nz * h.nz;
    m.Axz = m.Ayz = m.Azz = m.Hzx = m.Hzy = m.Hzz = S(0.0);
  } else if (std::abs(b.pitch) <= 1) {
    m.Axz = m.Axz - U.fx * h.fz;
    m.Ayz = m.Ayz - U.fy * h.fz;
    m.Azz = m.Azz - U.fz * h.fz;
    m.Hzx = m.Hzx - U.fz * h.nx;
    m.Hzy = m.Hzy - U.fz * h.ny;
    m.Hxz = -b.pitch * m.Axz;
    m.Hyz = -b.pitch * m.Ayz;
    m.Hzz = -b.pitch * m.Azz;
    m.Ixz = -b.pitch * m.Hzx;
    m.Iyz = -b.pitch * m.Hzy;
    m.Izz = -b.pitch * m.Hzz;
  } else {
    const double turns = 1 / b.pitch;
    m.Hxz = m.Hxz - U.fx * h.nz;
    m.Hyz = m.Hyz - U.fy * h.nz;
    m.Ixz = m.Ixz - U.nx * h.nz;
    m.Iyz = m.Iyz - U.ny * h.nz;
    m.Izz = m.Izz - U.nz * h.nz;
    m.Hzx = -turns * m.Ixz;
    m.Hzy = -turns * m.Iyz;
    m.Hzz = -turns * m.Izz;
    m.Axz = -turns * m.Hxz;
    m.Ayz = -turns * m.Hyz;
    m.Azz = -turns * m.Hzz;
  }
  articulated.Dfx = articulated.Dfx + e * h.fx;
  articulated.Dfy = articulated.Dfy + e * h.fy;
  articulated.Dfz = articulated.Dfz + e * h.fz;
  articulated.Dnx = articulated.Dnx + e * h.nx;
  articulated.Dny = articulated.Dny + e * h.ny;
  articulated.Dnz = articulated.Dnz + e * h.nz;
  return true;
}

/// Nearly parallel axes: a turn about y and the screw about x.
template <bool Gravity, class Constants, class Mass, class S>
__attribute__((noinline)) void tilt_inward(const Constants& k, const Mass& m,
                                           Articulated<S>& articulated) {
  Spatial::ArticulatedInertia<S> M = blocks(articulated.M);
  Spatial::Force<S> D = remainder_of(articulated);
  Vec3<S> G{};
  if constexpr (Gravity) G = {{articulated.Gx, articulated.Gy, articulated.Gz}};
  tilt_inward(k, M, D, G);
  if constexpr (Gravity)
    if (k.about_x) G[0] = G[0] + m * k.a;
  set_articulated(articulated, M, D, G);
}

/// M', D' and, for the mass m, G from the joint's frame to the parent's.
template <bool Gravity, class Link, class Constants, class Mass, class S>
MOMENTA_INLINE void carry_axis(const Link& l, const Constants& k, const Spatial::Edge<S>& e,
                               const Mass& m, Articulated<S>& articulated) {
  screw_inward<Gravity>(e.cos_theta, e.sin_theta, e.d, articulated);
  if constexpr (Gravity) articulated.Gz = articulated.Gz + m * e.d;
  if (l.turn == Turn::tilted) {
    tilt_inward<Gravity>(k, m, articulated);
  } else {
    if (l.turn == Turn::right)
      right_turn_x(articulated.M);
    else
      turn_x(articulated.M, l.ca, l.sa);
    shift_x(articulated.M, l.a);
    const auto turn = [&](S& y, S& z) {
      const S before = y;
      y = l.ca * y - l.sa * z;
      z = l.sa * before + l.ca * z;
    };
    turn(articulated.Dfy, articulated.Dfz);
    turn(articulated.Dny, articulated.Dnz);
    articulated.Dny = articulated.Dny - l.a * articulated.Dfz;
    articulated.Dnz = articulated.Dnz + l.a * articulated.Dfy;
    if constexpr (Gravity) {
      turn(articulated.Gy, articulated.Gz);
      articulated.Gx = articulated.Gx + m * l.a;
    }
  }
  if (l.screwed) {
    screw_inward<Gravity>(k.cos_gamma, k.sin_gamma, k.delta, articulated);
    if constexpr (Gravity) articulated.Gz = articulated.Gz + m * k.delta;
  }
}

/// W = 𝒯ⱽ Ω_L in the joint's frame, from the parent's motion in `c`; with gravity, g too.
template <bool Gravity, class Link, class Constants, class S>
MOMENTA_INLINE void constants_and_screw_outward(const Link& l, const Constants& k,
                                                const Spatial::Edge<S>& e, OutwardMotion<S>& c) {
  constants_outward(l, k, c.vx, c.vy, c.vz, c.ox, c.oy, c.oz);
  screw_outward(e.cos_theta, e.sin_theta, e.d, c.vx, c.vy, c.ox, c.oy);
  if constexpr (Gravity) {
    constants_outward(l, k, c.gx, c.gy, c.gz);
    turn_outward(e.cos_theta, e.sin_theta, c.gx, c.gy);
  }
}

/// u = M_j⁻¹ e − hᵀ W, (45).
template <class S>
MOMENTA_INLINE S axis_rate(const JointRecord<Spatial, S>& x, const OutwardMotion<S>& w) {
  return x.pivot * x.e - (x.h.f[0] * w.vx + x.h.f[1] * w.vy + x.h.f[2] * w.vz + x.h.n[0] * w.ox +
                          x.h.n[1] * w.oy + x.h.n[2] * w.oz);
}
/// Ω = W + E u
template <class Body, class S>
MOMENTA_INLINE void add_axis_motion(const Body& b, const S& u, OutwardMotion<S>& w) {
  if (b.kind == JointKind::revolute) {
    w.oz = w.oz + u;
  } else if (b.kind == JointKind::prismatic) {
    w.vz = w.vz + u;
  } else if (b.kind == JointKind::helical) {
    w.vz = w.vz + b.pitch * u;
    w.oz = w.oz + u;
  }
}

/// Eᵀ (T* − Ω × P*) of (35), P* = M*Ω + D: two or four of the six rows of P*.
template <bool Gravity, class Body, class S>
MOMENTA_INLINE S axis_momentum_rate(const Body& b, const JointRecord<Spatial, S>& x,
                                    const OutwardMotion<S>& w) {
  const auto& A = x.M.A.x;
  const auto& H = x.M.H.x;
  const auto& I = x.M.I.x;
  const S fx =
      A[0] * w.vx + A[1] * w.vy + A[2] * w.vz + H[0] * w.ox + H[1] * w.oy + H[2] * w.oz + x.D.f[0];
  const S fy =
      A[1] * w.vx + A[3] * w.vy + A[4] * w.vz + H[3] * w.ox + H[4] * w.oy + H[5] * w.oz + x.D.f[1];
  S along = w.oy * fx - w.ox * fy;  // f here, n below
  if constexpr (Gravity) along = along + b.subtree_mass * w.gz;
  if (b.kind == JointKind::prismatic) return along;
  const S nx =
      H[0] * w.vx + H[3] * w.vy + H[6] * w.vz + I[0] * w.ox + I[1] * w.oy + I[2] * w.oz + x.D.n[0];
  const S ny =
      H[1] * w.vx + H[4] * w.vy + H[7] * w.vz + I[1] * w.ox + I[3] * w.oy + I[4] * w.oz + x.D.n[1];
  S about = w.vy * fx - w.vx * fy + w.oy * nx - w.ox * ny;
  if constexpr (Gravity) about = about + x.moment[0] * w.gy - x.moment[1] * w.gx;
  return b.kind == JointKind::revolute ? about : b.pitch * along + about;
}

}  // namespace momenta
