#include "cut_words.h"

#include <cstdio>

namespace momenta::program {
namespace {

constexpr std::size_t most_named = 4;

std::string first_named(const std::vector<std::string>& names) {
  std::string all;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i == most_named) return all + " and " + std::to_string(names.size() - i) + " more";
    all += (i == 0 ? "'" : ", '") + names[i] + "'";
  }
  return all;
}

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
  return "cut at " + first_named(recut.cut) + ", with " + first_named(recut.joined) +
         " in the tree: " + numbers + factors;
}

}  // namespace momenta::program
