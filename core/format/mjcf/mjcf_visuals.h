#pragma once
// Geoms as drawn solids. MuJoCo draws the groups 0 to 2 by default; the others are contact shapes,
// which draw only bodies without any other drawn geom: one seen by meshes alone.

#include <momenta/core/format/mjcf/mjcf_model.h>
#include <momenta/core/format/mjcf/mjcf_parts.h>

#include <string>

namespace momenta::reading {

/// Reads the colours of the <material>s of an <asset>.
void read_materials(const Node& asset, MjcfModel& model);

/// Takes a <geom> of `body`, a name of the scene. Planes and height fields are not drawn.
void draw_geom(const MjcfPart& part, const std::string& body, MjcfModel& model);

/// Sets the visuals of the scene: of each body the geoms that MuJoCo draws, if any, else all.
void take_drawn(MjcfModel& model);

}  // namespace momenta::reading
