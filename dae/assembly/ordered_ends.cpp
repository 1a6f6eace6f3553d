#include <momenta/core/scene/turned_round.h>
#include <momenta/dae/assembly/ordered_ends.h>

#include <set>
#include <string>
#include <unordered_map>

namespace momenta {

std::optional<Scene> with_ordered_ends(const Scene& scene) {
  std::set<std::string> driven;
  for (const DriveSpec& drive : scene.drives) driven.insert(drive.loop);
  std::unordered_map<std::string, int> place;  // the ground before all: 0
  for (const BodySpec& body : scene.bodies)
    place.emplace(body.name, static_cast<int>(place.size()) + 1);
  std::optional<Scene> ordered;
  for (std::size_t i = 0; i < scene.loops.size(); ++i) {
    const LoopSpec& loop = scene.loops[i];
    if (!can_turn_round(loop) || driven.contains(loop.name)) continue;
    const auto of = [&](const std::string& body) {
      const auto found = place.find(body);
      return found == place.end() ? 0 : found->second;
    };
    if (of(loop.parent) <= of(loop.child)) continue;
    if (!ordered) ordered = scene;
    ordered->loops[i] = turned_round(loop);
  }
  return ordered;
}

}  // namespace momenta
