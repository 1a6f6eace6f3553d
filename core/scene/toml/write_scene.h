#pragma once
#include <momenta/core/scene/scene.h>

#include <string>

namespace momenta {

/// A scene as TOML that parse_scene() reads back the same, bit by bit: numbers have the shortest
/// digits that give the same double, signs of zeros are kept. Inertias are written out; what has
/// its default is left out; remarks become comments. Places in files are not kept.
/// @throws SceneError for a scene with a user joint, whose formula no file can hold
std::string scene_text(const Scene& scene);

}  // namespace momenta
