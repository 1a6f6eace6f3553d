#include <momenta/core/scene/kinds.h>
#include <momenta/core/scene/near_name.h>
#include <momenta/core/scene/validate_parts.h>

#include <cmath>
#include <set>
#include <utility>

namespace momenta::reading {

void check_coupler(const Scene& scene, const Census& census, const LoopSpec& loop) {
  const std::string who = "loop " + in_quotes(loop.name);
  const std::size_t n = loop.joints.size();
  const auto sized = [&](std::size_t size, const char* what) {
    require(size == n, scene, loop.at, who,
            (std::string(what) + " has " + std::to_string(size) + " entries and joints " +
             std::to_string(n) + ", expected as many")
                .c_str());
  };
  require(n > 0, scene, loop.at, who, "joints is empty, expected at least one");
  sized(loop.ratios.size(), "ratios");
  if (!loop.coordinates.empty()) sized(loop.coordinates.size(), "coordinates");
  require(std::isfinite(loop.offset), scene, loop.at, who, "offset must be finite [rad or m]");
  std::set<std::pair<std::string, int>> coupled;
  bool all_driven = true;
  for (std::size_t i = 0; i < n; ++i) {
    const JointSpec& joint = census.require_joint(loop.joints[i], loop.at, who);
    const int coordinate = loop.coordinates.empty() ? 0 : loop.coordinates[i];
    const std::string named = "joint " + in_quotes(joint.name);
    if (joint.kind == JointKind::spherical || joint.kind == JointKind::free ||
        joint.kind == JointKind::weld || joint.kind == JointKind::user)
      throw SceneError(scene.where(loop.at) + who + ": " + named + " is " +
                       std::string(name_of(joint.kind)) +
                       ", expected joints whose coordinates are angles and displacements");
    const int count = rates_of(joint.kind);
    if (coordinate < 0 || coordinate >= count)
      throw SceneError(scene.where(loop.at) + who + ": coordinate of " + named + " is " +
                       std::to_string(coordinate) + ", expected " +
                       (count == 1 ? std::string("0") : "0 to " + std::to_string(count - 1)) +
                       " for a " + std::string(name_of(joint.kind)) + " joint");
    require(std::isfinite(loop.ratios[i]) && loop.ratios[i] != 0, scene, loop.at, who,
            "ratios must be finite and not zero");
    require(coupled.emplace(joint.name, coordinate).second, scene, loop.at, who,
            ("coordinate " + std::to_string(coordinate) + " of " + named +
             " is there twice, expected once with the sum of its ratios")
                .c_str());
    all_driven &= drive_of(scene, &DriveSpec::joint, joint.name, coordinate) != nullptr;
  }
  require(!all_driven, scene, loop.at, who,
          "all its joints are driven, expected one that is free to follow");
}

}  // namespace momenta::reading
