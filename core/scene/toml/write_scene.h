#pragma once
#include <momenta/core/scene/scene.h>

#include <string>

namespace momenta {

/// A scene as TOML text, from which parse_scene() reads the same scene, bit by bit: numbers have
/// the fewest digits that give the same double, and signs of zeros are kept. Inertias are written
/// out; values equal to their default are left out; remarks become comments. Places in files are
/// not kept. @throws SceneError for a scene with a user joint, whose formula no file can hold
std::string scene_text(const Scene& scene);

}  // namespace momenta
