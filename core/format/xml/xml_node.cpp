#include <momenta/core/format/xml/xml_node.h>
#include <momenta/core/scene/file_text.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/text/quoting.h>
#include <momenta/core/text/utf8.h>

#include <tinyxml2.h>
#include <algorithm>
#include <charconv>
#include <cmath>

namespace momenta::reading {

namespace {

constexpr std::array<std::string_view, 4> flag_words{"false", "true", "0", "1"};  // odd: true

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

}  // namespace

void Node::fail(const std::string& sentence) const {
  momenta::reading::fail(file(), {element_->line, 0},
                         (owner_.empty() ? "" : owner_ + ": ") + "<" + name() + "> " + sentence);
}

void Node::fail(std::string_view attribute, const std::string& sentence) const {
  fail(std::string(attribute) + " " + sentence);
}

std::string Node::text(std::string_view attribute) const {
  const std::string* found = element_->find(attribute);
  if (found == nullptr) fail("has no " + std::string(attribute) + ", expected one");
  const std::string words(trimmed(*found));
  if (words.empty()) fail(attribute, "is empty, expected a name or a value");
  return words;
}

std::string Node::text(std::string_view attribute, const std::string& otherwise) const {
  const std::string* found = element_->find(attribute);
  return found == nullptr ? otherwise : std::string(trimmed(*found));
}

std::vector<double> Node::numbers_of(const std::string& text, const std::string& what) const {
  std::vector<double> all;
  const char* at = text.data();
  const char* const end = at + text.size();
  for (;;) {
    while (at != end && is_space(*at)) ++at;
    if (at == end) return all;
    const char* from = at;
    while (at != end && !is_space(*at)) ++at;
    const std::string_view word(from, static_cast<std::size_t>(at - from));
    double value = 0;
    const bool plus = word.size() > 1 && word[0] == '+' && word[1] != '-';
    const auto [stop, error] = std::from_chars(from + plus, at, value);
    if (stop != at || error != std::errc() || !std::isfinite(value))
      fail(what + "has " + in_quotes(word) + ", expected finite numbers");
    all.push_back(value);
  }
}

void Node::expect_count(std::size_t found, std::size_t expected, const std::string& what) const {
  if (found != expected)
    fail(what + "has " + std::to_string(found) + " numbers, expected " + std::to_string(expected));
}

std::vector<double> Node::numbers(std::string_view attribute) const {
  const std::string* found = element_->find(attribute);
  if (found == nullptr) fail("has no " + std::string(attribute) + ", expected numbers");
  return numbers_of(*found, std::string(attribute) + " ");
}

std::vector<double> Node::numbers(std::string_view attribute, std::size_t count) const {
  std::vector<double> all = numbers(attribute);
  expect_count(all.size(), count, std::string(attribute) + " ");
  return all;
}

std::string Node::content() const {
  const std::string words(trimmed(element_->text));
  if (words.empty()) fail("is empty, expected a name or a value");
  return words;
}
double Node::content_number() const {
  return content_numbers(1).front();
}
std::vector<double> Node::content_numbers() const {
  return numbers_of(element_->text, "");
}
std::vector<double> Node::content_numbers(std::size_t count) const {
  std::vector<double> all = content_numbers();
  expect_count(all.size(), count, "");
  return all;
}
bool Node::content_flag() const {
  return content_word(flag_words) % 2 == 1;
}
std::size_t Node::content_word(std::span<const std::string_view> words) const {
  return word_of(content(), words, "");
}

double Node::number(std::string_view attribute) const {
  return numbers(attribute, 1).front();
}
double Node::number(std::string_view attribute, double otherwise) const {
  return has(attribute) ? number(attribute) : otherwise;
}

bool Node::flag(std::string_view attribute, bool otherwise) const {
  return word(attribute, flag_words, otherwise ? 1 : 0) % 2 == 1;
}

Eigen::Vector3d Node::vector(std::string_view attribute) const {
  const std::vector<double> three = numbers(attribute, 3);
  return {three[0], three[1], three[2]};
}
Eigen::Vector3d Node::vector(std::string_view attribute, const Eigen::Vector3d& otherwise) const {
  return has(attribute) ? vector(attribute) : otherwise;
}

namespace {

/// The vector at unit length; zero stays zero.
Eigen::Vector3d of_unit_length(const Eigen::Vector3d& along) {
  const double largest = along.lpNorm<Eigen::Infinity>();
  return largest == 0 || is_unit(along) ? along : (along / largest).normalized();
}
constexpr const char* no_direction = "is the zero vector, expected a direction";

}  // namespace

Eigen::Vector3d Node::direction(std::string_view attribute,
                                const Eigen::Vector3d& otherwise) const {
  if (!has(attribute)) return otherwise;
  const Eigen::Vector3d along = of_unit_length(vector(attribute));
  if (along.isZero(0)) fail(attribute, no_direction);
  return along;
}
Eigen::Vector3d Node::content_direction() const {
  const std::vector<double> three = content_numbers(3);
  const Eigen::Vector3d along = of_unit_length({three[0], three[1], three[2]});
  if (along.isZero(0)) fail(no_direction);
  return along;
}

std::size_t Node::word(std::string_view attribute, std::span<const std::string_view> words,
                       std::size_t otherwise) const {
  if (!has(attribute)) return otherwise;
  return word_of(text(attribute), words, std::string(attribute) + " ");
}

std::size_t Node::word_of(const std::string& found, std::span<const std::string_view> words,
                          const std::string& what) const {
  const auto known = std::find(words.begin(), words.end(), found);
  if (known == words.end())
    fail(what + "is " + in_quotes(found) + ", expected one of: " + listed(words) +
         did_you_mean(found, words));
  return static_cast<std::size_t>(known - words.begin());
}

std::vector<Node> Node::children() const {
  std::vector<Node> all;
  for (const Element& e : element_->children) all.emplace_back(e, owner_, *file_);
  return all;
}

std::vector<Node> Node::children(std::string_view name) const {
  std::vector<Node> all;
  for (const Element& e : element_->children)
    if (e.name == name) all.emplace_back(e, owner_, *file_);
  return all;
}

std::optional<Node> Node::child(std::string_view name) const {
  std::vector<Node> all = children(name);
  if (all.size() > 1) all[1].fail("is there twice, expected once");
  return all.empty() ? std::nullopt : std::optional<Node>(std::move(all.front()));
}

Node Node::required(std::string_view name) const {
  std::optional<Node> found = child(name);
  if (!found) fail("has no <" + std::string(name) + ">, expected one");
  return *std::move(found);
}

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
