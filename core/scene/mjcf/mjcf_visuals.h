#pragma once
// Geoms as solids to be drawn. MuJoCo draws the groups 0 to 2 by default; the others are shapes to
// touch, which stand for a body that has nothing else to be drawn: one seen by meshes alone.

#include <momenta/core/scene/mjcf/mjcf_model.h>
#include <momenta/core/scene/mjcf/mjcf_parts.h>

#include <string>

namespace momenta::reading {

/// The colours of the <material>s of an <asset>.
void read_materials(const Node& asset, MjcfModel& model);

/// A <geom> of `body`, a name of the scene. Planes and height fields are not drawn.
void draw_geom(const MjcfPart& part, const std::string& body, MjcfModel& model);

/// The visuals of the scene: of each body the geoms that MuJoCo draws, if there are any, else all.
void take_drawn(MjcfModel& model);

}  // namespace momenta::reading
