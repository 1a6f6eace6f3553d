// <transmission>: the inertia of a motor's rotor, seen through its gear,
//
//   I = n² I_rotor,  ½ I q̇² of kinetic energy,  n the rotor's angle over the joint's
//
// on the rate of the joint it drives. I_rotor is in an <actuator> as <motorInertia> or
// <rotorInertia>, n beside it or in the <transmission> as <mechanicalReduction>; or both as
// <drake:rotor_inertia> and <drake:gear_ratio>. Default: n = 1.

#include <momenta/core/format/urdf/urdf.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <array>

namespace momenta::reading {
namespace {

/// A number in the text of the element, or in its attribute `value`.
double value_of(const Node& node) {
  return node.has("value") ? node.number("value") : node.content_number();
}

struct Names {
  std::string_view inertia, ratio;
};
constexpr std::array<Names, 3> conventions{{{"motorInertia", "mechanicalReduction"},
                                            {"rotorInertia", "mechanicalReduction"},
                                            {"drake:rotor_inertia", "drake:gear_ratio"}}};

/// n² I_rotor of one actuator [kg m² or kg]; nothing without an inertia.
std::optional<double> seen_inertia(const Node& actuator, const Node& transmission) {
  for (const Names& name : conventions) {
    const auto inertia = actuator.child(name.inertia);
    if (!inertia) continue;
    const double own = value_of(*inertia);
    if (own < 0) inertia->fail("is " + digits(own) + ", expected a number >= 0 [kg m² or kg]");
    auto ratio = actuator.child(name.ratio);
    if (!ratio) ratio = transmission.child(name.ratio);
    const double n = ratio ? value_of(*ratio) : 1;
    if (n == 0) ratio->fail("is 0, expected another number");
    return n * n * own;
  }
  return std::nullopt;
}

}  // namespace

void read_transmission(const Node& node, Scene& scene, Remarks& remarks) {
  double inertia = 0;
  bool given = false;
  for (const Node& actuator : node.children("actuator"))
    if (const auto seen = seen_inertia(actuator, node)) {
      given = true;
      inertia += *seen;
    }
  if (!given) return remarks.left_out("transmissions, which give no inertia of a rotor");
  const std::vector<Node> joints = node.children("joint");
  if (joints.size() != 1)
    node.fail("has an inertia of a rotor and " + std::to_string(joints.size()) +
              " joints, expected one joint");
  const std::string name = joints.front().text("name");
  std::vector<std::string_view> known;
  for (const JointSpec& joint : scene.joints) known.push_back(joint.name);
  const auto at = std::find(known.begin(), known.end(), name);
  if (at == known.end())
    joints.front().fail("name", "is " + in_quotes(name) + ", expected the name of a joint" +
                                    did_you_mean(name, known));
  JointSpec& joint = scene.joints[static_cast<std::size_t>(at - known.begin())];
  if (!has_one_coordinate(joint.kind))
    joints.front().fail("name", "is " + in_quotes(name) +
                                    ", which has no rate of its own for a rotor, expected a "
                                    "revolute or prismatic joint");
  if (joint.rotor_inertia.empty()) joint.rotor_inertia = {0};
  joint.rotor_inertia[0] += inertia;
}

}  // namespace momenta::reading
