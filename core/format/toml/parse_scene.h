#pragma once
#include <momenta/core/scene/scene.h>

#include <string>
#include <string_view>

namespace momenta {

/// Reads a scene from TOML text; `file` names it in messages only. @throws SceneError: one sentence
/// with file, line and column, the key or name at fault, what was found and what was expected. Cost
/// O(size of text)
Scene parse_scene(std::string_view text, const std::string& file = "scene");

}  // namespace momenta
