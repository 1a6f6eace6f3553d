#pragma once
// Numbers at places of a scene's text (setting.h), before others take their places.

#include <momenta/core/scene/scene.h>
#include <momenta/core/scene/toml/setting.h>

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace momenta {

/// Finds the number at a place of this TOML text, which is read once and with these settings in it;
/// a formula there has its value. @throws SceneError for a text that is no TOML; the function that
/// it returns std::invalid_argument where there is no number
std::function<double(const std::string& place)> numbers_of(std::string_view text,
                                                           const std::string& file,
                                                           const std::vector<Setting>& settings);

/// Where it, or a formula of it, stands in the text. @throws as numbers_of() and what it returns
Location location_of(std::string_view text, const std::string& file, const std::string& place);

}  // namespace momenta
