#include <momenta/core/scene/bearings_refused.h>
#include <momenta/core/scene/drive.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/gradient/differentiable.h>
#include <momenta/dae/gradient/form_tangents.h>
#include <momenta/dae/integrator/integrators.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>

namespace momenta {
namespace {

constexpr int most_unknowns =
    1000;  ///< nv + m: the matrix is dense at the start and with redundant rows

}  // namespace

void expect_differentiable(const RunSettings& s, const Mechanism& mechanism) {
  const std::vector<std::string>& forms = differentiable_forms();
  if (std::find(forms.begin(), forms.end(), s.form) == forms.end())
    throw std::invalid_argument("form '" + s.form +
                                "' has no gradient; expected one of: " + listed(forms));
  const std::vector<std::string> methods{"rk4", "dp5", "dop853", "vern9"};
  if (std::find(methods.begin(), methods.end(), s.integrator) == methods.end())
    throw std::invalid_argument("integrator '" + s.integrator +
                                "' has no gradient; expected one of: " + listed(methods));
  if (const int unknowns = mechanism.nv() + mechanism.m(); unknowns > most_unknowns)
    throw std::invalid_argument("the mechanism has " + std::to_string(unknowns) +
                                " rates and loop equations; expected at most " +
                                std::to_string(most_unknowns) + " for a gradient");
}

void expect_smooth_motion(const Scene& scene) {
  refuse_bearings(scene, "a gradient");
  for (const JointSpec& joint : scene.joints)
    if (joint.restitution)
      throw SceneError(scene.where(joint.at) + "joint " + reading::in_quotes(joint.name) +
                       " has rigid stops, and a run with impacts no gradient here; expected stops "
                       "that push back ('stop_stiffness'), or no 'restitution'");
}

namespace {

/// Word or function of a formula with corners or jumps; empty: none.
std::string_view corner_of(const Scene& scene, const std::string& law) {
  for (const std::string_view word : {"if(", "floor(", "sign(", "abs(", "min(", "max("})
    if (law.find(word) != std::string::npos) return word;
  for (const FunctionSpec& f : scene.functions)
    if (f.kind != "cubic" && law.find(f.name + "(") != std::string::npos) return f.name;
  return {};
}

}  // namespace

bool has_corners(const Scene& scene) {
  const auto with_one = [&](const std::string& law) { return !corner_of(scene, law).empty(); };
  return std::any_of(
             scene.joints.begin(), scene.joints.end(),
             [](const JointSpec& joint) { return has_stops(joint) || joint.friction != 0; }) ||
         std::any_of(
             scene.forces.begin(), scene.forces.end(),
             [&](const ForceSpec& force) {
               return has_stops(force) || force.dead_band != 0 || with_one(force.law) ||
                      std::any_of(force.force_law.begin(), force.force_law.end(), with_one) ||
                      std::any_of(force.torque_law.begin(), force.torque_law.end(), with_one);
             }) ||
         std::any_of(scene.drives.begin(), scene.drives.end(),
                     [](const DriveSpec& drive) {
                       return drive.kind == "step" || drive.kind == "table" ||
                              !law_corner(drive).empty();
                     }) ||
         (scene.lagrangian &&
          (with_one(scene.lagrangian->lagrangian.text) ||
           with_one(scene.lagrangian->kinetic.text) || with_one(scene.lagrangian->potential.text) ||
           std::any_of(
               scene.lagrangian->forces.begin(), scene.lagrangian->forces.end(),
               [&](const LagrangianSpec::Force& force) { return with_one(force.value.text); })));
}

std::vector<std::string> corners(const Scene& scene, const std::string& of_functional) {
  std::vector<std::string> remarks;
  const std::string ending =
      " has corners or jumps: the gradient is that of the pieces that the run was on, and what the "
      "time of a jump depends on is not in it";
  if (!of_functional.empty())
    remarks.push_back("'" + of_functional + "' in the functional" + ending);
  for (const DriveSpec& drive : scene.drives)
    if (const std::string corner = law_corner(drive); !corner.empty())
      remarks.push_back("the drive of " +
                        reading::in_quotes(drive.joint.empty() ? drive.loop : drive.joint) +
                        ", by '" + corner + "'," + ending);
  for (std::size_t i = 0; i < scene.events.size(); ++i)
    if (scene.events[i].stop)
      remarks.push_back("event " + reading::in_quotes(name_of(scene.events[i], i)) +
                        " would end a run: a gradient goes on to the end time");
  for (const ForceSpec& force : scene.forces) {
    std::vector<std::string> laws{force.law};
    laws.insert(laws.end(), force.force_law.begin(), force.force_law.end());
    laws.insert(laws.end(), force.torque_law.begin(), force.torque_law.end());
    for (const std::string& law : laws)
      if (!corner_of(scene, law).empty())
        remarks.push_back("a force by the formula " + reading::in_quotes(law) + ending);
  }
  if (scene.lagrangian)
    for (const LagrangianSpec::Force& force : scene.lagrangian->forces)
      if (!corner_of(scene, force.value.text).empty())
        remarks.push_back("a force by the formula " + reading::in_quotes(force.value.text) +
                          ending);
  return remarks;
}

std::string no_adjoint(const Mechanism& mechanism, bool along) {
  const std::string instead = "; expected the mode 'forward'";
  if (mechanism.nv() == 0)
    return "a mechanism of which nothing moves freely has no adjoint" + instead;
  if (mechanism.plan().quasi_velocities)
    return "spherical and free joints, whose rates are no derivatives of coordinates, have no "
           "adjoint" +
           instead;
  if (mechanism.has_nonholonomic())
    return "loops that roll or have an equation of velocities have no adjoint" + instead;
  if (along) return "an adjoint has no derivatives of the trajectory" + instead;
  return "";
}

}  // namespace momenta
