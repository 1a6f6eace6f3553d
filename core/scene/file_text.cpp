#include <momenta/core/scene/file_text.h>

#include <fstream>
#include <system_error>

namespace momenta::reading {

std::string text_of(const std::filesystem::path& file, const std::string& kind) {
  const std::string name = file.string();
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) fail(name, {}, "no such file, expected a " + kind);
  if (std::filesystem::is_directory(status))
    fail(name, {}, "a directory, expected a " + kind + " file");
  if (std::filesystem::is_regular_file(status)) {
    const auto size = std::filesystem::file_size(file, error);
    if (!error && size > largest_text)
      fail(name, {}, "the file is over 64 MiB, expected a " + kind + " of at most 64 MiB");
  }

  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail(name, {}, "the file cannot be opened for reading");
  std::string text;
  constexpr std::size_t chunk = std::size_t{1} << 16;
  while (stream && text.size() <= largest_text) {
    const std::size_t size = text.size();
    text.resize(size + chunk);
    stream.read(text.data() + size, static_cast<std::streamsize>(chunk));
    text.resize(size + static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) fail(name, {}, "the file cannot be read to its end");
  return text;
}

Location place_in(std::string_view text, Location at, std::size_t character) {
  if (text.find('\n') == std::string_view::npos && at.line > 0)
    at.column += 1 + static_cast<int>(character);
  return at;
}

void fail(const std::string& file, Location at, const std::string& sentence) {
  Scene scene;
  scene.file = file;
  throw SceneError(scene.where(at) + sentence);
}

}  // namespace momenta::reading
