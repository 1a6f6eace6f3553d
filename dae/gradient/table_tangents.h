#pragma once
// ∂/∂θ of the rows r1 = M u + Φ_qᵀσ, r2 = Φ̇ + βΦ and r3 = ṗ of (7), (8) at constant q, u, σ,
// where θ changes numbers n of the mechanism's tables alone (number_slopes.h), from dn/dθ:
//
//   inertias, gravity, forces   linear: δP*_K = Σ δM Ω, δT*_K = Σ δ(weight, forces) over what K
//                               carries; δr1 = Eᵀ δP*, δr3 = Eᵀ (δT* − Ω × δP*) + δQ_joint, (26),
//                               (27), (35); Φ̇ has none of them
//   places and loops too        the rows in dual numbers whose directions are in the tables
//
// by one sweep outward and one inward for several θ in the lanes of registers
// (levels/number_rows_at.h).

#include <momenta/dae/gradient/row_derivatives.h>

namespace momenta {

class TableTangents {
 public:
  /// Gains: κ of r3 and β of r2 [1/s].
  struct FedBack {
    double leak = 0, beta = 0;
  };
  virtual ~TableTangents() = default;
  /// Fills r1, r2, r3 at t [s], q (nq), u (nv), σ (m; null: zero). Cost for eight θ: about one
  /// evaluation for inertias and forces, five with places. O(bodies + m)
  virtual void at(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u, const double* sigma,
                  const FedBack& gains) = 0;
  Eigen::MatrixXd r1, r2, r3;  ///< nv, m and nv, × θ; zero where not `taken`
  std::vector<bool> taken;     ///< by θ
  bool any_loops = false;      ///< r2 is not zero
};

/// Tangents for `others` with numbers; null: none has any. The mechanism must outlive it. @pre
/// bodies, no quaternions
std::unique_ptr<TableTangents> make_table_tangents(const Mechanism& mechanism,
                                                   const std::vector<OtherParameter>& others);

}  // namespace momenta
