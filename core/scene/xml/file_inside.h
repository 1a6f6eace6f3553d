#pragma once
// Files that a model names.

#include <momenta/core/scene/xml/xml_node.h>

#include <filesystem>
#include <string>

namespace momenta::reading {

/// The file that an attribute names, from `folder`, with its symbolic links followed; `attribute`
/// empty: the text of the element. @throws SceneError where there is none, where it is no plain
/// file, or out of `folder`
std::filesystem::path file_inside(const Node& node, const std::string& attribute,
                                  const std::string& name, const std::filesystem::path& folder);

/// Elements and bytes of an element with all in it.
std::pair<std::size_t, std::size_t> size_of(const Element& element);
/// Marks an element and all in it as standing in a file.
void mark(Element& element, const std::shared_ptr<const IncludedFile>& file);

/// Where a mesh to be drawn lies, from the folder of the file that names it: a path, or
/// "file://PATH", or "package://NAME/PATH" and "model://NAME/PATH", which are looked for in the
/// folders around. Empty: it is not there.
std::string mesh_path(const std::string& uri, const std::filesystem::path& file);
/// Whether its ending is of a mesh that is read: .stl, .obj or .msh.
bool is_mesh_file(const std::string& path);

}  // namespace momenta::reading
