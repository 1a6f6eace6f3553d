#pragma once
#include <momenta/core/scene/scene.h>
#include <momenta/dae/mechanism/loop/higher_pair.h>

namespace momenta {

/// The pair of a loop with curves, in the axes frame_across(). @pre has_curves(loop). O(points)
HigherPair pair_of(const LoopSpec& loop);

/// Polylines that draw the curves of a slot, a cam or a rack: the parent's in axes of the parent,
/// the child's in axes of the child [m]. Lines are drawn up to `reach` on both sides.
struct DrawnCurves {
  struct Polyline {
    std::vector<Eigen::Vector3d> points;
    bool closed = false;
  };
  Polyline of_parent, of_child;
};
DrawnCurves drawn_curves(const LoopSpec& loop, double reach);

}  // namespace momenta
