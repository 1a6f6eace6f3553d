#pragma once
// XML as plain values with their lines. Only xml_values.cpp includes the parser, tinyxml2.

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace momenta::reading {

struct Attribute {
  std::string name, text;
};

struct IncludedFile {
  std::string name;
  int number = 0;  ///< Location::file
};

/// One element: its attributes, its text without comments, and the elements in it.
struct Element {
  std::string name;
  std::string text;
  int line = 0;
  std::shared_ptr<const IncludedFile> file;  ///< file of the element; null: the file that is read
  std::vector<Attribute> attributes;
  std::vector<Element> children;

  /// The text of an attribute; null: none.
  const std::string* find(std::string_view attribute) const;
};

/// The root element of a text, nested at most 200 deep. `file` only names it in messages. @throws
/// SceneError for text that is no XML, or over 64 MiB
Element parse_xml(std::string_view text, const std::string& file);

}  // namespace momenta::reading
