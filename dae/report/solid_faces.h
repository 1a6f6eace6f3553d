#pragma once
// Solids as faces, for figures: polygons in body axes, corners counter-clockwise seen from outside.

#include <momenta/dae/study/picture.h>

#include <vector>

namespace momenta {

using Face = std::vector<Eigen::Vector3d>;

/// Six faces of a box, 14 sides about the axis of a round solid, triangles of a mesh. O(faces)
std::vector<Face> faces_of(const Picture& picture, const Picture::Solid& solid);

}  // namespace momenta
