#pragma once
// XML as plain values with their lines. The parser behind it, tinyxml2, is seen by xml_values.cpp
// alone.

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace momenta::reading {

struct Attribute {
  std::string name, text;
};

/// A file that another one includes.
struct IncludedFile {
  std::string name;
  int number = 0;  ///< Location::file
};

/// One element: its attributes and the elements in it. Text between elements and comments are
/// dropped: neither URDF nor MJCF say anything there.
struct Element {
  std::string name;
  int line = 0;
  std::shared_ptr<const IncludedFile> file;  ///< where it stands; null: in the file that is read
  std::vector<Attribute> attributes;
  std::vector<Element> children;

  /// The text of an attribute; null: it has none.
  const std::string* find(std::string_view attribute) const;
};

/// The root element of a text, which may be nested 200 deep. `file` only names it in messages.
/// @throws SceneError for what is no XML, or over 64 MiB
Element parse_xml(std::string_view text, const std::string& file);

}  // namespace momenta::reading
