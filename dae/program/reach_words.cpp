#include <momenta/dae/text/number_text.h>

#include <cstdio>
#include "reach_words.h"

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

std::string cuts_in_words(const Recut& recut) {
  const CutCost &a = recut.before, &b = recut.after;
  if (!recut.gains()) return "no other cuts found that would be less work";
  char numbers[256];
  std::snprintf(numbers, sizeof numbers,
                "at most %d loop equations open at once, now %d; work on loops %.3g, now %.3g; "
                "entries of M %.3g, now %.3g; tree %d deep, now %d",
                b.open, a.open, static_cast<double>(b.work), static_cast<double>(a.work),
                static_cast<double>(b.mass_entries), static_cast<double>(a.mass_entries), b.depth,
                a.depth);
  std::string factors;
  if (b.factor_entries > 0) {
    char text[64];
    std::snprintf(text, sizeof text, "; entries of the factors %.3g, now %.3g",
                  static_cast<double>(b.factor_entries), static_cast<double>(a.factor_entries));
    factors = text;
  }
  return in_words(recut) + ": " + numbers + factors;
}

}  // namespace momenta::program
