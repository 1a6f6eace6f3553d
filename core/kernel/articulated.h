#pragma once
// The elimination that makes forward dynamics O(n), shared by the momentum recursion and its
// acceleration twin:
//
//   M*_K = M_K + Σ 𝒯ᶠ M' 𝒯ⱽ,  M_j = Eᵀ M* E,  M' = M* − M*E M_j⁻¹ EᵀM*            (43), (46), (47)
//   D_K += Σ 𝒯ᶠ (D' + M' Ω_t),  e = r_K − Eᵀ D,  D' = D + M*E M_j⁻¹ e               (44), (48)
//   u_K = M_j⁻¹ (e − EᵀM* W),  W = 𝒯ⱽ Ω_L + Ω_t                                     (45)
//
// r is p in the momentum form; in the acceleration form r is the joint force, D starts as the bias
// wrench and the prescribed part is the velocity product instead of Ω_t.

#include <momenta/core/kernel/revolute_carry.h>
#include <momenta/core/kernel/sweeps.h>
#include <momenta/core/scalar/dual.h>

#include <algorithm>
#include <limits>

namespace momenta {

/// Spherical and free joints: eliminate ω by its 3 × 3 block, then (free) v by the Schur
/// complement.
template <class S>
bool eliminate_wide(JointKind kind, typename Workspace<Spatial, S>::Inertia& m,
                    typename Workspace<Spatial, S>::Wide& x) {
  // Positive, and more than rounding: a slender rod on a ball joint has no inertia about itself,
  // however it lies. Entries are as exact as the largest, so the determinant is as exact as the
  // product of the two largest diagonals with the largest.
  const auto positive = [](const Vec3<S>& d, const Sym3<S>& from) {
    constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();
    double determinant = 1, product = 1, least = 0, largest = 0;
    for (int i = 0; i < 3; ++i) {
      if (!(value_of(d[i]) > 0)) return false;
      const double diagonal = value_of(from(i, i));
      determinant *= value_of(d[i]);
      product *= diagonal;
      least = i == 0 ? diagonal : std::min(least, diagonal);
      largest = std::max(largest, diagonal);
    }
    return determinant > rounding * (product / least * largest);
  };
  const Sym3<S> A = m.A;
  Vec3<S> pivots;
  x.I = inverse(m.I, pivots);
  if (!positive(pivots, m.I)) return false;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      x.h(i, j) = m.H(i, 0) * x.I(0, j) + m.H(i, 1) * x.I(1, j) + m.H(i, 2) * x.I(2, j);
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j)
      m.A(i, j) -= x.h(i, 0) * m.H(j, 0) + x.h(i, 1) * m.H(j, 1) + x.h(i, 2) * m.H(j, 2);
  m.H = {};
  m.I = {};
  if (kind == JointKind::free) {
    x.A = inverse(m.A, pivots);
    if (!positive(pivots, A)) return false;
    m.A = {};
  }
  return true;
}

/// M*, M_j⁻¹ and h of every joint; stops at the first joint (from the tips) whose M_j is not
/// positive and sets w.singular to it.
template <class Space, class S>
void articulated_masses_inward(Workspace<Space, S>& w) {
  const auto& model = *w.model;
  w.singular = -1;
  for (std::size_t k = 0; k < w.body.size(); ++k) {
    w.body[k].M = {};
    Space::add(w.body[k].M, w.inertia(k));
  }
  for (std::size_t k = w.body.size(); k-- > 0;) {
    const auto& b = model.bodies[k];
    auto& s = w.body[k];
    auto reduced = s.M;
    if (b.nv == 1) {
      const auto U = Joint<Space>::column(b, s.edge, s.M);
      const S joint_mass = Joint<Space>::along(b, s.edge, U);  // M_j, (46)
      if (!(value_of(joint_mass) > 0)) {
        w.singular = static_cast<int>(k);
        return;
      }
      s.pivot = S(1.0) / joint_mass;
      s.h = U;
      for (int i = 0; i < Space::dimension; ++i) s.h[i] = s.pivot * U[i];
      if constexpr (Space::dimension == 6) {
        if (b.kind == JointKind::revolute) {
          if (b.parent >= 0)
            w.body[static_cast<std::size_t>(b.parent)].M +=
                carry_revolute(b.edge, s.edge, s.M, U, s.h);
          continue;
        }
      }
      Joint<Space>::reduce(b, reduced, U, s.h);
    } else if (b.drive >= 0) {
      s.h = Joint<Space>::column(b, s.edge, s.M);
    } else if constexpr (Space::dimension == 6) {
      if (b.nv > 1 &&
          !eliminate_wide<S>(b.kind, reduced, w.wide[static_cast<std::size_t>(s.wide)])) {
        w.singular = static_cast<int>(k);
        return;
      }
    }
    if (b.parent >= 0)
      w.body[static_cast<std::size_t>(b.parent)].M +=
          Space::to_parent(b.edge, b.kind, s.edge, reduced);
  }
}

/// Carries D inward for the right-hand side r (size nv); body[k].D holds the start on entry (zero
/// in the momentum form). `prescribed(k)` adds M' times the prescribed motion of joint k to D'.
template <class Space, class S, class Prescribed>
void remainders_inward(Workspace<Space, S>& w, const S* r, Prescribed&& prescribed) {
  const auto& model = *w.model;
  for (std::size_t k = w.body.size(); k-- > 0;) {
    const auto& b = model.bodies[k];
    auto& s = w.body[k];
    auto D = s.D;
    if (b.nv == 1) {
      s.e = r[b.u] - Joint<Space>::along(b, s.edge, s.D);
      for (int i = 0; i < Space::dimension; ++i) D[i] += s.h[i] * s.e;
    } else if constexpr (Space::dimension == 6) {
      if (b.nv > 1) {
        auto& x = w.wide[static_cast<std::size_t>(s.wide)];
        const int angular = b.kind == JointKind::free ? 3 : 0;
        Vec3<S> e;
        for (int i = 0; i < 3; ++i) e[i] = r[b.u + angular + i] - s.D.n[i];
        x.x = x.I * e;
        const Vec3<S> he = x.h * e;
        D.n += e;
        if (b.kind == JointKind::free) {
          for (int i = 0; i < 3; ++i) {
            x.y[i] = r[b.u + i] - s.D.f[i] - he[i];
            D.f[i] = r[b.u + i];
          }
        } else {
          D.f += he;
        }
      }
    }
    prescribed(k, D);
    if (b.parent >= 0)
      w.body[static_cast<std::size_t>(b.parent)].D += Space::to_parent(b.edge, b.kind, s.edge, D);
  }
}

/// D += M'_K c: the reduced mass matrix (47) times a prescribed motion of joint k.
template <class Space, class S>
void add_reduced_momentum(const Workspace<Space, S>& w, std::size_t k,
                          const typename Space::template Motion<S>& c,
                          typename Space::template Force<S>& D) {
  const auto& b = w.model->bodies[k];
  const auto& s = w.body[k];
  if (b.kind == JointKind::free) return;  // M' = 0
  if (b.kind == JointKind::spherical) {
    if constexpr (Space::dimension == 6) {  // M' = A − h Hᵀ, for v alone
      const auto& x = w.wide[static_cast<std::size_t>(s.wide)];
      D.f += s.M.A * c.v - x.h * transpose_times(s.M.H, c.v);
    }
    return;
  }
  D += Space::momentum(s.M, c);
  if (b.nv == 1) {
    const S along = Space::power(s.h, c) / s.pivot;  // M*E M_j⁻¹ EᵀM* c = h (hᵀ c) M_j
    for (int i = 0; i < Space::dimension; ++i) D[i] -= s.h[i] * along;
  }
}

/// Joint rates u_K and motion of body k from W = 𝒯ⱽ Ω_L + prescribed part, eq. (45); W becomes W +
/// E u.
template <class Space, class S>
void solve_joint(Workspace<Space, S>& w, std::size_t k, typename Space::template Motion<S>& W,
                 S* u) {
  const auto& b = w.model->bodies[k];
  auto& s = w.body[k];
  if (b.nv == 1) {
    u[b.u] = s.pivot * s.e - Space::power(s.h, W);
    Joint<Space>::add_motion(b, s.edge, u + b.u, W);
  } else if constexpr (Space::dimension == 6) {
    if (b.nv > 1) {
      const auto& x = w.wide[static_cast<std::size_t>(s.wide)];
      if (b.kind == JointKind::free) {
        const Vec3<S> v = x.A * x.y;
        for (int i = 0; i < 3; ++i) u[b.u + i] = v[i] - W.v[i];
        W.v = v;
      }
      const Vec3<S> omega = x.x - transpose_times(x.h, W.v);
      const int angular = b.kind == JointKind::free ? 3 : 0;
      for (int i = 0; i < 3; ++i) u[b.u + angular + i] = omega[i] - W.w[i];
      W.w = omega;
    }
  }
}

}  // namespace momenta
