#include "cut_words.h"

#include <momenta/core/scene/near_name.h>

#include <cstdio>

namespace momenta::program {
namespace {

constexpr std::size_t most_named = 4;

}  // namespace

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
  if (recut.cut.empty())
    return std::string("trees on the ground in another order: ") + numbers + factors;
  return "cut at " + reading::all_in_quotes(recut.cut, most_named) + ", with " +
         reading::all_in_quotes(recut.joined, most_named) + " in the tree: " + numbers + factors;
}

}  // namespace momenta::program
