#include <momenta/core/format/xml/file_inside.h>
#include <momenta/core/scene/file_text.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <array>
#include <system_error>

namespace momenta::reading {
namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

}  // namespace

fs::path file_inside(const Node& node, const std::string& attribute, const std::string& name,
                     const fs::path& folder) {
  const NamedFile file = file_inside(name, folder);
  if (!file.fault.empty())
    node.fail((attribute.empty() ? "" : attribute + " ") + "is " + in_quotes(name) + file.fault);
  return file.path;
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
