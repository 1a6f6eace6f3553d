#include <momenta/core/scalar/all_finite.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/scene/validate_parts.h>
#include <momenta/core/text/quoting.h>

#include <cmath>
#include <set>
#include <utility>

namespace momenta::reading {
namespace {

/// Joints, coordinates and ratios of couplers and coordinate springs. `may_vanish`: the last ratio
/// may be zero.
template <class Sum>
bool check_sum(const Scene& scene, const Census& census, const Sum& sum, const Subject& who,
               bool may_vanish) {
  const std::size_t n = sum.joints.size();
  const auto sized = [&](std::size_t size, const char* what) {
    who.require(size == n, (std::string(what) + " has " + std::to_string(size) +
                            " entries and joints " + std::to_string(n) + ", expected as many"));
  };
  who.require(n > 0, "joints is empty, expected at least one");
  sized(sum.ratios.size(), "ratios");
  if (!sum.coordinates.empty()) sized(sum.coordinates.size(), "coordinates");
  std::set<std::pair<std::string, int>> met;
  bool all_driven = true;
  for (std::size_t i = 0; i < n; ++i) {
    const JointSpec& joint = census.require_joint(sum.joints[i], who);
    const int coordinate = sum.coordinates.empty() ? 0 : sum.coordinates[i];
    const std::string named = "joint " + in_quotes(joint.name);
    if (joint.kind == JointKind::spherical || joint.kind == JointKind::free ||
        joint.kind == JointKind::weld || joint.kind == JointKind::user)
      who.fail(named + " is " + std::string(name_of(joint.kind)) +
               ", expected joints whose coordinates are angles and displacements");
    const int count = rates_of(joint.kind);
    if (coordinate < 0 || coordinate >= count)
      who.fail("coordinate of " + named + " is " + std::to_string(coordinate) + ", expected " +
               (count == 1 ? std::string("0") : "0 to " + std::to_string(count - 1)) + " for a " +
               std::string(name_of(joint.kind)) + " joint");
    who.require(std::isfinite(sum.ratios[i]) && (sum.ratios[i] != 0 || (may_vanish && i + 1 == n)),
                "ratios has one that is 0 or not finite, expected finite ones other than 0");
    who.require(met.emplace(joint.name, coordinate).second,
                ("coordinate " + std::to_string(coordinate) + " of " + named +
                 " is there twice, expected once with the sum of its ratios"));
    all_driven &= drive_of(scene, &DriveSpec::joint, joint.name, coordinate) != nullptr;
  }
  return all_driven;
}

}  // namespace

bool check_coordinates(const Scene& scene, const Census& census, const LoopSpec& coupler,
                       const Subject& who) {
  return check_sum(scene, census, coupler, who, has_powers(coupler));
}
bool check_coordinates(const Scene& scene, const Census& census, const ForceSpec& spring,
                       const Subject& who) {
  return check_sum(scene, census, spring, who, false);
}

void check_coupler(const Scene& scene, const Census& census, const LoopSpec& loop) {
  const Subject who{scene, loop.at, "loop " + in_quotes(loop.name)};
  who.require(std::isfinite(loop.offset), "offset must be finite [rad or m]");
  who.require(loop.powers.size() <= 3 && all_finite(loop.powers),
              "powers must be finite and at most three: of the second to fourth power");
  const bool all_driven = check_coordinates(scene, census, loop, who);
  who.require(!all_driven, "all its joints are driven, expected one that is free to follow");
  if (!has_powers(loop)) return;
  const int last = loop.coordinates.empty() ? 0 : loop.coordinates.back();
  who.require(drive_of(scene, &DriveSpec::joint, loop.joints.back(), last) == nullptr,
              "takes powers of a driven coordinate, expected one that is not driven");
}

}  // namespace momenta::reading
