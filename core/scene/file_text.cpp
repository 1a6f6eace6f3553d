#include <momenta/core/scene/file_text.h>
#include <momenta/core/text/quoting.h>

#include <fstream>
#include <system_error>

namespace momenta::reading {

namespace fs = std::filesystem;

void expect_plain_file(const fs::path& file, const std::string& kind) {
  const std::string name = on_one_line(file.string());
  std::error_code error;
  const auto status = fs::status(file, error);
  if (!fs::exists(status)) fail(name, {}, "no such file, expected a " + kind);
  if (fs::is_directory(status)) fail(name, {}, "a directory, expected a " + kind + " file");
  if (!fs::is_regular_file(status))
    fail(name, {}, "a pipe or a device, expected a " + kind + " in a plain file");
}

std::string text_of(const fs::path& file, const std::string& kind) {
  const std::string name = file.string();
  expect_plain_file(file, kind);
  std::error_code error;
  const auto bytes = fs::file_size(file, error);
  if (!error && bytes > largest_text)
    fail(name, {}, "the file is over 64 MiB, expected a " + kind + " of at most 64 MiB");

  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail(name, {}, "the file cannot be opened for reading, expected a " + kind);
  std::string text;
  constexpr std::size_t chunk = std::size_t{1} << 16;
  while (stream && text.size() <= largest_text) {
    const std::size_t size = text.size();
    text.resize(size + chunk);
    stream.read(text.data() + size, static_cast<std::streamsize>(chunk));
    text.resize(size + static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) fail(name, {}, "the file cannot be read to its end, expected a " + kind);
  return text;
}

NamedFile file_inside(const std::string& name, const fs::path& folder) {
  std::error_code error;
  const fs::path home = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, error);
  NamedFile file{fs::weakly_canonical(home / name, error), ""};
  const fs::path way = file.path.lexically_relative(home);
  if (error || way.empty() || *way.begin() == ".." || way == ".") {
    file.fault = ", which is not in the folder " + in_quotes(home.string()) +
                 ", expected a file there or below";
    return file;
  }
  const fs::file_status status = fs::status(file.path, error);
  if (!fs::exists(status))
    file.fault = ", which does not exist, expected a file in " + in_quotes(home.string());
  else if (!fs::is_regular_file(status))
    file.fault = ", which is no plain file, expected one";
  return file;
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
