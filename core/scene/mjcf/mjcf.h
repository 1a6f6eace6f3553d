#pragma once
// MJCF, as far as it speaks of bodies, joints, inertias, springs and equality constraints. What is
// read, what is left out and what is refused: docs/reference/formats.md.

#include <momenta/core/scene/scene.h>
#include <momenta/core/scene/xml/xml_node.h>

#include <string>

namespace momenta::reading {

/// The scene of a <mujoco>, which begins at the <key> of that name or number; empty: as it is
/// drawn.
/// @throws SceneError
Scene read_mjcf(const Element& mujoco, const std::string& file, const std::string& key);

}  // namespace momenta::reading
