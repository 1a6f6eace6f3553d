#pragma once
// The columns C of open loops on their way to the parent: each is a wrench, so the screws of the
// edge turn and shift all of them as they do one force, eq. (22). Six parts at a time: a part holds
// as many slots as a register, or one slot of a pack.

#include <momenta/core/kernel/link.h>
#include <momenta/core/kernel/spatial.h>
#include <momenta/dae/kkt/sweeps/front.h>

namespace momenta {

/// One screw about axis X: turn (c, s), shift t.
template <int X, class Part>
MOMENTA_INLINE void screw_columns(Part* C6, const Part& c, const Part& s, const Part& t) {
  constexpr int Y = (X + 1) % 3, Z = (X + 2) % 3;
  const auto turn = [&](Part* v) MOMENTA_INLINED {
    const Part y = v[Y] * c - v[Z] * s;
    v[Z] = v[Y] * s + v[Z] * c;
    v[Y] = y;
  };
  turn(C6);
  turn(C6 + 3);
  C6[3 + Y] = C6[3 + Y] - C6[Z] * t;
  C6[3 + Z] = C6[3 + Z] + C6[Y] * t;
}

/// The constant screws of an edge, from the joint to the parent's frame.
template <class Constants, class Part>
MOMENTA_INLINE void columns_to_parent(const Constants& e, Part* C6) {
  if (e.about_y) screw_columns<1>(C6, Part(e.cos_beta), Part(e.sin_beta), Part(0.0));
  if (e.about_x) screw_columns<0>(C6, Part(e.cos_alpha), Part(e.sin_alpha), Part(e.a));
  if (e.about_z) screw_columns<2>(C6, Part(e.cos_gamma), Part(e.sin_gamma), Part(e.delta));
}

/// The same of a revolute joint's link, by the work its turn about x needs.
template <class Link, class Constants, class Part>
MOMENTA_INLINE void columns_to_parent(const Link& l, const Constants& e, Part* C6) {
  if (l.turn == Turn::general || l.turn == Turn::tilted) return columns_to_parent(e, C6);
  if (l.turn == Turn::right) {
    for (Part* v : {C6, C6 + 3}) {
      const Part y = -v[2];
      v[2] = v[1];
      v[1] = y;
    }
  } else {
    const Part sign(l.ca);
    for (const int i : {1, 2, 4, 5}) C6[i] = C6[i] * sign;
  }
  const Part a(l.a);
  C6[4] = C6[4] - C6[2] * a;
  C6[5] = C6[5] + C6[1] * a;
  if (l.screwed) screw_columns<2>(C6, Part(e.cos_gamma), Part(e.sin_gamma), Part(e.delta));
}

/// Rotation R and then step r of a joint that moves freely.
template <class Here, class S>
MOMENTA_INLINE void columns_to_parent(const Mat3<S>& R, const Vec3<S>& r, typename Here::Part* C6) {
  using Part = typename Here::Part;
  for (Part* v : {C6, C6 + 3}) {
    const Part x = v[0], y = v[1], z = v[2];
    for (int i = 0; i < 3; ++i)
      v[i] = x * Here::all(R(i, 0)) + y * Here::all(R(i, 1)) + z * Here::all(R(i, 2));
  }
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    C6[3 + i] = C6[3 + i] + (C6[k] * Here::all(r[j]) - C6[j] * Here::all(r[k]));
  }
}

/// Adds what a closed row leaves: c f cᵀ to M*, c f d to D.
template <class S, class Articulated>
struct SpatialWeight {
  Articulated& a;
  MOMENTA_INLINE void operator()(const S* c, const S* f, const S& fd) const {
    auto& m = a.M;
    m.Axx = m.Axx + c[0] * f[0];
    m.Axy = m.Axy + c[0] * f[1];
    m.Axz = m.Axz + c[0] * f[2];
    m.Ayy = m.Ayy + c[1] * f[1];
    m.Ayz = m.Ayz + c[1] * f[2];
    m.Azz = m.Azz + c[2] * f[2];
    m.Hxx = m.Hxx + c[0] * f[3];
    m.Hxy = m.Hxy + c[0] * f[4];
    m.Hxz = m.Hxz + c[0] * f[5];
    m.Hyx = m.Hyx + c[1] * f[3];
    m.Hyy = m.Hyy + c[1] * f[4];
    m.Hyz = m.Hyz + c[1] * f[5];
    m.Hzx = m.Hzx + c[2] * f[3];
    m.Hzy = m.Hzy + c[2] * f[4];
    m.Hzz = m.Hzz + c[2] * f[5];
    m.Ixx = m.Ixx + c[3] * f[3];
    m.Ixy = m.Ixy + c[3] * f[4];
    m.Ixz = m.Ixz + c[3] * f[5];
    m.Iyy = m.Iyy + c[4] * f[4];
    m.Iyz = m.Iyz + c[4] * f[5];
    m.Izz = m.Izz + c[5] * f[5];
    a.Dfx = a.Dfx + c[0] * fd;
    a.Dfy = a.Dfy + c[1] * fd;
    a.Dfz = a.Dfz + c[2] * fd;
    a.Dnx = a.Dnx + c[3] * fd;
    a.Dny = a.Dny + c[4] * fd;
    a.Dnz = a.Dnz + c[5] * fd;
  }
};

}  // namespace momenta
