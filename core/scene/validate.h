#pragma once
#include <momenta/core/scene/scene.h>

namespace momenta {

/// Everything that can be told from the scene alone: names unique and known, masses, inertias
/// (triangle inequality), finite numbers, sizes of position and velocity, every body the child of
/// exactly one joint, no cycle among the joints, drives and torques on joints that can take them.
/// Called by the readers; call it for scenes built by hand.
/// @throws SceneError
void validate(const Scene& scene);

}  // namespace momenta
