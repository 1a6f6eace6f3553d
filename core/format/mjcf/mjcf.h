#pragma once
// MJCF: bodies, joints, inertias, springs, tendons, actuators and equality constraints. What is
// read, left out and refused: docs/reference/formats.md.

#include <momenta/core/format/xml/xml_node.h>
#include <momenta/core/scene/scene.h>

#include <string>
#include <vector>

namespace momenta::reading {

/// The scene of a <mujoco>, at the <key> of that name or number; empty: as drawn. `controls` as
/// ReadOptions::controls. @throws SceneError
Scene read_mjcf(const Element& mujoco, const std::string& file, const std::string& key = "",
                const std::vector<std::string>& controls = {});

}  // namespace momenta::reading
