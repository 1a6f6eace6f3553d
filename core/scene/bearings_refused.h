#pragma once
// Which scenes have bearings with friction, and the refusal of what cannot take it.

#include <momenta/core/scene/scene.h>

namespace momenta {

/// The first joint with a bearing; null: none.
const JointSpec* with_bearing(const Scene& scene);

/// @throws SceneError where a joint has a bearing, whose friction `what` cannot take: "the
/// linearisation"
void refuse_bearings(const Scene& scene, const std::string& what);

}  // namespace momenta
