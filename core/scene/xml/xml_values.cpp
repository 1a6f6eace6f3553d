#include <momenta/core/scene/file_text.h>
#include <momenta/core/scene/xml/xml_values.h>
#include <momenta/core/text/near_name.h>
#include <momenta/core/text/utf8.h>
#include <tinyxml2.h>

#include <algorithm>

namespace momenta::reading {
namespace {

constexpr int deepest = 200;

/// Refuses names and values that are not UTF-8, whatever encoding the file declares: tinyxml2 hands
/// bytes on. Comments may hold any bytes.
void expect_utf8(std::string_view text, const tinyxml2::XMLElement& at, const std::string& file) {
  if (first_not_utf8(text) == std::string_view::npos) return;
  const auto* declaration = at.GetDocument()->FirstChild();
  const std::string first = declaration && declaration->ToDeclaration() ? declaration->Value() : "";
  const std::size_t word = first.find("encoding");
  std::string declared = word == std::string::npos ? "" : first.substr(word + 8);
  declared.erase(0, declared.find_first_not_of(" \t=\"'"));
  declared.erase(std::min(declared.find_first_of("\"' "), declared.size()));
  fail(file, {at.GetLineNum(), 0},
       in_quotes(text) + " is not in UTF-8" +
           (declared.empty() ? "" : " (the file declares " + on_one_line(declared) + ")") +
           ", expected UTF-8, which iconv -t UTF-8 makes of other encodings");
}

Element copied(const tinyxml2::XMLElement& from, int depth, const std::string& file) {
  Element element;
  expect_utf8(from.Name(), from, file);
  element.name = from.Name();
  element.line = from.GetLineNum();
  if (depth > deepest)
    fail(file, {element.line, 0}, "elements nested more than 200 deep, expected no such depth");
  for (auto* a = from.FirstAttribute(); a; a = a->Next()) {
    expect_utf8(a->Name(), from, file);
    expect_utf8(a->Value(), from, file);
    element.attributes.push_back({a->Name(), a->Value()});
  }
  for (auto* part = from.FirstChild(); part; part = part->NextSibling())
    if (part->ToText()) element.text += part->Value();
  expect_utf8(element.text, from, file);
  for (auto* child = from.FirstChildElement(); child; child = child->NextSiblingElement())
    element.children.push_back(copied(*child, depth + 1, file));
  return element;
}

/// The cause in a name of tinyxml2: "XML_ERROR_MISMATCHED_ELEMENT" is "mismatched element".
std::string in_words(const char* error) {
  std::string words = error;
  for (const std::string_view prefix : {"XML_ERROR_", "XML_"})
    if (words.starts_with(prefix)) words.erase(0, prefix.size());
  for (char& c : words)
    c = c == '_' ? ' ' : static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  return on_one_line(words);
}

}  // namespace

const std::string* Element::find(std::string_view attribute) const {
  for (const Attribute& a : attributes)
    if (a.name == attribute) return &a.text;
  return nullptr;
}

Element parse_xml(std::string_view text, const std::string& file) {
  if (text.size() > largest_text) fail(file, {}, "over 64 MiB, expected a scene of at most 64 MiB");
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff") ||
      text.find('\0') != std::string_view::npos)
    fail(file, {1, 0},
         "holds NUL or the mark of UTF-16, expected text in UTF-8, which iconv -t UTF-8 makes of "
         "other encodings");
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
    fail(file, {document.ErrorLineNum(), 0},
         "not valid XML: " + in_words(document.ErrorName()) + ", expected well-formed elements");
  if (document.RootElement() == nullptr)
    fail(file, {1, 0}, "no XML element, expected <robot>, <mujoco> or <sdf>");
  return copied(*document.RootElement(), 1, file);
}

}  // namespace momenta::reading
