#pragma once
// The meshes of a picture, with as many triangles as a page has bytes for. Points in one cell of a
// grid of cubes become one, their mean; triangles with two corners in one cell go. All meshes have
// the same cells, the smallest with which they fit of a row of which each is √2 times the one
// before: what is lost is smaller than a cell wherever it stands.
//
//   bytes = 8 (points + triangles): six bytes of each as base64
//
// J. Rossignac, P. Borrel, Multi-resolution 3D approximations for rendering complex scenes (1993).

#include <momenta/dae/study/picture.h>

#include <cstddef>
#include <string>
#include <vector>

namespace momenta {

inline constexpr std::size_t usual_mesh_bytes = 300'000;

/// Reads the meshes of the picture's solids, whose files are named from the folder of the scene's,
/// into it, each file and scale once. @returns a sentence for each reason why some are left out: a
/// file that cannot be read, no room. Cost O(triangles) for each size of cells tried, at most 48
std::vector<std::string> take_meshes(Picture& picture, const std::string& scene_file,
                                     std::size_t bytes);

/// Coarsens the meshes of a picture, if they take more than so many bytes.
void coarsen_meshes(Picture& picture, std::size_t bytes);

}  // namespace momenta
