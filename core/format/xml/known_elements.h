#pragma once
// The elements of a format, and what its reader does with them, so that nothing of a file is
// dropped without a remark. `taken`: read, refused or reported by the readers; `silent`: without
// effect on motion; `told`: left out, with a remark.

#include <momenta/core/format/xml/made_scene.h>
#include <momenta/core/format/xml/xml_node.h>

#include <span>
#include <string>
#include <string_view>

namespace momenta::reading {

/// An element by its name, or as "around/name" where the name means another thing there. Names of
/// its attributes and elements, separated by blanks; unlisted elements are left out with a remark,
/// unlisted attributes reported as not known.
struct KnownElement {
  std::string_view name;
  std::string_view taken, silent, told;
};

/// Refuses misspelt elements: unknown in their surroundings, but near to a known one. Not within
/// drawings and contacts. To call before a model is read: errors on the rest would mislead. @throws
/// SceneError
void refuse_misspelt(const Node& root, std::span<const KnownElement> known);

/// Reports what `root` and all in it have that `known` does not list as taken or silent. Elements
/// without a row are not entered. Silent too: attributes of a name space, values 0, false, none,
/// auto and disable, names with a blank, which readers put in. O(size of the elements · log of the
/// table)
void tell_unread(const Node& root, std::span<const KnownElement> known, Remarks& remarks);

/// The tables of the formats.
std::span<const KnownElement> mjcf_elements();
std::span<const KnownElement> mjcf_actuator_elements();  ///< under --control
std::span<const KnownElement> urdf_elements();
std::span<const KnownElement> sdf_elements();

}  // namespace momenta::reading
