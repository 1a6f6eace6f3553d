#pragma once
// Solids as faces, for figures: polygons in body axes, corners counter-clockwise seen from outside.

#include <momenta/dae/study/picture.h>

#include <vector>

namespace momenta {

using Face = std::vector<Eigen::Vector3d>;

/// Faces of a solid: a box by six, round ones by surfaces of 14 sides about their axis, a mesh by
/// its triangles. O(faces)
std::vector<Face> faces_of(const Picture& picture, const Picture::Solid& solid);

}  // namespace momenta
