#pragma once
// Inertia I_r of a rotor on a joint's rate: ½ I_r u² of kinetic energy beside that of the bodies,
// as of a motor's armature seen through its gear. It adds one number to the pivot and to p,
//
//   p = Eᵀ P* + I_r u,  M_j = Eᵀ M* E + I_r                                   (34), (46)
//
// and M' = M* − M*E M_j⁻¹ EᵀM* keeps what vanishes without it. About a revolute joint's ẑ, with h =
// M*E M_j⁻¹, γ = I_r M_j⁻¹, h_z = 1 − γ, and R for M' without row and column of ω_z:
//
//   M' = R + k ẑᵀ + ẑ kᵀ,  k = I_r (h − ½ h_z ẑ)                              (47)
//   D'_z = p − I_r M_j⁻¹ e                                                    (48)
//   Ω_z = M_j⁻¹ e − (h − h_z ẑ)ᵀ W + γ W_z                                    (45)
//   P* = R W + D' + I_r W_z h across ẑ                                        (42)
//
// The pair (k, ẑ) goes to the parent as two wrenches do. ẑ is a couple: it enters only H and I.
//
// A spherical joint's rotor has I_r about every axis, ½ I_r u·u with u in child axes. As u × I_r u
// = 0, (35) needs no further term. Its elimination: general_joint.h.

#include <momenta/core/kernel/revolute.h>

namespace momenta {

/// k of (47), in the axes of a wrench, over the joint's own screw.
template <class Link, class S>
MOMENTA_INLINE Spatial::Force<S> turned_rotor(const Link& l, const RevoluteColumn<S>& h,
                                              const S& inverse, const S& c, const S& s) {
  Spatial::Force<S> k{
      {{l.rotor * h.fx, l.rotor * h.fy, l.rotor * h.fz}},
      {{l.rotor * h.nx, l.rotor * h.ny, 0.5 * l.rotor * (1.0 - l.rotor * inverse)}}};
  Spatial::force_inward<2>(k, c, s, S(l.d));
  return k;
}

/// Share of W_z, before the joint's own turning, in −Eᵀ(Ω × P*) of (35).
template <class Inertia, class S>
MOMENTA_INLINE S rotor_rate(const RevoluteColumn<S>& h, const Inertia& rotor, const S& vx,
                            const S& vy, const S& ox, const S& oy, const S& oz) {
  return rotor * oz * (vy * h.fx - vx * h.fy + oy * h.nx - ox * h.ny);
}

/// M += k zᵀ + z kᵀ, z a couple.
template <class S, class C>
MOMENTA_INLINE void add_rotor_pair(const Spatial::Force<S>& k, const Vec3<C>& z, Full<S>& m) {
  m.Hxx = m.Hxx + k.f[0] * z[0];
  m.Hxy = m.Hxy + k.f[0] * z[1];
  m.Hxz = m.Hxz + k.f[0] * z[2];
  m.Hyx = m.Hyx + k.f[1] * z[0];
  m.Hyy = m.Hyy + k.f[1] * z[1];
  m.Hyz = m.Hyz + k.f[1] * z[2];
  m.Hzx = m.Hzx + k.f[2] * z[0];
  m.Hzy = m.Hzy + k.f[2] * z[1];
  m.Hzz = m.Hzz + k.f[2] * z[2];
  m.Ixx = m.Ixx + 2.0 * (k.n[0] * z[0]);
  m.Ixy = m.Ixy + (k.n[0] * z[1] + k.n[1] * z[0]);
  m.Ixz = m.Ixz + (k.n[0] * z[2] + k.n[2] * z[0]);
  m.Iyy = m.Iyy + 2.0 * (k.n[1] * z[1]);
  m.Iyz = m.Iyz + (k.n[1] * z[2] + k.n[2] * z[1]);
  m.Izz = m.Izz + 2.0 * (k.n[2] * z[2]);
}

/// M_L += k ẑᵀ + ẑ kᵀ over the constant screws to the parent.
template <class Edge, class S>
__attribute__((noinline)) void carry_rotor(const Edge& e, Spatial::Force<S> k,
                                           Articulated<S>& parent) {
  using Constant = std::decay_t<decltype(e.cos_alpha)>;
  Spatial::constants_inward(e, k);
  Vec3<Constant> z{{Constant(0.0), Constant(0.0), Constant(1.0)}};
  if (e.about_y) turn<1>(z, e.cos_beta, e.sin_beta);
  if (e.about_x) turn<0>(z, e.cos_alpha, e.sin_alpha);
  if (e.about_z) turn<2>(z, e.cos_gamma, e.sin_gamma);
  add_rotor_pair(k, z, parent.M);
}

/// The same for a link, in place where M_L is in memory, with k in registers: written number by
/// number and read back as one copy, k would wait.
template <class Link, class Edge, class S>
MOMENTA_INLINE void carry_rotor_of(const Link& l, const Edge& e, Spatial::Force<S> k,
                                   Articulated<S>& parent) {
  if (l.turn == Turn::tilted) return carry_rotor(e, k, parent);
  Spatial::force_inward<0>(k, l.ca, l.sa, l.a);
  if (l.screwed) Spatial::force_inward<2>(k, e.cos_gamma, e.sin_gamma, e.delta);
  Full<S>& m = parent.M;
  if (l.turn == Turn::parallel) {  // ẑ stays on its line
    const auto& c = l.ca;
    m.Hxz = m.Hxz + c * k.f[0];
    m.Hyz = m.Hyz + c * k.f[1];
    m.Hzz = m.Hzz + c * k.f[2];
    m.Ixz = m.Ixz + c * k.n[0];
    m.Iyz = m.Iyz + c * k.n[1];
    m.Izz = m.Izz + 2.0 * (c * k.n[2]);
    return;
  }
  using Constant = std::decay_t<decltype(l.ca)>;
  Vec3<Constant> z{{Constant(0.0), -l.sa, l.ca}};
  if (l.screwed) turn<2>(z, e.cos_gamma, e.sin_gamma);
  add_rotor_pair(k, z, m);
}

/// The same out of line and on a copy, so that callers keep their registers for joints without
/// rotors.
template <class Edge, class S>
MOMENTA_INLINE void hand_on_rotor(const Edge& e, const Spatial::Force<S>& k,
                                  Articulated<S>& parent) {
  Articulated<S> here = parent;
  carry_rotor(e, k, here);
  parent = here;
}

}  // namespace momenta
