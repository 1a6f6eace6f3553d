// Checks of drives: coordinates of joints; coordinates of loops and components of their origin.

#include <momenta/core/scene/drive.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/scene/validate_parts.h>
#include <momenta/core/text/near_name.h>

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
void check_full_drive(const Scene& scene, const Edge& joint, Kind spherical, const DriveSpec& drive,
                      const Driven& driven, const std::string& who) {
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
    throw SceneError(scene.where(drive.at) + who + ": coordinate " + missing +
                     " has no drive, expected drives of all " + std::to_string(names.size()) +
                     " coordinates of a " + std::string(name_of(joint.kind)) +
                     (of_loop ? " loop (" : " joint (") + listed(names) + ") or of none");
}

std::string owner_of(const DriveSpec& drive) {
  return drive.loop.empty() ? "drive of joint " + in_quotes(drive.joint)
                            : "drive of loop " + in_quotes(drive.loop);
}

/// Checks the coordinate or component that a drive of a loop prescribes.
void check_loop_drive(const Scene& scene, const Census& census, const DriveSpec& drive) {
  const std::string who = owner_of(drive);
  require(drive.joint.empty(), scene, drive.at, who,
          "a joint is given beside the loop, expected one of them");
  const LoopSpec& loop = census.require_loop(drive.loop, drive.at, who);
  const std::string kind(name_of(loop.kind));
  if (!drive.origin.empty()) {
    require(drive.origin == "x" || drive.origin == "y" || drive.origin == "z", scene, drive.at, who,
            "origin must be x, y or z");
    require(!has_equation(loop), scene, drive.at, who,
            "origin has no meaning for an equation, expected a formula with t in it");
    require(loop.kind != LoopKind::rolling, scene, drive.at, who,
            "origin of a rolling loop cannot be driven, expected a driven joint of the body that "
            "has the plane");
    require(loop.kind != LoopKind::coupler, scene, drive.at, who,
            "origin has no meaning for a coupler, expected none: a drive prescribes its offset");
    return;
  }
  const int count = has_curves(loop) ? 0 : driven_coordinates_of(loop.kind);
  if (has_equation(loop))
    throw SceneError(scene.where(drive.at) + who +
                     ": an equation has no coordinate to drive, expected a formula with t in it");
  if (loop.kind == LoopKind::rolling)
    throw SceneError(scene.where(drive.at) + who +
                     ": a rolling loop has no coordinate to drive, expected a driven joint");
  if (count == 0)
    throw SceneError(scene.where(drive.at) + who + ": a " + kind +
                     " loop has no coordinate to drive, expected origin = \"x\", \"y\" or \"z\"" +
                     (loop.kind == LoopKind::point ? " or a spherical loop" : ""));
  if (drive.coordinate < 0 || drive.coordinate >= count)
    throw SceneError(scene.where(drive.at) + who + ": coordinate is " +
                     std::to_string(drive.coordinate) + ", expected " +
                     (count == 1 ? std::string("0") : "0 to " + std::to_string(count - 1)) +
                     " for a " + kind + " loop");
}

/// Checks that a driven length starts positive. @pre the law is without fault
void check_driven_length(const Scene& scene, const Census& census, const DriveSpec& drive) {
  const LoopSpec& loop = census.require_loop(drive.loop, drive.at, owner_of(drive));
  if (loop.kind != LoopKind::distance || !drive.origin.empty()) return;
  double length, rate, second;
  MotionLaw(drive).evaluate(0.0, length, rate, second);
  if (!(length > 0))
    throw SceneError(scene.where(drive.at) + owner_of(drive) + ": the length at t = 0 is " +
                     digits(length) + " m, expected > 0");
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
    const std::string who = owner_of(drive);
    if (!drive.loop.empty()) {
      check_loop_drive(scene, census, drive);
      const std::string what =
          drive.origin.empty() ? coordinate_in_words(drive.coordinate) : "origin " + drive.origin;
      require(driven.emplace(drive.loop, what).second, scene, drive.at, who,
              (what + " has a drive already, expected one").c_str());
      const std::string fault = law_fault(drive);
      require(fault.empty(), scene, drive.at, who, fault.c_str());
      check_driven_length(scene, census, drive);
      continue;
    }
    const JointSpec& joint = census.require_joint(drive.joint, drive.at, who);
    const int count = rates_of(joint.kind);
    require(
        joint.kind != JointKind::user, scene, drive.at, who,
        ("joint " + in_quotes(joint.name) + " is user, expected what moves it in its law").c_str());
    if (count == 0)
      throw SceneError(scene.where(drive.at) + who + ": joint " + in_quotes(joint.name) + " is " +
                       std::string(name_of(joint.kind)) + ", expected a joint that moves");
    if (drive.coordinate < 0 || drive.coordinate >= count)
      throw SceneError(scene.where(drive.at) + who + ": coordinate is " +
                       std::to_string(drive.coordinate) + ", expected " +
                       (count == 1 ? std::string("0") : "0 to " + std::to_string(count - 1)) +
                       " for a " + std::string(name_of(joint.kind)) + " joint");
    if (!driven.emplace(drive.joint, coordinate_in_words(drive.coordinate)).second)
      throw SceneError(
          scene.where(drive.at) + who + ": " +
          (count == 1 ? std::string("the joint") : coordinate_in_words(drive.coordinate)) +
          " has a drive already, expected one");
    const std::string fault = law_fault(drive);
    require(fault.empty(), scene, drive.at, who, fault.c_str());
  }
  for (const DriveSpec& drive : scene.drives) {
    const std::string who = owner_of(drive);
    if (drive.loop.empty())
      check_full_drive(scene, census.require_joint(drive.joint, drive.at, who),
                       JointKind::spherical, drive, driven, who);
    else if (drive.origin.empty())
      check_full_drive(scene, census.require_loop(drive.loop, drive.at, who), LoopKind::spherical,
                       drive, driven, who);
  }
}

}  // namespace momenta::reading
