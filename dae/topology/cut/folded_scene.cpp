#include <momenta/core/text/quoting.h>
#include <momenta/dae/topology/cut/folded_scene.h>

#include <algorithm>
#include <cstdio>

namespace momenta {

std::string in_words(const FoldedScene& folded) {
  constexpr std::size_t most_named = 8;
  std::vector<std::pair<std::string, std::vector<std::string>>> by_carrier;
  for (const CarriedBody& c : folded.carried) {
    auto at = std::find_if(by_carrier.begin(), by_carrier.end(),
                           [&](const auto& x) { return x.first == c.carrier; });
    if (at == by_carrier.end()) at = by_carrier.insert(at, {c.carrier, {}});
    at->second.push_back(c.body);
  }
  std::string words;
  const auto add = [&](const std::string& part) { words += (words.empty() ? "" : "; ") + part; };
  for (std::size_t i = 0; i < by_carrier.size() && i < most_named; ++i) {
    const auto& [carrier, bodies] = by_carrier[i];
    add("welded into " + (carrier == "ground" ? "the ground" : reading::in_quotes(carrier)) + ": " +
        reading::all_in_quotes(bodies, most_named));
  }
  if (by_carrier.size() > most_named)
    add("others into " + std::to_string(by_carrier.size() - most_named) + " more bodies");
  for (std::size_t i = 0; i < folded.following.size() && i < most_named; ++i) {
    const FollowingJoint& f = folded.following[i];
    char inertia[32];
    std::snprintf(inertia, sizeof inertia, "%.4g", f.inertia);
    add("rotor " + reading::in_quotes(f.body) + " taken as " + inertia +
        (f.slides ? " kg" : " kg m²") + " at joint " + reading::in_quotes(f.leader));
  }
  if (folded.following.size() > most_named)
    add(std::to_string(folded.following.size() - most_named) + " more rotors likewise");
  return words;
}

}  // namespace momenta
