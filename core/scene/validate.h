#pragma once
#include <momenta/core/scene/scene.h>

namespace momenta {

/// Checks all that the scene alone decides: names unique and known, masses, inertias (triangle
/// inequality), finite numbers, sizes of position and velocity, every body the child of exactly one
/// joint, no cycle among joints, drives and torques on joints that can take them; for a Lagrangian
/// names, sizes and finite numbers, and no bodies beside it. Readers call it; call it for scenes
/// made by hand. @throws SceneError
void validate(const Scene& scene);

}  // namespace momenta
