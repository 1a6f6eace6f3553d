#pragma once
// Centroidal momentum: mass, centre of mass, linear and angular momentum of all bodies together, in
// ground axes. Prescribed motion is included. The sums: centroidal_sums.h.

#include <momenta/core/kernel/tree/tree.h>
#include <momenta/core/scene/scene.h>

#include <memory>

namespace momenta {

/// Centroidal quantities of a mechanism, in ground axes.
struct Centroidal {
  double mass = 0;                                             ///< [kg]
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();            ///< [m]; NaN without mass
  Eigen::Vector3d linear_momentum = Eigen::Vector3d::Zero();   ///< [kg m/s]
  Eigen::Vector3d angular_momentum = Eigen::Vector3d::Zero();  ///< [kg m²/s], about the origin
};

/// Computes centroidal quantities, with its own model and workspace: one object per thread. Always
/// spatial: with bodies at different heights, the angular momentum of a planar scene has components
/// in the plane too.
class CentroidalSweep {
 public:
  /// Copies what it needs from both. O(bodies).
  CentroidalSweep(const Tree& tree, const Scene& scene);
  ~CentroidalSweep();
  /// Movable. A moved-from sweep may only be destroyed or assigned to.
  CentroidalSweep(CentroidalSweep&&) noexcept;
  /// Move assignment.
  CentroidalSweep& operator=(CentroidalSweep&&) noexcept;

  /// The quantities at (t, q, u); q has nq numbers, u has nv. O(bodies), no allocation.
  Centroidal operator()(double t, const double* q, const double* u);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The same at one state (t, q, u), building the model for this call.
Centroidal centroidal(const Tree& tree, const Scene& scene, double t, const Eigen::VectorXd& q,
                      const Eigen::VectorXd& u);

}  // namespace momenta
