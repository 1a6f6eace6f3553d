#pragma once
// Text of a scene's file in any format, and sentences about places in it.

#include <momenta/core/scene/scene.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace momenta::reading {

inline constexpr std::size_t largest_text = std::size_t{64} << 20;  ///< [byte]

/// Refuses pipes and devices, which may never end. `kind` names the file expected. @throws
/// SceneError where there is none, or a directory, a pipe, a device
void expect_plain_file(const std::filesystem::path& file, const std::string& kind);

/// The text of a plain file of at most 64 MiB. @throws SceneError
std::string text_of(const std::filesystem::path& file, const std::string& kind = "scene");

struct NamedFile {
  std::filesystem::path path;  ///< path, symbolic links followed
  std::string fault;           ///< why it is refused, as the rest of a sentence; empty: accepted
};
/// Finds a plain file in `folder` or below, also after `..` and symbolic links: scenes read only
/// their own files.
NamedFile file_inside(const std::string& name, const std::filesystem::path& folder);

/// Place in the file of a character of a quoted text that begins at `at`; for a text over several
/// lines the place of the text.
Location place_in(std::string_view text, Location at, std::size_t character);

/// Throws the sentence "file:line:column: sentence".
[[noreturn]] void fail(const std::string& file, Location at, const std::string& sentence);

}  // namespace momenta::reading
