#pragma once
// <replicate> and <attach>: copies of elements with names of their own.
//
// <replicate count sep> then holds one <replica> for each copy of its content; names in the i-th
// end in sep and i, in as many digits as count has. Elements of <tendon>, <equality>, <contact> and
// <actuator> that refer to them are copied along. Places are read with the bodies: the i-th is
// turned by i `euler` and lies `offset` from the one before, in its axes.
//
// <attach model prefix (body | frame)> then holds that body or frame of the model, or all of its
// world, with the prefix before every name; tendons, equalities and actuators that refer to nothing
// else come along, and the assets. <compiler> and <default> of the model hold in it: they follow in
// an element `attached_model` of the root.

#include <momenta/core/format/mjcf/mjcf_files.h>
#include <momenta/core/format/xml/made_scene.h>

namespace momenta::reading {

/// Name of that element, which no element of a file has. Attributes: `model`, as the <attach> names
/// it with prefixes, and `prefix` of its classes.
inline constexpr const char* attached_model = "attached model";
/// Attribute of an <asset> or <key> of an attached model: its `model`.
inline constexpr const char* of_model = "of model";

/// The model with its includes, attachments and replicas. @throws SceneError
Element assembled(const Element& model, const std::string& file, MjcfFiles& files,
                  Remarks& remarks);

/// Makes the copies of each <replicate> below the root.
void replicate_all(Element& root, const std::string& file, MjcfFiles& files);

}  // namespace momenta::reading
