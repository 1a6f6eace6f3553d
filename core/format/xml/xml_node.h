#pragma once
// XML as plain values with their lines. Only xml_node.cpp includes the parser, tinyxml2.

#include <momenta/core/scene/scene.h>

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
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

// An XML element, read by type. Every complaint names the file, the line, the owner of the element
// ("link 'arm'"), the attribute, what was found and what was expected.

class Node {
 public:
  /// `owner` opens every sentence; empty: the element's own name.
  Node(const Element& element, std::string owner, const std::string& file)
      : element_(&element), owner_(std::move(owner)), file_(&file) {}

  const std::string& name() const { return element_->name; }
  const Element& element() const { return *element_; }
  const std::string& owner() const { return owner_; }
  Location at() const { return {element_->line, 0, element_->file ? element_->file->number : 0}; }
  const std::string& file() const { return element_->file ? element_->file->name : *file_; }
  bool has(std::string_view attribute) const { return element_->find(attribute) != nullptr; }

  // Attributes without `otherwise` are required. Numbers are finite; lists are separated by white
  // space.
  std::string text(std::string_view attribute) const;
  std::string text(std::string_view attribute, const std::string& otherwise) const;
  double number(std::string_view attribute) const;
  double number(std::string_view attribute, double otherwise) const;
  bool flag(std::string_view attribute, bool otherwise) const;  ///< true, false, 1 or 0
  std::vector<double> numbers(std::string_view attribute) const;
  std::vector<double> numbers(std::string_view attribute, std::size_t count) const;
  Eigen::Vector3d vector(std::string_view attribute) const;
  Eigen::Vector3d vector(std::string_view attribute, const Eigen::Vector3d& otherwise) const;
  /// The same at unit length.
  Eigen::Vector3d direction(std::string_view attribute, const Eigen::Vector3d& otherwise) const;
  /// Index in `words` of the attribute.
  std::size_t word(std::string_view attribute, std::span<const std::string_view> words,
                   std::size_t otherwise) const;

  // The text of the element itself, read likewise.
  std::string content() const;
  double content_number() const;
  std::vector<double> content_numbers() const;
  std::vector<double> content_numbers(std::size_t count) const;
  Eigen::Vector3d content_direction() const;  ///< three numbers, normalised
  bool content_flag() const;                  ///< true, false, 1 or 0
  std::size_t content_word(std::span<const std::string_view> words) const;

  /// The elements in this one, in the order of the file, with the same owner.
  std::vector<Node> children() const;
  std::vector<Node> children(std::string_view name) const;
  /// The only element of this name, if any. @throws SceneError for two
  std::optional<Node> child(std::string_view name) const;
  Node required(std::string_view name) const;
  /// This element under another owner.
  Node of(std::string owner) const { return {*element_, std::move(owner), *file_}; }

  /// "file:line: owner: <element> sentence"
  [[noreturn]] void fail(const std::string& sentence) const;
  [[noreturn]] void fail(std::string_view attribute, const std::string& sentence) const;

 private:
  /// `what`: "mass has", before the fault of the text.
  std::vector<double> numbers_of(const std::string& text, const std::string& what) const;
  void expect_count(std::size_t found, std::size_t expected, const std::string& what) const;
  std::size_t word_of(const std::string& found, std::span<const std::string_view> words,
                      const std::string& what) const;

  const Element* element_;
  std::string owner_;
  const std::string* file_;
};

}  // namespace momenta::reading
