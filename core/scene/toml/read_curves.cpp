// Loops with curves: slots, cams, racks; and wheels.

#include <momenta/core/scene/kinds.h>
#include <momenta/core/scene/plane_curve.h>
#include <momenta/core/scene/toml/read_tables.h>
#include <momenta/core/text/near_name.h>

#include <algorithm>

namespace momenta::reading {
namespace {

CurveSpec read_curve(const Fields& table, const std::string& kind) {
  CurveSpec curve;
  curve.kind = kind;
  if (kind == "circle") curve.radius = table.number("radius", {"m", Bound::positive});
  if (kind == "ellipse") {
    const std::vector<double> axes = table.numbers("semi_axes", {"m", Bound::positive});
    if (axes.size() != 2)
      table.fail_key("semi_axes", "has " + std::to_string(axes.size()) +
                                      " entries, expected two: along direction and across it");
    curve.semi_axes = {axes[0], axes[1]};
    curve.direction = table.direction("direction", curve.direction);
  }
  if (kind == "flat") {
    if (!table.has("normal"))
      table.fail_at(table.at(), "normal is missing, expected the outward direction of the face");
    curve.direction = table.direction("normal", curve.direction);
  }
  if (kind == "spline") {
    curve.points = table.vectors("points", {"m"});
    curve.closed = table.flag("closed", false);
  }
  return curve;
}

/// The outline of one body of a cam: { kind = "circle", radius = .. } and so on.
CurveSpec read_outline(const Fields& table) {
  const std::string kind(cam_curves[read_kind(table, cam_curves)]);
  if (kind == "circle") table.allow({"kind", "radius"});
  if (kind == "ellipse") table.allow({"kind", "semi_axes", "direction"});
  if (kind == "flat") table.allow({"kind", "normal"});
  if (kind == "spline") table.allow({"kind", "points"});
  CurveSpec curve = read_curve(table, kind);
  curve.closed = kind == "spline";
  return curve;
}

void refuse_fault(const Fields& table, const CurveSpec& curve, const Eigen::Vector3d& axis,
                  const std::string& what) {
  if (const std::string fault = curve_fault(curve, axis); !fault.empty())
    table.fail_at(table.at(), what + fault);
}

void read_frame(const Fields& table, LoopSpec& loop) {
  loop.name = table.text("name");
  read_ends(table, loop);
  loop.rotation = read_rotation(table);
  loop.axis = table.direction("axis", loop.axis);
}

}  // namespace

void read_slot(const Fields& table, LoopSpec& loop) {
  const std::string kind = table.has("curve")
                               ? std::string(slot_curves[read_kind(table, slot_curves, "curve")])
                               : "line";
  for (const std::string_view key : {"points", "closed"})
    if (kind != "spline")
      table.refuse(key, "has no meaning for a slot on a " + kind + ", expected on a spline only");
  if (kind != "circle")
    table.refuse("radius",
                 "has no meaning for a slot on a " + kind + ", expected on a circle only");
  table.allow({"name", "kind", "parent", "child", "origin", "rotation", "axis", "curve", "radius",
               "points", "closed"});
  read_frame(table, loop);
  if (kind == "line") return;
  loop.curve = read_curve(table, kind);
  refuse_fault(table, loop.curve, loop.axis, "");
}

void read_cam(const Fields& table, LoopSpec& loop) {
  table.allow({"name", "kind", "parent", "child", "origin", "rotation", "axis", "profile"});
  read_frame(table, loop);
  const auto profile = table.table("profile");
  if (!profile)
    table.fail_at(table.at(),
                  "profile is missing, expected { parent = { kind = .. }, child = { "
                  "kind = .. } }, the outlines that touch");
  profile->allow({"parent", "child"});
  const auto outline = [&](std::string_view side) {
    const auto found = profile->table(side);
    if (!found)
      table.fail_key("profile", "has no " + std::string(side) + ", expected both outlines");
    const CurveSpec curve = read_outline(*found);
    refuse_fault(*found, curve, loop.axis, "profile." + std::string(side) + ": ");
    return curve;
  };
  loop.curve = outline("parent");
  loop.child_curve = outline("child");
  if (loop.curve.kind == "flat" && loop.child_curve.kind == "flat")
    table.fail_key("profile", "has two flat faces, expected one that is curved");
}

void read_rack(const Fields& table, LoopSpec& loop) {
  table.allow({"name", "kind", "parent", "child", "origin", "rotation", "axis", "direction",
               "radius", "offset"});
  read_frame(table, loop);
  loop.direction = table.direction("direction", loop.direction);
  if (table.has("direction") && loop.axis.cross(loop.direction).norm() < parallel_slack)
    table.fail_key("direction", "is parallel to axis, expected another direction");
  loop.radius = table.number("radius", {"m", Bound::positive});
  loop.offset = table.number("offset", {"rad"}, 0);
}

void read_rolling(const Fields& table, LoopSpec& loop) {
  table.allow({"name", "kind", "parent", "child", "origin", "rotation", "axis", "normal", "radius",
               "crown_radius"});
  read_frame(table, loop);
  loop.normal = table.direction("normal", loop.normal);
  loop.radius = table.number("radius", {"m", Bound::positive});
  loop.crown_radius = table.number("crown_radius", {"m", Bound::not_negative}, 0);
  if (loop.crown_radius > loop.radius)
    table.fail_key("crown_radius", "is " + digits(loop.crown_radius) + " m, expected at most the " +
                                       "radius, " + digits(loop.radius) + " m, of a sphere");
}

}  // namespace momenta::reading
