#pragma once
// The mechanism as one body: mass, centre of mass, linear and angular momentum, ground axes. With
// R_K, r_K the pose of body K's frame, m_K, c_K its mass and centre of mass and (p_l, p_a) = M_K
// Ω_K its own momentum about O_K, eq. (11),
//
//   m = Σ m_K          c = Σ m_K (r_K + R_K c_K) / m
//   L = Σ R_K p_l      H = Σ (R_K p_a + r_K × R_K p_l)      about the ground's origin
//
// All bodies move as drives and rates say, so prescribed motion counts. Always in space: a planar
// scene whose bodies lie at different heights has angular momentum in its plane too.

#include <momenta/core/scene/scene.h>
#include <momenta/core/tree/tree.h>

namespace momenta {

struct Whole {
  double mass = 0;                                             ///< [kg]
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();            ///< [m]; NaN without mass
  Eigen::Vector3d linear_momentum = Eigen::Vector3d::Zero();   ///< [kg m/s]
  Eigen::Vector3d angular_momentum = Eigen::Vector3d::Zero();  ///< [kg m²/s], about the origin
};

/// At (t, q, u). Cost O(bodies).
Whole whole(const Tree& tree, const Scene& scene, double t, const Eigen::VectorXd& q,
            const Eigen::VectorXd& u);

}  // namespace momenta
