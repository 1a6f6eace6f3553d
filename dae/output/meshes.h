#pragma once
// The meshes of a picture, with triangles for a given number of bytes. Points in one cell of a grid
// of cubes become one, their mean; triangles with two corners in one cell go. All meshes have the
// same cells, the smallest that fit in a series with ratio √2: lost details are smaller than a
// cell.
//
//   bytes = 8 (points + triangles): six bytes of each as base64
//
// J. Rossignac, P. Borrel, Multi-resolution 3D approximations for rendering complex scenes (1993).

#include <momenta/dae/run/picture.h>

#include <cstddef>
#include <string>
#include <vector>

namespace momenta {

inline constexpr std::size_t usual_mesh_bytes = 300'000;

/// Reads the meshes of the picture's solids, each file and scale once; paths start at the scene's
/// folder. @returns a sentence for each reason for leaving some out: a file that cannot be read, no
/// room. Cost O(triangles) for each size of cells tried, at most 48
std::vector<std::string> take_meshes(Picture& picture, const std::string& scene_file,
                                     std::size_t bytes);

/// Coarsens meshes to `bytes`, if they take more.
void coarsen_meshes(Picture& picture, std::size_t bytes);

// Solids as faces, for figures: polygons in body axes, corners counter-clockwise seen from outside.

using Face = std::vector<Eigen::Vector3d>;

/// Six faces of a box, 14 sides about the axis of a round solid, triangles of a mesh. O(faces)
std::vector<Face> faces_of(const Picture& picture, const Picture::Solid& solid);

}  // namespace momenta
