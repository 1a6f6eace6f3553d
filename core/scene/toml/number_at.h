#pragma once
// The number at a place of a scene's text (setting.h), before another takes its place.

#include <string>
#include <string_view>

namespace momenta {

/// The number that stands at a place of a TOML text; a formula there has its value. @throws
/// std::invalid_argument where there is none; SceneError for a text that is no TOML
double number_at(std::string_view text, const std::string& file, const std::string& place);

}  // namespace momenta
