#include <momenta/core/format/mjcf/mjcf_names.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace momenta::reading {
namespace {

/// Kind of thing that an attribute refers to; empty: none.
std::string referred_kind(std::string_view attribute) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 11> others{
      {{"jointinparent", "joint"},
       {"cranksite", "site"},
       {"slidersite", "site"},
       {"refsite", "site"},
       {"sidesite", "site"},
       {"childclass", "class"},
       {"class", "class"},
       {"mesh", "mesh"},
       {"model", "model"},
       {"hfield", "hfield"},
       {"material", "material"}}};
  for (const auto& [name, kind] : others)
    if (attribute == name) return std::string(kind);
  if (attribute.ends_with('1') || attribute.ends_with('2')) attribute.remove_suffix(1);
  constexpr std::array<std::string_view, 6> kinds{"body", "joint",  "site",
                                                  "geom", "tendon", "actuator"};
  const bool known = std::find(kinds.begin(), kinds.end(), attribute) != kinds.end();
  return known ? std::string(attribute) : "";
}

}  // namespace

std::string named_kind(const Element& element, const std::string& section) {
  if (section == "asset") return element.name;
  if (!section.empty()) return section;
  return element.name == "freejoint" ? "joint" : element.name;
}

void each_reference(const Element& element,
                    const std::function<void(const std::string&, const std::string&)>& visit) {
  for (const Attribute& a : element.attributes) {
    const std::string kind = referred_kind(a.name);
    const bool asset = kind == "mesh" || kind == "model" || kind == "hfield" || kind == "material";
    if (kind.empty() || kind == "class" || asset || (kind == "body" && a.text == "world")) continue;
    visit(kind, a.text);
  }
  for (const Element& child : element.children) each_reference(child, visit);
}

void collect_names(const Element& element, const std::string& section, std::set<MjcfName>& names) {
  if (const std::string* name = element.find("name"))
    names.insert({named_kind(element, section), *name});
  if (section.empty())
    for (const Element& child : element.children) collect_names(child, section, names);
}

void rename(Element& element, const std::string& section, const std::string& prefix,
            const std::string& suffix,
            const std::function<bool(const std::string&, const std::string&)>& changed) {
  for (Attribute& a : element.attributes) {
    const std::string kind =
        a.name == "name" ? named_kind(element, section) : referred_kind(a.name);
    if (kind.empty() || (kind == "body" && a.text == "world")) continue;
    if (changed(kind, a.text)) a.text = prefix + a.text + suffix;
  }
  for (Element& child : element.children) rename(child, section, prefix, suffix, changed);
}

}  // namespace momenta::reading
