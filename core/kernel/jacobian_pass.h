#pragma once
// Exact derivatives of (q̇, ṗ) by dual numbers through the recursion, and with the structure of
// Hamilton's equations where they hold. In canonical coordinates q̇ = ∂H/∂p, ṗ = −∂H/∂q + Q, hence
//
//   ∂q̇/∂p = M⁻¹,  ∂ṗ/∂p = −(∂q̇/∂q)ᵀ + ∂Q/∂p,  ∂Q/∂p = −C M⁻¹ for dampers C on the joints,
//
// so only the nq directions of q need dual numbers, eight at a time, and M⁻¹ comes from nv cheap
// solves with the M* of the recursion. Quasi-velocities (spherical, free joints) and dampers
// between bodies have no such structure: there all directions are dual.

#include <momenta/core/kernel/momentum_recursion.h>

#include <vector>

namespace momenta {

/// The recursion along N directions at once.
template <class Space, int N>
class DirectionalPass {
 public:
  using D = Dual<double, N>;
  using Links = decltype(build_links(std::declval<const Model<Space>&>()));

  explicit DirectionalPass(const Links& links)
      : q(static_cast<std::size_t>(links.model->nq)),
        p(static_cast<std::size_t>(links.model->nv)),
        u(p.size()),
        pdot(p.size()),
        qdot(q.size()),
        sweeps_(links),
        w_(*links.model) {}

  /// Values of q and p, all directions zero.
  void set(const double* q_values, const double* p_values) {
    for (std::size_t i = 0; i < q.size(); ++i) q[i] = D(q_values[i]);
    for (std::size_t i = 0; i < p.size(); ++i) p[i] = D(p_values[i]);
  }
  /// qdot and pdot with their derivatives along the directions in q and p.
  bool operator()(double t) {
    if (!momentum_recursion(sweeps_, w_, D(t), q.data(), p.data(), u.data(), pdot.data()))
      return false;
    coordinate_rates(*w_.model, static_cast<const D*>(q.data()), static_cast<const D*>(u.data()),
                     qdot.data());
    return true;
  }

  int stuck() const { return sweeps_.stuck(); }

  std::vector<D> q, p, u, pdot, qdot;

 private:
  MomentumSweeps<Space, D> sweeps_;
  Workspace<Space, D> w_;
};

/// True where the structure above holds for the model.
template <class Space>
bool is_hamiltonian(const Model<Space>& model) {
  for (const auto& b : model.bodies)
    if (b.nq != b.nv) return false;
  for (const auto& spring : model.springs)
    if (spring.damping != 0) return false;
  return model.wrenches.empty();  // in body axes, or with a torque, one need not have a potential
}

/// ∂(q̇, ṗ)/∂(q, p) into a matrix of nq + nv rows and columns, J(row, column). `inverse_mass(x, y)`:
/// y = M⁻¹ x at (t, q). False as the recursion. Cost ⌈nq/8⌉ dual evaluations and nv solves where
/// the structure holds, ⌈(nq + nv)/8⌉ evaluations elsewhere.
template <class Space, class InverseMass, class Matrix>
bool jacobian(DirectionalPass<Space, 8>& pass, const Model<Space>& model, double t, const double* q,
              const double* p, InverseMass&& inverse_mass, Matrix& J) {
  const int nq = model.nq, nv = model.nv;
  const bool structured = is_hamiltonian(model);
  const int directions = structured ? nq : nq + nv;
  for (int first = 0; first < directions; first += 8) {
    pass.set(q, p);
    const int here = std::min(8, directions - first);
    for (int j = 0; j < here; ++j) {
      const int at = first + j;
      auto& x = at < nq ? pass.q[static_cast<std::size_t>(at)]
                        : pass.p[static_cast<std::size_t>(at - nq)];
      x.b[static_cast<std::size_t>(j)] = 1;
    }
    if (!pass(t)) return false;
    for (int j = 0; j < here; ++j) {
      const auto lane = static_cast<std::size_t>(j);
      for (int i = 0; i < nq; ++i) J(i, first + j) = pass.qdot[static_cast<std::size_t>(i)].b[lane];
      for (int i = 0; i < nv; ++i) {
        J(nq + i, first + j) = pass.pdot[static_cast<std::size_t>(i)].b[lane];
        if (structured)  // ∂ṗ/∂p = −(∂q̇/∂q)ᵀ; the dampers' part follows
          J(nq + first + j, nq + i) = -pass.qdot[static_cast<std::size_t>(i)].b[lane];
      }
    }
  }
  if (!structured) return true;
  std::vector<double> unit(static_cast<std::size_t>(nv)), column(unit.size());
  for (int j = 0; j < nv; ++j) {
    unit[static_cast<std::size_t>(j)] = 1;
    inverse_mass(unit.data(), column.data());
    unit[static_cast<std::size_t>(j)] = 0;
    for (int i = 0; i < nv; ++i) J(i, nq + j) = column[static_cast<std::size_t>(i)];
    for (const auto& b : model.bodies)
      if (b.nv == 1 && b.damping != 0)
        J(nq + b.u, nq + j) -= b.damping * column[static_cast<std::size_t>(b.u)];
  }
  return true;
}

}  // namespace momenta
