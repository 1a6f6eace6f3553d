#pragma once
// Elimination of a user joint, whose E has n = 1 … 6 columns. Column by column it factors M_j =
// EᵀM*E = L D Lᵀ without forming M_j: with M⁰ = M*, D⁰ = D
//
//   y_j = Mʲ E_j,  d_j = E_jᵀ y_j,  h_j = y_j / d_j,  Mʲ⁺¹ = Mʲ − y_j h_jᵀ        (46), (47)
//   e_j = r_j − E_jᵀ Dʲ,  Dʲ⁺¹ = Dʲ + h_j e_j                                    (48)
//   u_j = e_j / d_j − h_jᵀ W, then W += E_j u_j, from the last column to the first (45)
//
// and L_ij = E_iᵀ h_j for i > j. M' = Mⁿ has no exact zeros along E, unlike for built-in joints: a
// joint inward that moves along one of E's axes alone may find rounding there.

#include <momenta/core/kernel/joint.h>

#include <limits>

namespace momenta {

template <class S>
struct UserRecord {
  UserMotion<S> motion;
  Spatial::Force<S> h[6];
  S pivot[6]{}, inverse[6]{}, e[6]{};  ///< d_j, 1 / d_j, e_j
};

/// M* in `m` becomes M'; false where a pivot is not positive, or within rounding of all the inertia
/// that the column moves.
template <class S>
bool eliminate_user(const Model<Spatial>::Body& b, UserRecord<S>& x,
                    Spatial::ArticulatedInertia<S>& m) {
  const double rounding = 16 * b.nv * std::numeric_limits<double>::epsilon();
  const S turning = m.I(0, 0) + m.I(1, 1) + m.I(2, 2);
  for (int c = 0; c < b.nv; ++c) {
    const Spatial::Motion<S>& E = x.motion.E[c];
    const auto y = Spatial::momentum(m, E);
    const S d = Spatial::power(y, E);
    const S moved = b.subtree_mass * dot(E.v, E.v) + turning * dot(E.w, E.w);
    if (!all_positive(S(d - rounding * moved))) return false;
    x.pivot[c] = d;
    x.inverse[c] = S(1.0) / d;
    auto& h = x.h[c];
    for (int i = 0; i < 6; ++i) h[i] = x.inverse[c] * y[i];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        if (i <= j) {
          m.A(i, j) -= y.f[i] * h.f[j];
          m.I(i, j) -= y.n[i] * h.n[j];
        }
        m.H(i, j) -= y.f[i] * h.n[j];
      }
  }
  if (b.nv == 6) m = {};  // nothing is left
  return true;
}

/// D' from D for the right-hand side r.
template <class S>
Spatial::Force<S> user_remainder(const Model<Spatial>::Body& b, UserRecord<S>& x,
                                 Spatial::Force<S> D, const S* r) {
  for (int c = 0; c < b.nv; ++c) {
    x.e[c] = r[c] - Spatial::power(D, x.motion.E[c]);
    for (int i = 0; i < 6; ++i) D[i] += x.h[c][i] * x.e[c];
  }
  return D;
}

/// M' c of a motion c.
template <class S>
Spatial::Force<S> user_reduced_momentum(const Model<Spatial>::Body& b, const UserRecord<S>& x,
                                        const Spatial::ArticulatedInertia<S>& M,
                                        const Spatial::Motion<S>& c) {
  if (b.nv == 6) return {};
  auto P = Spatial::momentum(M, c);
  for (int k = 0; k < b.nv; ++k) {
    const S along = Spatial::power(x.h[k], c) * x.pivot[k];
    for (int i = 0; i < 6; ++i) P[i] -= x.h[k][i] * along;
  }
  return P;
}

/// u of the joint; W becomes W + E u.
template <class S>
void solve_user(const Model<Spatial>::Body& b, const UserRecord<S>& x, Spatial::Motion<S>& W,
                S* u) {
  for (int c = b.nv; c-- > 0;) {
    u[c] = x.inverse[c] * x.e[c] - Spatial::power(x.h[c], W);
    for (int i = 0; i < 6; ++i) W[i] += x.motion.E[c][i] * u[c];
  }
}

}  // namespace momenta
