// Checks of drives: coordinates of joints; coordinates of loops and components of their origin.

#include <momenta/core/scene/drive.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/scene/validate_parts.h>
#include <momenta/core/text/quoting.h>

#include <set>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>

namespace momenta::reading {
namespace {

/// Driven coordinates and components of origins, each with its joint or loop.
using Driven = std::set<std::pair<std::string, std::string>>;
std::string coordinate_in_words(int coordinate) {
  return "coordinate " + std::to_string(coordinate);
}

/// Spherical and free joints, and spherical loops, are driven in all coordinates or in none.
template <class Edge, class Kind>
void check_full_drive(const Edge& joint, Kind spherical, const Driven& driven, const Subject& who) {
  bool slides = false;
  if constexpr (std::is_same_v<Kind, JointKind>) slides = joint.kind == JointKind::free;
  if (joint.kind != spherical && !slides) return;
  constexpr bool of_loop = std::is_same_v<Kind, LoopKind>;
  const std::span<const std::string_view> all(pose_coordinates);
  const auto names = slides ? all : all.subspan(3);
  std::string missing;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (!driven.contains({joint.name, coordinate_in_words(static_cast<int>(i))}))
      missing +=
          (missing.empty() ? "" : ", ") + std::to_string(i) + " (" + std::string(names[i]) + ")";
  if (!missing.empty())
    who.fail("coordinate " + missing + " has no drive, expected drives of all " +
             std::to_string(names.size()) + " coordinates of a " +
             std::string(name_of(joint.kind)) + (of_loop ? " loop (" : " joint (") + listed(names) +
             ") or of none");
}

Subject subject_of(const Scene& scene, const DriveSpec& drive) {
  return {scene, drive.at,
          drive.loop.empty() ? "drive of joint " + in_quotes(drive.joint)
                             : "drive of loop " + in_quotes(drive.loop)};
}

/// Checks the coordinate or component that a drive of a loop prescribes.
void check_loop_drive(const Scene& scene, const Census& census, const DriveSpec& drive) {
  const Subject who = subject_of(scene, drive);
  who.require(drive.joint.empty(), "a joint is given beside the loop, expected one of them");
  const LoopSpec& loop = census.require_loop(drive.loop, who);
  const std::string kind(name_of(loop.kind));
  if (!drive.origin.empty()) {
    who.require(drive.origin == "x" || drive.origin == "y" || drive.origin == "z",
                "origin must be x, y or z");
    who.require(!has_equation(loop),
                "origin has no meaning for an equation, expected a formula with t in it");
    who.require(
        loop.kind != LoopKind::rolling,
        "origin of a rolling loop cannot be driven, expected a driven joint of the body that "
        "has the plane");
    who.require(
        loop.kind != LoopKind::coupler,
        "origin has no meaning for a coupler, expected none: a drive prescribes its offset");
    return;
  }
  const int count = has_curves(loop) ? 0 : driven_coordinates_of(loop.kind);
  if (has_equation(loop))
    who.fail("an equation has no coordinate to drive, expected a formula with t in it");
  if (loop.kind == LoopKind::rolling)
    who.fail("a rolling loop has no coordinate to drive, expected a driven joint");
  if (count == 0)
    who.fail("a " + kind +
             " loop has no coordinate to drive, expected origin = \"x\", \"y\" or \"z\"" +
             (loop.kind == LoopKind::point ? " or a spherical loop" : ""));
  if (drive.coordinate < 0 || drive.coordinate >= count)
    who.fail("coordinate is " + std::to_string(drive.coordinate) + ", expected " +
             (count == 1 ? std::string("0") : "0 to " + std::to_string(count - 1)) + " for a " +
             kind + " loop");
}

/// Checks that a driven length starts positive. @pre the law is without fault
void check_driven_length(const Scene& scene, const Census& census, const DriveSpec& drive) {
  const Subject who = subject_of(scene, drive);
  const LoopSpec& loop = census.require_loop(drive.loop, who);
  if (loop.kind != LoopKind::distance || !drive.origin.empty()) return;
  double length, rate, second;
  MotionLaw(drive).evaluate(0.0, length, rate, second);
  if (!(length > 0)) who.fail("the length at t = 0 is " + digits(length) + " m, expected > 0");
}

}  // namespace

const DriveSpec* drive_of(const Scene& scene, std::string DriveSpec::*owner,
                          const std::string& name, int coordinate) {
  for (const DriveSpec& drive : scene.drives)
    if (drive.*owner == name && drive.coordinate == coordinate && drive.origin.empty())
      return &drive;
  return nullptr;
}

void check_drives(const Scene& scene, const Census& census) {
  Driven driven;
  for (const DriveSpec& drive : scene.drives) {
    const Subject who = subject_of(scene, drive);
    if (!drive.loop.empty()) {
      check_loop_drive(scene, census, drive);
      const std::string what =
          drive.origin.empty() ? coordinate_in_words(drive.coordinate) : "origin " + drive.origin;
      who.require(driven.emplace(drive.loop, what).second,
                  (what + " has a drive already, expected one"));
      const std::string fault = law_fault(drive);
      who.require(fault.empty(), fault);
      check_driven_length(scene, census, drive);
      continue;
    }
    const JointSpec& joint = census.require_joint(drive.joint, who);
    const int count = rates_of(joint.kind);
    who.require(joint.kind != JointKind::user,
                ("joint " + in_quotes(joint.name) + " is user, expected what moves it in its law"));
    if (count == 0)
      who.fail("joint " + in_quotes(joint.name) + " is " + std::string(name_of(joint.kind)) +
               ", expected a joint that moves");
    if (drive.coordinate < 0 || drive.coordinate >= count)
      who.fail("coordinate is " + std::to_string(drive.coordinate) + ", expected " +
               (count == 1 ? std::string("0") : "0 to " + std::to_string(count - 1)) + " for a " +
               std::string(name_of(joint.kind)) + " joint");
    if (!driven.emplace(drive.joint, coordinate_in_words(drive.coordinate)).second)
      who.fail((count == 1 ? std::string("the joint") : coordinate_in_words(drive.coordinate)) +
               " has a drive already, expected one");
    const std::string fault = law_fault(drive);
    who.require(fault.empty(), fault);
  }
  for (const DriveSpec& drive : scene.drives) {
    const Subject who = subject_of(scene, drive);
    if (drive.loop.empty())
      check_full_drive(census.require_joint(drive.joint, who), JointKind::spherical, driven, who);
    else if (drive.origin.empty())
      check_full_drive(census.require_loop(drive.loop, who), LoopKind::spherical, driven, who);
  }
}

}  // namespace momenta::reading
