#pragma once
// Names in MJCF: which attribute gives one and which refers to one, and of what kind. Copies of a
// part of the model get names of their own, and what refers to it follows.

#include <momenta/core/scene/xml/xml_node.h>

#include <functional>
#include <set>
#include <string>
#include <utility>

namespace momenta::reading {

/// A kind ("body", "joint", "site", …) and a name of it.
using MjcfName = std::pair<std::string, std::string>;

/// The kind of what a section's elements are: "equality" for <equality><joint>, "" for bodies and
/// what is in them, where the element itself says it.
std::string named_kind(const Element& element, const std::string& section);

/// Calls visit(kind, name) for every name that an element and those in it refer to, without the
/// ground, assets and classes of defaults.
void each_reference(const Element& element,
                    const std::function<void(const std::string&, const std::string&)>& visit);

/// Names that an element and those in it give.
void collect_names(const Element& element, const std::string& section, std::set<MjcfName>& names);

/// Gives every name that `changed(kind, name)` holds for the prefix and the suffix, where it is
/// given and where it is referred to. Kinds include "class".
void rename(Element& element, const std::string& section, const std::string& prefix,
            const std::string& suffix,
            const std::function<bool(const std::string&, const std::string&)>& changed);

}  // namespace momenta::reading
