// [[body]].

#include <momenta/core/scene/kinds.h>
#include <momenta/core/scene/shapes.h>
#include <momenta/core/scene/toml/read_tables.h>
#include <momenta/core/text/near_name.h>

#include <algorithm>
#include <cmath>

namespace momenta::reading {
namespace {

Shape read_shape(const Fields& table) {
  Shape shape;
  shape.kind = shape_kinds.at(read_kind(table, shape_kinds));
  constexpr Quantity extent{"m", Bound::positive};
  if (shape.kind == "rod") {
    table.allow({"kind", "length", "axis"});
    shape.size.x() = table.number("length", extent);
  } else if (shape.kind == "box") {
    table.allow({"kind", "size"});
    shape.size = table.vector("size", extent);
  } else if (shape.kind == "cylinder") {
    table.allow({"kind", "length", "radius", "axis"});
    shape.size = {table.number("length", extent), table.number("radius", extent), 0};
  } else if (shape.kind == "sphere") {
    table.allow({"kind", "radius"});
    shape.size.x() = table.number("radius", extent);
  } else {
    table.allow({"kind"});
  }
  shape.axis = table.direction("axis", shape.axis);
  return shape;
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

BodySpec read_body(const Fields& table) {
  table.allow({"name", "mass", "com", "inertia", "any_inertia", "shape"});
  BodySpec body;
  body.at = table.at();
  body.name = table.text("name");
  body.mass = table.number("mass", {"kg", Bound::not_negative});

  if (const auto shape = table.table("shape")) {
    body.shape = read_shape(*shape);
  } else if (body.mass > 0 && !table.has("inertia")) {
    table.fail_at(
        table.at(),
        "a mass with neither shape nor inertia, expected one of them (a point mass is shape = { "
        "kind = \"point\" })");
  }

  // explicit values take precedence over the shape
  body.com = table.vector("com", {"m"}, centre_of(body.shape));
  body.inertia = table.has("inertia") ? read_inertia(table) : inertia_of(body.shape, body.mass);
  body.any_inertia = table.flag("any_inertia", false);
  if (const std::string fault = inertia_fault(body.inertia); !fault.empty() && !body.any_inertia)
    table.fail_key(table.has("inertia") ? "inertia" : "shape", fault);
  return body;
}

}  // namespace momenta::reading
