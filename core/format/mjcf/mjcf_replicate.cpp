#include <momenta/core/format/mjcf/mjcf_copies.h>
#include <momenta/core/format/mjcf/mjcf_names.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace momenta::reading {
namespace {

/// In this order, since actuators may refer to tendons.
constexpr std::array<std::string_view, 4> following{"tendon", "equality", "contact", "actuator"};

/// Marks a replicated <replicate>; no attribute of a file has such a name.
constexpr const char* done = "is replicated";

class Replicator {
 public:
  Replicator(Element& root, const std::string& file, MjcfFiles& files)
      : root_(root), file_(file), files_(files) {}

  /// The innermost first: their numbers are next to the name.
  void expand(Element& element) {
    for (Element& child : element.children) expand(child);
    if (element.name == "replicate" && element.find(done) == nullptr) replicate(element);
  }

 private:
  void replicate(Element& element) {
    const Node node(element, "", file_);
    const double number = node.number("count");
    if (!(number >= 1 && number <= static_cast<double>(MjcfFiles::most_elements)) ||
        number != std::floor(number))
      node.fail("count", "is " + digits(number) + ", expected a whole number from 1 to " +
                             std::to_string(MjcfFiles::most_elements));
    const auto count = static_cast<std::size_t>(number);
    const std::string sep = node.text("sep", "");
    files_.grow(node, element, count);

    std::set<MjcfName> inside;
    for (const Element& child : element.children) collect_names(child, "", inside);
    std::vector<std::string> suffixes;
    const std::size_t width = std::to_string(count).size();
    for (std::size_t i = 0; i < count; ++i) {
      const std::string digits = std::to_string(i);
      suffixes.push_back(sep + std::string(width - digits.size(), '0') + digits);
    }
    Element replica;
    replica.name = "replica";
    replica.line = element.line;
    replica.file = element.file;
    replica.children = std::move(element.children);
    element.children.clear();
    const std::set<MjcfName> tree = inside;
    for (const std::string& suffix : suffixes) {
      Element copy = replica;
      rename(copy, "", "", suffix, [&](const std::string& kind, const std::string& name) {
        return tree.contains({kind, name});
      });
      element.children.push_back(std::move(copy));
    }
    element.attributes.push_back({done, ""});
    for (const std::string_view section : following)
      for (Element& part : root_.children)
        if (part.name == section) follow(part, suffixes, inside);
  }

  /// Copies the elements of a section that refer to copied names.
  void follow(Element& section, const std::vector<std::string>& suffixes,
              std::set<MjcfName>& inside) {
    std::vector<Element> all;
    for (Element& element : section.children) {
      std::string in, out;
      each_reference(element, [&](const std::string& kind, const std::string& name) {
        (inside.contains({kind, name}) ? in : out) = name;
      });
      if (in.empty()) {
        all.push_back(std::move(element));
        continue;
      }
      const Node node(element, section.name, file_);
      if (!out.empty())
        node.fail("refers to " + in_quotes(in) + " in a <replicate> and to " + in_quotes(out) +
                  " elsewhere, expected all of it in the same <replicate>");
      files_.grow(node, element, suffixes.size());
      std::set<MjcfName> own;
      if (const std::string* name = element.find("name")) own.insert({section.name, *name});
      for (const std::string& suffix : suffixes) {
        Element copy = element;
        rename(copy, section.name, "", suffix,
               [&](const std::string& kind, const std::string& name) {
                 return inside.contains({kind, name}) || own.contains({kind, name});
               });
        all.push_back(std::move(copy));
      }
      inside.merge(own);
    }
    section.children = std::move(all);
  }

  Element& root_;
  const std::string& file_;
  MjcfFiles& files_;
};

}  // namespace

void replicate_all(Element& root, const std::string& file, MjcfFiles& files) {
  Replicator replicator(root, file, files);
  for (std::size_t i = 0; i < root.children.size(); ++i)
    if (root.children[i].name == "worldbody") replicator.expand(root.children[i]);
}

}  // namespace momenta::reading
