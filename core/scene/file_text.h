#pragma once
#include <filesystem>
#include <string>

namespace momenta::reading {

/// The whole file. Its size is asked before a byte is read; what has no size (a pipe) is read up to
/// the limit of 64 MiB. @throws SceneError
std::string text_of(const std::filesystem::path& file);

}  // namespace momenta::reading
