#pragma once
// The text of a scene's file, in whatever format, and sentences about places in it.

#include <momenta/core/scene/scene.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace momenta::reading {

inline constexpr std::size_t largest_text = std::size_t{64} << 20;  ///< [byte]

/// The whole file. Its size is asked before a byte is read; what has no size (a pipe) is read up to
/// the limit of 64 MiB. `kind` says what it should be. @throws SceneError
std::string text_of(const std::filesystem::path& file, const std::string& kind = "scene");

/// The place in the file of a character of a text in quotes that begins at `at`; of one over
/// several lines that of the text.
Location place_in(std::string_view text, Location at, std::size_t character);

/// Throws the sentence "file:line:column: sentence".
[[noreturn]] void fail(const std::string& file, Location at, const std::string& sentence);

}  // namespace momenta::reading
