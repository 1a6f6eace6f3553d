#pragma once
// The derivatives of ∂T/∂q, at constant q, and of p = M u along rates, for transposed derivatives
// of p = M u: D_v T_q and M v at (q, u), by (8) in dual numbers of one direction, without forces
// and σ.

#include <momenta/dae/mechanism.h>

#include <memory>

namespace momenta {

/// One object serves one thread; no call allocates.
class KineticRates {
 public:
  virtual ~KineticRates() = default;
  /// D_v T_q and M v (nv each) at t [s], q, u along v (nv each). O(bodies)
  virtual void along(double t, const double* q, const double* u, const double* v, double* rates,
                     double* momenta) = 0;
};

/// @pre bodies, no quaternions
std::unique_ptr<KineticRates> make_kinetic_rates(const Mechanism& mechanism);

}  // namespace momenta
