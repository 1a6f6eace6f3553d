#pragma once
// Names in MJCF: attributes that give or refer to a name, and its kind. Copies of a part of the
// model get names of their own, and references follow.

#include <momenta/core/format/xml/xml_node.h>

#include <functional>
#include <set>
#include <string>
#include <utility>

namespace momenta::reading {

/// A kind ("body", "joint", "site", …) and a name of it.
using MjcfName = std::pair<std::string, std::string>;

/// Kind of a section's elements: "equality" for <equality><joint>, "" for bodies and their content,
/// where the element itself tells.
std::string named_kind(const Element& element, const std::string& section);

/// Calls visit(kind, name) for every name to which an element and those in it refer, without the
/// ground, assets and classes of defaults.
void each_reference(const Element& element,
                    const std::function<void(const std::string&, const std::string&)>& visit);

/// Collects the names that an element and those in it give.
void collect_names(const Element& element, const std::string& section, std::set<MjcfName>& names);

/// Adds prefix and suffix to every name with `changed(kind, name)`, where it is given and where it
/// is referred to. Kinds include "class".
void rename(Element& element, const std::string& section, const std::string& prefix,
            const std::string& suffix,
            const std::function<bool(const std::string&, const std::string&)>& changed);

}  // namespace momenta::reading
