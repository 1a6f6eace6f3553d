#pragma once
// The mechanism as one body: mass, centre of mass, linear and angular momentum, ground axes. All
// bodies move as drives and rates say, so prescribed motion counts. The sums:
// centroidal_sums.h.

#include <momenta/core/scene/scene.h>
#include <momenta/core/tree/tree.h>

#include <memory>

namespace momenta {

/// A mechanism as one body, ground axes.
struct Centroidal {
  double mass = 0;                                             ///< [kg]
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();            ///< [m]; NaN without mass
  Eigen::Vector3d linear_momentum = Eigen::Vector3d::Zero();   ///< [kg m/s]
  Eigen::Vector3d angular_momentum = Eigen::Vector3d::Zero();  ///< [kg m²/s], about the origin
};

/// Always in space: a planar scene whose bodies lie at different heights has angular momentum in
/// its plane too. Owns its model and workspace; one object serves one thread.
class CentroidalSweep {
 public:
  /// Copies what it needs of both. O(bodies).
  CentroidalSweep(const Tree& tree, const Scene& scene);
  ~CentroidalSweep();
  /// Sweeps move; the one moved from may only be destroyed or assigned to.
  CentroidalSweep(CentroidalSweep&&) noexcept;
  /// As the constructor.
  CentroidalSweep& operator=(CentroidalSweep&&) noexcept;

  /// At (t, q, u), nq and nv numbers. O(bodies), no allocation.
  Centroidal operator()(double t, const double* q, const double* u);

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

/// At one state (t, q, u), model and all.
Centroidal centroidal(const Tree& tree, const Scene& scene, double t, const Eigen::VectorXd& q,
                      const Eigen::VectorXd& u);

}  // namespace momenta
