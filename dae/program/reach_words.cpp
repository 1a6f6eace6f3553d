#include "reach_words.h"

#include <momenta/dae/text/number_text.h>

namespace momenta::program {

bool has_reach(const Mechanism& mechanism) {
  return !mechanism.scene().drives.empty() && mechanism.m() > 0;
}

std::string in_words(const DriveReach& reach, double end) {
  if (!reach.obstacle.empty()) return reach.obstacle;
  if (!reach.determined && reach.until >= end)
    return "loops move by forces too: whether they stay closed is for a run to tell";
  std::string words = "loops close along the drives up to t = " + compact(reach.until, 6) + " s";
  if (reach.until < end) words += ", further on was not looked at";
  return words;
}

nlohmann::ordered_json reach_json(const DriveReach& reach) {
  nlohmann::ordered_json j{{"determined", reach.determined}, {"until_s", reach.until}};
  j["obstacle"] = nullptr;
  if (!reach.obstacle.empty()) j["obstacle"] = reach.obstacle;
  return j;
}

}  // namespace momenta::program
