#pragma once
// The derivative of (q, p, t) → (u, σ, ṗ), eqs. (7)-(8), along one direction (δq, δp) or several:
// the sweeps that carry the loops, in dual numbers of one direction, or of one a lane, compiled for
// the machine (levels/tangent_sweeps.h, levels/direction_sweeps.h). O(bodies + m), no matrix; u, σ,
// ṗ come along.

#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace momenta {

/// One object serves one thread; no call allocates.
class SweptTangent {
 public:
  virtual ~SweptTangent() = default;
  /// Sweeps at (t, q, p) along (dq, dp), nv each; without quaternions. False where a joint has no
  /// inertia or a branch is weak.
  virtual bool operator()(double t, const double* q, const double* p, const double* dq,
                          const double* dp) = 0;
  // Last results: u and its derivative, that of ṗ (nv), all forces included; σ and its (m).
  std::vector<double> u, du, dpdot, sigma, dsigma;

  /// Several directions, by columns: dq, dp, du and dpdot nv × directions, besides and dsigma m ×
  /// directions. `besides` joins the second row of (2): Φ_q δu + δΦ_q u + … + besides = 0; empty:
  /// zero. Resizes results. Cost: about two evaluations for one direction, less than one for each
  /// of eight where fronts are narrow.
  virtual bool along(double t, const double* q, const double* p, const Eigen::MatrixXd& dq,
                     const Eigen::MatrixXd& dp, const Eigen::MatrixXd& besides, Eigen::MatrixXd& du,
                     Eigen::MatrixXd& dpdot, Eigen::MatrixXd& dsigma) = 0;
};

/// `leak`: κ of (8), `beta`: β of (7) [1/s]. Null where the sweeps do not carry the loops or the
/// forces.
std::unique_ptr<SweptTangent> make_swept_tangent(const Mechanism& mechanism, double leak = 0,
                                                 double beta = 0);

}  // namespace momenta
