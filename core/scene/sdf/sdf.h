#pragma once
// SDF 1.x: one <model>, or a <world> of models. What is read, what is left out and what is refused:
// docs/reference/formats.md.

#include <momenta/core/scene/scene.h>
#include <momenta/core/scene/xml/xml_node.h>

#include <string>

namespace momenta::reading {

/// The scene of an <sdf>. `sdf` and `file` outlive the call only. @throws SceneError
Scene read_sdf(const Element& sdf, const std::string& file);

}  // namespace momenta::reading
