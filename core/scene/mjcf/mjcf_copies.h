#pragma once
// <replicate> and <attach>, by copies of elements with names of their own.
//
// <replicate count sep> holds afterwards one <replica> for each copy, with what stood in it; names
// in the i-th end in sep and i, in as many digits as count has. Elements of <tendon>, <equality>,
// <contact> and <actuator> that refer to such names are copied along. Where the copies stand is
// read with the bodies: the i-th is turned by i `euler` and lies `offset`, in the axes of the one
// before, from that one.
//
// <attach model prefix (body | frame)> holds afterwards that body or frame of the model, or all of
// its world, with the prefix before every name; so do tendons, equalities and actuators that refer
// to nothing else, and the assets. What <compiler> and <default> of the model say holds in it: they
// follow in an element `attached_model` of the root.

#include <momenta/core/scene/mjcf/mjcf_files.h>
#include <momenta/core/scene/xml/remarks.h>

namespace momenta::reading {

/// No element of a file has such a name. Attributes: `model`, as the <attach> says it with
/// prefixes, and `prefix` of its classes.
inline constexpr const char* attached_model = "attached model";
/// On an <asset> and a <key> that came with an attached model: that `model`.
inline constexpr const char* of_model = "of model";

/// The model with its parts included, attached and replicated. @throws SceneError
Element assembled(const Element& model, const std::string& file, MjcfFiles& files,
                  Remarks& remarks);

/// Copies for each <replicate> below the root.
void replicate_all(Element& root, const std::string& file, MjcfFiles& files);

}  // namespace momenta::reading
