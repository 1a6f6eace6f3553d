// [[body]], [[marker]], and [[visual]]: solids that are drawn.

#include <momenta/core/format/toml/scene_keys.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/scene/shapes.h>
#include <momenta/core/text/quoting.h>

namespace momenta::reading {
namespace {

constexpr Quantity extent{"m", Bound::positive};

/// shape = { kind = .., .. }
void declare_shape(Keys& t, Shape& shape) {
  if (!t.writes()) shape.kind = shape_kinds.at(read_kind(t.in(), shape_kinds));
  const bool rod = shape.kind == "rod", cylinder = shape.kind == "cylinder";
  t.word("kind", shape.kind);
  if (shape.kind == "box") t.value("size", shape.size, extent);
  if (rod || cylinder) t.value("length", shape.size[0], extent);
  if (cylinder) t.value("radius", shape.size[1], extent);
  if (shape.kind == "sphere") t.value("radius", shape.size[0], extent);
  if (rod || cylinder) t.direction("axis", shape.axis, Eigen::Vector3d::UnitX());
}

/// inertia = [xx, yy, zz, xy, xz, yz] | [xx, yy, zz] | Izz of a planar body
Eigen::Matrix3d read_inertia(const Fields& table) {
  constexpr Quantity moment{"kg m²"};
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  if (const Value* value = table.find("inertia"); value->type != Value::Type::array) {
    if (!is_number(*value) && value->type != Value::Type::text)
      table.fail_key("inertia",
                     "is " + std::string(described(value->type)) +
                         ", expected xx, yy, zz, xy, xz, yz in an array, or one number [kg m²]");
    const double izz = table.number("inertia", {"kg m²", Bound::not_negative});
    inertia.diagonal() << izz / 2, izz / 2, izz;
    return inertia;
  }
  const std::vector<double> m = table.numbers("inertia", moment);
  if (m.size() != 3 && m.size() != 6)
    table.fail_key(
        "inertia",
        "has " + std::to_string(m.size()) +
            " entries, expected 6 (xx, yy, zz, xy, xz, yz), 3 (xx, yy, zz) or one number [kg m²]");
  inertia.diagonal() << m[0], m[1], m[2];
  if (m.size() == 6) {
    inertia(0, 1) = inertia(1, 0) = m[3];
    inertia(0, 2) = inertia(2, 0) = m[4];
    inertia(1, 2) = inertia(2, 1) = m[5];
  }
  return inertia;
}

}  // namespace

void declare(Keys& t, BodySpec& body) {
  const auto shape = [&] {
    if (t.writes() && body.shape.kind.empty()) return;
    t.table("shape", [&](Keys& s) { declare_shape(s, body.shape); });
  };
  t.value("name", body.name);
  t.value("mass", body.mass, {"kg", Bound::not_negative});

  // explicit values take precedence over the shape, which is read first; where a body with a shape
  // is written, they are written out: nothing is computed anew
  if (t.reads()) {
    shape();
    if (body.mass > 0 && !t.in().has("shape") && !t.in().has("inertia"))
      t.in().fail_at(
          t.in().at(),
          "a mass with neither shape nor inertia, expected one of them (a point mass is shape = { "
          "kind = \"point\" })");
  }
  const bool shaped = !body.shape.kind.empty();
  if (t.reads()) body.com = centre_of(body.shape);
  if (t.has("com", shaped || !toml_text::same(body.com, Eigen::Vector3d::Zero())))
    t.value("com", body.com, {"m"});
  t.key(
      "inertia",
      [&](const Fields& in) {
        body.inertia = in.has("inertia") ? read_inertia(in) : inertia_of(body.shape, body.mass);
      },
      [&] {
        const Eigen::Matrix3d& m = body.inertia;
        return shaped || body.mass > 0 || !m.isZero(0)
                   ? toml_text::of(
                         std::vector{m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)})
                   : "";
      });
  t.value_or("any_inertia", body.any_inertia, false);
  if (!t.reads()) return shape();
  if (const std::string fault = inertia_fault(body.inertia); !fault.empty() && !body.any_inertia)
    t.in().fail_key(t.in().has("inertia") ? "inertia" : "shape", fault);
}

void declare(Keys& t, MarkerSpec& marker) {
  t.value("name", marker.name);
  t.value("body", marker.body);
  t.vector("point", marker.point, {"m"});
}

void read_kind_of(const Fields& table, VisualSpec& visual) {
  visual.kind = visual_kinds.at(read_kind(table, visual_kinds));
}

void declare(Keys& t, VisualSpec& visual) {
  const bool sphere = visual.kind == "sphere";
  if (visual.kind == "box" || visual.kind == "ellipsoid") {
    t.value("size", visual.size, extent);
  } else if (visual.kind == "mesh") {
    t.value("file", visual.file);
    if (t.reads() && visual.file.empty())
      t.in().fail_key("file", "is empty, expected the path of a mesh");
    t.vector("scale", visual.size, {}, Eigen::Vector3d::Ones());
  } else {
    if (!sphere) t.value("length", visual.size[0], extent);
    t.value("radius", visual.size[sphere ? 0 : 1], extent);
  }
  t.place(-1);
  t.value("body", visual.body);
  t.word("kind", visual.kind);
  t.place(0);
  t.vector("position", visual.position, {"m"});
  t.rotation(visual.rotation);
  t.optional("colour", visual.colour);
  if (t.reads() && visual.colour)
    for (const double part : *visual.colour)
      if (!(part >= 0 && part <= 1))
        t.in().fail_key("colour",
                        "has " + digits(part) + ", expected red, green, blue from 0 to 1");
}

}  // namespace momenta::reading
