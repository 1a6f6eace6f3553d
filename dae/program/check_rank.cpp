// The rank of loop equations, dependent ones, and simpler loops.

#include <cstdio>

#include "checked.h"

namespace momenta::program {
namespace {

const std::string& loop_of(const Mechanism& mechanism, int row) {
  return mechanism.rows()[static_cast<std::size_t>(row)].loop;
}

std::string in_words(const SimplerLoop& change) {
  return change.kind.empty() ? "loop '" + change.loop + "' can be left out"
                             : "a " + change.kind + " loop in place of '" + change.loop +
                                   "' ties as much, with " + std::to_string(change.fewer) +
                                   (change.fewer == 1 ? " equation" : " equations") + " less";
}

}  // namespace

void print_rank(const Mechanism& mechanism, const RankReport& r) {
  const int m = mechanism.m(), redundant = m - r.rank_nearby;
  std::printf(mechanism.scene().lagrangian ? "\nConstraints\n" : "\nLoop equations\n");
  if (r.rank == m) {
    std::printf("  independent: smallest singular value %.3g, of Φ_q without units\n", r.kept);
    return;
  }
  std::printf(
      "  rank %d of %d: smallest singular value that counts %.3g, largest that does not %.2g\n",
      r.rank, m, r.kept, r.dropped);
  if (r.poses == 0)
    std::printf("  nothing can move: whether this holds elsewhere cannot be told\n");
  else if (r.singular_here())
    std::printf(
        "  a singular pose: rank %d nearby. Motions in %d directions meet here; a run follows its "
        "velocities, and from rest may follow any\n",
        r.rank_nearby, mechanism.nv() - r.rank);
  for (const Dependency& d : r.dependencies)
    std::printf("  %s: %s\n", d.only_here ? "only here" : "redundant",
                in_words(mechanism, d).c_str());
  if (redundant > 0) {
    for (const SimplerLoop& change : r.simpler) std::printf("  %s\n", in_words(change).c_str());
    if (r.simpler.empty() && !mechanism.scene().lagrangian)
      std::printf(
          "  no simpler kind of loop ties as much: how the loops share the load is not "
          "determined\n");
  }
}

nlohmann::ordered_json rank_json(const Mechanism& mechanism, const RankReport& r) {
  nlohmann::ordered_json j;
  j["rank"] = r.rank;
  j["kept"] = r.kept;
  j["dropped"] = r.dropped;
  j["poses_nearby"] = r.poses;
  j["rank_nearby"] = r.rank_nearby;
  j["dependencies"] = nlohmann::json::array();
  for (const Dependency& d : r.dependencies) {
    nlohmann::ordered_json one{{"loop", loop_of(mechanism, d.row)},
                               {"row", mechanism.rows()[static_cast<std::size_t>(d.row)].what},
                               {"only_here", d.only_here},
                               {"words", in_words(mechanism, d)}};
    j["dependencies"].push_back(std::move(one));
  }
  j["simpler"] = nlohmann::json::array();
  for (const SimplerLoop& change : r.simpler)
    j["simpler"].push_back(
        {{"loop", change.loop}, {"kind", change.kind}, {"equations_fewer", change.fewer}});
  return j;
}

}  // namespace momenta::program
