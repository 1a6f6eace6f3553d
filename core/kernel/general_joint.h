#pragma once
// Elimination of a joint of any kind, one record a joint: for both recursions, off the fast path
// for revolute joints.
//
//   M_j = Eᵀ M* E + I_r,  M' = M* − M*E M_j⁻¹ EᵀM*           (46), (47); I_r: rotor.h
//   e = r − Eᵀ D,   D' = D + M*E M_j⁻¹ e                     (48)
//   u = M_j⁻¹ (e − EᵀM* W),  Ω = W + E u                     (45)
//
// A spherical joint with a rotor, with J = I + I_r 1 and h = H J⁻¹, keeps
//
//   A' = A − h Hᵀ,  H' = I_r h,  I' = I_r J⁻¹ I,  D' = (D_f + h e, D_n + I J⁻¹ e)
//
// (without one: spherical.h).
// r is p in the momentum form and the joint force in the acceleration form; W is the motion the
// joint would leave its body without u. A driven or welded joint has no u: M' = M*, D' = D.
// User joints, whose E has up to six columns: user_elimination.h.

#include <momenta/core/kernel/prescribe.h>
#include <momenta/core/kernel/user_elimination.h>
#include <momenta/core/scalar/dual.h>
#include <momenta/core/scalar/sine_cosine.h>

#include <limits>

namespace momenta {

template <class Space, class S>
struct JointRecord;

/// M_j of a revolute joint from the inertia of its subtree about it, with the link's rotor.
template <class Link, class S>
MOMENTA_INLINE S pivot_of(const Link& l, const S& inertia) {
  return l.has_rotor ? inertia + l.rotor : inertia;
}

template <class S>
struct JointRecord<Spatial, S> {
  Spatial::Edge<S> edge;
  S drive{}, drive_rate{}, drive_acceleration{};  ///< prescribed motion
  Spatial::ArticulatedInertia<S> M;               ///< M*_K
  Spatial::Force<S> D;                            ///< D_K, (44)
  Spatial::Force<S> h;                            ///< one dof: M*E M_j⁻¹
  S pivot{}, e{};                                 ///< one dof: M_j⁻¹, r − Eᵀ D
  Vec3<S> moment;                                 ///< first moment of the subtree about O_K
  Mat3<S> H;                                      ///< several dofs: H I⁻¹ …
  Sym3<S> I, A;  ///< … I⁻¹ (J⁻¹ with a rotor), of a free joint (A − H I⁻¹Hᵀ)⁻¹
  Vec3<S> x, y;  ///< … I⁻¹ e_ω, and of a free joint e_v − H I⁻¹ e_ω
  Spatial::Motion<S> c;           ///< acceleration form: W − 𝒯ⱽ A_L
  UserRecord<S>* user = nullptr;  ///< user joints alone; owned beside the records
};
template <class S>
struct JointRecord<Planar, S> {
  Planar::Edge<S> edge;
  S drive{}, drive_rate{}, drive_acceleration{};
  Planar::ArticulatedInertia<S> M;
  Planar::Force<S> D, h;
  S pivot{}, e{};
  S value{};   ///< position of the joint
  S moment{};  ///< moment of the subtree's weight about O_K
  Planar::Motion<S> c;
};

/// Whether the determinant of a matrix with diagonal a, b, c exceeds rounding (a slender rod on a
/// spherical joint has no inertia about itself). Entries are as exact as the largest, so the
/// determinant is as exact as the product of the two largest diagonals with the largest.
template <class S>
MOMENTA_INLINE bool determinant_positive(const S& determinant, const S& a, const S& b, const S& c) {
  constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
  const S bound = rounding * ((a * b + (b * c + c * a)) * (a + (b + c)));
  return all_positive(determinant - bound);
}
/// The same for pivots d: all positive, and their product beyond rounding.
template <class S>
bool pivots_positive(const Vec3<S>& d, const Sym3<S>& from) {
  return all_positive(d[0]) && all_positive(d[1]) && all_positive(d[2]) &&
         determinant_positive(d[0] * d[1] * d[2], from.x[0], from.x[3], from.x[5]);
}

/// I⁻¹ and h = H I⁻¹ of a joint with free ω.
template <class S>
bool eliminate_angular(const Spatial::ArticulatedInertia<S>& m, Sym3<S>& inverse_I, Mat3<S>& h) {
  Vec3<S> pivots;
  inverse_I = inverse(m.I, pivots);
  if (!pivots_positive(pivots, m.I)) return false;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      h(i, j) =
          m.H(i, 0) * inverse_I(0, j) + m.H(i, 1) * inverse_I(1, j) + m.H(i, 2) * inverse_I(2, j);
  return true;
}

/// Free joints: ω by its 3 × 3 block, then v by the Schur complement; M' = 0.
template <class S>
bool eliminate_free(Spatial::ArticulatedInertia<S>& m, JointRecord<Spatial, S>& x) {
  if (!eliminate_angular(m, x.I, x.H)) return false;
  Sym3<S> A = m.A;
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j)
      A(i, j) -= x.H(i, 0) * m.H(j, 0) + x.H(i, 1) * m.H(j, 1) + x.H(i, 2) * m.H(j, 2);
  Vec3<S> pivots;
  x.A = inverse(A, pivots);
  if (!pivots_positive(pivots, m.A)) return false;
  m = {};
  return true;
}

/// Eliminates spherical joints with a rotor.
template <class S>
bool eliminate_turned(double rotor, Spatial::ArticulatedInertia<S>& m, JointRecord<Spatial, S>& x) {
  auto with_rotor = m;
  for (int i = 0; i < 3; ++i) with_rotor.I(i, i) += rotor;
  if (!eliminate_angular(with_rotor, x.I, x.H)) return false;
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) {
      m.A(i, j) -= x.H(i, 0) * m.H(j, 0) + x.H(i, 1) * m.H(j, 1) + x.H(i, 2) * m.H(j, 2);
      m.I(i, j) =
          rotor * (x.I(i, 0) * x.M.I(0, j) + x.I(i, 1) * x.M.I(1, j) + x.I(i, 2) * x.M.I(2, j));
    }
  for (std::size_t i = 0; i < 9; ++i) m.H.x[i] = rotor * x.H.x[i];
  return true;
}

/// M' from x.M; false when M_j is not positive.
template <class Space, class S>
bool eliminate(const typename Model<Space>::Body& b, JointRecord<Space, S>& x,
               typename Space::template ArticulatedInertia<S>& reduced) {
  reduced = x.M;
  if (b.nv == 0) return true;
  if constexpr (Space::dimension == 6)
    if (b.law) return eliminate_user<S>(b, *x.user, reduced);
  if (b.nv == 1) {
    const auto U = Joint<Space>::column(b, x.edge, x.M);
    const S joint_mass = Joint<Space>::along(b, x.edge, U) + b.rotor;  // M_j, (46)
    if (!all_positive(Joint<Space>::inertia_margin(b, x.M, joint_mass))) return false;
    x.pivot = S(1.0) / joint_mass;
    for (int i = 0; i < Space::dimension; ++i) x.h[i] = x.pivot * U[i];
    Joint<Space>::reduce(b, reduced, U, x.h);
    return true;
  }
  if constexpr (Space::dimension == 6)
    return b.nv == 3 ? eliminate_turned<S>(b.rotor, reduced, x) : eliminate_free<S>(reduced, x);
  else
    return false;
}

/// D' from x.D for the right-hand side r of this joint (nv numbers).
template <class Space, class S>
typename Space::template Force<S> remainder(const typename Model<Space>::Body& b,
                                            JointRecord<Space, S>& x, const S* r) {
  auto D = x.D;
  if constexpr (Space::dimension == 6)
    if (b.law) return user_remainder<S>(b, *x.user, D, r);
  if (b.nv == 1) {
    x.e = r[0] - Joint<Space>::along(b, x.edge, x.D);
    for (int i = 0; i < Space::dimension; ++i) D[i] += x.h[i] * x.e;
  } else if constexpr (Space::dimension == 6) {
    if (b.nv == 3) {
      Vec3<S> e;
      for (int i = 0; i < 3; ++i) e[i] = r[i] - x.D.n[i];
      x.x = x.I * e;
      D.f += x.H * e;
      D.n += x.M.I * x.x;
    } else if (b.nv == 6) {
      Vec3<S> e;
      for (int i = 0; i < 3; ++i) e[i] = r[3 + i] - x.D.n[i];
      x.x = x.I * e;
      const Vec3<S> he = x.H * e;
      for (int i = 0; i < 3; ++i) x.y[i] = r[i] - x.D.f[i] - he[i];
      for (int i = 0; i < 6; ++i) D[i] = r[i];
    }
  }
  return D;
}

/// M'_K c: the reduced mass matrix (47) times a motion c.
template <class Space, class S>
typename Space::template Force<S> reduced_momentum(const typename Model<Space>::Body& b,
                                                   const JointRecord<Space, S>& x,
                                                   const typename Space::template Motion<S>& c) {
  if constexpr (Space::dimension == 6) {
    if (b.law) return user_reduced_momentum<S>(b, *x.user, x.M, c);
    if (b.nv == 6) return {};  // M' = 0
    if (b.nv == 3) {
      const Vec3<S> n = transpose_times(x.M.H, c.v) + x.M.I * c.w;
      auto P = Space::momentum(x.M, c);
      P.f -= x.H * n;
      P.n -= x.M.I * (x.I * n);
      return P;
    }
  }
  auto P = Space::momentum(x.M, c);
  if (b.nv == 1) {
    const S along = Space::power(x.h, c) / x.pivot;  // M*E M_j⁻¹ EᵀM* c = h (hᵀ c) M_j
    for (int i = 0; i < Space::dimension; ++i) P[i] -= x.h[i] * along;
  }
  return P;
}

/// u (nv) of the joint; W becomes W + E u.
template <class Space, class S>
void solve_joint(const typename Model<Space>::Body& b, const JointRecord<Space, S>& x,
                 typename Space::template Motion<S>& W, S* u) {
  if constexpr (Space::dimension == 6)
    if (b.law) return solve_user<S>(b, *x.user, W, u);
  if (b.nv == 1) {
    u[0] = x.pivot * x.e - Space::power(x.h, W);
    Joint<Space>::add_motion(b, x.edge, u, W);
  } else if constexpr (Space::dimension == 6) {
    if (b.nv == 0) return;
    if (b.nv == 3) {
      const Vec3<S> own = x.x - transpose_times(x.H, W.v) - x.I * (x.M.I * W.w);
      for (int i = 0; i < 3; ++i) u[i] = own[i];
      W.w += own;
      return;
    }
    const Vec3<S> v = x.A * x.y, omega = x.x - transpose_times(x.H, v);
    for (int i = 0; i < 3; ++i) {
      u[i] = v[i] - W.v[i];
      u[3 + i] = omega[i] - W.w[i];
    }
    W = {v, omega};
  }
}

}  // namespace momenta
