#include <momenta/core/format/toml/curve_keys.h>
#include <momenta/core/format/toml/scene_keys.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/scene/plane_curve.h>
#include <momenta/core/text/quoting.h>

namespace momenta::reading {
namespace {

/// Keys of a curve beside its kind.
void declare_curve(Keys& t, CurveSpec& curve) {
  if (curve.kind == "circle") t.value("radius", curve.radius, {"m", Bound::positive});
  if (curve.kind == "ellipse") {
    std::vector<double> axes(curve.semi_axes.begin(), curve.semi_axes.end());
    t.value("semi_axes", axes, {"m", Bound::positive});
    if (axes.size() != 2)
      t.in().fail_key("semi_axes", "has " + std::to_string(axes.size()) +
                                       " entries, expected two: along direction and across it");
    curve.semi_axes = {axes[0], axes[1]};
    t.direction("direction", curve.direction, Eigen::Vector3d::Zero());
  }
  if (curve.kind == "flat") {
    if (t.reads() && !t.in().has("normal"))
      t.in().fail_at(t.in().at(), "normal is missing, expected the outward direction of the face");
    t.direction("normal", curve.direction, Eigen::Vector3d::Zero());
  }
  if (curve.kind == "spline") t.value("points", curve.points, {"m"});
}

void refuse_fault(const Fields& table, const CurveSpec& curve, const Eigen::Vector3d& axis,
                  const std::string& what) {
  if (const std::string fault = curve_fault(curve, axis); !fault.empty())
    table.fail_at(table.at(), what + fault);
}

/// The outline of one body of a cam: { kind = "circle", radius = .. } and so on.
void declare_outline(Keys& t, CurveSpec& curve) {
  if (!t.writes()) {
    curve.kind = cam_curves[read_kind(t.in(), cam_curves)];
    curve.closed = curve.kind == "spline";
  }
  t.word("kind", curve.kind);
  declare_curve(t, curve);
}

void declare_axis(Keys& t, LoopSpec& loop) {
  t.direction("axis", loop.axis, Eigen::Vector3d::UnitZ());
}

}  // namespace

void read_kind_of_slot(const Fields& table, LoopSpec& loop) {
  const std::string kind = table.has("curve")
                               ? std::string(slot_curves[read_kind(table, slot_curves, "curve")])
                               : "line";
  for (const std::string_view key : {"points", "closed"})
    if (kind != "spline")
      table.refuse(key, "has no meaning for a slot on a " + kind + ", expected on a spline only");
  if (kind != "circle")
    table.refuse("radius",
                 "has no meaning for a slot on a " + kind + ", expected on a circle only");
  if (kind != "line") loop.curve.kind = kind;
}

void declare_slot(Keys& t, LoopSpec& loop) {
  CurveSpec& curve = loop.curve;
  const bool circle = curve.kind == "circle", spline = curve.kind == "spline";
  declare_axis(t, loop);
  if (t.names() || !curve.kind.empty()) t.word("curve", curve.kind);
  if (t.names() || circle) t.value("radius", curve.radius, {"m", Bound::positive});
  if (t.names() || spline) {
    t.value("points", curve.points, {"m"});
    t.value_or("closed", curve.closed, false);
  }
  if (t.reads() && !curve.kind.empty()) refuse_fault(t.in(), curve, loop.axis, "");
}

void declare_cam(Keys& t, LoopSpec& loop) {
  declare_axis(t, loop);
  if (t.reads() && !t.in().has("profile"))
    t.in().fail_at(t.in().at(),
                   "profile is missing, expected { parent = { kind = .. }, child = { "
                   "kind = .. } }, the outlines that touch");
  t.table("profile", [&](Keys& profile) {
    const auto outline = [&](const char* side, CurveSpec& curve) {
      if (profile.reads() && !profile.in().has(side))
        t.in().fail_key("profile", "has no " + std::string(side) + ", expected both outlines");
      profile.table(side, [&](Keys& keys) {
        declare_outline(keys, curve);
        if (keys.reads())
          refuse_fault(keys.in(), curve, loop.axis, "profile." + std::string(side) + ": ");
      });
    };
    outline("parent", loop.curve);
    outline("child", loop.child_curve);
  });
  if (t.reads() && loop.curve.kind == "flat" && loop.child_curve.kind == "flat")
    t.in().fail_key("profile", "has two flat faces, expected one that is curved");
}

void declare_rack(Keys& t, LoopSpec& loop) {
  declare_axis(t, loop);
  declare_second(t, "direction", loop.direction, loop);
  t.value("radius", loop.radius, {"m", Bound::positive});
  t.number("offset", loop.offset, {"rad"});
}

void declare_rolling(Keys& t, LoopSpec& loop) {
  declare_axis(t, loop);
  t.direction("normal", loop.normal, Eigen::Vector3d::UnitZ());
  t.value("radius", loop.radius, {"m", Bound::positive});
  t.number("crown_radius", loop.crown_radius, {"m", Bound::not_negative});
  if (t.reads() && loop.crown_radius > loop.radius)
    t.in().fail_key("crown_radius", "is " + digits(loop.crown_radius) +
                                        " m, expected at most the " + "radius, " +
                                        digits(loop.radius) + " m, of a sphere");
}

}  // namespace momenta::reading
