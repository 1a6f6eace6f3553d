#pragma once
// A DaeSystem of second order: y = (q, v, λ), rows in the same order: q' = E(q) v, M v' + … + Φ_qᵀλ
// = 0, Φ(q, t) = 0. There may be more coordinates than rates (quaternions).

#include <momenta/dae/solver/system.h>

#include <vector>

namespace momenta {

/// The local matrix with a factor for each unknown in place of one c, ∂F/∂y + ∂F/∂y' diag(c):
/// LocalJacobian of such a system. c: n.
class LocalOfSecondOrder : public LocalJacobian {
 public:
  using LocalJacobian::evaluate;
  virtual bool evaluate(double t, const double* y, const double* ydot, const double* c) = 0;
};

class SecondOrder {
 public:
  virtual ~SecondOrder() = default;
  virtual int coordinates() const = 0;  ///< nq
  virtual int rates() const = 0;        ///< nv
  virtual int multipliers() const = 0;  ///< m
  /// E(q) v (nq) of v (nv).
  virtual void coordinate_rates(const double* q, const double* v, double* qdot) = 0;
  /// q ∘ exp δ: q after constant rates δ (nv) for a unit of time, to fourth order in δ (exact for
  /// joints with q' = v); quaternions of unit length.
  virtual void move(const double* q, const double* delta, double* moved) = 0;

  // For projections and penalties:
  /// Φ (m) at (t, q), Φ̇ of v, and Φ̈ of v and v̇.
  virtual void constraints(double t, const double* q, double* phi) = 0;
  virtual void constraint_rates(double t, const double* q, const double* v, double* rate) = 0;
  virtual void constraint_accelerations(double t, const double* q, const double* v,
                                        const double* vdot, double* rate) = 0;
  /// 1/(penalty × effective mass) by row of Φ (m).
  virtual const std::vector<double>& compliance() = 0;
};

}  // namespace momenta
