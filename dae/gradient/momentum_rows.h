#pragma once
// The rows of the momentum form for derivatives, for every scalar, at x = (q, u, σ):
//
//   r1 = M u + Φ_qᵀσ,  r2 = Φ_q u + Φ_t + βΦ,  r3 = ṗ                                     (7), (8)
//
// and of a position correction, at x = (q, δ, ν): M δ + Φ_qᵀν, Φ_q δ + Φ; and the derivatives of L*
// = T − V + σᵀΦ̇ by u and q, without forces that have no potential.

#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace momenta {

/// a, b and c one above the other.
inline Eigen::VectorXd joined(const Eigen::VectorXd& a, const Eigen::VectorXd& b,
                              const Eigen::VectorXd& c) {
  Eigen::VectorXd all(a.size() + b.size() + c.size());
  all << a, b, c;
  return all;
}

/// Places of the parts of x; constants of the form.
struct RowPlaces {
  explicit RowPlaces(const Mechanism& mechanism)
      : nq(mechanism.nq()), nv(mechanism.nv()), m(mechanism.m()) {}
  Eigen::Index nq, nv, m;
  double t = 0;     ///< [s]
  double beta = 0;  ///< β of r2 [1/s]
  double leak = 0;  ///< κ of r3 [1/s]

  template <class S>
  const S* u(const S* x) const {
    return x + nq;
  }
  /// σ; null without loops.
  template <class S>
  const S* sigma(const S* x) const {
    return m > 0 ? x + nq + nv : nullptr;
  }
};

/// r1, r2: nv + m.
struct MomentumRows : RowPlaces {
  template <class E, class S>
  void operator()(E& e, const S* x, S* out) const {
    e.place(t, x);
    e.move(u(x));
    e.momenta(sigma(x), out);
    if (m == 0) return;
    e.velocities(out + nv);
    if (beta == 0) return;
    std::vector<S> phi(static_cast<std::size_t>(m));
    e.positions(phi.data());
    for (Eigen::Index i = 0; i < m; ++i) out[nv + i] += beta * phi[static_cast<std::size_t>(i)];
  }
};

/// r1, r2, r3: 2 nv + m.
struct MomentumAndRateRows : MomentumRows {
  template <class E, class S>
  void operator()(E& e, const S* x, S* out) const {
    MomentumRows::operator()(e, x, out);
    e.momentum_rates(x, u(x), sigma(x), leak, out + nv + m);
  }
};

/// (L*_u, L*_q), 2 nv: M u + Φ_qᵀσ, and ṗ without the forces that have no potential.
struct LagrangianSlopes : RowPlaces {
  bool forces = false;     ///< some have no potential
  bool at_points = false;  ///< some act at points of bodies: all but weights are left out
  template <class E, class S>
  void operator()(E& e, const S* x, S* out) const {
    e.place(t, x);
    e.move(u(x));
    e.momenta(sigma(x), out);
    e.momentum_rates(x, u(x), sigma(x), leak, out + nv);
    if (!forces) return;
    std::vector<S> tau(static_cast<std::size_t>(nv));
    e.applied_forces(t, x, u(x), tau.data(), at_points);
    for (Eigen::Index i = 0; i < nv; ++i) out[nv + i] -= tau[static_cast<std::size_t>(i)];
  }
};

/// Rows of a correction, nv + m, without prescribed motion.
struct CorrectionRows : RowPlaces {
  template <class E, class S>
  void operator()(E& e, const S* x, S* out) const {
    std::vector<S> still(static_cast<std::size_t>(nv + m)), phi(static_cast<std::size_t>(m));
    e.place(t, x);
    e.move(nullptr);
    e.momenta(nullptr, still.data());
    e.velocities(still.data() + nv);
    e.positions(phi.data());
    e.move(u(x));
    e.momenta(sigma(x), out);
    e.velocities(out + nv);
    for (Eigen::Index i = 0; i < nv + m; ++i) out[i] -= still[static_cast<std::size_t>(i)];
    for (Eigen::Index i = 0; i < m; ++i) out[nv + i] += phi[static_cast<std::size_t>(i)];
  }
};

}  // namespace momenta
