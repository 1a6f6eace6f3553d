#pragma once
// Files named in a model.

#include <momenta/core/format/xml/xml_node.h>

#include <filesystem>
#include <string>

namespace momenta::reading {

/// The file named by an attribute, from `folder`, symbolic links followed; `attribute` empty: by
/// the text of the element. @throws SceneError where it does not exist, is no plain file, or out of
/// `folder`
std::filesystem::path file_inside(const Node& node, const std::string& attribute,
                                  const std::string& name, const std::filesystem::path& folder);

/// Number of elements and bytes of an element with all in it.
std::pair<std::size_t, std::size_t> size_of(const Element& element);
/// Marks an element and all in it with its file.
void mark(Element& element, const std::shared_ptr<const IncludedFile>& file);

/// Path of a mesh to draw, from the folder of the file that names it: a path, "file://PATH", or
/// "package://NAME/PATH" and "model://NAME/PATH", which are sought in the folders around. Empty:
/// not found.
std::string mesh_path(const std::string& uri, const std::filesystem::path& file);
/// Whether the ending is of a mesh format that is read: .stl, .obj or .msh.
bool is_mesh_file(const std::string& path);

}  // namespace momenta::reading
