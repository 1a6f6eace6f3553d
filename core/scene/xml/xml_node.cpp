#include <momenta/core/scene/file_text.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/scene/xml/xml_node.h>
#include <momenta/core/text/near_name.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace momenta::reading {
namespace {

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
  constexpr std::array<std::string_view, 4> words{"false", "true", "0", "1"};
  return content_word(words) % 2 == 1;
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
  constexpr std::array<std::string_view, 2> words{"false", "true"};
  return word(attribute, words, otherwise ? 1 : 0) == 1;
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

}  // namespace momenta::reading
