#pragma once
#include <momenta/core/scene/scene.h>

namespace momenta {

/// Checks everything that the scene alone decides: names unique and known, masses, inertias
/// (triangle inequality), finite numbers, sizes of position and velocity, every body the child of
/// exactly one joint, no cycle among the joints, drives and torques on joints that can take them;
/// of a Lagrangian names, sizes and finite numbers, and that nothing of bodies stands beside it.
/// The readers call it; call it yourself for scenes built by hand. @throws SceneError
void validate(const Scene& scene);

}  // namespace momenta
