#pragma once
// What RATTLE needs of a system beside y = (q, p): the parts of H(q, p) = L's Legendre transform
// under Φ(q, t) = 0, with p = M u + (prescribed part), no impulses σ in it.

#include <Eigen/Core>

namespace momenta {

/// At one (t, q): matrices for M u = p − prescribed and Φ_q.
struct PlacedHamiltonian {
  Eigen::MatrixXd mass;        ///< nv × nv, both triangles
  Eigen::MatrixXd constraint;  ///< m × nv
  Eigen::VectorXd prescribed;  ///< nv
  Eigen::VectorXd phi, phi_t;  ///< m
};

class ConstrainedHamiltonian {
 public:
  virtual ~ConstrainedHamiltonian() = default;
  virtual int coordinates() const = 0;  ///< nq
  virtual int momenta() const = 0;      ///< nv
  virtual int multipliers() const = 0;  ///< m
  /// Fills `placed`, of the right sizes; the calls below are at this place.
  virtual void place(double t, const double* q, PlacedHamiltonian& placed) = 0;
  /// −∂H/∂q + Q = L_q + Q (nv) at rates u (nv).
  virtual void force(const double* q, const double* u, double* g) = 0;
  /// q' (nq) at rates u, and q ∘ exp δ, see SecondOrder.
  virtual void coordinate_rates(const double* q, const double* u, double* qdot) = 0;
  virtual void move(const double* q, const double* delta, double* moved) = 0;
};

}  // namespace momenta
