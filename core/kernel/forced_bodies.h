#pragma once
// Which bodies are placed for the forces at points of bodies. Forces between two bodies ask for the
// ways to their lowest common ancestor alone (relative_ways.h): a damper of a ball on a robot's leg
// costs one joint, not the robot. Coordinate springs look at single joints and act there. What acts
// on one body alone, or depends on where it is, takes the way to the ground. In a plane bodies have
// the axes of the ground, and all take that way.

#include <momenta/core/kernel/model.h>

#include <vector>

namespace momenta {

struct ForcedBody {
  int body = 0;
  bool from_rest = false;  ///< its parent, not among them, is at rest in its own axes
};

/// Parents first. O(bodies + length of the ways). Out of line: it does not depend on the scalar of
/// the sweeps that call it, which are compiled for several instruction levels.
template <class Space>
std::vector<ForcedBody> forced_bodies(const Model<Space>& model);
extern template std::vector<ForcedBody> forced_bodies(const Model<Spatial>&);
extern template std::vector<ForcedBody> forced_bodies(const Model<Planar>&);

}  // namespace momenta
