#pragma once
// How pins and ball joints pass mass matrices and remainders to their parents: shared by the
// momentum and the acceleration recursion.

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

/// What is left of a body once its pin is eliminated: M', and D' and G in its frame.
template <class S>
struct Eliminated {
  Reduced<S> M;
  S fx, fy, fz, nx, ny, nz, Gx, Gy, Gz;
};

template <bool Gravity, class S>
MOMENTA_INLINE void add(Cargo<S>& a, const Cargo<S>& b) {
  add(a.M, b.M);
  a.Dfx = a.Dfx + b.Dfx;
  a.Dfy = a.Dfy + b.Dfy;
  a.Dfz = a.Dfz + b.Dfz;
  a.Dnx = a.Dnx + b.Dnx;
  a.Dny = a.Dny + b.Dny;
  a.Dnz = a.Dnz + b.Dnz;
  if constexpr (Gravity) {
    a.Gx = a.Gx + b.Gx;
    a.Gy = a.Gy + b.Gy;
    a.Gz = a.Gz + b.Gz;
  }
}

/// What a child beside the first leaves in its parent's slot.
template <bool Gravity, class S>
MOMENTA_INLINE void leave(const Link& l, Cargo<S>& slot, const Cargo<S>& cargo) {
  if (l.opens)
    slot = cargo;
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

/// The screw about the parent's z.
template <bool Gravity, class S>
MOMENTA_INLINE void screw_inward(const Spatial::EdgeConstants& e, Cargo<S>& cargo) {
  const double c = e.cos_gamma, s = e.sin_gamma, d = e.delta;
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
template <Turn turn, bool Gravity, class S>
MOMENTA_INLINE void carry(const Eliminated<S>& r, const Link& l, Cargo<S>& cargo) {
  const double ca = l.ca, sa = l.sa, a = l.a;
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

template <class S>
Spatial::Force<S> remainder_of(const Cargo<S>& c) {
  return {{{c.Dfx, c.Dfy, c.Dfz}}, {{c.Dnx, c.Dny, c.Dnz}}};
}
template <class S>
void set_cargo(Cargo<S>& c, const Spatial::ArticulatedInertia<S>& M, const Spatial::Force<S>& D,
               const Vec3<S>& G) {
  c = {full(M), D.f[0], D.f[1], D.f[2], D.n[0], D.n[1], D.n[2], G[0], G[1], G[2]};
}
template <class S>
void set_cargo(OutwardCargo<S>& c, const Spatial::Motion<S>& V, const Vec3<S>& g) {
  c = {V.v[0], V.v[1], V.v[2], V.w[0], V.w[1], V.w[2], g[0], g[1], g[2]};
}

/// Nearly parallel axes: a turn about y and the screw about x.
template <class S>
__attribute__((noinline)) void tilt_inward(const Spatial::EdgeConstants& e, const Eliminated<S>& r,
                                           Cargo<S>& cargo) {
  const S zero(0.0);
  const Reduced<S>& m = r.M;
  Spatial::ArticulatedInertia<S> M{{{m.Axx, m.Axy, m.Axz, m.Ayy, m.Ayz, m.Azz}},
                                   {{m.Hxx, m.Hxy, zero, m.Hyx, m.Hyy, zero, m.Hzx, m.Hzy, zero}},
                                   {{m.Ixx, m.Ixy, zero, m.Iyy, zero, zero}}};
  Spatial::Force<S> D{{{r.fx, r.fy, r.fz}}, {{r.nx, r.ny, r.nz}}};
  Vec3<S> G{{r.Gx, r.Gy, r.Gz}};
  if (e.about_y) {
    Spatial::inertia_inward<1>(M, e.cos_beta, e.sin_beta, 0.0);
    Spatial::force_inward<1>(D, e.cos_beta, e.sin_beta, 0.0);
    momenta::turn<1>(G, e.cos_beta, e.sin_beta);
  }
  if (e.about_x) {
    Spatial::inertia_inward<0>(M, e.cos_alpha, e.sin_alpha, e.a);
    Spatial::force_inward<0>(D, e.cos_alpha, e.sin_alpha, e.a);
    momenta::turn<0>(G, e.cos_alpha, e.sin_alpha);
  }
  set_cargo(cargo, M, D, G);
}

/// All constant screws of a pin, in order.
template <bool Gravity, class S>
MOMENTA_INLINE void carry_any(const Link& l, const Spatial::EdgeConstants& e,
                              const Eliminated<S>& r, Cargo<S>& cargo) {
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
    case Turn::tilted:
      tilt_inward(e, r, cargo);
      break;
  }
  if (l.screwed) screw_inward<Gravity>(e, cargo);
}

/// (46)-(48) of a ball joint by I = L Δ Lᵀ, which leaves A' = A − Z Δ⁻¹ Zᵀ with Z = H L⁻ᵀ, the
/// whole of M', and D'_f = D_f + Z Δ⁻¹ L⁻¹ e. No inverse is formed: shorter, and backward stable.
template <class S>
struct BallPivot {
  S l10, l20, l21, i0, i1, i2;  ///< L, Δ⁻¹
  Mat3<S> s;                    ///< Z Δ⁻¹
  Vec3<S> e;                    ///< L⁻¹ e

  /// False when I is not positive.
  MOMENTA_INLINE bool eliminate(const Full<S>& m, Sym3<S>& A) {
    i0 = S(1.0) / m.Ixx;
    l10 = m.Ixy * i0;
    l20 = m.Ixz * i0;
    const S d1 = m.Iyy - l10 * m.Ixy, below = m.Iyz - l20 * m.Ixy;
    i1 = S(1.0) / d1;
    l21 = below * i1;
    const S d2 = m.Izz - l20 * m.Ixz - l21 * below;
    i2 = S(1.0) / d2;
    if (!pivots_positive(m.Ixx, d1, d2, m.Ixx, m.Iyy, m.Izz)) return false;
    const S zx0 = m.Hxx, zx1 = m.Hxy - l10 * zx0, zx2 = m.Hxz - l20 * zx0 - l21 * zx1;
    const S zy0 = m.Hyx, zy1 = m.Hyy - l10 * zy0, zy2 = m.Hyz - l20 * zy0 - l21 * zy1;
    const S zz0 = m.Hzx, zz1 = m.Hzy - l10 * zz0, zz2 = m.Hzz - l20 * zz0 - l21 * zz1;
    s = {
        {zx0 * i0, zx1 * i1, zx2 * i2, zy0 * i0, zy1 * i1, zy2 * i2, zz0 * i0, zz1 * i1, zz2 * i2}};
    A.x[0] = m.Axx - (s.x[0] * zx0 + s.x[1] * zx1 + s.x[2] * zx2);
    A.x[1] = m.Axy - (s.x[0] * zy0 + s.x[1] * zy1 + s.x[2] * zy2);
    A.x[2] = m.Axz - (s.x[0] * zz0 + s.x[1] * zz1 + s.x[2] * zz2);
    A.x[3] = m.Ayy - (s.x[3] * zy0 + s.x[4] * zy1 + s.x[5] * zy2);
    A.x[4] = m.Ayz - (s.x[3] * zz0 + s.x[4] * zz1 + s.x[5] * zz2);
    A.x[5] = m.Azz - (s.x[6] * zz0 + s.x[7] * zz1 + s.x[8] * zz2);
    return true;
  }
  /// D'_f − D_f from e = r − D_n.
  MOMENTA_INLINE Vec3<S> remainder(const Vec3<S>& right) {
    e[0] = right[0];
    e[1] = right[1] - l10 * e[0];
    e[2] = right[2] - l20 * e[0] - l21 * e[1];
    return s * e;
  }
  /// ω = L⁻ᵀ (Δ⁻¹ L⁻¹ e − (Z Δ⁻¹)ᵀ v) of the body, v the velocity of its origin.
  MOMENTA_INLINE Vec3<S> omega(const Vec3<S>& v) const {
    const Vec3<S> g = transpose_times(s, v);
    const S z = e[2] * i2 - g[2];
    const S y = e[1] * i1 - g[1] - l21 * z;
    return {{e[0] * i0 - g[0] - l10 * y - l20 * z, y, z}};
  }
};

/// M' = (A, 0; 0, 0) and D' = (f, n) of a ball joint in the parent's frame: A turned by R, and what
/// the step r makes of it, H = −A r̃, I = r̃ H.
template <class S>
MOMENTA_INLINE void carry_ball(const Vec3<double>& r, const Mat3<S>& R, const Sym3<S>& A,
                               const Vec3<S>& force, const Vec3<S>& moment, Cargo<S>& cargo) {
  const S rx(r[0]), ry(r[1]), rz(r[2]);
  Mat3<S> RA;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      RA(i, j) = R(i, 0) * A(0, j) + R(i, 1) * A(1, j) + R(i, 2) * A(2, j);
  const auto entry = [&](int i, int j) {
    return RA(i, 0) * R(j, 0) + RA(i, 1) * R(j, 1) + RA(i, 2) * R(j, 2);
  };
  Full<S>& m = cargo.M;
  m.Axx = entry(0, 0);
  m.Axy = entry(0, 1);
  m.Axz = entry(0, 2);
  m.Ayy = entry(1, 1);
  m.Ayz = entry(1, 2);
  m.Azz = entry(2, 2);
  m.Hxx = m.Axz * ry - m.Axy * rz;
  m.Hxy = m.Axx * rz - m.Axz * rx;
  m.Hxz = m.Axy * rx - m.Axx * ry;
  m.Hyx = m.Ayz * ry - m.Ayy * rz;
  m.Hyy = m.Axy * rz - m.Ayz * rx;
  m.Hyz = m.Ayy * rx - m.Axy * ry;
  m.Hzx = m.Azz * ry - m.Ayz * rz;
  m.Hzy = m.Axz * rz - m.Azz * rx;
  m.Hzz = m.Ayz * rx - m.Axz * ry;
  m.Ixx = ry * m.Hzx - rz * m.Hyx;
  m.Ixy = ry * m.Hzy - rz * m.Hyy;
  m.Ixz = ry * m.Hzz - rz * m.Hyz;
  m.Iyy = rz * m.Hxy - rx * m.Hzy;
  m.Iyz = rz * m.Hxz - rx * m.Hzz;
  m.Izz = rx * m.Hyz - ry * m.Hxz;
  const Vec3<S> f = R * force, n = R * moment;
  cargo.Dfx = f[0];
  cargo.Dfy = f[1];
  cargo.Dfz = f[2];
  cargo.Dnx = n[0] + ry * f[2] - rz * f[1];
  cargo.Dny = n[1] + rz * f[0] - rx * f[2];
  cargo.Dnz = n[2] + rx * f[1] - ry * f[0];
}

// The constant screws outward, for a direction and for a motion; nearly parallel axes out of line.
template <class S>
__attribute__((noinline)) void tilt_outward(const Spatial::EdgeConstants& e, Vec3<S>& g) {
  g = Spatial::direction_to_child(e, JointKind::weld, Spatial::Edge<S>{}, g);
}
template <class S>
__attribute__((noinline)) void tilt_outward(const Spatial::EdgeConstants& e,
                                            Spatial::Motion<S>& m) {
  m = Spatial::to_child(e, JointKind::weld, Spatial::Edge<S>{}, m);
}
template <class S>
MOMENTA_INLINE void constants_outward(const Link& l, const Spatial::EdgeConstants& e, S& gx, S& gy,
                                      S& gz) {
  S x;
  if (l.turn == Turn::tilted) {
    Vec3<S> g{{gx, gy, gz}};
    tilt_outward(e, g);
    gx = g[0];
    gy = g[1];
    gz = g[2];
    return;
  }
  if (l.screwed) {
    x = e.cos_gamma * gx + e.sin_gamma * gy;
    gy = e.cos_gamma * gy - e.sin_gamma * gx;
    gx = x;
  }
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
template <class S>
MOMENTA_INLINE void constants_outward(const Link& l, const Spatial::EdgeConstants& e, S& vx, S& vy,
                                      S& vz, S& ox, S& oy, S& oz) {
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
  if (l.screwed) {
    vx = vx + e.delta * oy;
    vy = vy - e.delta * ox;
    x = e.cos_gamma * vx + e.sin_gamma * vy;
    vy = e.cos_gamma * vy - e.sin_gamma * vx;
    vx = x;
    x = e.cos_gamma * ox + e.sin_gamma * oy;
    oy = e.cos_gamma * oy - e.sin_gamma * ox;
    ox = x;
  }
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

/// Sines and cosines of all pins, turned axes of ball joints (`axes(record)`), edges of the others.
template <class S, class In, class Axes>
void place_links(const LinkTree& tree, const S& t, const In& q, Angles<S>& angles,
                 std::vector<JointRecord<Spatial, S>>& joints, std::vector<UserRecord<S>>& users,
                 Axes&& axes) {
  const Link* links = tree.links.data();
  const double* theta0 = tree.theta0.data();
  const std::size_t n = angles.size();
  for (std::size_t k = 0; k < n; ++k)
    angles.set(k, links[k].kind == LinkKind::pin ? q[links[k].q] + theta0[k] : S(0.0));
  angles.turn();
  if (joints.empty() && tree.balls.empty()) return;
  for (std::size_t k = 0; k < n; ++k) {
    if (links[k].kind == LinkKind::pin) continue;
    const auto& b = tree.model->bodies[k];
    const auto record = static_cast<std::size_t>(links[k].record);
    if (links[k].kind == LinkKind::ball) {
      const S at[4] = {q[b.q], q[b.q + 1], q[b.q + 2], q[b.q + 3]};
      // c ∘ q, the constant turn and the joint's own as one quaternion
      const double* c = tree.balls[record].turn;
      const S both[4] = {c[0] * at[0] - c[1] * at[1] - c[2] * at[2] - c[3] * at[3],
                         c[0] * at[1] + c[1] * at[0] + c[2] * at[3] - c[3] * at[2],
                         c[0] * at[2] + c[2] * at[0] + c[3] * at[1] - c[1] * at[3],
                         c[0] * at[3] + c[3] * at[0] + c[1] * at[2] - c[2] * at[1]};
      axes(record) = rotation_of(both);
      continue;
    }
    auto& x = joints[record];
    S at[7]{};
    for (int i = 0; i < b.nq; ++i) at[i] = q[b.q + i];
    if (b.law) {
      x.user = &users[static_cast<std::size_t>(b.user)];
      Joint<Spatial>::place(b, t, static_cast<const S*>(at), x.user->motion, x.edge);
      continue;
    }
    if (b.drive >= 0)
      prescribe(tree.model->drives[static_cast<std::size_t>(b.drive)], t, x.drive, x.drive_rate,
                x.drive_acceleration);
    Joint<Spatial>::place<S>(b, nullptr, b.drive >= 0 ? x.drive : at[0], at, x.edge);
  }
}

}  // namespace momenta
