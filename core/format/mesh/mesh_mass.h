#pragma once
// Volume or area of a mesh, its centre of mass and its inertia, for a density of one.

#include <momenta/core/format/mesh/mesh.h>

namespace momenta::reading {

struct MeshMass {
  double measure = 0;                                 ///< volume [m³], or area [m²] of a shell
  Eigen::Vector3d com = Eigen::Vector3d::Zero();      ///< [m], axes of the mesh
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about com, axes of the mesh
};

/// Inside of a closed surface: sum over its triangles (a, b, c) of tetrahedra with a common corner
/// o, each with the sign of its volume v = (a−o)·(b−o)×(c−o)/6. With o = 0 and s = a + b + c:
///   V = Σ v,   V com = Σ v s/4,   ∫ x xᵀ = Σ v/20 (a aᵀ + b bᵀ + c cᵀ + s sᵀ)
/// The sums are exact for closed surfaces, whose edges are passed as often one way as the other, by
/// the divergence theorem; then o does not matter. First o is the mean of the points, then the
/// centre of mass, about which I = tr(C) 1 − C of C = ∫ x xᵀ. `fault`: why the surface has no
/// inside, in words; else empty.
/// Source: the simplex integrals of a polynomial of degree two. Cost O(n log n)
MeshMass mass_of_inside(const Mesh& mesh, std::string& fault);

/// The same sums with |v| instead of v, about the mean of the triangles' centres weighted by area:
/// MuJoCo's "legacy". Equal to the inside where that point sees all triangles from within (convex
/// surfaces), else larger. Also for open surfaces.
MeshMass mass_by_pyramids(const Mesh& mesh, std::string& fault);

/// The surface itself, of uniform density per area. Over a triangle of area A:
///   ∫ x = A s/3,   ∫ x xᵀ = A/12 (a aᵀ + b bᵀ + c cᵀ + s sᵀ)
MeshMass mass_of_shell(const Mesh& mesh, std::string& fault);

/// Convex hull of a mesh's points, by Qhull. `fault` as above: the points lie in a plane, or Qhull
/// fails. Cost O(n log n)
Mesh hull_of(const Mesh& mesh, std::string& fault);

}  // namespace momenta::reading
