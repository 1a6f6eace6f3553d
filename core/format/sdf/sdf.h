#pragma once
// SDF 1.x: one <model>, or a <world> of models. What is read, left out and refused:
// docs/reference/formats.md.

#include <momenta/core/format/xml/xml_node.h>
#include <momenta/core/scene/scene.h>

#include <string>

namespace momenta::reading {

/// The scene of an <sdf>. `sdf` and `file` need only outlive the call. @throws SceneError
Scene read_sdf(const Element& sdf, const std::string& file);

}  // namespace momenta::reading
