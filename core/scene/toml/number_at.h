#pragma once
// Numbers at places of a scene's text (setting.h), before others take their places.

#include <momenta/core/scene/scene.h>

#include <functional>
#include <string>
#include <string_view>

namespace momenta {

/// Tells the number that stands at a place of this TOML text, which is read once; a formula there
/// has its value. @throws SceneError for a text that is no TOML; what it returns
/// std::invalid_argument where there is none
std::function<double(const std::string& place)> numbers_of(std::string_view text,
                                                           const std::string& file);

/// Where it, or a formula of it, stands in the text. @throws as numbers_of() and what it returns
Location location_of(std::string_view text, const std::string& file, const std::string& place);

}  // namespace momenta
