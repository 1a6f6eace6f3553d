#pragma once
// Elimination of spherical joints, for both recursions. One that carries nothing has constant M*
// and is eliminated once; one on the ground passes nothing on, its origin rests, and ω = I⁻¹ e is
// all.

#include <momenta/core/kernel/revolute.h>

#include <vector>

namespace momenta {

/// (46)-(48) of a spherical joint by I = L Δ Lᵀ: A' = A − Z Δ⁻¹ Zᵀ with Z = H L⁻ᵀ is the whole of
/// M', and D'_f = D_f + Z Δ⁻¹ L⁻¹ e. No inverse: shorter, and backward stable. Pivots by minors, d₁
/// = m₁/I_xx and d₂ = m₂/(I_xx m₁) with m₁ = I_xx I_yy − I_xy² and m₂ = m₁ (I_xx I_zz − I_xz²) −
/// (I_xx I_yz − I_xy I_xz)²: elimination of scaled rows, as exact, and no division waits for
/// another.
template <class S>
struct SphericalPivot {
  S l10, l20, l21, i0, i1, i2;  ///< L, Δ⁻¹
  Mat3<S> s;                    ///< Z Δ⁻¹
  Vec3<S> e;                    ///< L⁻¹ e

  /// L and Δ⁻¹ alone, enough for a joint on the ground. False when I is not positive.
  MOMENTA_INLINE bool factor(const Full<S>& m) {
    const S minor = m.Ixx * m.Iyy - m.Ixy * m.Ixy, below = m.Ixx * m.Iyz - m.Ixy * m.Ixz;
    const S last = minor * (m.Ixx * m.Izz - m.Ixz * m.Ixz) - below * below;
    i0 = S(1.0) / m.Ixx;
    const S r1 = S(1.0) / minor;
    i1 = m.Ixx * r1;
    i2 = m.Ixx * minor / last;
    l10 = m.Ixy * i0;
    l20 = m.Ixz * i0;
    l21 = below * r1;
    return all_positive(m.Ixx) && all_positive(minor) &&
           determinant_positive(last * i0, m.Ixx, m.Iyy, m.Izz);
  }
  /// The same, and A'.
  MOMENTA_INLINE bool eliminate(const Full<S>& m, Sym3<S>& A) {
    if (!factor(m)) return false;
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
  /// Takes e = r − D_n.
  MOMENTA_INLINE void take(const Vec3<S>& right) {
    e[0] = right[0];
    e[1] = right[1] - l10 * e[0];
    e[2] = right[2] - l20 * e[0] - l21 * e[1];
  }
  /// D'_f − D_f from e = r − D_n.
  MOMENTA_INLINE Vec3<S> remainder(const Vec3<S>& right) {
    take(right);
    return s * e;
  }
  /// ω = I⁻¹ e with the origin at rest.
  MOMENTA_INLINE Vec3<S> omega() const {
    const S z = e[2] * i2;
    const S y = e[1] * i1 - l21 * z;
    return {{e[0] * i0 - l10 * y - l20 * z, y, z}};
  }
  /// ω = L⁻ᵀ (Δ⁻¹ L⁻¹ e − (Z Δ⁻¹)ᵀ v) of the body, v the velocity of its origin.
  MOMENTA_INLINE Vec3<S> omega(const Vec3<S>& v) const {
    const Vec3<S> g = transpose_times(s, v);
    const S z = e[2] * i2 - g[2];
    const S y = e[1] * i1 - g[1] - l21 * z;
    return {{e[0] * i0 - g[0] - l10 * y - l20 * z, y, z}};
  }
};

/// Eliminates spherical joints that carry nothing, into `pivot` and `A` of their records, and marks
/// them `constant`. One without inertia is left to its sweep, which reports it.
template <class S, class Record>
void eliminate_leaves(const LinkTree& tree, std::vector<Record>& records) {
  for (const Link& l : tree.links) {
    if (l.kind != LinkKind::spherical || !l.leaf || l.slot >= 0) continue;
    Record& w = records[static_cast<std::size_t>(l.record)];
    Full<S> m;
    set_body(m, l);
    w.constant = w.pivot.eliminate(m, w.A);
  }
}

/// M' = (A, 0; 0, 0) and D' = (f, n) of a spherical joint in the parent's frame: A turned by R and
/// shifted by the step r, H = −A r̃, I = r̃ H.
template <class S>
MOMENTA_INLINE void carry_spherical(const Vec3<double>& r, const Mat3<S>& R, const Sym3<S>& A,
                                    const Vec3<S>& force, const Vec3<S>& moment,
                                    Articulated<S>& articulated) {
  const S rx(r[0]), ry(r[1]), rz(r[2]);
  Mat3<S> RA;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      RA(i, j) = R(i, 0) * A(0, j) + R(i, 1) * A(1, j) + R(i, 2) * A(2, j);
  const auto entry = [&](int i, int j) {
    return RA(i, 0) * R(j, 0) + RA(i, 1) * R(j, 1) + RA(i, 2) * R(j, 2);
  };
  Full<S>& m = articulated.M;
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
  articulated.Dfx = f[0];
  articulated.Dfy = f[1];
  articulated.Dfz = f[2];
  articulated.Dnx = n[0] + ry * f[2] - rz * f[1];
  articulated.Dny = n[1] + rz * f[0] - rx * f[2];
  articulated.Dnz = n[2] + rx * f[1] - ry * f[0];
}

}  // namespace momenta
