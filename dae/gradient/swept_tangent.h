#pragma once
// The derivative of (q, p, t) → (u, σ, ṗ), eqs. (7)-(8), along one direction (δq, δp): the sweeps
// that carry the loops, in dual numbers of one direction, compiled for the registers of the machine
// (levels/tangent_sweeps.h). O(bodies + m), no matrix; the evaluation itself comes along.

#include <momenta/dae/mechanism.h>

#include <memory>
#include <vector>

namespace momenta {

/// One object serves one thread; no call allocates.
class SweptTangent {
 public:
  virtual ~SweptTangent() = default;
  /// At (t, q, p) along (dq, dp), nv each; without quaternions, leak and β. False where a joint has
  /// no inertia or a branch is weak.
  virtual bool operator()(double t, const double* q, const double* p, const double* dq,
                          const double* dp) = 0;
  // Of the last call: u and its derivative, that of ṗ (nv), all forces included; σ and its (m).
  std::vector<double> u, du, dpdot, sigma, dsigma;
};

/// Null where the sweeps do not carry the loops or the forces: then there is the matrix alone.
std::unique_ptr<SweptTangent> make_swept_tangent(const Mechanism& mechanism);

}  // namespace momenta
