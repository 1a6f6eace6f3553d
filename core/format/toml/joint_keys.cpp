// [[joint]].

#include <momenta/core/format/toml/scene_keys.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/text/quoting.h>

#include <cmath>
#include <initializer_list>

namespace momenta::reading {
namespace {

/// Refuses the keys that a joint of this kind cannot have.
void refuse_keys(Keys& t, JointKind kind) {
  const bool one = has_one_coordinate(kind), spherical = kind == JointKind::spherical;
  const bool revolute = kind == JointKind::revolute, prismatic = kind == JointKind::prismatic;
  struct Meaning {
    bool has;
    const char* kinds;
    std::initializer_list<std::string_view> keys;
  };
  for (const Meaning& m : {
           Meaning{has_axis(kind),
                   "revolute, prismatic, helical, cylindrical, universal and planar",
                   {"axis"}},
           {one,
            "revolute, prismatic and helical",
            {"stiffness", "rest", "damping", "friction", "friction_rate"}},
           {one || spherical,
            "revolute, prismatic, helical and spherical",
            {"limits", "stop_stiffness", "stop_damping", "stop_width"}},
           {one,
            spherical ? "revolute, prismatic and helical"
                      : "revolute, prismatic, helical and spherical",
            {"restitution"}},
           {revolute || prismatic, "revolute and prismatic", {"bearing"}},
           {kind == JointKind::helical, "helical", {"pitch"}},
           {kind == JointKind::universal, "universal", {"axis2"}},
           {kind == JointKind::planar, "planar", {"direction"}},
           {rotors_of(kind) != 0,
            "revolute, prismatic, helical, cylindrical, universal, planar and spherical joints",
            {"rotor_inertia"}},
       })
    for (const std::string_view key : m.keys)
      if (!m.has)
        t.refuse(key, "has no meaning for a " + std::string(name_of(kind)) +
                          " joint, expected on " + m.kinds + " only");
  t.refuse("length", "belongs to a [[loop]] of kind distance, expected none on a joint");
}

/// Numbers by coordinate: one number for one degree of freedom, else an array.
void declare_state(Keys& t, std::string_view key, std::vector<double>& state, std::size_t size,
                   JointKind kind, Quantity quantity) {
  t.key(
      key,
      [&](const Fields& in) {
        const Value* value = in.find(key);
        if (value == nullptr) return;
        if (size == 1 && value->type != Value::Type::array) {
          state = {in.number(key, quantity)};
          return;
        }
        state = in.numbers(key, size == 1 ? quantity : Quantity{});
        if (state.size() != size)
          in.fail_key(key, "has " + std::to_string(state.size()) + " entries, expected " +
                               std::to_string(size) + " for a " + std::string(name_of(kind)) +
                               " joint");
      },
      [&] { return state.empty() ? "" : toml_text::of(state); });
}

/// Normalises the quaternion, the last four numbers of a position, when nearly of unit length, so
/// that no solver meets a scaled one.
void normalise_quaternion(const Fields& table, std::vector<double>& position) {
  if (position.size() < 4) return;
  Eigen::Map<Eigen::Vector4d> quaternion(position.data() + position.size() - 4);
  const double norm = quaternion.norm();
  if (!(std::abs(norm - 1) <= norm_slack))
    table.fail_key("position",
                   "has a quaternion of norm " + digits(norm) + ", expected 1 within 1e-6");
  if (!is_unit(quaternion)) quaternion /= norm;
}

void declare_bearing(Keys& t, BearingSpec& bearing, bool turns) {
  if (!turns) t.refuse("radius", "has no meaning for a prismatic joint, expected on revolute only");
  if (t.reads()) bearing.static_friction = t.in().number("dynamic", {"", Bound::not_negative});
  if (t.has("static", true)) t.value("static", bearing.static_friction);
  t.value("dynamic", bearing.dynamic_friction, {"", Bound::not_negative});
  if (t.reads() && bearing.static_friction < bearing.dynamic_friction)
    t.in().fail_key(
        "static", "is " + digits(bearing.static_friction) +
                      ", below dynamic, expected a number >= " + digits(bearing.dynamic_friction));
  if (t.has("transition", true))
    t.value("transition", bearing.transition_velocity, {"m/s", Bound::positive});
  if (turns || t.names()) t.value("radius", bearing.radius, {"m", Bound::positive});
  t.number("length", bearing.length, {"m", Bound::positive});
}

/// Checks the rate after an impact at rigid stops over that before.
void check_restitution(const Fields& table, const JointSpec& joint) {
  if (!joint.limits)
    table.refuse("restitution", "is there without limits, expected limits to stop at");
  for (const char* key : {"stop_stiffness", "stop_damping", "stop_width"})
    table.refuse(key, "is given beside restitution, expected stops that give way or rigid ones");
  if (*joint.restitution > 1)
    table.fail_key("restitution",
                   "is above 1, expected the rate after an impact over that before, 0 to 1");
}

}  // namespace

void read_kind_of(const Fields& table, JointSpec& joint) {
  joint.kind =
      static_cast<JointKind>(read_kind(table, joint_kinds, "kind", loop_kinds, "[[loop]]"));
}

void declare(Keys& t, JointSpec& joint) {
  const JointKind kind = joint.kind;
  const bool turns = kind != JointKind::prismatic;
  const std::string unit = turns ? "rad" : "m", force = turns ? "N m" : "N";
  if (t.names()) refuse_keys(t, kind);
  t.value("name", joint.name);
  t.word("kind", name_of(kind));
  declare_ends(t, joint);
  t.rotation(joint.rotation);
  if (has_axis(kind) || !t.writes()) {
    t.direction("axis", joint.axis, Eigen::Vector3d::UnitZ());
    declare_second(t, "axis2", joint.axis2, joint);
    declare_second(t, "direction", joint.direction, joint);
  }
  if (kind == JointKind::helical || t.names()) t.value("pitch", joint.pitch, {"m/rad"});
  declare_state(t, "position", joint.position, static_cast<std::size_t>(coordinates_of(kind)), kind,
                {unit});
  declare_state(t, "velocity", joint.velocity, static_cast<std::size_t>(rates_of(kind)), kind,
                {turns ? "rad/s" : "m/s"});
  if (t.reads()) normalise_quaternion(t.in(), joint.position);

  const std::string spring = force + "/" + unit, damper = force + " s/" + unit;
  t.number("stiffness", joint.stiffness, {spring});
  t.number("rest", joint.rest, {unit});
  t.number("damping", joint.damping, {damper});
  t.number("friction", joint.friction, {force, Bound::not_negative});
  t.number("friction_rate", joint.friction_rate, {turns ? "rad/s" : "m/s", Bound::positive},
           JointSpec{}.friction_rate);
  t.place(1);
  declare_state(t, "rotor_inertia", joint.rotor_inertia, rotors_of(kind), kind,
                {turns ? "kg m²" : "kg", Bound::not_negative});
  declare_limits(t, unit, force, joint);
  t.optional("restitution", joint.restitution, {"", Bound::not_negative});
  if (t.reads() && joint.restitution) check_restitution(t.in(), joint);
  t.place(0);
  if (joint.bearing || !t.writes())
    t.table("bearing", [&](Keys& b) {
      if (!joint.bearing) joint.bearing.emplace();
      declare_bearing(b, *joint.bearing, turns);
    });
}

}  // namespace momenta::reading
