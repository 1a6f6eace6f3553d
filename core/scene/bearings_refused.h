#pragma once
// Bearings with friction in a scene, and their refusal.

#include <momenta/core/scene/scene.h>

namespace momenta {

/// The first joint with a bearing; null: none.
const JointSpec* with_bearing(const Scene& scene);

/// @throws SceneError where a joint has a bearing: `what`, "the linearisation", cannot take its
/// friction
void refuse_bearings(const Scene& scene, const std::string& what);

}  // namespace momenta
