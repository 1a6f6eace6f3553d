#include <momenta/core/format/xml/known_elements.h>
#include <momenta/core/text/edits.h>
#include <momenta/core/text/quoting.h>

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

/// Whether a value asks for nothing.
bool idle(const std::string& text) {
  return text == "0" || text == "false" || text == "none" || text == "auto" || text == "disable";
}

/// Elements without effect on a mechanism.
constexpr std::string_view pictures = "visual collision material texture camera light skin hfield";

class Rows {
 public:
  explicit Rows(std::span<const KnownElement> known) {
    for (const KnownElement& e : known) rows_.emplace(e.name, &e);
  }
  const KnownElement* find(const std::string& name, const std::string& around) const {
    auto at = rows_.find(around + "/" + name);
    if (at == rows_.end()) at = rows_.find(name);
    return at == rows_.end() ? nullptr : at->second;
  }

 private:
  std::map<std::string_view, const KnownElement*, std::less<>> rows_;
};

/// The known name of which `word` is a misspelling; empty: none.
std::string_view meant(const std::string& word, const KnownElement& row) {
  std::string_view nearest;
  std::size_t least = most_edits + 1;
  for (const std::string_view words : {row.taken, row.silent, row.told})
    for (std::size_t at = 0; at < words.size();) {
      const std::size_t end = std::min(words.find(' ', at), words.size());
      const std::string_view name = words.substr(at, end - at);
      at = end + 1;
      const std::size_t apart = edits(word, name);
      if (apart == 0) return {};
      if (apart < least && is_misspelt(word, name)) {
        least = apart;
        nearest = name;
      }
    }
  return nearest;
}

void refuse_misspelt(const Node& node, const std::string& around, const Rows& rows) {
  const KnownElement* row = rows.find(node.name(), around);
  if (row == nullptr) return;
  for (const Node& child : node.children()) {
    const std::string& name = child.name();
    if (lists(pictures, name)) continue;
    if (const std::string_view known = meant(name, *row); !known.empty() && !lists(pictures, known))
      child.fail("is not known in <" + node.name() +
                 ">, expected an element of the format; did you mean " + in_quotes(known) + "?");
    refuse_misspelt(child, node.name(), rows);
  }
}

class Teller {
 public:
  Teller(std::span<const KnownElement> known, Remarks& remarks) : rows_(known), remarks_(remarks) {}

  void look(const Node& node, const std::string& around) {
    const KnownElement* row = rows_.find(node.name(), around);
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
  Rows rows_;
  Remarks& remarks_;
};

}  // namespace

void refuse_misspelt(const Node& root, std::span<const KnownElement> known) {
  refuse_misspelt(root, "", Rows(known));
}

void tell_unread(const Node& root, std::span<const KnownElement> known, Remarks& remarks) {
  Teller(known, remarks).look(root, "");
}

}  // namespace momenta::reading
