#pragma once
// Files that an MJCF names: parts of the model to include, models to attach, meshes. And how much a
// model may hold once all its parts are in it.

#include <momenta/core/scene/xml/xml_node.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace momenta::reading {

class MjcfFiles {
 public:
  /// Elements that a model may hold with everything included, attached and replicated.
  static constexpr std::size_t most_elements = 200'000;
  static constexpr int deepest = 10;  ///< files that include or attach each other

  /// `model` is the file that is read.
  explicit MjcfFiles(const std::string& model);

  const std::filesystem::path& folder() const { return folder_; }  ///< of the model
  /// The folder of the file that an element stands in.
  std::filesystem::path folder_of(const Node& node) const;
  /// The root element of a file, its elements marked as standing there. `node` asks for it.
  Element read(const Node& node, const std::filesystem::path& file);
  /// Takes note of `count` copies of an element. @throws SceneError beyond most_elements or 64 MiB
  void grow(const Node& node, const Element& element, std::size_t count);
  /// Drops attributes without a value, which MuJoCo takes as not given, from an element and all in
  /// it; empty() counts them.
  void drop_empty(Element& element);
  int empty() const { return empty_; }
  /// Of the files read so far, for Scene::included.
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::filesystem::path folder_, written_;  ///< the folder, and as the model's name has it
  std::vector<std::string> names_;
  std::size_t elements_ = 0, bytes_ = 0;
  int empty_ = 0;
};

/// The model with the elements of other files in the place of each <include>. As in MuJoCo a file
/// is looked for in the folder of the model, then in that of the file that includes it; each may be
/// included once; its root element may have any name. @throws SceneError
Element with_includes(Element model, const std::string& file, MjcfFiles& files);

}  // namespace momenta::reading
