#include <momenta/core/scene/xml/file_inside.h>
#include <momenta/core/text/near_name.h>

#include <algorithm>
#include <array>
#include <system_error>

namespace momenta::reading {
namespace {

namespace fs = std::filesystem;

bool lies_in(const fs::path& file, const fs::path& folder) {
  const fs::path way = file.lexically_relative(folder);
  return !way.empty() && *way.begin() != ".." && way != ".";
}

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

}  // namespace

fs::path file_inside(const Node& node, const std::string& attribute, const std::string& name,
                     const fs::path& folder) {
  const auto refuse = [&](const std::string& sentence) {
    node.fail((attribute.empty() ? "" : attribute + " ") + "is " + in_quotes(name) + sentence);
  };
  std::error_code error;
  const fs::path home = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, error);
  const fs::path file = fs::weakly_canonical(home / name, error);
  if (error || !lies_in(file, home))
    refuse(", which is not in the folder " + in_quotes(home.string()) +
           ", expected a file there or below");
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status))
    refuse(", which does not exist, expected a file in " + in_quotes(home.string()));
  if (!fs::is_regular_file(status)) refuse(", which is no plain file, expected one");
  return file;
}

std::pair<std::size_t, std::size_t> size_of(const Element& element) {
  std::pair<std::size_t, std::size_t> size{1, element.name.size()};
  for (const Attribute& a : element.attributes) size.second += a.name.size() + a.text.size();
  for (const Element& child : element.children) {
    const auto [elements, bytes] = size_of(child);
    size.first += elements;
    size.second += bytes;
  }
  return size;
}

void mark(Element& element, const std::shared_ptr<const IncludedFile>& file) {
  element.file = file;
  for (Element& child : element.children) mark(child, file);
}

std::string mesh_path(const std::string& uri, const fs::path& file) {
  std::error_code error;
  const fs::path folder =
      fs::weakly_canonical(file.parent_path().empty() ? fs::path(".") : file.parent_path(), error);
  const auto from_folder = [&](const fs::path& path) {
    return path.lexically_relative(folder).string();
  };
  constexpr std::string_view plain = "file://";
  for (const std::string_view scheme : {"package://", "model://"}) {
    if (!uri.starts_with(scheme)) continue;
    const std::string rest = uri.substr(scheme.size());
    const std::size_t slash = rest.find('/');
    if (slash == std::string::npos) return "";
    const std::string package = rest.substr(0, slash), inside = rest.substr(slash + 1);
    fs::path around = folder;
    constexpr int highest = 6;
    for (int level = 0; level < highest; ++level) {
      if (is_file(around / package / inside)) return from_folder(around / package / inside);
      if (is_file(around / inside)) return from_folder(around / inside);
      if (around == around.root_path()) break;
      around = around.parent_path();
    }
    return "";
  }
  const fs::path path = folder / (uri.starts_with(plain) ? uri.substr(plain.size()) : uri);
  return is_file(path) ? from_folder(path) : "";
}

bool is_mesh_file(const std::string& path) {
  std::string ending = fs::path(path).extension().string();
  for (char& c : ending)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return ending == ".stl" || ending == ".obj" || ending == ".msh";
}

}  // namespace momenta::reading
