#pragma once
// Numbers at places of a scene's text (setting.h).

#include <momenta/core/format/toml/setting.h>
#include <momenta/core/scene/scene.h>

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace momenta {

/// A function that gives the number at a place of this TOML text, with these settings in it; a
/// formula has its value. @throws SceneError for a text that is no TOML; the function
/// std::invalid_argument where there is no number
std::function<double(const std::string& place)> numbers_of(std::string_view text,
                                                           const std::string& file,
                                                           const std::vector<Setting>& settings);

/// Where that number, or its formula, stands in the text. @throws as numbers_of() and its function
Location location_of(std::string_view text, const std::string& file, const std::string& place);

}  // namespace momenta
