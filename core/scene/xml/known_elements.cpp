#include <momenta/core/scene/xml/known_elements.h>
#include <momenta/core/text/near_name.h>

#include <algorithm>
#include <map>

namespace momenta::reading {
namespace {

bool lists(std::string_view words, std::string_view name) {
  for (std::size_t at = 0; at < words.size();) {
    const std::size_t end = std::min(words.find(' ', at), words.size());
    if (words.substr(at, end - at) == name) return true;
    at = end + 1;
  }
  return false;
}

/// A value that asks for nothing.
bool idle(const std::string& text) {
  return text == "0" || text == "false" || text == "none" || text == "auto" || text == "disable";
}

class Teller {
 public:
  Teller(std::span<const KnownElement> known, Remarks& remarks) : remarks_(remarks) {
    for (const KnownElement& e : known) rows_.emplace(e.name, &e);
  }

  void look(const Node& node, const std::string& around) {
    const KnownElement* row = find(node.name(), around);
    if (row == nullptr) return;
    const std::string in = " of <" + node.name() + ">";
    for (const Attribute& a : node.element().attributes) {
      if (a.name.starts_with("xmlns") || a.name.find(' ') != std::string::npos ||
          lists(row->taken, a.name) || lists(row->silent, a.name))
        continue;
      if (lists(row->told, a.name)) {
        if (!idle(a.text)) remarks_.left_out(a.name + in);
      } else {
        remarks_.count("not known, left out: attribute " + in_quotes(a.name) + in);
      }
    }
    for (const Node& child : node.children()) {
      const std::string& name = child.name();
      if (lists(row->silent, name) || name.find(' ') != std::string::npos) continue;
      if (lists(row->taken, name))
        look(child, node.name());
      else if (!idle(child.element().text))
        remarks_.left_out("<" + name + ">" + in);
    }
  }

 private:
  const KnownElement* find(const std::string& name, const std::string& around) const {
    auto at = rows_.find(around + "/" + name);
    if (at == rows_.end()) at = rows_.find(name);
    return at == rows_.end() ? nullptr : at->second;
  }

  std::map<std::string_view, const KnownElement*, std::less<>> rows_;
  Remarks& remarks_;
};

}  // namespace

void tell_unread(const Node& root, std::span<const KnownElement> known, Remarks& remarks) {
  Teller(known, remarks).look(root, "");
}

}  // namespace momenta::reading
