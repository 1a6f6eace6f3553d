#pragma once
#include <momenta/core/scene/scene.h>

#include <string>

namespace momenta {

/// A scene as TOML text; parse_scene() reads the same scene from it, bit by bit: numbers have the
/// fewest digits that give the same double, and signs of zeros are kept. Inertias are written out,
/// defaults left out, remarks become comments; places in files are lost. @throws SceneError for a
/// scene with a user joint, whose formula no file can hold
std::string scene_text(const Scene& scene);

}  // namespace momenta
