#pragma once
// What a format has, element by element, and what its reader does with it; so that nothing of a
// file is dropped without a remark. What the readers themselves take, refuse or tell stands under
// `taken`; what has no effect on motion is silent; what has one and is left out is told here.

#include <momenta/core/scene/xml/remarks.h>
#include <momenta/core/scene/xml/xml_node.h>

#include <span>
#include <string>
#include <string_view>

namespace momenta::reading {

/// An element by its name, or as "around/name" where the same name means another thing there. Its
/// attributes and the elements in it by name, parted by blanks; an element that no list has is
/// left out and told, an attribute that no list has is told as not known.
struct KnownElement {
  std::string_view name;
  std::string_view taken, silent, told;
};

/// Refuses an element that is misspelt: one that its surroundings do not have, and which is near to
/// one that they have. Not in what is drawn or touched alone. Before a model is read: what a reader
/// says of the rest would mislead. @throws SceneError
void refuse_misspelt(const Node& root, std::span<const KnownElement> known);

/// Tells what `root` and all in it have that `known` does not list as taken or silent. Elements
/// without a row of their own are not looked into; attributes of a name space are silent, values of
/// 0, false, none, auto and disable are too, and so is what a reader itself put in, by names with a
/// blank. O(size of the elements · log of the table)
void tell_unread(const Node& root, std::span<const KnownElement> known, Remarks& remarks);

/// The tables of the formats.
std::span<const KnownElement> mjcf_elements();
std::span<const KnownElement> mjcf_actuator_elements();  ///< under --control
std::span<const KnownElement> urdf_elements();
std::span<const KnownElement> sdf_elements();

}  // namespace momenta::reading
