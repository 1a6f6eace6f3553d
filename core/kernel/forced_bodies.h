#pragma once
// Bodies placed for forces at points of bodies. Forces between two bodies need the ways to their
// lowest common ancestor alone (relative_ways.h): a damper of a ball on a robot's leg costs one
// joint, not the robot. Coordinate springs need single joints. Forces on one body alone, or
// dependent on its place, need the way to the ground; in a plane, with ground axes, all do.

#include <momenta/core/kernel/model.h>

#include <vector>

namespace momenta {

struct ForcedBody {
  int body = 0;
  bool from_rest = false;  ///< its parent, not in the list, is at rest in its own axes
};

/// The forced bodies, parents first. O(bodies + length of the ways). Out of line, for callers of
/// any scalar and level.
template <class Space>
std::vector<ForcedBody> forced_bodies(const Model<Space>& model);
extern template std::vector<ForcedBody> forced_bodies(const Model<Spatial>&);
extern template std::vector<ForcedBody> forced_bodies(const Model<Planar>&);

}  // namespace momenta
