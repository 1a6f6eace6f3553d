#pragma once
// The text of a scene's file, in whatever format, and sentences about places in it.

#include <momenta/core/scene/scene.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace momenta::reading {

inline constexpr std::size_t largest_text = std::size_t{64} << 20;  ///< [byte]

/// A pipe or a device may never end, nor begin. `kind` says what it should be. @throws SceneError
/// where there is none, or a directory, a pipe, a device
void expect_plain_file(const std::filesystem::path& file, const std::string& kind);

/// The whole file, which is a plain one of at most 64 MiB. @throws SceneError
std::string text_of(const std::filesystem::path& file, const std::string& kind = "scene");

/// A file that another one names.
struct NamedFile {
  std::filesystem::path path;  ///< its symbolic links followed
  std::string fault;           ///< why it is refused, as the rest of a sentence; empty: it is not
};
/// It has to be a plain file in `folder` or below, by `..` and by symbolic links alike: a scene
/// from elsewhere does not read what it was not given.
NamedFile file_inside(const std::string& name, const std::filesystem::path& folder);

/// The place in the file of a character of a text in quotes that begins at `at`; of one over
/// several lines that of the text.
Location place_in(std::string_view text, Location at, std::size_t character);

/// Throws the sentence "file:line:column: sentence".
[[noreturn]] void fail(const std::string& file, Location at, const std::string& sentence);

}  // namespace momenta::reading
