#pragma once
// Files named in an MJCF: includes, attached models, meshes. Bounds the size of the whole model.

#include <momenta/core/format/xml/xml_node.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace momenta::reading {

class MjcfFiles {
 public:
  /// Most elements of a model with everything included, attached and replicated.
  static constexpr std::size_t most_elements = 200'000;
  static constexpr int deepest = 10;  ///< most files that include or attach each other

  /// `model`: the file that is read.
  explicit MjcfFiles(const std::string& model);

  const std::filesystem::path& folder() const { return folder_; }  ///< folder of the model
  /// The folder of an element's file.
  std::filesystem::path folder_of(const Node& node) const;
  /// The root element of a file, its elements marked with it. `node` asks for it.
  Element read(const Node& node, const std::filesystem::path& file);
  /// Counts `count` copies of an element. @throws SceneError beyond most_elements or 64 MiB
  void grow(const Node& node, const Element& element, std::size_t count);
  /// Drops attributes without a value, as MuJoCo does, from an element and those in it; empty()
  /// counts them.
  void drop_empty(Element& element);
  int empty() const { return empty_; }
  /// Files read so far, for Scene::included.
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::filesystem::path folder_, written_;  ///< the folder, and as written in the model's name
  std::vector<std::string> names_;
  std::size_t elements_ = 0, bytes_ = 0;
  int empty_ = 0;
};

/// The model with each <include> replaced by the elements of its file. As in MuJoCo a file is
/// sought in the folder of the model, then in that of the including file; each may be included
/// once; its root element may have any name. @throws SceneError
Element with_includes(Element model, const std::string& file, MjcfFiles& files);

}  // namespace momenta::reading
