#pragma once
// Centre of mass and inertia of the solid shapes, of uniform density.

#include <momenta/core/scene/scene.h>

#include <string>

namespace momenta::reading {

/// Centre of mass [m], body axes: half way along a rod, else the body origin.
Eigen::Vector3d centre_of(const Shape& shape);

/// Inertia about the centre of mass [kg m²], body axes, with a the unit axis:
///   rod       m l²/12 (1 − a aᵀ)
///   box       m/12 diag(y² + z², x² + z², x² + y²)
///   cylinder  m r²/2 a aᵀ + m (3 r² + l²)/12 (1 − a aᵀ)
///   sphere    2/5 m r² 1
///   point     0
Eigen::Matrix3d inertia_of(const Shape& shape, double mass);

/// Why numbers make no symmetric matrix, in words; empty: they do.
std::string matrix_fault(const Eigen::Matrix3d& inertia);

/// Why a matrix is no inertia of a rigid body, in words; empty: it is one. The principal moments a
/// <= b <= c must satisfy 0 <= a and c <= a + b, both within 1e-9 c.
std::string inertia_fault(const Eigen::Matrix3d& inertia);

}  // namespace momenta::reading
